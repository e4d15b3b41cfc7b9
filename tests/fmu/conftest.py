"""One short program on ``mill4``: its setpoints, and what the twin's own machine does with them as a whole."""

import numpy as np
import pytest

from tests.fmu.recorded import START, Recorded
from twin.columns import join
from twin.files.shipped import machine_file
from twin.machine.load import read_machine
from twin.machine.simulation.live import LiveMachine
from twin.motion.planner import plan
from twin.nc.control.settings import ControlSettings
from twin.nc.dialects import dialect_named
from twin.nc.interpreter import Interpretation
from twin.nc.text.source import source_from_text

PROGRAM = "G90 G94 G17 G21\nG1 X12 Y5 F3000\nG2 X20 Y-3 I8 J0\nG0 Z4 C30\nM2\n"


@pytest.fixture(scope="session")
def recorded() -> Recorded:
    machine = read_machine(machine_file("mill4"))
    zero = np.array(START)
    program = Interpretation(
        source_from_text(PROGRAM), dialect_named("linuxcnc"), ControlSettings(axes=machine.axes)
    )
    limits, period = machine.motion_limits, machine.file.servo_period_s
    points = join(list(plan(program.chunks(), limits, period_s=period, part_zero=zero, start=zero)))
    samples = LiveMachine(machine, position=zero).follow(points[1:])
    assert len(samples) == len(points) - 1
    return Recorded(
        points.position[1:],
        points.velocity[1:],
        points.acceleration[1:],
        samples.joint_position,
        samples.joint_velocity,
        samples.drive_force,
    )
