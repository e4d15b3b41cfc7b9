"""G74 and G84 of a Fanuc control with Q: rigid tapping in passes that break the chip.

Decision: behind each pass the tap comes back by 0.5 mm, as G73 does (parameters 5200 #5 and 5213).
"""

import dataclasses

from twin.nc.control.codes import GCode, Interpolation
from twin.nc.control.control import Control
from twin.nc.control.interpolation import CycleRule
from twin.nc.dialects.fanuc.motion import target
from twin.nc.dialects.fanuc.transformations import refuse_scaled_pecks
from twin.nc.iso.drilling import repeats_of, take_words
from twin.nc.iso.tapping import Passes, tap_in_passes
from twin.nc.path.drilling_cycle import (
    BOTTOM,
    CHIP_CLEARANCE,
    DWELL,
    MOST_PECKS,
    PECK,
    REFERENCE,
    START,
    Cycle,
    either,
)

_WORDS = {"R": REFERENCE, "P": DWELL, "Q": PECK}


def in_passes(number: int, code: GCode) -> GCode:
    """G74 or G84, which taps in passes where its block has Q, or a cycle before it left Q in force."""
    rule = CycleRule(f"G{number}", Cycle(lasting=True, across=BOTTOM, needed=0), _WORDS)
    tap = Interpolation(lambda control: _tap_holes(control, rule, left=number == 74))
    begin = code.action
    assert begin is not None

    def call(control: Control) -> None:
        begin(control)
        if "Q" in control.words or control.cycle_state[PECK] > 0.0:
            refuse_scaled_pecks(control, rule.name)
            control.modal.cycle = tap

    meaning = code.meaning.replace("R P", "R P Q")
    return dataclasses.replace(code, meaning=meaning, action=call, compiler=None)


def _tap_holes(control: Control, rule: CycleRule, *, left: bool) -> None:
    """Tap the holes of a block."""
    count, given = repeats_of(control, "K"), dict(control.words)
    if count == 0:
        take_words(control, rule)
        control.take_axis_words()
    for _ in range(count):
        control.words = dict(given)
        take_words(control, rule)
        hole = target(control)
        tap_in_passes(control, hole, _passes(control, rule.name, left=left))


def _passes(control: Control, name: str, *, left: bool) -> Passes:
    """What is done at a hole.

    Raises:
        ProgramError: A word is missing or wrong.
    """
    values = control.cycle_state
    places = {"R": REFERENCE, "Z": BOTTOM}
    missing = [letter for letter, place in places.items() if values[place] != values[place]]
    if missing:
        control.fail("cycle-word", f"{name} needs {' and '.join(missing)}")
    reference, bottom = values[REFERENCE], values[BOTTOM]
    if not bottom < reference:
        message = f"{name} must drill downwards, not from {reference:g} to {bottom:g}"
        control.fail("cycle-depth", message)
    if not values[PECK] > 0.0:
        control.fail("cycle-depth", f"{name} needs passes Q above 0")
    to_reference = control.modal.return_to_reference
    passes = Passes(
        reference=reference,
        bottom=bottom,
        depth=values[PECK],
        lift=CHIP_CLEARANCE,
        dwell=either(values[DWELL], 0.0),
        back=reference if to_reference else max(values[START], reference),
        left=left,
    )
    if passes.total > MOST_PECKS:
        message = f"the hole would need more than {MOST_PECKS} passes"
        control.fail("cycle-depth", message, hint="write a larger Q")
    return passes
