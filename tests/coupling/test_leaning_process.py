"""Teeth in a part that is cut from any side: on one machine they feel what they feel in a height map."""

import dataclasses
from collections.abc import Iterator

import numpy as np
import pytest

from tests.coupling.test_cutting_process import SPEED, STOCK, TOOL, WAY, loads, run
from tests.machine.machine_fixtures import shipped_machine
from twin.coupling.cutting_process import CuttingProcess
from twin.coupling.leaning_process import LeaningProcess
from twin.coupling.operations import OperatorOperation, cutting_process
from twin.machine.description.config import MachineConfig

CELL = 0.2


def processes(machine: MachineConfig) -> Iterator[CuttingProcess | None]:
    """One slot of two processes: on the machine as a turntable, and on the same machine as a chain of joints."""
    turntable, zero = machine.part_frame, np.zeros(4)
    chain = dataclasses.replace(turntable, rotary=None, chain=machine.kinematics, zero=zero)
    for frame in (turntable, chain):
        operation = OperatorOperation(TOOL)
        operation.speed = SPEED
        yield cutting_process(STOCK, CELL, operation, machine, frame, zero)


@pytest.mark.seconds("the loop of leaning tools is compiled or loaded")
def test_a_leaning_process_feels_what_a_height_map_does() -> None:
    machine = shipped_machine()
    upright, leaning = processes(machine)
    assert isinstance(leaning, LeaningProcess)
    one, other = run([WAY], upright), run([WAY], leaning)
    late = slice(-300, None)
    for name, within in (("force", 0.03), ("deflection", 0.03), ("chip", 0.02), ("power", 0.03)):
        mean, like = (getattr(loads(each), name)[late].mean(axis=0) for each in (other, one))
        size = within * float(np.abs(like).max())
        np.testing.assert_allclose(mean, like, atol=size, err_msg=name)
    moved = np.abs(one.joint_position - other.joint_position).max()
    assert 1e-6 < moved < 2e-3
