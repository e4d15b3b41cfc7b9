"""The ISO 6983-1 base that several dialects share: codes, words and what they do."""

import dataclasses
import re
from collections.abc import Callable, Mapping

from twin.nc.control.codes import Action, GCode, Interpolation, MCode
from twin.nc.control.control import Control
from twin.nc.control.dialect import Decision, Dialect
from twin.nc.control.modal import ArcRule, LineRule
from twin.nc.functions import starts_spindle
from twin.nc.geometry.arcs import Point
from twin.nc.geometry.planes import XY, YZ, ZX
from twin.nc.iso.circular import BOUNDS, both_senses, iso_arc
from twin.nc.iso.declared import modal, motion_code, plane_code, replacement
from twin.nc.iso.drilling.fixed_cycles import CYCLES
from twin.nc.iso.offsets import OFFSETS, PRESET
from twin.nc.iso.tool_change import change_tool_at
from twin.nc.iso.tool_compensation import COMPENSATION, LENGTH
from twin.nc.path.blends import Blend, BlendKind
from twin.nc.path.feed_rates import FeedMode, feed_per_minute, needs_own_feed
from twin.nc.path.splines import MOST_CHORDS
from twin.nc.text.blocks import Statement, Word
from twin.nc.text.expressions.arithmetic import is_whole
from twin.nc.text.expressions.expressions import LARGEST_NUMBER


def straight(
    go: Callable[[Control, bool], None], without_words: Action | None = None
) -> tuple[Interpolation, Interpolation]:
    """G0, at the machine's own speed, and G1, with the feed.

    Args:
        go: Takes the words of a block and moves, given whether rapidly.
        without_words: Of G1, as ``Interpolation`` has it.
    """
    return (
        Interpolation(lambda control: go(control, True), rapid=True, rule=LineRule()),
        Interpolation(lambda control: go(control, False), without_words, rule=LineRule()),
    )


def draw_curve(
    control: Control, goal: list[float], at: Callable[[float], Point], count: int
) -> None:
    """Move on so many chords of a curve of the working plane, by u from 0 to 1; all else goes linearly."""
    if count > MOST_CHORDS:
        control.fail("curve-size", f"the curve would need {count} chords")
    plane, before = control.modal.plane, list(control.motion.programmed)
    for number in range(1, count):
        u = number / count
        point = [a + u * (b - a) for a, b in zip(before, goal, strict=True)]
        point[:3] = plane.world(*at(u), plane.local(point).height)
        control.line_to(point, rapid=False)
    control.line_to(goal, rapid=False)


POSITIONING, LINEAR = straight(
    lambda control, rapid: control.line_to(control.target(), rapid=rapid)
)
CLOCKWISE, COUNTER_CLOCKWISE = both_senses(iso_arc, ArcRule(bounds=BOUNDS))


# Nothing is given back once it is taken (``++``): else dots could be shared out without end.
_ELLIPSIS = re.compile(
    r"[ \t]*+(?:N[ \t]*+[0-9]++)?(?:[ \t]*+(?:[A-Z][ \t]*+)?\.{3,}+)+[ \t]*+(?:[$\"].*)?",
    re.IGNORECASE,
)


def is_ellipsis(line: str) -> bool:
    """Dots alone or in place of values, by which documents show what they leave out."""
    return _ELLIPSIS.fullmatch(line) is not None


def excuse_ellipsis(line: str, _previous: str) -> str | None:
    """Why a line that is no block may be left out: it is an ellipsis."""
    return "ellipsis" if is_ellipsis(line) else None


POSITIVE_FEED = "a feed is above 0: F100"
"""What to write in place of a feed that is none."""


def set_feed(control: Control, word: Word) -> None:
    """F: the feed; must be positive."""
    feed = control.number(word)
    if not feed > 0.0:
        control.fail("feed-range", f"the feed {word.text} is not positive", word, POSITIVE_FEED)
    control.motion.feed = feed


def set_spindle_speed(control: Control, word: Word) -> float:
    """The speed of a word S, which counts from now on [1/min].

    Raises:
        ProgramError: It is negative.
    """
    speed = control.number(word)
    if not speed >= 0.0:
        message = f"the speed {word.text} is negative"
        control.fail("spindle-range", message, word, "M4 turns it the other way")
    control.motion.spindle = speed
    return speed


def spindle_speed(control: Control, word: Word) -> None:
    """S: the spindle's speed [1/min]; reported where no spindle start carries it."""
    speed = set_spindle_speed(control, word)
    others = control.block.words
    functions = (other.value for other in others if other.address == "M")
    if not any(isinstance(number, float) and starts_spindle(number) for number in functions):
        control.function("S", {"S": speed})


def next_tool(control: Control, word: Word) -> None:
    """T: the tool that comes next."""
    number = control.number(word)
    if not is_whole(number, LARGEST_NUMBER):
        control.fail("tool-number", f"{word.text} is no tool number", word)
    control.tools.selected = int(number)
    control.function(f"T{int(number)}", {})


def dwell(letters: str, message: str, hint: str) -> Action:
    """A dwell whose seconds are in one of these words; the message where there is none or more."""

    def action(control: Control) -> None:
        words = [control.words.pop(letter) for letter in letters if letter in control.words]
        if len(words) != 1:
            control.fail("dwell", message, hint=hint)
        wait(control, control.number(words[0]), words[0])

    return action


def wait(control: Control, seconds: float, error_at: Word | Statement) -> None:
    """Wait."""
    if not seconds >= 0.0:
        control.fail("dwell", "a dwell cannot be negative", error_at)
    control.dwell(seconds)


PLANES: dict[float, GCode] = {
    17: plane_code("plane X Y", XY, basis="decision"),
    18: plane_code("plane Z X", ZX, basis="decision"),
    19: plane_code("plane Y Z", YZ, basis="decision"),
}
DISTANCE: dict[float, GCode] = {
    90: modal("absolute coordinates", "distance", basis="decision", incremental=False),
    91: modal("incremental coordinates", "distance", basis="decision", incremental=True),
}
UNITS = {
    70: modal("inches", "units", basis="decision", unit=25.4),
    71: modal("millimetres", "units", basis="decision", unit=1.0),
}
MOTION = {
    0: motion_code("rapid positioning", POSITIONING, "decision"),
    1: motion_code("straight line", LINEAR, "decision"),
    2: motion_code("arc clockwise", CLOCKWISE, "decision"),
    3: motion_code("arc counter-clockwise", COUNTER_CLOCKWISE, "decision"),
}
DWELL = {
    4: replacement(
        "dwell, seconds in P, X or F",
        dwell("PXF", "G4 needs its time", "write G4 P and the seconds"),
        consumes="F",
        basis="decision",
    )
}
FEEDS = {
    94: modal("feed per minute", "feed", basis="decision", feed_mode=FeedMode.PER_MINUTE),
    95: modal(
        "feed per revolution of the spindle",
        "feed",
        basis="decision",
        feed_mode=FeedMode.PER_REVOLUTION,
    ),
}

REPLACEMENTS: dict[float, str] = {
    20: "inches are G70",
    21: "millimetres are G71",
    28: "write G53 and the axes",
    30: "write G53 and the axes",
    52: "write G92, or a work offset of the job",
    93: "F is a feed per minute (G94) or per revolution (G95)",
}
"""Codes of other controls, and what the base has for them."""

CODES = {
    **MOTION,
    **DWELL,
    **PLANES,
    **COMPENSATION,
    **LENGTH,
    **OFFSETS,
    **UNITS,
    **CYCLES,
    **DISTANCE,
    **PRESET,
    **FEEDS,
}
"""The base that ``gost`` and ``mefi`` share; each replaces what its own page says otherwise."""

START = (17, 40, 49, 71, 80, 90, 94)
"""Codes in force when a program starts: none moves until one is programmed (decision)."""

GROUPS = (
    "units",
    "plane",
    "distance",
    "feed",
    "corner",
    "offset",
    "length",
    "return plane",
    "compensation",
    "motion",
    "cycle",
)

M_CODES = {
    0: MCode(meaning="program stop", group="stop", after_motion=True),
    1: MCode(meaning="optional stop", group="stop", after_motion=True),
    2: MCode(meaning="end of program", group="stop", after_motion=True, ends=True),
    3: MCode(meaning="spindle clockwise", group="spindle"),
    4: MCode(meaning="spindle counter-clockwise", group="spindle"),
    5: MCode(meaning="spindle stop", group="spindle", after_motion=True),
    6: MCode(meaning="tool change", action=change_tool_at(None)),
    7: MCode(meaning="mist on"),
    8: MCode(meaning="coolant on", group="coolant"),
    9: MCode(meaning="coolant off", group="coolant", after_motion=True),
    30: MCode(
        meaning="end of program and back to its start", group="stop", after_motion=True, ends=True
    ),
}

WORDS = {"F": set_feed, "S": spindle_speed, "T": next_tool}

WORD_MEANINGS = {
    "N": "block number",
    "G": "preparatory code",
    "X": "X axis",
    "Y": "Y axis",
    "Z": "Z axis",
    "A": "A axis",
    "B": "B axis",
    "C": "C axis",
    "U": "U axis",
    "V": "V axis",
    "W": "W axis",
    "I": "centre along X, from the start of the arc",
    "J": "centre along Y",
    "K": "centre along Z",
    "R": "radius of the arc, negative: the larger of the two; reference plane of a cycle",
    "D": "tool whose radius compensates",
    "H": "tool whose length compensates",
    "P": "seconds of a dwell",
    "Q": "depth of one peck (G83)",
    "F": "feed",
    "S": "spindle speed",
    "T": "tool",
    "M": "machine function",
}


def require_feed_of_block(control: Control) -> None:
    """G93: an F holds for its block alone."""
    if needs_own_feed(control.modal.feed_mode) and not any(
        word.address == "F" for word in control.block.words
    ):
        message = "with G93 every block that cuts needs its F"
        control.fail("no-feed", message, hint="write F, or G94")


def by_manual(codes: Mapping[float, GCode]) -> dict[float, GCode]:
    """Codes of the base whose meaning the manual of a control gives as well."""
    return {number: dataclasses.replace(code, basis="manual") for number, code in codes.items()}


def jog_block(dialect: Dialect, axis: str, distance: float, feed: float) -> str:
    """One straight move by a distance [mm or deg] with a feed per minute, in a control's own language."""
    mode = dialect.codes.start_state.get("feed_mode", FeedMode.PER_MINUTE)
    of_one = feed_per_minute(1.0, mode, distance, True, 1.0, 0.0, (feed, feed))
    number, rate = _written(distance), _written(feed / of_one)
    return dialect.rules.jog.format(axis=axis, distance=number, feed=rate)


def _written(number: float) -> str:
    """A number to a nanometre with its point, without an exponent and zeros that say nothing."""
    return f"{number:.6f}".rstrip("0")


DECISIONS = (
    Decision(
        "Which codes are in force when a program starts?",
        "G17 G40 G49 G71 G80 G90 G94; none moves until G0, G1, G2 or G3 is programmed.",
        "The pages do not say; a program that moves without a code would be a guess.",
        example="start_state",
    ),
    Decision(
        "How far may start and end of an arc differ in their distance from the centre?",
        "By 0.01 mm or 0.1 % of the radius; the centre is then moved to fit, by 0.1 mm or 1 % of "
        "the radius at most.",
        "Programs rounded to 0.001 mm stay far below it; nearly full circles magnify it.",
        example="arc_centre_moved_to_fit",
    ),
    Decision(
        "Where do work offsets count from?",
        "G54 to G59 count from the job's part zero, G54 is part zero itself where the job gives it "
        "no values; a work offset ends a preset (G92); G53 puts coordinates back to machine zero.",
        "The job says where part zero lies on the machine.",
        example="work_offset_ends_preset",
    ),
    Decision(
        "What do D and H name?",
        "The tool of the job whose radius or length compensates; without them the tool in the "
        "spindle. Lengths count against the job's first tool.",
        "The job's tools have one offset each.",
        example="tools_by_d_and_h",
    ),
    Decision(
        "How does radius compensation pass corners?",
        "Outside corners are rolled around, inside corners end where the parallel paths meet; the "
        "straight lead-in ends square to the contour, the straight lead-out starts square to it; "
        "what does not fit is refused, and so is a neck of the contour that is narrower than the "
        "tool, as far as 50 elements lie between its sides; a lead that cuts into the contour is "
        "driven with a warning.",
        "It keeps the tool's edge on the contour and leaves it nowhere; leads are the programmer's.",
        example="compensation_corners",
    ),
    Decision(
        "What do drilling cycles do?",
        "Z R P Q stay in force until G80 or a motion code; R counts from the tool and Z from R with "
        "G91; a cycle block without a hole drills where the tool is.",
        "ISO 6983-1 names the cycles and leaves their words to the control.",
        example="drilling_words_stay",
    ),
    Decision(
        "How long is G4?",
        "The seconds of P, X or F.",
        "All three are in use; seconds are their common unit.",
        example="dwell_in_seconds",
    ),
)


def blend_corner_behind(control: Control, kind: BlendKind, size: float, word: Word) -> None:
    """Round or chamfer the corner between the block's own feed move and the next.

    Args:
        size: Radius or length [mm].
        word: That asks for it.
    """
    blend = Blend(kind, size, control.motion.part_plane)
    if not control.path.hold_for_blends().blend_next(blend, control.block.line):
        message = (
            f"{word.address} is for the end of a move with G1, G2 or G3, which this block lacks"
        )
        control.fail("blend", message, word)
