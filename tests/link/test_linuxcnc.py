"""LinuxCNC itself on the twin; these tests run where it is installed (``scripts/link`` does that)."""

import contextlib
import fcntl
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from command_line import Finished, Twin

from tests.machine.machine_fixtures import three_axis_machine
from tests.nc.running import good
from twin.columns import join
from twin.files.shipped import machine_file
from twin.link.component import COMPILER, is_installed, module_folder
from twin.link.linuxcnc import LOCK, OPERATOR, process_name, processes_at_home
from twin.machine.load import read_machine
from twin.machine.model.model import MachineModel
from twin.machine.simulation.simulate import simulate
from twin.recording.form import STEPS
from twin.recording.reader import open_recording
from twin.run.replay import open_scene

LINUXCNC = shutil.which("linuxcnc")


def cannot_run() -> str:
    """Why LinuxCNC cannot be driven here; empty: it can."""
    if LINUXCNC is None:
        return "linuxcnc-uspace is not installed"
    modules = module_folder(Path(LINUXCNC))
    if not is_installed(modules) and not os.access(modules, os.W_OK):
        return "LinuxCNC's component of this version is not installed, which takes root"
    if not is_installed(modules) and shutil.which(COMPILER) is None:
        return f"{COMPILER}, which builds LinuxCNC's component, is missing: linuxcnc-uspace-dev"
    return ""


pytestmark = [
    pytest.mark.oracle,
    pytest.mark.skipif(bool(cannot_run()), reason=cannot_run() or "it can"),
    pytest.mark.xdist_group("linuxcnc"),
]

takes_minutes = pytest.mark.by_hand("minutes of real time with LinuxCNC; scripts/link runs it")

SQUARE = """(a square with a rounded corner, a circle, and the table)
G21 G90 G61
G0 X0 Y0 Z5
G1 Z0 F1200
G1 X15 F3000
G1 Y10
G3 X10 Y15 I-5 J0
G1 X0
G1 Y0
G2 X0 Y0 I3 J0
G1 C10 F3600
G0 Z5
M2
"""
SPINDLE = "G21 G90 G61\nG0 X1\nS1000 M3\nG1 X2 F600\nM2\n"
MOVES = (
    "G1 X3 Y4",
    "G1 X2 C5",
    "G1 C5",
    "G2 X4 Y0 I2 J0",
    "G2 X4 Y0 Z-1 I2 J0",
    "G2 X4 Y0 C5 I2 J0",
)
_RAMPS_S = 0.02
"""More than starting and stopping add to a move of 13 mm/s [s]."""
FEEDS = {"G93": "F120", "G94": "F600", "G95": "F0.6"}
RAPID = "G21 G90\nG0 Z5\nG0 X200\nM2\n"
LONG = "G21 G90 G64\nG1 Z5 F600\n" + "G1 X20 F600\nG1 X0\n" * 30 + "M2\n"


@pytest.fixture
def folder() -> Iterator[Path]:
    """A folder that LinuxCNC's user may enter; one LinuxCNC at a time runs on a computer."""
    with (
        tempfile.TemporaryDirectory(prefix="twin-link-") as name,
        (Path(tempfile.gettempdir()) / "mill-twin-link.lock").open("w") as lock,
    ):
        Path(name).chmod(0o755)
        fcntl.flock(lock, fcntl.LOCK_EX)
        before = shared_memory()
        yield Path(name)
        left = processes_at_home(Path(name) / "out" / "linuxcnc")
        for number in left:
            os.kill(number, signal.SIGKILL)
        locked, shared = LOCK.exists(), shared_memory()
        LOCK.unlink(missing_ok=True)
        assert (left, locked, shared) == ([], False, before)


def shared_memory() -> set[str]:
    """Keys of the shared memory on this computer that is LinuxCNC's user's."""
    rows = subprocess.run(["ipcs", "-m"], capture_output=True, text=True, check=True).stdout
    return {row.split()[0] for row in rows.splitlines() if row.startswith("0x")}


def linked(twin: Twin, folder: Path, program: str, *options: object) -> Finished:
    path = folder / "part.ngc"
    path.write_text(program)
    return twin("link", "linuxcnc", "--out", folder / "out", "--headless", path, *options)


def result(folder: Path) -> dict:
    return json.loads((folder / "out" / "result.json").read_text())


def test_a_sound_machine_runs_a_program_and_can_be_played_back(folder: Path, twin: Twin):
    ran = linked(twin, folder, SQUARE, "--machine", "mill4")
    told = result(folder)
    assert ran.code in (0, 1), ran.stderr
    assert told["alarms"] == []
    assert told["link"]["missed"] == 0
    # LinuxCNC's own f-error is the recording's lag, to what commands are rounded to.
    assert told["link"]["f_error_difference"] < 1e-6
    assert told["tracking_um"]["X"]["max"] > 100.0
    with open_recording(folder / "out" / "recording.h5") as recording:
        samples = join(list(recording.chunks()))
        assert recording.header.program.endswith("program_as_read.nc")
    machine = read_machine(machine_file("mill4"))
    again = join(list(simulate(machine, MachineModel(machine), [samples.setpoint])))
    step = STEPS["joint/position"]
    assert np.array_equal(np.rint(again.joint_position / step) * step, samples.joint_position)
    lines = samples.setpoint.line
    assert set(lines.tolist()) == {0, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}
    assert np.all(np.diff(lines) >= 0)
    corner = samples.setpoint.position[lines == 6][0] - samples.setpoint.position[0]
    assert corner[:2] == pytest.approx([15.0, 0.0], abs=0.1)
    with open_scene(folder / "out" / "recording.h5") as (scene, _):
        assert len(scene.recording) == told["samples"]


def test_each_move_takes_the_time_that_its_f_says(folder: Path, twin: Twin):
    """Every kind of move with every mode of feed, by LinuxCNC's planner, which stops between."""
    text = "G21 G91 G61 G17\nM3 S1000\n" + "".join(
        f"{mode} {move} {feed}\nG4 P0.1\n" for mode, feed in FEEDS.items() for move in MOVES
    )
    text += "G20 G95 F0.02\nG1 X0.2\nG4 P0.1\nG94 G1 C5 F600\nM2\n"
    ran = linked(twin, folder, text, "--machine", "mill4")
    assert ran.code in (0, 1), ran.stderr
    with open_recording(folder / "out" / "recording.h5") as recording:
        setpoint = join(list(recording.chunks())).setpoint
    steps = np.diff(setpoint.position, axis=0, prepend=setpoint.position[:1])
    moving = np.any(np.abs(steps) > STEPS["setpoint/position"], axis=1)
    moves = good(text, "linuxcnc").moves
    assert len(moves) == len(FEEDS) * len(MOVES) + 2
    for line, seconds in zip(moves.line, moves.length / moves.feed * 60.0, strict=True):
        taken = np.count_nonzero(moving & (setpoint.line == line)) * 0.001
        assert taken == pytest.approx(seconds, abs=_RAMPS_S), line


@pytest.mark.parametrize(("waits", "least_s", "most_s"), [("true", 0.5, 0.8), ("false", 0.0, 0.3)])
def test_a_feed_waits_for_the_spindle_where_the_machine_does(
    folder: Path, twin: Twin, waits: str, least_s: float, most_s: float
):
    machine = folder / "slow_spindle.toml"
    machine.write_text(
        f'base = "mill4"\nname = "slow"\n[spindle]\nacceleration = 2000.0\nwaits = {waits}\n'
    )
    linked(twin, folder, SPINDLE, "--machine", machine)
    with open_recording(folder / "out" / "recording.h5") as recording:
        setpoint = join(list(recording.chunks())).setpoint
    x = setpoint.position[:, 0] - setpoint.position[0, 0]
    stood = np.count_nonzero((x > 0.999) & (x < 1.001)) * 0.001
    assert least_s <= stood <= most_s


def test_linuxcncs_own_limit_trips_where_the_lag_reaches_it(folder: Path, twin: Twin):
    ran = linked(twin, folder, RAPID, "--machine", "mill4", "--ferror", 2)
    told = result(folder)
    assert ran.code == 4
    assert "following error" in ran.stderr
    assert told["alarms"][0]["code"] == "following-error"
    with open_recording(folder / "out" / "recording.h5") as recording:
        samples = join(list(recording.chunks()))
    lag = np.abs(samples.setpoint.position - samples.joint_position)[:, 0]
    # It sees the lag of a period in the next one, and switches off in that.
    assert lag[:-2].max() <= 2.0 < lag.max() < 2.1


def test_the_twins_alarm_arrives_as_an_amplifier_fault_with_its_reason(folder: Path, twin: Twin):
    machine = folder / "dull.toml"
    machine.write_text('schema = 1\nname = "dull"\nbase = "mill4"\n[axes.X]\nkv = 1.5\n')
    ran = linked(twin, folder, RAPID, "--machine", machine, "--ferror", 100)
    assert ran.code == 4
    assert "joint 0 amplifier fault" in ran.stderr
    alarm = result(folder)["alarms"][0]
    assert (alarm["code"], alarm["line"]) == ("following-error", 3)
    with open_recording(folder / "out" / "recording.h5") as recording:
        samples = join(list(recording.chunks()))
    # A drive of 1.5 (m/min)/mm, critically damped, lags 2/w behind a ramp of acceleration a by
    # 2 v / w - 2 a / w^2 and so trips at 10 mm before the speed has come to 10 w / 2.
    speed = samples.setpoint.velocity[-1, 0]
    lag = (samples.setpoint.position - samples.joint_position)[-1, 0]
    assert 10.0 < lag < 10.5
    assert speed == pytest.approx(10.0 * 1.5 / 0.06, rel=0.6)
    log = (folder / "out" / "linuxcnc.log").read_text(errors="replace")
    assert "mill_twin: line" in log
    assert "following-error: X trails its setpoint" in log


def test_a_program_that_the_screen_opens_with_is_the_one_that_is_judged(
    folder: Path, twin: Twin, monkeypatch: pytest.MonkeyPatch
):
    """What works LinuxCNC without a screen stands in for one here: it does what somebody at AXIS does."""
    monkeypatch.setenv("DISPLAY", ":0")
    (folder / "part.ngc").write_text(SQUARE)
    screen, home = folder / "screen.py", folder / "out" / "linuxcnc"
    screen.write_text(OPERATOR.read_text())
    screen.chmod(0o755)
    worked = f"--program {home}/program.ngc --joints 4 --twin {os.getpid()} --log {home}/screen.log"
    ran = twin(
        "link", "linuxcnc", "--machine", "mill4", "--out", folder / "out",
        "--open", folder / "part.ngc", "--display", f"{screen} {worked}",
    )  # fmt: skip
    told = result(folder)
    assert ran.code in (0, 1), ran.stderr
    assert f"OPEN_FILE = {home}/program.ngc\n" in (home / "linuxcnc.ini").read_text()
    assert (home / "program.ngc").read_text() == SQUARE
    assert told["dialect"] == "linuxcnc"
    assert {block["line"] for block in told["blocks"]} >= {4, 5, 6, 7, 8, 9, 10, 11, 12}
    assert [block["motion"] for block in told["blocks"] if block["line"] in (3, 12)] == [
        "rapid"
    ] * 2


def test_a_screen_that_was_closed_before_the_programs_end_is_no_pass(
    folder: Path, twin: Twin, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setenv("DISPLAY", ":0")
    (folder / "part.ngc").write_text(SQUARE)
    ran = twin(
        "link", "linuxcnc", "--machine", "mill4", "--out", folder / "out",
        "--open", folder / "part.ngc", "--display", "sleep 1",
    )  # fmt: skip
    assert ran.code == 4
    assert [each["code"] for each in result(folder)["alarms"]] == ["control-stop"]


def test_a_program_that_linuxcnc_refuses_ends_with_its_line(folder: Path, twin: Twin):
    ran = linked(twin, folder, "G21\nG1 X1 F100\nG1 X2 Q\nM2\n")
    assert ran.code == 3
    assert "part.ngc:3:1: error linuxcnc:" in ran.stderr


def test_a_program_that_linuxcnc_gives_up_does_not_pass(folder: Path, twin: Twin):
    """Nothing orients the spindle: LinuxCNC gives up after Q seconds, and the last move is never made."""
    ran = linked(twin, folder, "G21 G90 G61\nG0 X1\nM19 R0 Q0.5\nG1 X2 F600\nM2\n")
    alarm = result(folder)["alarms"][0]
    assert ran.code == 4
    assert (alarm["code"], result(folder)["verdict"]) == ("control-stop", "alarm")
    assert "wait for orient complete: TIMED OUT" in alarm["message"]


@contextlib.contextmanager
def running_link(folder: Path) -> Iterator[subprocess.Popen[str]]:
    """The command in a process of its own, once LinuxCNC moves the twin."""
    path = folder / "part.ngc"
    path.write_text(LONG)
    process = subprocess.Popen(
        [
            sys.executable, "-m", "twin", "link", "linuxcnc", "--machine", "mill4",
            "--out", str(folder / "out"), "--headless", str(path),
        ],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    )  # fmt: skip
    log = folder / "out" / "linuxcnc" / "operator.jsonl"
    until(lambda: log.is_file() and "running" in log.read_text(), 300.0)
    time.sleep(1.0)
    try:
        yield process
    finally:
        process.kill()
        process.wait()
        if process.stdout is not None:
            process.stdout.close()


def until(done: Callable[[], bool], seconds: float) -> None:
    end = time.monotonic() + seconds
    while not done():
        assert time.monotonic() < end
        time.sleep(0.1)


@takes_minutes
@pytest.mark.parametrize("period_us", [500, 2000])
def test_another_servo_period_is_that_of_both(folder: Path, twin: Twin, period_us: int):
    ran = linked(twin, folder, SQUARE, "--machine", "mill4", "--period-us", period_us)
    told = result(folder)
    assert ran.code in (0, 1), ran.stderr
    assert told["alarms"] == []
    assert told["link"]["f_error_difference"] < 1e-6
    with open_recording(folder / "out" / "recording.h5") as recording:
        assert recording.header.period_s == pytest.approx(period_us * 1e-6)


@takes_minutes
def test_a_machine_without_rotary_axes_is_driven_too(folder: Path, twin: Twin):
    three_axis_machine(folder)
    program = SQUARE.replace("G1 C10 F3600\n", "")
    ran = linked(twin, folder, program, "--machine", folder / "three.toml")
    assert ran.code in (0, 1), ran.stderr
    assert result(folder)["alarms"] == []


@takes_minutes
def test_the_first_run_of_an_installation_compiles_before_linuxcnc_waits(
    folder: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(folder / "cache"))
    monkeypatch.setenv("HOME", str(folder))
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    path = folder / "part.ngc"
    path.write_text(SQUARE)
    ran = subprocess.run(
        [sys.executable, "-m", "twin", "link", "linuxcnc", "--machine", "mill4",
         "--out", str(folder / "out"), "--headless", str(path)],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert ran.returncode in (0, 1), ran.stderr
    assert "compiling what this run needs" in ran.stderr
    assert result(folder)["alarms"] == []


@takes_minutes
def test_a_second_twin_is_refused_and_leaves_the_first_alone(folder: Path, twin: Twin):
    with running_link(folder) as process:
        path = folder / "other.ngc"
        path.write_text(RAPID)
        ran = twin("link", "linuxcnc", "--out", folder / "other", "--headless", path)
        assert ran.code == 2
        assert "another twin works LinuxCNC" in ran.stderr
        assert process.poll() is None
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=60) == 130


@takes_minutes
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_run_leaves_no_linuxcnc(folder: Path, number: int):
    with running_link(folder) as process:
        process.send_signal(number)
        assert process.wait(timeout=60) == 130
    assert processes_at_home(folder / "out" / "linuxcnc") == []


@takes_minutes
def test_a_killed_twin_is_a_fault_and_linuxcnc_ends_by_itself(folder: Path):
    with running_link(folder) as process:
        process.kill()
        process.wait()
        log = folder / "out" / "linuxcnc" / "operator.jsonl"
        until(lambda: "failed" in log.read_text(), 120.0)
        # The start script takes its lock away before it ends itself.
        until(lambda: not LOCK.exists() and not processes_at_home(log.parent), 120.0)
    assert "amplifier fault" in log.read_text() or "the twin has gone" in log.read_text()
    assert "the twin does not answer" in (folder / "out" / "linuxcnc.log").read_text()
    assert not (folder / "out" / "result.json").exists()


@takes_minutes
def test_a_killed_linuxcnc_ends_the_run_with_an_alarm(folder: Path):
    with running_link(folder) as process:
        for number in processes_at_home(folder / "out" / "linuxcnc"):
            with contextlib.suppress(ProcessLookupError):
                os.kill(number, signal.SIGKILL)
        output, _ = process.communicate(timeout=300)
    assert process.returncode == 4, output
    told = result(folder)
    assert told["alarms"][0]["code"] == "control-stop"
    assert told["samples"] > 100
    assert told["alarms"][0]["line"] >= 2


@takes_minutes
def test_an_unloaded_component_ends_both_sides(folder: Path):
    home = folder / "out" / "linuxcnc"
    at_home = ["env", f"HOME={home}"]
    if os.geteuid() == 0:
        at_home = ["runuser", "-u", "nobody", "--", *at_home]
    with running_link(folder) as process:
        for order in (["delf", "mill-twin", "servo-thread"], ["unloadrt", "mill_twin"]):
            # LinuxCNC may be on its way out when the second comes.
            subprocess.run([*at_home, "halcmd", *order], check=False, timeout=60)
        output, _ = process.communicate(timeout=300)
    assert process.returncode == 4, output
    assert result(folder)["alarms"][0]["code"] in ("control-stop", "following-error")


@takes_minutes
def test_no_question_is_missed_with_a_busy_process_on_each_core(folder: Path, twin: Twin):
    busy = [
        subprocess.Popen([sys.executable, "-c", "while True: pass"])
        for _ in range(os.cpu_count() or 1)
    ]
    killer = threading.Timer(120.0, lambda: [process.kill() for process in busy])
    killer.start()
    try:
        ran = linked(twin, folder, SQUARE, "--machine", "mill4")
    finally:
        killer.cancel()
        for process in busy:
            process.kill()
            process.wait()
    told = result(folder)
    assert ran.code in (0, 1), ran.stderr
    assert told["alarms"] == []
    assert told["link"]["missed"] == 0
    assert told["link"]["f_error_difference"] < 1e-6


STOPS = "G21 G90 G61\nG1 X2 F1000\nM0\nG1 X3\nM1\nG1 X4\nM60\nG1 X5\nM2\n"


def test_a_program_that_waits_for_somebody_goes_on_and_says_so(folder: Path, twin: Twin):
    ran = linked(twin, folder, STOPS, "--machine", "mill4")
    assert ran.code == 0, ran.stderr
    assert ran.stderr.count("the program stops (M0, M1 or M60)") == 2
    told = result(folder)
    assert told["dialect"] == "linuxcnc"
    assert told["alarms"] == []


@takes_minutes
@pytest.mark.parametrize("part", ["milltask", "rtapi_app"])
def test_a_killed_part_of_linuxcnc_ends_the_run_and_is_named(folder: Path, part: str):
    home = folder / "out" / "linuxcnc"
    with running_link(folder) as process:
        time.sleep(2.0)
        (number,) = [each for each in processes_at_home(home) if process_name(each) == part]
        os.kill(number, signal.SIGKILL)
        output, _ = process.communicate(timeout=300)
    assert process.returncode == 4, output
    (alarm,) = result(folder)["alarms"]
    assert alarm["code"] == "control-stop"
    assert f"its process {part} has gone" in alarm["message"]


def test_a_soft_limit_ends_the_run_at_once(folder: Path, twin: Twin):
    ran = linked(twin, folder, "G21 G90 G61\nG1 X5 F1000\nG1 X5000\nM2\n", "--machine", "mill4")
    assert ran.code == 4
    assert "soft-limit" in ran.stderr
    assert result(folder)["wall_s"] < 15.0
