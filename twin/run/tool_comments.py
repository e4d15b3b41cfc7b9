"""Tools as posts write them into comments: ``(T1 D=10. CR=0. - ZMIN=-5. - flat end mill)`` and its relatives."""

import re
from typing import NamedTuple

_INCH = 25.4
_NUMBER = r"[0-9]*[.,]?[0-9]+|[0-9]+[.,]"

_LISTED = (
    re.compile(r"^\s*T\s*([0-9]+)\s*(?:\||-|:|=|,|\s)\s*(.*\S)", re.IGNORECASE),
    re.compile(r"\bTOOL\s*(?:NO\.?|NUMBER|#|-|=|:)?\s*([0-9]+)\b\s*[-:=,|]*\s*(.*)", re.IGNORECASE),
    re.compile(r"^\s*([0-9]+)\s*=\s*(.*\b(?:MILL|DRILL|BIT|TAP)\b.*)", re.IGNORECASE),
)
"""Comments that begin with the tool's number."""

_KINDS: tuple[tuple[str, str], ...] = (
    (
        r"SPOT|CENT(?:ER|RE) ?DRILL|CHAMFER|COUNTERSINK|C'?SINK|\bV[- ]?(?:BIT|CARVE|TOOL)|ENGRAV|FASE",
        "chamfer",
    ),
    (r"DRILL|BOHRER|\bTAP\b|\bTAPPING|REAM", "drill"),
    (r"BULL|CORNER RAD|RADIUSED|TOROID", "bull"),
    (r"BALL|SPHER|\bKUGEL", "ball"),
)
"""Words of comments, and the kind that they tell; other tools are end mills."""

_DIAMETERS = (
    rf"\b(?:DIA(?:METER|M)?\.?|D(?=\s*[=:]))\s*(?:OFF\.?\s*-?\s*[0-9]+\s*(?:LEN\.?\s*-?\s*[0-9]+\s*)?(?:DIA\.?)\s*)?[-=:]?\s*({_NUMBER})\s*(MM|IN(?:CH)?\b|\")?",
    rf"[ØøΦ⌀]\s*({_NUMBER})\s*(MM|IN(?:CH)?\b|\")?",
    rf"\{{\s*({_NUMBER})\s*(MM|IN(?:CH)?)?",
    rf"({_NUMBER})\s*(MM|IN(?:CH)?\b|\")",
    rf"(?<![A-Z0-9./])({_NUMBER})()(?=\s*(?:\w+\s+){{0,2}}(?:END ?MILL|MILL|DRILL|BALL|BULL|TAP|CUTTER|REAMER|CHAMFER|FLAT|SPOT|DIA))",
    rf"^\s*({_NUMBER})()\s*$",
)
_FRACTION = re.compile(r"(?<![0-9.])([0-9]+)/([0-9]+)(?![0-9])")
_THREAD = re.compile(r"\bM([0-9]+(?:\.[0-9]+)?)(?:\s*[Xx][0-9.]+)?\s*(?:TAP|GEWINDE)")
_CORNER = re.compile(
    rf"\b(?:CR|R|RAD(?:IUS)?|CORNER RAD(?:IUS)?)\s*[=:.-]?\s*({_NUMBER})", re.IGNORECASE
)
_TAPER = re.compile(r"\bTAPER\s*=\s*([0-9.]+)\s*DEG", re.IGNORECASE)


class ToolComment(NamedTuple):
    """What a comment tells of a tool.

    Attributes:
        kind: As ``ToolTable`` has it; empty: it is not told.
        diameter: [mm]; None: it is not told.
        corner: Radius of a bull-nose's corner [mm].
        text: The comment.
    """

    kind: str
    diameter: float | None
    corner: float | None
    text: str


def numbered_tool(comment: str) -> tuple[int, str] | None:
    """The number of the tool that a comment lists, and what it says of it; None: it lists none."""
    for pattern in _LISTED:
        found = pattern.search(comment)
        if found is not None and found[2]:
            return int(found[1]), found[2]
    return None


def tool_of_comment(text: str, *, inches: bool) -> ToolComment:
    """What a comment tells of a tool; numbers without a unit are the program's."""
    upper = text.upper()
    kind = next((kind for words, kind in _KINDS if re.search(words, upper)), "")
    diameter = _diameter(upper, inches=inches)
    corner = _CORNER.search(upper)
    radius = None if corner is None else _value(corner[1]) * (_INCH if inches else 1.0)
    if diameter and radius and kind in ("", "bull") and "CR=" in upper.replace(" ", ""):
        kind = "ball" if 2.0 * radius >= diameter * 0.999 else "bull"
    if not kind and re.search(r"MILL|CUTTER|FRÄSER|FLAT|ROUTER|UPCUT|DOWNCUT|COMPRESSION", upper):
        kind = "flat"
    if kind == "bull" and (not diameter or not radius or 2.0 * radius > diameter):
        kind, radius = "flat", None
    return ToolComment(kind, diameter, radius if kind == "bull" else None, text.strip())


def _diameter(text: str, *, inches: bool) -> float | None:
    thread = _THREAD.search(text)
    if thread is not None:
        return float(thread[1])
    fraction = _FRACTION.search(text)
    if fraction is not None and int(fraction[2]) in (2, 4, 8, 16, 32, 64):
        return int(fraction[1]) / int(fraction[2]) * _INCH
    for pattern in _DIAMETERS:
        found = re.search(pattern, text)
        if found is not None and 0.0 < _value(found[1]) < 500.0:
            by_unit = bool(found[2]) and not found[2].startswith("M")
            inch = by_unit or (inches and not found[2])
            return _value(found[1]) * (_INCH if inch else 1.0)
    return None


def _value(text: str) -> float:
    return float(text.replace(",", "."))
