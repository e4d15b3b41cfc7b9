"""G76 and G87 of a Fanuc control: boring with the spindle oriented and the tool shifted by Q.

Decision: the tool shifts towards + of the plane's first axis, which is how parameter 5148 comes from
the maker. The spindle is oriented by M19 and started again by M3.
"""

import dataclasses

from twin.nc.control.codes import GCode, Interpolation
from twin.nc.control.control import Control
from twin.nc.control.interpolation import CycleRule
from twin.nc.dialects.fanuc.memory import Variant, memory_of
from twin.nc.dialects.fanuc.motion import holes_of, target
from twin.nc.dialects.fanuc.transformations import refuse_scaled_pecks
from twin.nc.iso.drilling import cycle_code, take_words
from twin.nc.path.drilling_cycle import BOTTOM, DWELL, PECK, REFERENCE, START, Cycle, either

_WORDS = {"R": REFERENCE, "P": DWELL, "Q": PECK}


def boring_code(number: int, meaning: str, variant: Variant) -> GCode:
    """The code that calls G76 or G87."""
    cycle = Cycle(lasting=True, across=BOTTOM, needed=0)
    rule = CycleRule(f"G{number}", cycle, _WORDS)
    code = cycle_code(rule, f"{meaning}: X Y Z R P Q", holes_of(variant))
    begin = code.action
    assert begin is not None

    def call(control: Control) -> None:
        refuse_scaled_pecks(control, rule.name)
        memory = memory_of(control)
        if memory.mirror or memory.rotation is not None:
            message = f"{rule.name} shifts the tool as the machine stands: no mirror or rotation turns that"
            control.fail("rotation-active", message, hint="end them first: G50.1, G69")
        begin(control)

    def perform(control: Control) -> None:
        take_words(control, rule)
        _bore(control, rule.name, target(control), back=number == 87)

    return dataclasses.replace(code, sets={"cycle": Interpolation(perform)}, action=call)


def _bore(control: Control, name: str, hole: list[float], *, back: bool) -> None:
    """Bore at a programmed position; ``back``: from below, R lies under the part."""
    values, axis = control.cycle_state, control.modal.plane.axes[2]
    missing = [
        letter
        for letter, value in (("R", REFERENCE), ("Z", BOTTOM), ("Q", PECK))
        if values[value] != values[value]
    ]
    if missing:
        control.fail("cycle-word", f"{name} needs {' and '.join(missing)}")
    reference, bottom, shift = values[REFERENCE], values[BOTTOM], values[PECK]
    if shift < 0.0:
        control.fail("cycle-depth", f"{name} needs a shift Q not below 0")
    upwards = bottom > reference
    if upwards != back:
        way = "upwards" if back else "downwards"
        message = f"{name} must bore {way}, not from {reference:g} to {bottom:g}"
        control.fail("cycle-depth", message)
    if back and control.modal.return_to_reference:
        message = "G87 returns to the height of its call: its plane R lies under the part"
        control.fail("cycle-depth", message, hint="write G98")
    over = values[START] if back else max(control.programmed[axis], reference)
    _rise(control, axis, over, rapid=True)
    hole[axis] = over
    control.line_to(hole, rapid=True)
    turning = {} if control.spindle is None else {"S": control.spindle}
    if back:
        _orient(control, shift)
        _rise(control, axis, reference, rapid=True)
        _shift(control, -shift)
        control.function("M3", turning)
    else:
        _rise(control, axis, reference, rapid=True)
    _rise(control, axis, bottom, rapid=False)
    seconds = either(values[DWELL], 0.0)
    if seconds > 0.0:
        control.dwell(seconds)
    _orient(control, shift)
    to_start = back or not control.modal.return_to_reference
    _rise(control, axis, max(values[START], reference) if to_start else reference, rapid=True)
    _shift(control, -shift)
    control.function("M3", turning)


def _orient(control: Control, shift: float) -> None:
    control.function("M19", {})
    _shift(control, shift)


def _shift(control: Control, way: float) -> None:
    there = list(control.programmed)
    there[control.modal.plane.axes[0]] += way
    control.line_to(there, rapid=True)


def _rise(control: Control, axis: int, height: float, *, rapid: bool) -> None:
    there = list(control.programmed)
    there[axis] = height
    control.line_to(there, rapid=rapid)
