"""Moves that count from machine zero: G53 for its block, G28 and G30.

The coordinates are those of the axes: no work offset, preset, tool length, mirror, scale or rotation
acts on them, and no tip is led meanwhile.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import NamedTuple

from twin.nc.control.control import Control
from twin.nc.geometry.frame import SHIFTS, Frame
from twin.nc.geometry.matrices import IDENTITY, Matrix
from twin.nc.iso.offsets import machine_zero
from twin.nc.path.tool_center.tool_center import ToolCenter


class SuspendedFrame(NamedTuple):
    """The frame that machine coordinates have put aside.

    Attributes:
        shifts: Of every kind, shape (s, k) [mm or deg].
        matrix: Mirror, scale and rotation.
    """

    shifts: list[list[float]]
    matrix: Matrix
    tool_center: ToolCenter | None


def enter_machine_frame(
    control: Control, code: str, zero: Mapping[str, float] | None = None
) -> SuspendedFrame:
    """Let programmed coordinates count from machine zero, or from another zero of the builder's; ``code`` asks for it."""
    zero, frame = machine_zero(control, code) if zero is None else zero, control.frame
    center, names = control.path.tool_center, control.settings.axes.names
    kept = SuspendedFrame(frame.shifts, frame.matrix, center)
    control.motion.on_screen = _screen_of(kept)
    if center is not None:
        control.motion.lead_tip(None)
    frame.set_shifts([[0.0] * len(names) for _ in SHIFTS])
    frame.set_shift("offset", [zero.get(name, 0.0) for name in names])
    frame.set_matrix(IDENTITY)
    control.motion.reframed()
    return kept


def _screen_of(kept: SuspendedFrame) -> Callable[[list[float]], list[float]]:
    """Programmed coordinates of a place of the axes: the screen goes on showing them."""
    frame, center = Frame(len(kept.shifts[0])), kept.tool_center
    frame.set_shifts(kept.shifts)
    frame.set_matrix(kept.matrix)

    def shown(part: list[float]) -> list[float]:
        return frame.to_programmed(part if center is None else center.tip(part))

    return shown


def leave_machine_frame(control: Control, kept: SuspendedFrame) -> None:
    """Let programmed coordinates be what they were."""
    control.motion.on_screen = None
    control.frame.set_shifts(kept.shifts)
    control.frame.set_matrix(kept.matrix)
    if kept.tool_center is not None:
        control.motion.lead_tip(kept.tool_center)
    control.motion.reframed()


@contextmanager
def machine_frame(
    control: Control, code: str, zero: Mapping[str, float] | None = None
) -> Iterator[None]:
    """As ``enter_machine_frame``, within."""
    if control.path.compensation.in_force:
        message = "machine coordinates know no radius compensation"
        control.fail("compensation-change", message, hint=f"end it by G40 before {code}")
    kept = enter_machine_frame(control, code, zero)
    yield
    leave_machine_frame(control, kept)
