"""Drilling cycles: the codes that call them, their words, and what happens at a hole, in every dialect."""

import math
from collections.abc import Callable
from typing import NamedTuple, NoReturn

from twin.nc.control.codes import Basis, GCode, Interpolation
from twin.nc.control.control import Control
from twin.nc.control.interpolation import CycleRule
from twin.nc.path.drilling_cycle import (
    BOTTOM,
    EVERY,
    FACTOR,
    LIFT,
    PECK,
    REFERENCE,
    CycleBlock,
    no_values,
    read_words,
)
from twin.nc.path.hole import (
    MOST_PECKS,
    NO_MOVE,
    Act,
    Fault,
    Hole,
    hole_of,
    most_acts,
    next_place,
    write_acts,
)


class Holes(NamedTuple):
    """How the blocks of a cycle name their holes.

    Attributes:
        target: Takes the words that name the hole; its programmed position, shape (k,).
        basis: On what the meaning rests.
        repeats: Address that says how often a block drills, each hole as far from the last as the
            block's increments say; 0: its words are taken and nothing is drilled. Empty: none.
    """

    target: Callable[[Control], list[float]] = Control.target
    basis: Basis = "decision"
    repeats: str = ""


ONE_HOLE = Holes()
"""Axis words name one hole."""


def cycle_code(rule: CycleRule, meaning: str, holes: Holes = ONE_HOLE) -> GCode:
    """The code that calls a cycle with its words, told to people by its meaning."""

    def call(control: Control) -> None:
        _take_options(control, rule)
        take_words(control, rule, calls=True)

    def perform(control: Control) -> None:
        count = repeats_of(control, holes.repeats)
        take_words(control, rule)
        given = dict(control.words)
        if count == 0:
            control.take_axis_words()
        for _ in range(count):
            control.words = dict(given)
            drill(control, hole_in_force(control, rule), holes.target(control))

    return GCode(
        meaning=meaning,
        group="cycle",
        sets={"cycle": Interpolation(perform, rule=rule)},
        action=call,
        basis=holes.basis,
    )


def repeats_of(control: Control, address: str, least: int = 0) -> int:
    """How often the block drills, ``least`` times or more; takes the word that says it.

    Raises:
        ProgramError: It is no count, or too large a one.
    """
    word = control.take(address) if address else None
    if word is None:
        return 1
    given, most = control.number(word), control.settings.step_limit
    if given < least or given != int(given) or given > most:
        message = f"{word.address} must count holes, {least} to {most}"
        control.fail("repeat-count", message, word)
    return int(given)


def take_words(control: Control, rule: CycleRule, *, calls: bool = False) -> None:
    """Take the words of a block that calls a cycle, or of its hole; which of both it is, the cycle says."""
    modal, given = control.modal, no_values()
    axis, incremental = modal.plane.axes[2], modal.incremental and not rule.cycle.as_written
    relative = dict.fromkeys((REFERENCE, BOTTOM), incremental)
    if calls != rule.cycle.lasting:
        for address, value in rule.addresses(control.settings.axes.names[axis]).items():
            word = control.take(address)
            if word is not None:
                given[value] = control.number(word)
                relative[value] = incremental or word.incremental
    from_where = relative[REFERENCE], relative[BOTTOM]
    block = CycleBlock(calls, axis, control.motion.programmed[axis], modal.unit, from_where)
    read_words(rule.cycle, control.cycle_state, given, block)


def _take_options(control: Control, rule: CycleRule) -> None:
    """Take words of the call that change nothing of the path.

    Raises:
        ProgramError: One has another value than those that are known to do so.
    """
    for letter, known in rule.options.items():
        word = control.take(letter)
        if word is not None and control.number(word) not in known:
            values = " or ".join(f"{letter}{value:g}" for value in known)
            control.fail("unsupported-word", f"only {values} is followed here", word)


def hole_in_force(control: Control, rule: CycleRule) -> Hole:
    """What the cycle does at a hole.

    Raises:
        ProgramError: A word is missing or wrong.
    """
    axis, to_reference = control.modal.plane.axes[2], control.modal.return_to_reference
    hole = hole_of(rule.cycle, control.cycle_state, axis, to_reference)
    if hole.fault != Fault.NONE:
        refuse_hole(control, rule, hole)
    return hole


NEEDED_WORDS = {
    "R": "the height where the feed begins, such as R2.",
    "Z": "the depth of the hole, such as Z-10.",
    "Q": "the depth of a peck, such as Q2.",
    "F": "the feed, such as F100.",
}
"""What the words of a drilling cycle are, for hints."""


def refuse_hole(control: Control, rule: CycleRule, hole: Hole) -> NoReturn:
    """Report what is wrong with the words of a cycle.

    Raises:
        ProgramError: Always.
    """
    name = rule.name
    across = control.settings.axes.names[control.modal.plane.axes[2]]
    addresses = {value: address for address, value in rule.addresses(across).items()}
    if hole.fault == Fault.MISSING:
        missing = [
            address
            for value, address in sorted(addresses.items())
            if (rule.cycle.needed >> value) & 1 and math.isnan(control.cycle_state[value])
        ]
        hint = "; ".join(
            f"{each}: {NEEDED_WORDS[each]}" for each in missing if each in NEEDED_WORDS
        )
        control.fail("cycle-word", f"{name} needs {' and '.join(missing)}", hint=hint or None)
    if hole.fault == Fault.PLANE:
        message = f"{name} was called in another plane"
        control.fail("cycle-plane", message, hint="end it by G80 before the plane changes")
    if hole.passes and hole.fault == Fault.MANY_PECKS:
        message = f"the hole would need more than {MOST_PECKS} passes"
        control.fail("cycle-depth", message, hint=f"write a larger {addresses[PECK]}")
    if hole.passes and hole.fault == Fault.PECKS:
        needed = f"passes {addresses[PECK]} above 0"
        if LIFT in addresses:
            needed = f"{addresses[PECK]} above 0, and {addresses[LIFT]} not below 0"
        control.fail("cycle-depth", f"{name} needs {needed}")
    if hole.fault == Fault.MANY_PECKS:
        message = f"the hole would need more than {MOST_PECKS} pecks"
        control.fail("cycle-depth", message, hint="write deeper pecks")
    if hole.fault == Fault.DWELL:
        control.fail("dwell", f"{name} cannot wait {hole.dwell:g} seconds")
    if hole.fault == Fault.PECK_WORDS:
        message = f"{name} needs Q, the depth of each peck, or I, J and K: the first, less each time, the least"
        control.fail("cycle-word", message, hint="write one or the other, and G80 between both")
    if hole.fault == Fault.FASTER:
        message = (
            f"{name} comes back 1 to 9 times as fast, a whole number, not {hole.faster:g} times"
        )
        control.fail("cycle-word", message)
    if hole.fault == Fault.PECKS and FACTOR in addresses:
        above = f"{addresses[PECK]} and {addresses[FACTOR]} above 0"
        others = f"{addresses[LIFT]} not below 0, and {addresses[EVERY]} a count"
        control.fail("cycle-depth", f"{name} needs {above}, {others}")
    if hole.fault == Fault.PECKS:
        control.fail("cycle-depth", f"{name} needs pecks above 0")
    message = f"{name} must drill downwards, not from {hole.reference:g} to {hole.bottom:g}"
    control.fail("cycle-depth", message)


def turn_spindle(control: Control, function: str) -> None:
    """Report that M3 or M4 turns the spindle, with the speed in force."""
    control.function(
        function, {} if control.motion.spindle is None else {"S": control.motion.spindle}
    )


def drill(control: Control, hole: Hole, target: list[float] | None) -> None:
    """Go over the hole, drill it, return.

    Args:
        control: The control.
        hole: What is done there.
        target: Programmed position of the hole, shape (k,); its height is not used. None: the tool
            stands over it at the reference plane.
    """
    axis = control.modal.plane.axes[2]
    room = most_acts(hole.stops)
    acts, amounts = [0.0] * room, [0.0] * room
    goal = list(control.motion.programmed)
    over = goal if target is None else target
    for number in range(write_acts(hole, goal[axis], acts, amounts)):
        act, amount = int(acts[number]), amounts[number]
        speed = next_place(act, amount, hole, over, goal, axis)
        if speed != NO_MOVE:
            feed = control.motion.feed
            if feed is not None and speed > 0.0:
                control.motion.feed = feed * speed
            control.line_to(list(goal), rapid=speed == 0.0)
            control.motion.feed = feed
        else:
            _report(control, Act(act), amount)


def _report(control: Control, act: Act, amount: float) -> None:
    """What happens at a hole and is no move: a dwell [s], or an M function of the spindle."""
    if act is Act.DWELL:
        control.dwell(amount)
    elif act is Act.M5:
        control.function(act.name, {})
    else:
        turn_spindle(control, act.name)
