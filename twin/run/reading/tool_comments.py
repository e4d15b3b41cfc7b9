"""What comments of a raw program say of its tools: the lists and comments of posts.

Posts write ``(T1 D=10. CR=0. - ZMIN=-5. - flat end mill)`` and its relatives.
"""

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import NamedTuple

from twin.nc.dialects.recognition import HEAD_LINES

_INCH = 25.4
_NUMBER = r"[0-9]*[.,]?[0-9]+|[0-9]+[.,]"

_COLUMNS = re.compile(
    r"^\s*([0-9]{1,4})\s{2,}(\S.*(?:MILL|DRILL|TAP|REAMER|CUTTER|BAR|CHAMFER)\b.*)", re.IGNORECASE
)
"""A row of a list in columns: number, name, diameter."""
_LISTED = (
    re.compile(r"^\s*T\s*([0-9]{1,6})\s*(?:\||-|:|=|,|\s)\s*(.*\S)", re.IGNORECASE),
    re.compile(
        r"\bTOOL\s*(?:NO\.?|NUMBER|#|-|=|:)?\s*([0-9]{1,6})\b\s*[-:=,|]*\s*(.*)", re.IGNORECASE
    ),
    re.compile(r"^\s*#\s*([0-9]{1,6})\s+(D\s*=.*\S)", re.IGNORECASE),
    re.compile(r"^\s*([0-9]{1,6})\s*=\s*(.*\b(?:MILL|DRILL|BIT|TAP)\b.*)", re.IGNORECASE),
    _COLUMNS,
)
"""Comments that begin with the tool's number."""

_KINDS: tuple[tuple[str, str], ...] = (
    (
        r"SPOT|CENT(?:ER|RE) ?DRILL|CHAMFER|COUNTERSINK|C'?SINK|\bV[- ]?(?:BIT|CARVE|TOOL)|ENGRAV|FASE",
        "chamfer",
    ),
    (r"(?<!SLOT)(?<!SLOT )DRILL|BOHRER|\bTAP\b|\bTAPPING|REAM", "drill"),
    (r"BULL|CORNER RAD|RADIUSED|TOROID", "bull"),
    (r"BALL|SPHER|\bKUGEL", "ball"),
)
"""Words of comments, and the kind of tool that they name; other tools are end mills."""

_WHAT = r"MILL|DRILL|TAP|REAMER|FRAESER|FRÄSER|BOHRER"
_DIAMETERS = (
    rf"(?<![A-Z0-9])(?:DIA(?:METER|M)?\.?|DM?(?=\s*[=:]))[\s\"]*(?:OFF\.?\s*-?\s*[0-9]+\s*(?:LEN\.?\s*-?\s*[0-9]+\s*)?(?:DIA\.?)\s*)?[-=:]?\s*({_NUMBER})\s*(MM|IN(?:CH)?\b|\")?",
    rf"[ØøΦ⌀]\s*({_NUMBER})\s*(MM|IN(?:CH)?\b|\")?",
    rf"\{{\s*({_NUMBER})\s*(MM|IN(?:CH)?)?",
    rf"({_NUMBER})\s*(MM|IN(?:CH)?\b|\")",
    rf"(?<![A-Z0-9./])({_NUMBER})()(?=\s*(?:\w+\s+){{0,2}}(?:END ?MILL|MILL|DRILL|BALL|BULL|TAP|CUTTER|REAMER|CHAMFER|FLAT|SPOT|DIA))",
    rf"(?:MILL|DRILL|TAP|REAMER|CUTTER|BAR|CHAMFER)\s{{2,}}({_NUMBER})()(?![0-9./])",
    rf"^\s*({_NUMBER})()\s*$",
    rf"^(?!.*\bH\s*[0-9]).*\bD\s*({_NUMBER})()(?![0-9.])",
)
_FRACTION = re.compile(r"(?<![0-9.])([0-9]{1,4})/([0-9]{1,4})(?![0-9])")
_GAUGE = re.compile(r"(?:#|\bNO\.?)\s*([1-9][0-9]?)\s+(?:\w+\s+)?DRILL")
_GAUGES = (
    *(228.0, 221.0, 213.0, 209.0, 205.5, 204.0, 201.0, 199.0, 196.0, 193.5),
    *(191.0, 189.0, 185.0, 182.0, 180.0, 177.0, 173.0, 169.5, 166.0, 161.0),
    *(159.0, 157.0, 154.0, 152.0, 149.5, 147.0, 144.0, 140.5, 136.0, 128.5),
    *(120.0, 116.0, 113.0, 111.0, 110.0, 106.5, 104.0, 101.5, 99.5, 98.0),
    *(96.0, 93.5, 89.0, 86.0, 82.0, 81.0, 78.5, 76.0, 73.0, 70.0),
    *(67.0, 63.5, 59.5, 55.0, 52.0, 46.5, 43.0, 42.0, 41.0, 40.0),
)
"""Diameters of number drills 1 to 60, ASME B94.11M [inch/1000]."""
_THREAD = re.compile(r"\bM([0-9]+(?:\.[0-9]+)?)(?:\s*[Xx][0-9.]+)?\s*(?:TAP|GEWINDE)")
_CORNER = re.compile(
    rf"\b(?:CR|R|RAD(?:IUS)?|CORNER RAD(?:IUS)?)\s*[=:.-]?\s*({_NUMBER})", re.IGNORECASE
)
_SIMULATED = re.compile(rf"\s*TOOL/(MILL|DRILL|CHAMFER)\s*,\s*({_NUMBER})\s*(?:,\s*({_NUMBER}))?")
"""What Carbide Create and others write for CutViewer: diameter, and of a mill its corner radius."""
_SIMULATED_LINES = 10
"""So far before its call such a comment may stand."""
_WHOLE_LENGTH = re.compile(rf"\bTL\s*=\s*({_NUMBER})")
"""What hyperMILL writes from the spindle nose to the tip."""
_RADIUS = re.compile(r"\bKR\s*[+]?([0-9]+\.[0-9]*)")
"""What the set-up sheets of Keller write of a tool's radius."""
_WEAR = re.compile(r"\bWEAR\b")
_COMPENSATION = re.compile(r"\b(?:WEAR|CONTROL|COMPUTER) COMP")
"""What posts write of how the radius is compensated: by the control, or in the program and the wear by the control."""


class ToolComment(NamedTuple):
    """What a comment says about a tool.

    Attributes:
        kind: As ``ToolTable`` has it; empty: it is not stated.
        diameter: [mm]; None: it is not stated.
        corner: Radius of a bull-nose's corner [mm].
        wear: Its contours are the path of its centre, so that D has only its wear; None: not known.
        name: By which the program calls it; empty: by its number.
        source: What says so, for people.
        length: That the program writes, into the control's table or a comment [mm]; None: it writes none.
    """

    kind: str
    diameter: float | None
    corner: float | None
    text: str
    wear: bool | None = None
    name: str = ""
    length: float | None = None
    source: str = "its comment"

    @property
    def table_radius(self) -> float | None:
        """What it has as its radius in the control's table [mm]; None: it is not known."""
        whole = None if self.diameter is None else self.diameter / 2.0
        return 0.0 if self.wear else whole


def numbered_tool(comment: str) -> tuple[int, str] | None:
    """The number of the tool that a comment lists, and what it says of it; None: it lists none."""
    for pattern in _LISTED:
        found = pattern.search(comment)
        if found is not None and found[2]:
            return int(found[1]), found[2]
    return None


def tool_of_comment(text: str, *, inches: bool) -> ToolComment:
    """What a comment says about a tool; numbers without a unit are the program's."""
    upper = text.upper()
    simulated = _SIMULATED.match(upper)
    if simulated is not None:
        return _simulated_tool(simulated, text, _INCH if inches else 1.0)
    kind = next((kind for words, kind in _KINDS if re.search(words, upper)), "")
    diameter = _diameter(upper, inches=inches)
    corner = _CORNER.search(upper)
    radius = None if corner is None else _value(corner[1]) * (_INCH if inches else 1.0)
    if diameter and radius and kind in ("", "bull") and "CR=" in upper.replace(" ", ""):
        kind = "ball" if 2.0 * radius >= diameter * 0.999 else "bull"
    if not kind and re.search(
        r"MILL|[0-9] ?MM[ _]FACE|CUTTER|FRÄSER|FRAESER|SLOT ?DRILL|FLAT|ROUTER|UPCUT|DOWNCUT|COMPRESSION",
        upper,
    ):
        kind = "flat"
    if not kind and diameter and corner and "CR=" in upper.replace(" ", ""):
        kind = "flat"
    if kind == "bull" and (not diameter or not radius or 2.0 * radius > diameter):
        kind, radius = "flat", None
    wear = bool(_WEAR.search(upper)) if _COMPENSATION.search(upper) else None
    whole = _WHOLE_LENGTH.search(upper)
    length = None if whole is None else _value(whole[1]) * (_INCH if inches else 1.0)
    return ToolComment(
        kind, diameter, radius if kind == "bull" else None, text.strip(), wear, length=length
    )


def _simulated_tool(found: re.Match[str], text: str, unit: float) -> ToolComment:
    diameter, corner = _value(found[2]) * unit, 0.0
    kind = {"DRILL": "drill", "CHAMFER": "chamfer"}.get(found[1], "flat")
    if kind == "flat" and found[3]:
        corner = _value(found[3]) * unit
        kind = "ball" if 2.0 * corner >= diameter * 0.999 else "bull" if corner else "flat"
    return ToolComment(kind, diameter, corner if kind == "bull" else None, text.strip())


def named_tools(names: Mapping[int, str], *, inches: bool) -> dict[int, ToolComment]:
    """What the names by which a program calls tools say about them, by number: ``T="MILL_D16"``, ``T="MILL_16"``."""
    return {
        number: tool_of_comment(_spaced(name), inches=inches)._replace(name=name)
        for number, name in names.items()
    }


def tool_of_call(
    name: str, line: int, comments: Sequence[tuple[int, str]], *, inches: bool
) -> ToolComment | None:
    """What the name by which a line calls a tool says about it, or a comment next to that; None: neither does."""
    own = tool_of_comment(_spaced(name), inches=inches)
    return own if own.diameter else near_comment(0, [(0, line, 0)], comments, inches=inches)


def _spaced(name: str) -> str:
    """A name as a comment would be: a number at the end of what it is, such as MILL_16, is its diameter."""
    alone = re.fullmatch(rf"([A-Z_-]*?(?:{_WHAT}))[_-]?({_NUMBER})", name, re.IGNORECASE)
    return (f"{alone[1]} D={alone[2]}" if alone else name).replace("_", " ")


def _diameter(text: str, *, inches: bool) -> float | None:
    thread = _THREAD.search(text)
    if thread is not None:
        return float(thread[1])
    gauge = _GAUGE.search(text)
    if gauge is not None and int(gauge[1]) <= len(_GAUGES):
        return round(_GAUGES[int(gauge[1]) - 1] * _INCH / 1000.0, 4)
    radius = _RADIUS.search(text)
    if radius is not None:
        return 2.0 * float(radius[1])
    fraction = _FRACTION.search(text)
    if fraction is not None and int(fraction[2]) in (2, 4, 8, 16, 32, 64):
        return int(fraction[1]) / int(fraction[2]) * _INCH
    for pattern in _DIAMETERS:
        found = re.search(pattern, text)
        if found is None:
            continue
        by_unit = bool(found[2]) and not found[2].startswith("M")
        inch = by_unit or (inches and not found[2] and _ALWAYS_MM not in text)
        diameter = _value(found[1]) * (_INCH if inch else 1.0)
        if 0.0 < diameter <= _LARGEST_DIAMETER:
            return diameter
    return None


def _value(text: str) -> float:
    return float(text.replace(",", "."))


_LARGEST_DIAMETER = 160.0
"""Numbers that would be larger diameters are none: so large are face mills [mm]."""
_ALWAYS_MM = "COMPENSATED TOOL PATH"
"""FreeCAD's comment counts millimetres whatever the program does."""
_SAYS_DIAMETER = re.compile(
    rf"{_ALWAYS_MM}. DIAMETER|\b(?:TOOL|CUTTER|BIT|MILL|DRILL)(?:\b.*\b|_)(?:DIA|DIAMETER|DIAM)\b",
    re.IGNORECASE,
)
"""Comments that speak of a tool's diameter."""
_NEAR_LINES = 3
"""So far from the call of a tool a comment may stand that describes it."""


def listed_tools(
    comments: Iterable[str], numbers: Collection[int], *, inches: bool
) -> dict[int, ToolComment]:
    """What comments that begin with a tool's number say about the tools, by number."""
    listed: dict[int, ToolComment] = {}
    for comment in comments:
        found = numbered_tool(comment)
        if found is not None and found[0] in numbers:
            tool = tool_of_comment(found[1], inches=inches)
            if tool.diameter is not None or tool.kind:
                listed.setdefault(found[0], tool)
    return listed


def near_comment(
    number: int,
    calls: list[tuple[int, int, int]],
    comments: Sequence[tuple[int, str]],
    *,
    inches: bool,
) -> ToolComment | None:
    """What a comment next to a tool's call says about it; without a list, and one tool alone, any comment of the head."""
    lines = [line for each, line, _ in calls if each == number]
    near = [
        (abs(line - call), text)
        for line, text in comments
        for call in lines
        if (
            abs(line - call) <= _NEAR_LINES
            or (0 < call - line <= _SIMULATED_LINES and _SIMULATED.match(text.upper()))
        )
        and not _lists_another(text, number)
    ]
    if not lines:
        near = [(line, text) for line, text in comments if line <= HEAD_LINES]
    for distance, text in sorted(near):
        tool = tool_of_comment(text, inches=inches)
        on_line = not distance and lines
        if (tool.diameter is not None and (tool.kind or on_line)) or (tool.kind and on_line):
            return tool
    return None


def _lists_another(text: str, number: int) -> bool:
    """Whether a comment is the row of another tool in a list."""
    row = _COLUMNS.match(text)
    return row is not None and int(row[1]) != number


def while_in_spindle(
    number: int,
    calls: list[tuple[int, int, int]],
    comments: Sequence[tuple[int, str]],
    *,
    inches: bool,
) -> ToolComment | None:
    """What the first comment says that speaks of a diameter before another tool comes; with one tool or none any one."""
    alone = len({each for each, _, _ in calls}) <= 1
    for line, text in comments:
        if not _SAYS_DIAMETER.search(text):
            continue
        before = [each for each, call, _ in calls if call <= line]
        if alone or (before and before[-1] == number):
            tool = tool_of_comment(text, inches=inches)
            if tool.diameter is not None:
                return tool
    return None
