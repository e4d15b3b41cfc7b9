"""Bad days: kills, full disks, locked folders, no memory. ``scripts/faults`` kills a hundred times."""

import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.left_behind import complaints
from twin.errors import UsageError
from twin.run.run_folder import run_folder

pytestmark = pytest.mark.processes

JOB = Path(__file__).parents[1] / "programs" / "fagor8070" / "bolt_hole_ring.toml"


def start(folder: Path, before: Callable[[], None] | None = None) -> "subprocess.Popen[str]":
    return subprocess.Popen(
        [sys.executable, "-m", "twin", "run", str(JOB), "--out", str(folder)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=before,  # noqa: PLW1509 (limits can be set nowhere else)
    )


def limited(what: int, to: int) -> Callable[[], None]:
    return lambda: resource.setrlimit(what, (to, to))


@pytest.mark.parametrize("stop", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_a_run_that_is_stopped_leaves_nothing_torn(tmp_path: Path, stop: signal.Signals) -> None:
    run = start(tmp_path)
    deadline = time.monotonic() + 60.0
    while run.poll() is None and not list(tmp_path.glob(".*.part.*")):
        assert time.monotonic() < deadline
        time.sleep(0.01)
    run.send_signal(stop)
    _, said = run.communicate(timeout=60)
    assert complaints(tmp_path) == []
    if stop is not signal.SIGKILL and run.returncode != 0:
        assert run.returncode == 130, said
        assert "interrupted" in said
        assert list(tmp_path.glob(".*")) == []


THROUGH_AN_EXEC = """
import os, signal, sys
import twin.__main__, twin.cli

def interrupted(stopped):
    try:
        exec("os.kill(os.getpid(), signal.SIGINT)")
    except KeyboardInterrupt:
        raise SystemExit(130)

twin.cli.main = interrupted
twin.__main__.main()
"""


def test_an_interruption_within_an_exec_ends_with_the_code_too(tmp_path: Path) -> None:
    (tmp_path / "through_an_exec.py").write_text(THROUGH_AN_EXEC)
    root = Path(__file__).parents[1]
    surroundings = {**os.environ, "PYTHONPATH": f"{root}{os.pathsep}{tmp_path}"}
    done = subprocess.run(
        [sys.executable, "-m", "through_an_exec"], env=surroundings, check=False, timeout=60
    )
    assert done.returncode == 130


def ended(script: str) -> "subprocess.CompletedProcess[str]":
    """A process of Python that has run a script beside the package."""
    return subprocess.run(
        [sys.executable, "-c", script],
        cwd=Path(__file__).parents[1], capture_output=True, text=True, check=False, timeout=60,
    )  # fmt: skip


WITHIN_A_LIBRARY = """
import os, signal
import twin.__main__, twin.cli

def library():
    try:
        os.kill(os.getpid(), signal.SIGTERM)
    except KeyboardInterrupt as stop:
        raise SystemError("a callback returned a result with an exception set") from stop

twin.cli.app = library
twin.__main__.main()
"""


def test_an_interruption_that_a_library_makes_another_error_of_is_one() -> None:
    done = ended(WITHIN_A_LIBRARY)
    assert done.returncode == 130
    assert done.stderr == "interrupted: what was complete is kept, nothing is torn\n"


WHILE_PYTHON_LEAVES = """
import atexit, os, signal
import twin.__main__, twin.cli

def done(stopped):
    raise SystemExit(1)

atexit.register(lambda: os.kill(os.getpid(), signal.SIGINT))
twin.cli.main = done
twin.__main__.main()
"""


def test_an_interruption_after_the_end_changes_nothing() -> None:
    done = ended(WHILE_PYTHON_LEAVES)
    assert (done.returncode, done.stderr) == (1, "")


def test_a_full_disk_ends_the_run_with_a_sentence(tmp_path: Path) -> None:
    run = start(tmp_path, limited(resource.RLIMIT_FSIZE, 100_000))
    _, said = run.communicate(timeout=120)
    assert run.returncode == 2
    assert "Traceback" not in said
    assert said.strip()
    assert list(tmp_path.iterdir()) == []


def test_no_memory_ends_the_run_without_torn_files(tmp_path: Path) -> None:
    run = start(tmp_path, limited(resource.RLIMIT_AS, 400_000_000))
    _, said = run.communicate(timeout=120)
    assert run.returncode != 0
    assert said.strip()
    assert complaints(tmp_path) == []


def test_a_folder_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("")
    run = start(file / "out")
    _, said = run.communicate(timeout=60)
    assert run.returncode == 2
    assert str(file) in said
    assert "Traceback" not in said


def test_two_runs_do_not_share_a_folder(tmp_path: Path) -> None:
    with run_folder(tmp_path, []):
        run = start(tmp_path)
        _, said = run.communicate(timeout=60)
    assert run.returncode == 2
    assert "another run" in said


def hold(folder: Path) -> None:
    with run_folder(folder, ["result.json"]):
        pass


def test_what_killed_runs_left_is_removed(tmp_path: Path) -> None:
    for name in (".recording.0123.part.h5", "result.json", "notes.txt"):
        (tmp_path / name).write_text("")
    hold(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["notes.txt"]
    with run_folder(tmp_path, []), pytest.raises(UsageError, match="another run"):
        hold(tmp_path)


def test_a_window_library_that_mujoco_does_not_know_is_refused() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "twin", "--version"],
        env={**os.environ, "MUJOCO_GL": "wrong"}, capture_output=True, text=True, check=False, timeout=60,
    )  # fmt: skip
    assert done.returncode == 2
    assert "MUJOCO_GL=wrong" in done.stderr
    assert "egl" in done.stderr
