"""G76 and G87 of a Fanuc control: boring with the spindle oriented and the tool shifted by Q.

Decision: the tool shifts towards + of the plane's first axis, which is how parameter 5148 comes from
the maker. The spindle is oriented by M19 and started again by M3.
"""

import dataclasses

from twin.nc.control.codes import GCode, Interpolation
from twin.nc.control.control import Control
from twin.nc.dialects.fanuc.frames.transformations import refuse_scaled_pecks
from twin.nc.dialects.fanuc.memory import Variant, memory_of
from twin.nc.dialects.fanuc.motion import holes_of, target
from twin.nc.iso.cycle_moves import go_to_height
from twin.nc.iso.drilling.drilling import Cycle, cycle_code, require_words, take_words
from twin.nc.iso.drilling.hole import turn_spindle

_WORDS = {"R": "reference", "P": "dwell", "Q": "peck"}
_NEEDED = ("reference", "bottom", "peck")


def boring_code(number: int, meaning: str, variant: Variant) -> GCode:
    """The code that calls G76 or G87."""
    cycle = Cycle(name=f"G{number}", words=_WORDS, needed=_NEEDED)
    code = cycle_code(cycle, f"{meaning}: X Y Z R P Q", holes_of(variant))
    begin = code.action
    assert begin is not None

    def call(control: Control) -> None:
        refuse_scaled_pecks(control, cycle.name)
        memory = memory_of(control)
        if memory.mirror or memory.rotation is not None:
            message = f"{cycle.name} shifts the tool as the machine stands: no mirror or rotation turns that"
            control.fail("rotation-active", message, hint="end them first: G50.1, G69")
        begin(control)

    def perform(control: Control) -> None:
        take_words(control, cycle)
        _bore(control, cycle, target(control), back=number == 87)

    return dataclasses.replace(code, sets={"cycle": Interpolation(perform)}, action=call)


def _bore(control: Control, cycle: Cycle, hole: list[float], *, back: bool) -> None:
    """Bore at a programmed position; ``back``: from below, R lies under the part."""
    require_words(control, cycle)
    values, name, axis = control.cycle_values, cycle.name, control.modal.plane.axes[2]
    start, reference, bottom, shift = (values[each] for each in ("start", *_NEEDED))
    to_reference = control.modal.return_to_reference
    if shift < 0.0:
        control.fail("cycle-depth", f"{name} needs a shift Q not below 0")
    upwards = bottom > reference
    if upwards != back:
        direction = "upwards" if back else "downwards"
        message = f"{name} must bore {direction}, not from {reference:g} to {bottom:g}"
        control.fail("cycle-depth", message)
    if back and to_reference:
        message = "G87 returns to the height of its call: its plane R lies under the part"
        control.fail("cycle-depth", message, hint="write G98")
    over = start if back else max(control.motion.programmed[axis], reference)
    go_to_height(control, over)
    hole[axis] = over
    control.line_to(hole, rapid=True)
    if back:
        _orient(control, shift)
        go_to_height(control, reference)
        _shift(control, -shift)
        turn_spindle(control, "M3")
    else:
        go_to_height(control, reference)
    go_to_height(control, bottom, rapid=False)
    if values.get("dwell", 0.0) > 0.0:
        control.dwell(values["dwell"])
    _orient(control, shift)
    go_to_height(control, reference if to_reference else max(start, reference))
    _shift(control, -shift)
    turn_spindle(control, "M3")


def _orient(control: Control, shift: float) -> None:
    control.function("M19", {})
    _shift(control, shift)


def _shift(control: Control, direction: float) -> None:
    there = list(control.motion.programmed)
    there[control.modal.plane.axes[0]] += direction
    control.line_to(there, rapid=True)
