"""How a raw program is read: what its job would say, as far as the program's text shows it."""

import dataclasses
import json
import re
from collections.abc import Callable, Mapping, Set
from types import MappingProxyType
from typing import NamedTuple

from twin.nc.control.dialect import Dialect, JobKey
from twin.nc.control.settings import ControlSettings, ToolData
from twin.nc.dialects.recognition import lines_with, raw_text
from twin.nc.geometry.arcs import TURN
from twin.nc.text.source import Source
from twin.run.reading.assumed_offsets import named_offsets
from twin.run.reading.assumed_tools import USUAL_LENGTH
from twin.run.reading.tool_comments import ToolComment, listed_tools, tool_of_call

_LENGTH = re.compile(
    r"(?<![A-Z#\[])([XYZABCIJKRF])[ \t]*[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)", re.IGNORECASE
)
_WITH_POINT_AT_END = re.compile(
    r"(?<![A-Z#\[])[XYZABCIJKRF][ \t]*[-+]?[0-9]+\.(?![0-9])", re.IGNORECASE
)
_FUNCTION = re.compile(r"(?<![A-Z_#\[])M[ \t]*([0-9]{1,4})(?![0-9.\[#])", re.IGNORECASE)
_TOOL = re.compile(r"(?<![A-Z#\[])T[ \t]*([0-9]{1,4})(?![0-9.])", re.IGNORECASE)
_INCHES = re.compile(r"(?<![A-Z0-9.])G[ \t]*[27]0(?![0-9.])", re.IGNORECASE)
_UNITS = re.compile(r"(?<![A-Z0-9.])G[ \t]*(?:2[01]|7[01]0?)(?![0-9.])", re.IGNORECASE)
_TOOL_IN_INCHES = re.compile(
    r"(?:[0-9]+/[0-9]+|[0-9.]+ ?(?:IN(?:CH)?\b|\"))(?=.*(?:MILL|DRILL|TAP|REAM|CUTTER))"
    r"|(?:MILL|DRILL|TAP|REAM|CUTTER)\b[^0-9]*(?:[0-9]+/[0-9]+|[0-9.]+ ?(?:IN(?:CH)?\b|\"))",
    re.IGNORECASE,
)
_MILLIMETRES = re.compile(r"[0-9] ?MM\b|\bMETRIC\b|\bMILLIMET", re.IGNORECASE)
_FARTHEST_INCHES = 40.0
"""Programs that go farther do not count inches: it is as far as the larger mills go [inch]."""
_CHANGE = re.compile(r"(?<![A-Z])M[ \t]*0?6(?![0-9])", re.IGNORECASE)
_CALLS_OFFSET = re.compile(r"(?<![A-Z0-9.])G[ \t]*4[1-4](?![0-9.])", re.IGNORECASE)
_ROW = re.compile(r"(?<![A-Z#\[])[HD][ \t]*0*([1-9][0-9]{0,3})(?![0-9.])", re.IGNORECASE)
"""H and D name rows of the offset memory on controls where it is numbered."""
_ROWS_TOLD, _ROLLOVER_TOLD = "offsets H and D: ", "rotary axes roll over: "
_OF_SOME = {JobKey.OFFSET_ROWS: _ROWS_TOLD, JobKey.ROLLOVER: _ROLLOVER_TOLD}
"""Keys that some dialects alone have a setting for, and how their notes begin."""
_TOOL_OR_OFFSET = re.compile(
    "|".join(each.pattern for each in (_TOOL, _CHANGE, _CALLS_OFFSET)), re.IGNORECASE
)
_ANGLE = re.compile(r"(?<![A-Z#\[])([ABC])[ \t]*([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+))", re.IGNORECASE)
_MOTION = re.compile(r"(?<![A-Z0-9.])G[ \t]*0?([0-3])(?![0-9.])", re.IGNORECASE)
_NEARLY_A_TURN = 350.0
"""What no axis turns back by in a cut, whose neighbours are some degrees apart [deg]."""
UNKNOWN_FUNCTION = "not known here: taken to do nothing"


class AssumedReading(NamedTuple):
    """Keys of the job, and what was assumed and from what, for people.

    Attributes:
        keys: Of the job file, that it does not give itself.
        notes: A line each.
        tools: What comments say of the tools, for radius compensation; the job's own come later, by what
            they do.
        tool_of_call: The same of tools that are called by names.
    """

    keys: dict[str, object]
    notes: tuple[str, ...]
    tools: Mapping[int, ToolData] = MappingProxyType({})
    tool_of_call: Callable[[str, int], ToolData | None] | None = None

    def as_read_by(self, dialect: Dialect, settings: ControlSettings) -> "AssumedReading":
        """What of it matters to a dialect, in which numbers without a point may always count whole units."""
        for name, begin in _OF_SOME.items():
            if name in self.keys and name not in dialect.job_keys:
                keys = {key: value for key, value in self.keys.items() if key != name}
                notes = tuple(each for each in self.notes if not each.startswith(begin))
                return self._replace(keys=keys, notes=notes).as_read_by(dialect, settings)
        counting = dataclasses.replace(settings, decimal_point="increments")
        if "decimal_point" not in self.keys or dialect.rules.without_point(counting):
            return self
        keys = {key: value for key, value in self.keys.items() if key != "decimal_point"}
        return self._replace(keys=keys, notes=self.notes[1:])


NOTHING_ASSUMED = AssumedReading({}, ())


def assumed_reading(source: Source) -> AssumedReading:
    """What the text of a raw program shows of how it is to be read, in whatever dialect."""
    keys: dict[str, object] = {}
    notes: list[str] = []
    bare = _bare_number(source)
    if bare:
        keys["decimal_point"] = "calculator"
        notes.append(
            f"{bare} counts whole units: the program never writes a whole number with a point"
        )
    blocks = raw_text(source).blocks
    offsets = named_offsets(blocks)
    if offsets:
        keys["offsets"] = {offset: {} for offset in offsets}
    tool = _tool_in_inches(source)
    if tool:
        keys["units"] = "inch"
        notes.append(f"inches: the program names no units, and its tools are in inches ({tool})")
    rows = _offset_rows(source)
    if rows:
        keys["offset_rows"] = rows
        listed = ", ".join(f"{row} that of tool {tool}" for row, tool in rows.items())
        notes.append(f"{_ROWS_TOLD}{listed}, which was in the spindle then")
    turn = _turn_within_a_cut(source)
    if turn:
        keys["rollover"] = "shorter"
        notes.append(f"{_ROLLOVER_TOLD}{turn}")
    inches = bool(tool) or _INCHES.search(blocks) is not None
    return AssumedReading(
        keys, tuple(notes), _commented_tools(source, inches=inches), _named_tools(source, inches)
    )


def unit_lines(reading: AssumedReading) -> list[str]:
    """The units, and what numbers without a point and angles count, where that was assumed."""
    comments = {
        "decimal_point": "  # increments: X10 is 0.010 mm",
        "units": "",
        "rollover": "  # sign: in the direction of their sign",
    }
    return [
        f'{key} = "{reading.keys[key]}"{comment}'
        for key, comment in comments.items()
        if key in reading.keys
    ]


def table_lines(reading: AssumedReading) -> list[str]:
    """Tables of the work offsets and M codes that were assumed."""
    lines: list[str] = []
    offsets, functions = reading.keys.get("offsets"), reading.keys.get("m_functions")
    rows = reading.keys.get("offset_rows")
    if isinstance(offsets, dict):
        lines += [line for name in offsets for line in (f"[offsets.{json.dumps(name)}]", "")]
    if isinstance(rows, dict):
        lines += ["[offset_rows]", *(f"{row} = {tool}" for row, tool in rows.items()), ""]
    if isinstance(functions, dict):
        lines += ["[m_functions]", *(f'{code} = "{does}"' for code, does in functions.items()), ""]
    return lines


def _named_tools(source: Source, inches: bool) -> Callable[[str, int], ToolData | None]:
    """What tells a tool by its name and the line that calls it."""

    def tool(name: str, line: int) -> ToolData | None:
        found = tool_of_call(name, line, raw_text(source).comments, inches=inches)
        return None if found is None else _data_of(found)

    return tool


def _data_of(tool: ToolComment) -> ToolData | None:
    """What the control's table has of a tool, all of them equally long, so that heights are the program's; None: its radius is not known."""
    return None if tool.table_radius is None else ToolData(tool.table_radius, USUAL_LENGTH)


def _turn_within_a_cut(source: Source) -> str:
    """Where a cut goes on from one end of a turn to the other, as for a control whose axes count 0 to 360; empty: nowhere."""
    angles: dict[str, float] = {}
    motion, found, blocks = "", "", raw_text(source).blocks
    if _ANGLE.search(blocks) is None:
        return ""
    for line, text in enumerate(blocks.split("\n"), 1):
        motion = next((each[1] for each in _MOTION.finditer(text)), motion)
        for word in _ANGLE.finditer(text):
            letter, angle = word[1].upper(), float(word[2])
            if abs(angle) > TURN:
                return ""
            before = angles.get(letter, angle)
            if motion == "1" and abs(angle - before) > _NEARLY_A_TURN and not found:
                found = f"line {line} goes on cutting from {letter}{before:g} to {letter}{angle:g}"
            angles[letter] = angle
    return found


def _offset_rows(source: Source) -> dict[int, int]:
    """Rows of H and D that are no tool's number, and the tool that was in the spindle where each came first."""
    numbers, blocks = _tool_numbers(source), raw_text(source).blocks
    rows: dict[int, int] = {}
    selected = spindle = 0
    for line in lines_with(blocks, _TOOL_OR_OFFSET):
        for found in _TOOL.finditer(line):
            selected = int(found[1])
        if _CHANGE.search(line):
            spindle = selected
        if spindle and _CALLS_OFFSET.search(line):
            for found in _ROW.finditer(line):
                if int(found[1]) not in numbers:
                    rows.setdefault(int(found[1]), spindle)
    return rows


def _tool_in_inches(source: Source) -> str:
    """The first comment of a tool in inches of a program that names no units; empty: its lengths are millimetres."""
    if _UNITS.search(raw_text(source).blocks):
        return ""
    comments = [text for _, text in raw_text(source).comments]
    if any(map(_MILLIMETRES.search, comments)) or _farthest(source) > _FARTHEST_INCHES:
        return ""
    return next(filter(_TOOL_IN_INCHES.search, comments), "")


def _farthest(source: Source) -> float:
    """The largest number behind X, Y or Z."""
    numbers = _LENGTH.finditer(raw_text(source).blocks)
    return max((float(each[2]) for each in numbers if each[1] in "XYZxyz"), default=0.0)


def _tool_numbers(source: Source) -> set[int]:
    return {int(found[1]) for found in _TOOL.finditer(raw_text(source).blocks)}


def _commented_tools(source: Source, *, inches: bool) -> dict[int, ToolData]:
    """The tools of comments whose radius they tell, by number."""
    comments = (text for _, text in raw_text(source).comments)
    listed = listed_tools(comments, _tool_numbers(source), inches=inches)
    data = {number: _data_of(tool) for number, tool in listed.items()}
    return {number: each for number, each in data.items() if each is not None}


def functions_of(source: Source) -> set[int]:
    """The M codes of a program."""
    return {int(found[1]) for found in _FUNCTION.finditer(raw_text(source).blocks)}


def unknown_functions(
    numbers: Set[int], dialect: Dialect, declared: frozenset[int]
) -> tuple[int, ...]:
    """M codes that neither a dialect nor the machine's builder gives a meaning."""
    return () if dialect.codes.any_m else tuple(sorted(numbers - set(dialect.codes.m) - declared))


def _bare_number(source: Source) -> str:
    """The first number without a point of a program whose numbers without a point count whole units.

    Such a program writes its fractions with a point and its whole numbers without one. Where a whole number
    has a point somewhere (``X20.``), one without is a slip or counts increments. Where no number has a
    point, increments would put the whole program, or all its heights, within a millimetre if they are below 1000,
    and as whole units it fits a mill. Empty: it is none.
    """
    first, fractions, largest, highest = "", False, 0.0, 0.0
    blocks = raw_text(source).blocks
    if _WITH_POINT_AT_END.search(blocks):
        return ""
    for found in _LENGTH.finditer(blocks):
        number, letter = found[2], found[1].upper()
        if "." in number:
            fractions = True
        elif float(number):
            first = first or found[0]
            largest = max(largest, float(number) if letter != "F" else 0.0)
            highest = max(highest, float(number) if letter == "Z" else 0.0)
    flat = 0.0 < highest < _INCREMENTS and largest <= _LARGEST_PART
    return first if fractions or flat or 0.0 < largest < _INCREMENTS else ""


_LARGEST_PART = 2000.0
"""No larger coordinate is one of a mill [mm]."""
_INCREMENTS = 1000
"""So many least input increments are a millimetre."""
