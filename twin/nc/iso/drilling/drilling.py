"""Drilling cycles: the codes that call them, their words, and what these say of a hole, in every dialect."""

import dataclasses
import enum
import math
from collections.abc import Callable, Mapping
from typing import NamedTuple, NoReturn

from twin.nc.control.codes import Basis, GCode, Interpolation
from twin.nc.control.control import Control
from twin.nc.iso.drilling.hole import (
    CHIP_CLEARANCE,
    MOST_PECKS,
    Hole,
    Retract,
    count_passes,
    drill,
)

_FASTEST_RETURN = 9.0
_LENGTHS = frozenset(
    ("reference", "bottom", "surface", "peck", "least", "lift", "clearance", "first", "reduction")
)
"""Values whose words count in the unit in force."""


class Pecking(enum.IntEnum):
    """How a cycle goes down."""

    NONE = 0
    TO_BOTTOM = 1
    """By pecks, from the first on, as far as the bottom."""
    COUNTED = 2
    """By so many equal pecks."""
    PASSES = 3
    """By passes of a tap, which breaks the chip in its thread: all of them are made with the feed, and out with
    the spindle reversed. At once where nothing says how deep they are."""
    UNSIGNED_PASSES = 4
    """As ``PASSES``; their depth may be written with either sign."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Cycle:
    """What is peculiar to one drilling cycle.

    What it remembers is in ``Control.cycle_values``: the height of its call, ``start``; the axis across its plane,
    ``axis``; and what its words have given: heights of the ``reference`` plane and of the ``bottom``, with ``depth``
    as the latter was written; seconds of the ``dwell``; how far the ``surface`` lies below the reference plane; the
    first ``peck``, the ``factor`` of each next one, the ``least``; how far the tool ``lift``s, and after ``every`` how
    many pecks it clears; the ``count`` of pecks; the ``clearance`` above its last height at which a rapid return ends;
    the ``first`` peck where each next one is less deep by a ``reduction``; how many times ``faster`` a tap comes back.

    Attributes:
        words: Which value each word gives, besides that of the axis across the plane.
        across: The value that the latter gives.
        needed: Values that must be there.
        options: Other words of its call, and those of their values that change nothing of the path.
        lasting: Its words stay in force from cycle to cycle, and every hole may change them; else
            its first block says all.
        clearance: Where its words give none [mm].
        lift: Likewise; 0: to the reference plane [mm].
        as_written: It remembers heights as they are written, and at each hole they count from what is in
            force there.
    """

    name: str
    words: Mapping[str, str]
    across: str = "bottom"
    needed: tuple[str, ...] = ("reference", "bottom")
    options: Mapping[str, tuple[float, ...]] = dataclasses.field(default_factory=dict)
    lasting: bool = True
    pecking: Pecking = Pecking.NONE
    dwells: bool = True
    clearance: float = CHIP_CLEARANCE
    retract: Retract = Retract.RAPID
    lift: float = 0.0
    as_written: bool = False

    def addresses(self, control: Control) -> dict[str, str]:
        """Which value each word gives, also that of the axis across the plane."""
        across = control.settings.axes.names[control.modal.plane.axes[2]]
        return {**self.words, across: self.across}


class Holes(NamedTuple):
    """How the blocks of a cycle name their holes.

    Attributes:
        target: Takes the words that name the hole; its programmed position, shape (k,).
        repeats: Address that says how often a block drills, each hole as far from the last as the
            block's increments say; 0: its words are taken and nothing is drilled. Empty: none.
    """

    target: Callable[[Control], list[float]] = Control.target
    basis: Basis = "decision"
    repeats: str = ""


ONE_HOLE = Holes()
"""Axis words name one hole."""


def cycle_code(cycle: Cycle, meaning: str, holes: Holes = ONE_HOLE) -> GCode:
    """The code that calls a cycle with its words."""

    def call(control: Control) -> None:
        _take_options(control, cycle)
        take_words(control, cycle, calls=True)

    def perform(control: Control) -> None:
        count = repeats_of(control, holes.repeats)
        take_words(control, cycle)
        given = dict(control.words)
        if count == 0:
            control.take_axis_words()
        for _ in range(count):
            control.words = dict(given)
            drill(control, _hole_in_force(control, cycle), holes.target(control))

    return GCode(
        meaning=meaning,
        group="cycle",
        sets={"cycle": Interpolation(perform)},
        action=call,
        basis=holes.basis,
    )


def repeats_of(control: Control, address: str, least: int = 0) -> int:
    """How often the block drills, ``least`` times or more; takes the word that says it."""
    word = control.take(address) if address else None
    if word is None:
        return 1
    given, most = control.number(word), control.settings.step_limit
    if given < least or given != int(given) or given > most:
        message = f"{word.address} must count holes, {least} to {most}"
        control.fail("repeat-count", message, word)
    return int(given)


def take_words(control: Control, cycle: Cycle, *, calls: bool = False) -> None:
    """Take the words of a block that calls a cycle, or of its hole; which of both it is, the cycle says."""
    modal, values = control.modal, control.cycle_values
    axis, incremental = modal.plane.axes[2], modal.incremental and not cycle.as_written
    if calls and not (cycle.lasting and "start" in values):
        values.clear()
        values |= {"start": control.motion.programmed[axis], "axis": axis}
    if calls == cycle.lasting:
        return
    given: dict[str, float] = {}
    relative: dict[str, bool] = dict.fromkeys(("reference", "bottom"), incremental)
    for address, value in cycle.addresses(control).items():
        if (word := control.take(address)) is not None:
            given[value] = control.length(word) if value in _LENGTHS else control.number(word)
            relative[value] = incremental or word.incremental
    if "reference" in given:
        given["reference"] += values["start"] if relative["reference"] else 0.0
    elif not cycle.lasting:
        given["reference"] = values["start"]
    values |= given
    if "bottom" in given:
        above = values.get("reference", 0.0) if relative["bottom"] else 0.0
        values |= {"bottom": given["bottom"] + above, "depth": given["bottom"]}


def _take_options(control: Control, cycle: Cycle) -> None:
    """Take words of the call that change nothing of the path."""
    for letter, known in cycle.options.items():
        word = control.take(letter)
        if word is not None and control.number(word) not in known:
            values = " or ".join(f"{letter}{value:g}" for value in known)
            control.fail("unsupported-word", f"only {values} is followed here", word)


def require_words(control: Control, cycle: Cycle) -> None:
    """What a cycle needs at a hole must be there.

    Raises:
        ProgramError: A word is missing, or another plane is in force than that of its call.
    """
    values = control.cycle_values
    if values.get("axis") != control.modal.plane.axes[2]:
        refuse_other_plane(control, cycle.name)
    letters = {value: letter for letter, value in cycle.addresses(control).items()}
    missing = {letters[value]: value for value in cycle.needed if value not in values}
    if missing:
        refuse_missing(control, cycle.name, missing)


def refuse_other_plane(control: Control, name: str) -> NoReturn:
    """Refuse a hole in another plane than that of the cycle's call."""
    message = f"{name} was called in another plane"
    control.fail("cycle-plane", message, hint="end it by G80 before the plane changes")


_NEEDED = {
    "reference": "the height where the feed begins, such as {}2.",
    "bottom": "the depth of the hole, such as {}-10.",
    "peck": "the depth of a peck, such as {}2.",
    "count": "the number of pecks, such as {}3",
    "feed": "the feed, such as {}100.",
}
"""What a value of a cycle is, and how its word is written behind its address."""


def refuse_missing(control: Control, name: str, missing: Mapping[str, str]) -> NoReturn:
    """Refuse a hole of a cycle that lacks words: the value of each, by its address."""
    hints = [
        f"{each}: {_NEEDED[value].format(each)}"
        for each, value in missing.items()
        if value in _NEEDED
    ]
    message = f"{name} needs {' and '.join(missing)}"
    control.fail("cycle-word", message, hint="; ".join(hints) or None)


def _hole_in_force(control: Control, cycle: Cycle) -> Hole:
    """What the cycle does at a hole."""
    require_words(control, cycle)
    if cycle.pecking is Pecking.TO_BOTTOM and "peck" not in cycle.needed:
        _require_peck_words(control, cycle)
    hole = hole_of(control, cycle)
    if not (hole.bottom < hole.reference and hole.clearance >= 0.0):
        message = (
            f"{cycle.name} must drill downwards, not from {hole.reference:g} to {hole.bottom:g}"
        )
        control.fail("cycle-depth", message)
    if hole.dwell < 0.0:
        control.fail("dwell", f"{cycle.name} cannot wait {hole.dwell:g} seconds")
    if hole.faster % 1.0 != 0.0 or not 1.0 <= hole.faster <= _FASTEST_RETURN:
        message = f"{cycle.name} comes back 1 to 9 times as fast, a whole number, not {hole.faster:g} times"
        control.fail("cycle-word", message)
    return hole


def _require_peck_words(control: Control, cycle: Cycle) -> None:
    """Either the depth of all pecks must be there, or the first, the reduction and the least."""
    values = control.cycle_values
    fading = {"first", "reduction", "least"}
    there = fading & values.keys()
    if there if "peck" in values else there != fading:
        message = f"{cycle.name} needs Q, the depth of each peck, or I, J and K: the first, less each time, the least"
        control.fail("cycle-word", message, hint="write one or the other, and G80 between both")
    if there and (values["reduction"] < 0.0 or values["least"] <= 0.0):
        message = f"{cycle.name} needs pecks above 0"
        control.fail("cycle-depth", message, hint="depths of pecks have no sign: Q2")


def hole_of(control: Control, cycle: Cycle, values: Mapping[str, float] | None = None) -> Hole:
    """What a cycle does at a hole, by what it remembers; nothing but its pecks is checked."""
    values = control.cycle_values if values is None else values
    reference, get = values["reference"], values.get
    dwell = get("dwell", 0.0) if cycle.dwells else 0.0
    to_reference = control.modal.return_to_reference
    back = reference if to_reference else max(values["start"], reference)
    surface, bottom = reference - get("surface", 0.0), values["bottom"]
    peck = get("first", get("peck", math.nan))
    if cycle.pecking is Pecking.COUNTED:
        peck = abs(values["depth"])
        bottom = surface - peck * values["count"]
    if cycle.pecking is Pecking.UNSIGNED_PASSES:
        peck = abs(peck)
    passes = cycle.pecking in (Pecking.PASSES, Pecking.UNSIGNED_PASSES)
    hole = Hole(reference, bottom, back, dwell, surface, passes=passes)
    hole = hole._replace(
        peck=peck,
        factor=get("factor", 1.0),
        reduction=get("reduction", 0.0),
        least=get("least", 0.0),
        lift=get("lift", cycle.lift),
        clearance=get("clearance", cycle.clearance),
        retract=cycle.retract,
        faster=get("faster", 1.0),
    )
    every = get("every", 0.0)
    if cycle.pecking is Pecking.NONE or (passes and math.isnan(peck)):
        return hole
    if peck <= 0.0 or hole.factor <= 0.0 or hole.lift < 0.0 or every < 0.0 or every % 1.0 != 0.0:
        _refuse_pecks(control, cycle)
    hole = hole._replace(full_every=1 if hole.lift == 0.0 else int(every))
    if passes:
        hole = hole._replace(stops=count_passes(surface, bottom, peck) - 1)
    else:
        hole = hole.with_stops()
    if hole.stops + passes > MOST_PECKS:
        _refuse_many_pecks(control, cycle)
    return hole


def _refuse_many_pecks(control: Control, cycle: Cycle) -> NoReturn:
    kind, hint = "pecks", "write deeper pecks"
    if cycle.pecking in (Pecking.PASSES, Pecking.UNSIGNED_PASSES):
        address = next(letter for letter, value in cycle.words.items() if value == "peck")
        kind, hint = "passes", f"write a larger {address}"
    control.fail("cycle-depth", f"the hole would need more than {MOST_PECKS} {kind}", hint=hint)


def _refuse_pecks(control: Control, cycle: Cycle) -> NoReturn:
    letters = {value: letter for letter, value in cycle.words.items()}
    needed = "pecks above 0"
    if cycle.pecking in (Pecking.PASSES, Pecking.UNSIGNED_PASSES):
        needed = f"passes {letters['peck']} above 0"
        if "lift" in letters:
            needed = f"{letters['peck']} above 0, and {letters['lift']} not below 0"
    elif "factor" in letters:
        above = f"{letters['peck']} and {letters['factor']} above 0"
        needed = f"{above}, {letters['lift']} not below 0, and {letters['every']} a count"
    hint = f"write {letters['peck']}2"
    control.fail("cycle-depth", f"{cycle.name} needs {needed}", hint=hint)
