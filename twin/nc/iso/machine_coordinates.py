"""Moves that count from machine zero: G53 for its block, G28 and G30.

The coordinates are those of the axes: no work offset, preset, tool length, mirror, scale or rotation
acts on them.
"""

from collections.abc import Iterator
from contextlib import contextmanager

from twin.nc.control.control import Control
from twin.nc.geometry.frame import SHIFTS
from twin.nc.geometry.matrices import IDENTITY
from twin.nc.iso.offsets import machine_zero


@contextmanager
def machine_frame(control: Control, code: str) -> Iterator[None]:
    """Let programmed coordinates be those of the machine, within; ``code`` asks for it.

    Raises:
        ProgramError: Nobody said where machine zero is, or compensation is in force.
    """
    if control.path.compensating:
        message = "machine coordinates know no radius compensation"
        control.fail("compensation-change", message, hint=f"end it by G40 before {code}")
    zero, frame = machine_zero(control, code), control.frame
    shifts, matrix = frame.shifts, frame.matrix
    names = control.settings.axes.names
    frame.set_shifts([[0.0] * len(names) for _ in SHIFTS])
    frame.set_shift("offset", [zero.get(name, 0.0) for name in names])
    frame.set_matrix(IDENTITY)
    control.reframed()
    yield
    frame.set_shifts(shifts)
    frame.set_matrix(matrix)
    control.reframed()
