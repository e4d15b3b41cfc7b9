"""Canned cycles of LinuxCNC: G73, G74, G81 to G89.

The words of a cycle stay while the same cycle is in force; another one needs its own R and Z. With
G91, R counts from the height of the call and Z from R, and L repeats the hole along the displacement.
"""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from twin.nc.control.codes import GCode, Interpolation
from twin.nc.control.control import Control
from twin.nc.dialects.linuxcnc.memory import memory_of
from twin.nc.dialects.linuxcnc.motion import check_feed, target
from twin.nc.dialects.linuxcnc.offsets import refuse_in_compensation
from twin.nc.iso.cycle_moves import go_to_height
from twin.nc.iso.drilling.drilling import (
    Cycle,
    Pecking,
    hole_of,
    refuse_missing,
    refuse_other_plane,
    repeats_of,
    take_words,
)
from twin.nc.iso.drilling.hole import Retract, drill, turn_spindle
from twin.nc.path.feed_rates import FeedMode

CLEARANCE = 0.254
"""A rapid return ends this far above the bottom of the last peck [mm]: a hundredth of an inch."""


class Drilling(NamedTuple):
    """One hole, in programmed coordinates.

    Attributes:
        reference: R [mm].
        bottom: Z [mm].
        clear: Height to which the tool returns [mm].
        back_boring: I, J and K of G87 [mm].
    """

    reference: float
    bottom: float
    clear: float
    back_boring: tuple[float, float, float]


Work = Callable[[Control, Drilling], None]


class Kind(NamedTuple):
    """What is peculiar to one cycle.

    Attributes:
        words: Its own words besides R and the axes.
        needed: Those that it must have when it is called.
        work: What happens at the hole, from R on: a function, or fields of ``Cycle``.
    """

    number: int
    meaning: str
    words: str
    needed: str
    work: Mapping[str, Any] | Work

    @property
    def cycle(self) -> Cycle:
        """Its words, and what is done at the hole, where there is a rule for that."""
        words = {"R": "reference"}
        words |= {letter: value for letter, value in _VALUES.items() if letter in self.words}
        peculiar = {} if callable(self.work) else self.work
        return Cycle(name=f"G{self.number}", words=words, as_written=True, **{**_PLAIN, **peculiar})


_NAME_PLACES = frozenset("XYZ@^")
_VALUES = {"P": "dwell", "Q": "peck"}


def _dwell(control: Control) -> None:
    seconds = control.cycle_values.get("dwell", 0.0)
    if seconds > 0.0:
        control.dwell(seconds)


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
        _dwell(control)
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
    _dwell(control)
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
    """Take the cycle's words; they stay in ``cycle_values`` as they are written."""
    values, memory, axis = control.cycle_values, memory_of(control), control.modal.plane.axes[2]
    if "start" not in values:
        memory.cycle = 0
    elif values["axis"] != axis:
        refuse_other_plane(control, f"G{kind.number}")
    if memory.cycle != kind.number:
        deep = control.settings.axes.names[axis]
        values_of = {"R": "reference", deep: "bottom", "Q": "peck"}
        needed = ("R", deep, *kind.needed)
        missing = {
            letter: values_of.get(letter, "") for letter in needed if letter not in control.words
        }
        if missing:
            refuse_missing(control, f"G{kind.number}", missing)
        memory.back_boring = (0.0, 0.0, 0.0)
    dwell = control.words.get("P") if "P" in kind.words else None
    if dwell is not None and control.number(dwell) < 0.0:
        control.fail("dwell", "a dwell cannot be negative", dwell)
    take_words(control, kind.cycle, calls=True)
    take_words(control, kind.cycle)
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
            message = f"G{kind.number} drills where its block says, and no word of an axis is in it"
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
    values, memory = control.cycle_values, memory_of(control)
    axis, incremental = control.modal.plane.axes[2], control.modal.incremental
    words = {letter: control.words[letter] for letter in (*"XYZ@^",) if letter in control.words}
    reference = values["reference"] + (values["start"] if incremental else 0.0)
    bottom = values["bottom"] + (reference if incremental else 0.0)
    if bottom > reference:
        message = f"G{kind.number} must drill downwards, not from {reference:g} to {bottom:g}"
        control.fail("cycle-depth", message)
    start = values["start"]
    if start < reference:
        go_to_height(control, reference)
        start = reference
    clear = reference if control.modal.return_to_reference else start
    i, j, k = memory.back_boring
    hole = Drilling(reference, bottom, clear, (i, j, k + bottom if incremental else k))
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
        if callable(kind.work):
            kind.work(control, hole)
        else:
            heights = {"start": clear, "reference": reference, "bottom": bottom}
            drill(control, hole_of(control, kind.cycle, {**values, **heights}))


_PLAIN = {"dwells": False, "clearance": CLEARANCE}
_PECKING = {"pecking": Pecking.TO_BOTTOM}

KINDS = (
    Kind(
        73,
        "drilling with chips broken every Q",
        "Q",
        "Q",
        {**_PECKING, "lift": CLEARANCE},
    ),
    Kind(74, "tapping, left-hand", "P", "", _tap(4, 3)),
    Kind(81, "drilling", "", "", {}),
    Kind(82, "drilling with P seconds at the bottom", "P", "P", {"dwells": True}),
    Kind(83, "drilling in pecks of Q", "Q", "Q", _PECKING),
    Kind(84, "tapping, right-hand", "P", "", _tap(3, 4)),
    Kind(85, "reaming, out with the feed", "", "", {"retract": Retract.FEED}),
    Kind(86, "boring, out with the spindle stopped", "P", "P", _bore),
    Kind(87, "boring from behind: I J beside the hole, K its top", "IJK", "IJK", _bore_back),
    Kind(
        89,
        "reaming with P seconds at the bottom",
        "P",
        "P",
        {"dwells": True, "retract": Retract.FEED_ALL},
    ),
)


def _code(kind: Kind) -> GCode:
    mode = Interpolation(_perform(kind))
    return GCode(
        meaning=kind.meaning,
        group="motion",
        sets={"cycle": mode, "interpolation": None},
        basis="manual",
    )


CYCLES = {kind.number: _code(kind) for kind in KINDS}
