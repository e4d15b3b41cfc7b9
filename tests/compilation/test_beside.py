"""Compilation in another process: alone in its folder, and gone with the process that wants it."""

import subprocess
import sys
from pathlib import Path

SLEEPER = """
import pathlib, sys, time
from twin.compilation.beside import serve
serve(pathlib.Path(sys.argv[1]))
print("serves", flush=True)
time.sleep(600)
"""


def started(folder: Path) -> subprocess.Popen[bytes]:
    return subprocess.Popen(
        [sys.executable, "-c", SLEEPER, str(folder)], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )


def test_it_ends_when_its_parent_lets_go_of_the_pipe(tmp_path: Path):
    process = started(tmp_path)
    assert process.stdout is not None
    assert process.stdout.readline() == b"serves\n"
    process.communicate(timeout=60)
    assert process.returncode == 0


def test_a_second_one_in_the_same_folder_ends_at_once(tmp_path: Path):
    with started(tmp_path) as first:
        assert first.stdout is not None
        assert first.stdout.readline() == b"serves\n"
        second = started(tmp_path)
        assert second.stdout is not None
        assert second.stdout.read() == b""
        assert second.wait(timeout=60) == 0
        second.communicate()


def test_where_nothing_can_be_locked_it_compiles_all_the_same(tmp_path: Path):
    process = started(tmp_path / "missing")
    assert process.stdout is not None
    assert process.stdout.readline() == b"serves\n"
    process.communicate(timeout=60)
