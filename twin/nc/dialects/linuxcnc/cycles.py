"""Canned cycles of LinuxCNC: G73, G74, G81 to G89.

The words of a cycle stay while the same cycle is in force; another one needs its own R and Z. With
G91, R counts from the height of the call and Z from R, and L repeats the hole along the way.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

from twin.nc.control.codes import GCode, Interpolation
from twin.nc.control.control import Control
from twin.nc.control.interpolation import CycleRule
from twin.nc.dialects.linuxcnc.memory import memory_of
from twin.nc.dialects.linuxcnc.motion import check_feed, target
from twin.nc.dialects.linuxcnc.offsets import refuse_in_compensation
from twin.nc.iso.drilling import (
    NEEDED_WORDS,
    drill,
    refuse_hole,
    repeats_of,
    take_words,
    turn_spindle,
)
from twin.nc.iso.plane_moves import go_to_height
from twin.nc.path.drilling_cycle import (
    AXIS,
    BOTTOM,
    DWELL,
    PECK,
    REFERENCE,
    START,
    Cycle,
    Pecking,
    Retract,
    Values,
)
from twin.nc.path.feed_rates import FeedMode
from twin.nc.path.hole import Fault, hole_of

CLEARANCE = 0.254
"""A rapid return ends this far above the bottom of the last peck [mm]: a hundredth of an inch."""


class Drilling(NamedTuple):
    """One hole, in programmed coordinates.

    Attributes:
        reference: R [mm].
        bottom: Z [mm].
        clear: Height to which the tool returns [mm].
        values: What the cycle remembers of its words.
        back_boring: I, J and K of G87 [mm].
    """

    reference: float
    bottom: float
    clear: float
    values: Values
    back_boring: tuple[float, float, float]


Work = Callable[[Control, Drilling], None]


class Kind(NamedTuple):
    """What is peculiar to one cycle.

    Attributes:
        number: Of its code.
        meaning: For people.
        words: Its own words besides R and the axes.
        needed: Those that it must have when it is called.
        work: What happens at the hole, from R on: a rule, or a function.
    """

    number: int
    meaning: str
    words: str
    needed: str
    work: Cycle | Work

    @property
    def rule(self) -> CycleRule:
        """Its words, and what is done at the hole, where there is a rule for that."""
        cycle = self.work if isinstance(self.work, Cycle) else _G81
        letters = {letter: place for letter, place in _PLACES.items() if letter in self.words}
        return CycleRule(f"G{self.number}", cycle, {"R": REFERENCE, **letters})


_NAME_PLACES = frozenset("XYZ@^")
_PLACES = {"P": DWELL, "Q": PECK}


def _dwell(control: Control, hole: Drilling) -> None:
    seconds = hole.values[DWELL]
    if seconds == seconds and seconds > 0.0:
        control.dwell(seconds)


def _drill(control: Control, hole: Drilling, rule: CycleRule) -> None:
    """What the cycle's rule says of the way down and back."""
    modal = control.modal
    values = list(hole.values)
    values[START], values[REFERENCE], values[BOTTOM] = hole.clear, hole.reference, hole.bottom
    found = hole_of(rule.cycle, values, modal.plane.axes[2], modal.return_to_reference)
    if found.fault in (Fault.PECKS, Fault.MANY_PECKS):
        refuse_hole(control, rule, found)
    drill(control, found, None)


def _tap(inwards: int, outwards: int) -> Work:
    """Tap with a spindle that turns by these M functions."""

    def work(control: Control, hole: Drilling) -> None:
        turns = memory_of(control).functions.get("spindle") == inwards
        if not control.motion.spindle_turns or not turns:
            code = "G84" if inwards == 3 else "G74"
            message = f"{code} needs the spindle turning by M{inwards}"
            control.fail("spindle-needed", message)
        go_to_height(control, hole.bottom, rapid=False)
        turn_spindle(control, f"M{outwards}")
        _dwell(control, hole)
        go_to_height(control, hole.clear, rapid=False)
        turn_spindle(control, f"M{inwards}")

    return work


def _start_again(control: Control, code: str) -> Callable[[], None]:
    """Check that the spindle turns; what turns it again."""
    if not control.motion.spindle_turns:
        control.fail("spindle-needed", f"{code} needs the spindle turning", hint="write M3 before")
    sense = memory_of(control).functions.get("spindle", 3.0)
    return lambda: turn_spindle(control, f"M{int(sense)}")


def _bore(control: Control, hole: Drilling) -> None:
    start = _start_again(control, "G86")
    go_to_height(control, hole.bottom, rapid=False)
    _dwell(control, hole)
    control.function("M5", {})
    go_to_height(control, hole.clear)
    start()


def _bore_back(control: Control, hole: Drilling) -> None:
    start = _start_again(control, "G87")
    first, second, _ = control.modal.plane.axes
    over = list(control.motion.programmed)
    beside = list(over)
    beside[first] += hole.back_boring[0]
    beside[second] += hole.back_boring[1]
    control.line_to(beside, rapid=True)
    control.function("M5", {})
    go_to_height(control, hole.bottom)
    _across(control, over)
    start()
    go_to_height(control, hole.back_boring[2], rapid=False)
    go_to_height(control, hole.bottom, rapid=False)
    control.function("M5", {})
    _across(control, beside)
    go_to_height(control, hole.clear)
    _across(control, over)
    start()


def _across(control: Control, over: list[float]) -> None:
    goal, axis = list(over), control.modal.plane.axes[2]
    goal[axis] = control.motion.programmed[axis]
    control.line_to(goal, rapid=True)


# --- one block


def _take_words(control: Control, kind: Kind) -> None:
    """Take the cycle's words; they stay in ``cycle_state`` as they are written.

    Raises:
        ProgramError: One is missing.
    """
    state, memory, axis = control.cycle_state, memory_of(control), control.modal.plane.axes[2]
    if math.isnan(state[START]):
        memory.cycle = 0
    elif state[AXIS] != axis:
        message = f"G{kind.number} was called in another plane"
        control.fail("cycle-plane", message, hint="end it by G80 before the plane changes")
    if memory.cycle != kind.number:
        needed = ("R", control.settings.axes.names[axis], *kind.needed)
        missing = [letter for letter in needed if letter not in control.words]
        if missing:
            hint = "; ".join(
                f"{each}: {NEEDED_WORDS[each]}" for each in missing if each in NEEDED_WORDS
            )
            control.fail("cycle-word", f"G{kind.number} needs {' and '.join(missing)}", hint=hint)
        memory.back_boring = (0.0, 0.0, 0.0)
    dwell = control.words.get("P") if "P" in kind.words else None
    if dwell is not None and control.number(dwell) < 0.0:
        control.fail("dwell", "a dwell cannot be negative", dwell)
    take_words(control, kind.rule, calls=True)
    take_words(control, kind.rule)
    if kind.words == "IJK":
        memory.back_boring = tuple(
            old if (word := control.take(letter)) is None else control.length(word)
            for letter, old in zip("IJK", memory.back_boring, strict=True)
        )
    memory.cycle = kind.number


def _perform(kind: Kind) -> Callable[[Control], None]:
    def perform(control: Control) -> None:
        refuse_in_compensation(control)
        check_feed(control, False)
        if not _NAME_PLACES & control.words.keys():
            message = (
                f"G{kind.number} drills where its block says, and no word of an axis stands in it"
            )
            control.fail("code-words", message, hint="write X or Y, or end the cycle by G80")
        if control.modal.feed_mode is FeedMode.BLOCKS_PER_MINUTE:
            control.fail("code-words", "canned cycles need a feed per minute", hint="write G94 F")
        _refuse_rotary(control)
        repeats = repeats_of(control, "L", least=1)
        _take_words(control, kind)
        _drill_holes(control, kind, repeats)

    return perform


def _refuse_rotary(control: Control) -> None:
    for letter, word in control.words.items():
        axis = control.axis_index.get(letter)
        if axis is not None and not control.motion.linear[axis]:
            message = "a canned cycle drills where the rotary axes stand"
            control.fail("code-words", message, word, "turn them in a block of their own")


def _drill_holes(control: Control, kind: Kind, repeats: int) -> None:
    state, memory = control.cycle_state, memory_of(control)
    axis, incremental = control.modal.plane.axes[2], control.modal.incremental
    words = {letter: control.words[letter] for letter in (*"XYZ@^",) if letter in control.words}
    reference = state[REFERENCE] + (state[START] if incremental else 0.0)
    bottom = state[BOTTOM] + (reference if incremental else 0.0)
    if bottom > reference:
        message = f"G{kind.number} must drill downwards, not from {reference:g} to {bottom:g}"
        control.fail("cycle-depth", message)
    start = state[START]
    if start < reference:
        go_to_height(control, reference)
        start = reference
    clear = reference if control.modal.return_to_reference else start
    i, j, k = memory.back_boring
    hole = Drilling(reference, bottom, clear, state, (i, j, k + bottom if incremental else k))
    current = max(control.motion.programmed[axis], reference)
    if not control.modal.return_to_reference:
        current = start
    for number in range(repeats):
        if number and (incremental or not words):
            control.words.update(words)
        over = target(control) if number == 0 or incremental else list(control.motion.programmed)
        over[axis] = current if number == 0 else clear
        control.line_to(over, rapid=True)
        go_to_height(control, reference)
        if isinstance(kind.work, Cycle):
            _drill(control, hole, kind.rule)
        else:
            kind.work(control, hole)


_G81 = Cycle(
    lasting=True,
    across=BOTTOM,
    needed=1 << REFERENCE | 1 << BOTTOM,
    dwells=False,
    clearance=CLEARANCE,
    as_written=True,
)
_PECKING = _G81._replace(needed=_G81.needed | 1 << PECK, pecking=int(Pecking.TO_BOTTOM))

KINDS = (
    Kind(
        73,
        "drilling with chips broken every Q",
        "Q",
        "Q",
        _PECKING._replace(lift=CLEARANCE),
    ),
    Kind(74, "tapping, left-hand", "P", "", _tap(4, 3)),
    Kind(81, "drilling", "", "", _G81),
    Kind(82, "drilling with P seconds at the bottom", "P", "P", _G81._replace(dwells=True)),
    Kind(83, "drilling in pecks of Q", "Q", "Q", _PECKING),
    Kind(84, "tapping, right-hand", "P", "", _tap(3, 4)),
    Kind(85, "reaming, out with the feed", "", "", _G81._replace(retract=int(Retract.FEED))),
    Kind(86, "boring, out with the spindle stopped", "P", "P", _bore),
    Kind(87, "boring from behind: I J beside the hole, K its top", "IJK", "IJK", _bore_back),
    Kind(
        89,
        "reaming with P seconds at the bottom",
        "P",
        "P",
        _G81._replace(dwells=True, retract=int(Retract.FEED_ALL)),
    ),
)


def _code(kind: Kind) -> GCode:
    mode = Interpolation(_perform(kind), rule=kind.rule if isinstance(kind.work, Cycle) else None)
    return GCode(
        meaning=kind.meaning,
        group="motion",
        sets={"cycle": mode, "interpolation": None},
        basis="manual",
    )


CYCLES = {kind.number: _code(kind) for kind in KINDS}
