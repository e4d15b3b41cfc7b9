"""Compilation in another process: alone in its folder, and not lost with the process that began it."""

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from twin.compilation.beside import Beside

SERVES_UNTIL_TOLD = """
import pathlib, sys
from twin.compilation.beside import serve
serve(pathlib.Path(sys.argv[1]))
print("serves", flush=True)
sys.stdin.read()
"""
BEGINS_AND_ENDS = """
import os
from twin.compilation.beside import Beside
os.environ["BEGAN_BY"] = str(os.getpid())
Beside("outlives").start()
"""
OUTLIVES = """
import os, pathlib, time
from twin.compilation.beside import serve
from twin.compilation.folders import writable_folder
serve(writable_folder())
while os.getppid() == int(os.environ["BEGAN_BY"]):
    time.sleep(0.01)
pathlib.Path(os.environ["DONE"]).touch()
"""


@contextmanager
def server(folder: Path) -> Iterator[bytes]:
    """A process that serves in a folder, and its first line."""
    command = [sys.executable, "-c", SERVES_UNTIL_TOLD, str(folder)]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe) as process:
        assert process.stdout is not None
        yield process.stdout.readline()
        process.communicate(timeout=60)
        assert process.returncode == 0


def test_a_second_one_in_the_same_folder_ends_at_once(tmp_path: Path):
    with server(tmp_path) as first, server(tmp_path) as second:
        assert first == b"serves\n"
        assert second == b""


def test_a_process_that_looks_sees_what_another_began(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("twin.compilation.beside.writable_folder", lambda: tmp_path)
    other = Beside("nothing")
    assert not other.is_running()
    with server(tmp_path):
        assert other.is_running()
        other.start()
        assert other._process is None
    assert not other.is_running()


def test_where_nothing_can_be_locked_it_compiles_all_the_same(tmp_path: Path):
    with server(tmp_path / "missing") as line:
        assert line == b"serves\n"


def test_it_goes_on_when_the_process_that_began_it_has_ended(tmp_path: Path):
    (tmp_path / "outlives.py").write_text(OUTLIVES)
    done = tmp_path / "done"
    path = os.pathsep.join([str(tmp_path), *filter(None, sys.path)])
    environment = {
        **os.environ,
        "PYTHONPATH": path,
        "NUMBA_CACHE_DIR": str(tmp_path),
        "DONE": str(done),
    }
    subprocess.run([sys.executable, "-c", BEGINS_AND_ENDS], env=environment, check=True)
    deadline = time.monotonic() + 60.0
    while not done.exists() and time.monotonic() < deadline:
        time.sleep(0.02)
    assert done.exists()
