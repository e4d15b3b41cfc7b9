"""Places of cycles: the patterns 220 and 221, which act where they are defined, and PATTERN DEF."""

import re

from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.cycles.calls import (
    CLEARANCE,
    SECOND_CLEARANCE,
    SURFACE,
    defined,
    go_over,
    run_raised,
)
from twin.nc.dialects.heidenhain.cycles.parameters import continued
from twin.nc.dialects.heidenhain.memory import CycleParameters, memory_of
from twin.nc.geometry.arcs import Point
from twin.nc.iso.cycle_moves import circle, grid, row
from twin.nc.text.blocks import Statement

MOST_PLACES = 10_000
"""Places of a pattern: more is a slip of the pen."""


def _count(control: Control, value: float, name: str) -> int:
    if value != int(value) or not 1 <= value <= MOST_PLACES:
        control.fail("repeat-count", f"{name} counts places, 1 to {MOST_PLACES}, not {value:g}")
    return int(value)


def polar_pattern(control: Control, given: CycleParameters) -> None:
    """220: Q241 places on the circle of the diameter Q244, from Q245 on, Q247 apart or up to Q246."""
    center, radius = (given.length(216), given.length(217)), given.length(244) / 2.0
    first, last, step = given.number(245), given.number(246), given.number(247)
    count = _count(control, given.number(241), "Q241")
    if step == 0.0:
        whole = abs(last - first) % 360.0 == 0.0
        step = (last - first) / (count if whole else max(count - 1, 1))
    if given.number(365) == 1.0 and given.number(301) == 0.0:
        message = (
            "between the places of cycle 220 the tool goes straight here, not on an arc (Q365)"
        )
        control.report.notice("Q365", message, *control.span_of(None))
    _machine(control, given, circle(center, radius, first, step, count))


def linear_pattern(control: Control, given: CycleParameters) -> None:
    """221: Q242 columns and Q243 lines, every other line backwards, turned by Q224 about the first place."""
    start = (given.length(225), given.length(226))
    columns = _count(control, given.number(242), "Q242")
    lines = _count(control, given.number(243), "Q243")
    _count(control, columns * lines, "Q242 times Q243")
    angle, spacing = given.number(224), (given.length(237), given.length(238))
    _machine(control, given, grid(start, (angle, angle), spacing, (columns, lines)))


def _machine(control: Control, given: CycleParameters, places: list[Point]) -> None:
    """Run the cycle that was defined before at all places, with the clearances and the surface of the pattern."""
    memory = memory_of(control)
    own = {each: given.values[each] for each in (200, 203, 204) if each in given.values}
    memory.parameters = parameters = defined(control).replaced(own)
    surface, second = parameters.length(SURFACE), given.number(301, 1.0) != 0.0
    for number, (x, y) in enumerate(places):
        high = second or number == 0
        above = parameters.length(SECOND_CLEARANCE) if high else 0.0
        height = surface + max(above, parameters.length(CLEARANCE))
        go_over(control, [x, y, *control.motion.programmed[2:]], height, rapid=True)
        run_raised(control, 0.0, second=second or number == len(places) - 1)


# --- PATTERN DEF

_PIECE = re.compile(r"(POS|ROW|PAT|FRAME|CIRC|PITCHCIRC)[0-9]*[ \t]*\(([^()]*)\)", re.IGNORECASE)
_WORD = re.compile(
    r"(I(?=[XY])|)(NUMX|NUMY|NUM|ROTX|ROTY|ROT|START|STEP|DX|DY|D|X|Y|Z)[ \t]*([-+]?[ \t]*(?:[.0-9]+|Q[LR]?[0-9]+))",
    re.IGNORECASE,
)


def define_pattern(control: Control, statement: Statement) -> None:
    """PATTERN DEF: the places of CYCL CALL PAT."""
    memory, line, column = memory_of(control), control.block.line, statement.text_column
    memory.pattern = []
    pieces = re.compile(r"[ \t]*(?:POS|ROW|PAT|FRAME|CIRC|PITCHCIRC)[0-9]", re.IGNORECASE)
    texts = [
        (line - 1, column, statement.text),
        *((n, 0, t) for n, t in continued(control, while_=pieces)),
    ]
    for number, at, text in texts:
        control.report.line = number + 1
        rest = _PIECE.sub("", text).strip(" \t~")
        if rest:
            hint = "PATTERN DEF POS1 (X+10 Y+20 Z+0), ROW1, PAT1, FRAME1, CIRC1, PITCHCIRC1"
            begin = at + text.index(rest[0])
            control.report.fail(
                "unreadable-statement", f"'{rest}' is no piece of a pattern", begin, len(rest), hint
            )
        for match in _PIECE.finditer(text):
            words = _words(control, match[2], at + match.start(2))
            memory.pattern += _places(control, match[1].upper(), words, statement)
    control.report.line = line
    if not 0 < len(memory.pattern) <= MOST_PLACES:
        control.fail("unreadable-statement", f"a pattern has 1 to {MOST_PLACES} places", statement)


def _words(control: Control, text: str, column: int) -> dict[str, float]:
    words: dict[str, float] = {}
    for match in _WORD.finditer(text):
        value, _ = control.statements.operand(text, match.start(3), column)
        name, last = match[2].upper(), memory_of(control).pattern[-1:]
        before = last[0]["XY".index(name)] / control.modal.unit if match[1] and last else 0.0
        words[name] = before + control.compute(value, column + match.start(3))
    if _WORD.sub("", text).strip() or "X" not in words or "Y" not in words:
        message = f"({text}) is no place of a pattern"
        control.report.fail("unreadable-statement", message, column, len(text), "(X+10 Y+20 Z+0)")
    return words


def _places(
    control: Control, kind: str, words: dict[str, float], statement: Statement
) -> list[tuple[float, float, float]]:
    """The places of one piece, programmed coordinates [mm]."""
    start, needed = (words["X"], words["Y"]), _NEEDED[kind]
    missing = [each for each in needed if each not in words]
    if missing:
        control.fail("unreadable-statement", f"{kind} needs {' and '.join(missing)}", statement)
    number = _count(control, words.get("NUM", 1.0), "NUM")
    columns = _count(control, words.get("NUMX", 1.0), "NUMX")
    lines = _count(control, words.get("NUMY", 1.0), "NUMY")
    _count(control, float(columns * lines), "NUMX times NUMY")
    turn = words.get("ROT", 0.0)
    if kind == "ROW":
        points = row(start, turn, words["D"], number)
    elif kind in ("CIRC", "PITCHCIRC"):
        step = words["STEP"] if kind == "PITCHCIRC" else 360.0 / number
        points = circle(start, words["D"] / 2.0, words["START"] + turn, step, number)
    elif kind in ("PAT", "FRAME"):
        angles = (turn + words.get("ROTX", 0.0), turn + words.get("ROTY", 0.0))
        spacing = (words["DX"], words["DY"])
        points = grid(start, angles, spacing, (columns, lines), frame=kind == "FRAME")
    else:
        points = [start]
    unit, height = control.modal.unit, words.get("Z", 0.0)
    return [(x * unit, y * unit, height * unit) for x, y in points]


_NEEDED = {
    "POS": (),
    "ROW": ("D", "NUM"),
    "PAT": ("DX", "DY", "NUMX", "NUMY"),
    "FRAME": ("DX", "DY", "NUMX", "NUMY"),
    "CIRC": ("D", "START", "NUM"),
    "PITCHCIRC": ("D", "START", "STEP", "NUM"),
}
