"""One LinuxCNC at a time, and its operator, without LinuxCNC."""

import io
import json
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from twin.commands.live.link import _explain_blending
from twin.errors import UsageError
from twin.link import linuxcnc
from twin.link.headless_screen import FailedError, LinuxcncClient
from twin.link.program_reading import Listing


@pytest.fixture
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """LinuxCNC's start script and its lock, and a claim of these tests alone."""
    monkeypatch.setattr(shutil, "which", lambda _: "/usr/bin/linuxcnc")
    monkeypatch.setattr(linuxcnc, "LOCK", tmp_path / "linuxcnc.lock")
    monkeypatch.setattr(linuxcnc, "_CLAIM", f"\0{tmp_path}".encode())
    return tmp_path / "linuxcnc.lock"


def test_a_second_twin_is_refused_until_the_first_has_ended(installed: Path):
    with (
        linuxcnc.claimed_linuxcnc() as start,
        pytest.raises(UsageError, match="another twin works LinuxCNC"),
        linuxcnc.claimed_linuxcnc(),
    ):
        pass
    assert start == Path("/usr/bin/linuxcnc")
    with linuxcnc.claimed_linuxcnc():
        assert not installed.exists()


def test_a_linuxcnc_of_somebody_else_is_left_alone(installed: Path):
    installed.touch()
    with pytest.raises(UsageError, match="halrun -U"), linuxcnc.claimed_linuxcnc():
        pass
    assert installed.exists()


def test_the_operator_leaves_as_soon_as_the_twin_has_gone():
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    silent = SimpleNamespace(
        state=lambda _: None, poll=lambda: None, task_state=1, STATE_ESTOP_RESET=2
    )
    module = SimpleNamespace(
        command=lambda: silent, stat=lambda: silent, error_channel=lambda: silent,
        STATE_ESTOP_RESET=2,
    )  # fmt: skip
    log = io.StringIO()
    operator = LinuxcncClient(module, log, gone.pid)
    with pytest.raises(FailedError, match="the twin has gone"):
        operator.switch_on(1)
    operator.tell("failed", "the twin has gone")
    assert json.loads(log.getvalue()) == {"event": "failed", "text": "the twin has gone"}


@pytest.mark.parametrize(
    ("block", "explained"),
    [
        ("G64", True),
        ("G21 g064 G1 X1", True),
        ("G64 P0.01", False),
        ("(G64)", False),
        ("G1 X64", False),
    ],
)
def test_a_g64_without_p_is_explained_with_its_line(
    capsys: pytest.CaptureFixture[str], block: str, explained: bool
) -> None:
    _explain_blending(Listing(Path("part.ngc"), f"G21\n{block}\nM2\n"))
    assert ("part.ngc:2: G64 without P" in capsys.readouterr().err) == explained


def test_a_part_that_only_hands_on_what_it_is_told_is_none(tmp_path: Path):
    """``loadrt`` starts an ``rtapi_app`` that ends at once: only the one that stays is watched."""
    program = tmp_path / "rtapi_app"
    shutil.copy("/bin/sleep", program)
    start = subprocess.Popen(["/bin/sleep", "60"])
    control = linuxcnc.LinuxCnc(start, tmp_path, tmp_path / "log")
    environment = {"HOME": str(tmp_path)}
    handing, staying = (
        subprocess.Popen([program, "60"], env=environment, start_new_session=leads)
        for leads in (False, True)
    )
    try:
        assert control.goes_on()
        handing.kill()
        handing.wait()
        assert control.goes_on()
        staying.kill()
        staying.wait()
        assert not control.goes_on()
        assert control.lost == "rtapi_app"
    finally:
        for process in (start, handing, staying):
            process.kill()
            process.wait()
