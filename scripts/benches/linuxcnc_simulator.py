"""LinuxCNC's planner as a peer: its simulated machine, without a screen, sampled every servo cycle.

It needs Debian's ``linuxcnc-uspace``. LinuxCNC refuses to run as root; there it runs as ``nobody``.
"""

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from twin.motion.limits import MotionLimits
from twin.nc.canonical import FloatArray

PERIOD_S = 0.001
AXES = "XYZC"
TIMEOUT_S = 300
"""Its programs run in real time; it takes some seconds to start."""

CONFIGURATION = """[EMC]
VERSION = 1.1
MACHINE = peer
[DISPLAY]
DISPLAY = {folder}/drive.py
[TASK]
TASK = milltask
CYCLE_TIME = 0.001
[RS274NGC]
PARAMETER_FILE = {folder}/peer.var
[EMCMOT]
EMCMOT = motmod
COMM_TIMEOUT = 10.0
SERVO_PERIOD = 1000000
[EMCIO]
EMCIO = io
CYCLE_TIME = 0.1
TOOL_TABLE = {folder}/peer.tbl
[HAL]
HALFILE = {folder}/peer.hal
[TRAJ]
COORDINATES = X Y Z C
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
MAX_LINEAR_VELOCITY = {velocity}
MAX_LINEAR_ACCELERATION = {acceleration}
MAX_ANGULAR_VELOCITY = {rotary_velocity}
MAX_ANGULAR_ACCELERATION = {rotary_acceleration}
NO_FORCE_HOMING = 1
[KINS]
KINEMATICS = trivkins coordinates=XYZC
JOINTS = 4
"""

JOINT = """[AXIS_{name}]
MAX_VELOCITY = {velocity}
MAX_ACCELERATION = {acceleration}
MIN_LIMIT = -100000
MAX_LIMIT = 100000
[JOINT_{number}]
TYPE = {kind}
MAX_VELOCITY = {velocity}
MAX_ACCELERATION = {acceleration}
MIN_LIMIT = -100000
MAX_LIMIT = 100000
FERROR = 100
MIN_FERROR = 100
HOME = 0
HOME_OFFSET = 0
HOME_SEARCH_VEL = 0
HOME_LATCH_VEL = 0
HOME_SEQUENCE = 0
"""

WIRING = """loadrt trivkins coordinates=XYZC
loadrt motmod servo_period_nsec=1000000 num_joints=4
loadrt sampler depth=60000 cfg=ffff
setp sampler.0.enable 0
addf motion-command-handler servo-thread
addf motion-controller servo-thread
addf sampler.0 servo-thread
net x joint.0.motor-pos-cmd => joint.0.motor-pos-fb sampler.0.pin.0
net y joint.1.motor-pos-cmd => joint.1.motor-pos-fb sampler.0.pin.1
net z joint.2.motor-pos-cmd => joint.2.motor-pos-fb sampler.0.pin.2
net c joint.3.motor-pos-cmd => joint.3.motor-pos-fb sampler.0.pin.3
net estop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in
net prepare iocontrol.0.tool-prepare => iocontrol.0.tool-prepared
net change iocontrol.0.tool-change => iocontrol.0.tool-changed
"""

OPERATOR = '''#!/usr/bin/python3
"""Stands in for LinuxCNC's screen: runs every program of its folder once and leaves."""
import pathlib, signal, subprocess, time
import linuxcnc
command, status = linuxcnc.command(), linuxcnc.stat()
def wait(done):
    end = time.time() + 60.0
    while time.time() < end:
        status.poll()
        if done():
            return
        time.sleep(0.02)
    raise SystemExit("LinuxCNC does not answer")
time.sleep(1.0)
command.state(linuxcnc.STATE_ESTOP_RESET)
wait(lambda: status.task_state >= linuxcnc.STATE_ESTOP_RESET)
command.state(linuxcnc.STATE_ON)
wait(lambda: status.task_state == linuxcnc.STATE_ON)
for joint in range(4):
    command.home(joint)
wait(lambda: all(status.homed[:4]))
for program in sorted(pathlib.Path(__file__).parent.glob("*.ngc")):
    command.mode(linuxcnc.MODE_AUTO)
    command.wait_complete()
    with program.with_suffix(".samples").open("w") as out:
        sampling = subprocess.Popen(["halsampler"], stdout=out)
        time.sleep(0.3)
        subprocess.run(["halcmd", "setp", "sampler.0.enable", "1"], check=True)
        command.program_open(str(program))
        command.wait_complete()
        command.auto(linuxcnc.AUTO_RUN, 0)
        wait(lambda: not status.inpos)
        wait(lambda: status.interp_state == linuxcnc.INTERP_IDLE and status.inpos)
        time.sleep(0.3)
        subprocess.run(["halcmd", "setp", "sampler.0.enable", "0"], check=True)
        time.sleep(0.3)
        sampling.send_signal(signal.SIGINT)
        sampling.wait()
'''


def installed() -> bool:
    """Whether LinuxCNC is there."""
    return shutil.which("linuxcnc") is not None and shutil.which("halsampler") is not None


def commanded(programs: dict[str, str], limits: MotionLimits) -> dict[str, FloatArray]:
    """Run programs with LinuxCNC's own planner.

    Args:
        programs: G-code by a name without blanks, millimetres; each begins and ends at zero.
        limits: Velocities and accelerations of X, Y, Z and C; LinuxCNC knows no jerk.

    Returns:
        Commanded positions by name while something moves, one row per servo cycle, shape (n, 4).

    Raises:
        subprocess.SubprocessError: LinuxCNC failed or did not come to its end.
    """
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        text = CONFIGURATION.format(
            folder=folder,
            velocity=max(limits.velocity[:3]), acceleration=max(limits.acceleration[:3]),
            rotary_velocity=limits.velocity[3], rotary_acceleration=limits.acceleration[3],
        )  # fmt: skip
        for number, axis in enumerate(AXES):
            text += JOINT.format(
                name=axis, number=number, kind="ANGULAR" if axis == "C" else "LINEAR",
                velocity=limits.velocity[number], acceleration=limits.acceleration[number],
            )  # fmt: skip
        (folder / "peer.ini").write_text(text, encoding="utf-8")
        (folder / "peer.hal").write_text(WIRING, encoding="utf-8")
        (folder / "peer.tbl").write_text("T1 P1 D10\n", encoding="utf-8")
        (folder / "peer.var").write_text("", encoding="utf-8")
        (folder / "drive.py").write_text(OPERATOR, encoding="utf-8")
        (folder / "drive.py").chmod(0o755)
        for program, lines in programs.items():
            (folder / f"{program}.ngc").write_text(lines, encoding="utf-8")
        command = ["env", f"HOME={folder}", "linuxcnc", "-r", str(folder / "peer.ini")]
        if os.geteuid() == 0:
            shutil.chown(folder, "nobody")
            for file in folder.iterdir():
                shutil.chown(file, "nobody")
            command = ["runuser", "-u", "nobody", "--", *command]
        subprocess.run(  # noqa: S603 - names no user has a hand in
            command, check=True, capture_output=True, timeout=TIMEOUT_S
        )
        return {
            program: _moving((folder / f"{program}.samples").read_text(encoding="utf-8"))
            for program in programs
        }


def _moving(samples: str) -> FloatArray:
    """The samples from the first that moves to the last."""
    lines = samples.splitlines()
    if lines and lines[0] == "overrun":
        # The sampler counts what nobody asked for before it was listened to.
        del lines[0]
    if "overrun" in lines:
        raise subprocess.SubprocessError("LinuxCNC's sampler lost samples")
    position = np.array([[float(word) for word in line.split()] for line in lines])
    moves = np.flatnonzero(np.any(np.diff(position, axis=0) != 0.0, axis=1))
    if len(moves) == 0:
        raise subprocess.SubprocessError("LinuxCNC did not move")
    return position[moves[0] : moves[-1] + 2]
