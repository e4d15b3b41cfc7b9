"""What F counts in every kind of move, as a table of each dialect's page.

``path/feed_rates`` computes it; ``tests/golden/<dialect>/feeds`` has a program with its time for every cell.
"""

from collections.abc import Mapping
from typing import NamedTuple

KINDS: Mapping[str, str] = {
    "line": "line",
    "line with a rotary axis": "line_with_rotary",
    "rotary axes alone": "rotary",
    "arc": "arc",
    "helix": "helix",
    "arc with a rotary axis": "arc_with_rotary",
}
"""Kinds of moves, and what their programs are called."""


class FeedRow(NamedTuple):
    """What F counts in one kind of move.

    Attributes:
        rate: What F counts as a rate, per minute, second or revolution.
        inverse: What F of G93 says; empty where the control has no such feed.
    """

    kind: str
    rate: str
    inverse: str
    basis: str


_PATH = "the path in X Y Z"
_FOLLOWS = "the path in X Y Z; the rotary axis arrives with it"
_DEGREES = "degrees"


def _rows(basis: str, *cells: tuple[str, str] | tuple[str, str, str]) -> tuple[FeedRow, ...]:
    """Rows in the order of ``KINDS``: rate, inverse time, and a basis where it is another."""
    return tuple(
        FeedRow(kind, cell[0], cell[1], cell[2] if len(cell) > 2 else basis)
        for kind, cell in zip(KINDS, cells, strict=True)
    )


def _path_counts(inverse: str, basis: str, helix: str = "") -> tuple[FeedRow, ...]:
    """Of a control whose F counts X, Y and Z, the rotary axes where these rest."""
    return _rows(
        basis,
        (_PATH, inverse),
        (_FOLLOWS, inverse),
        (_DEGREES, inverse),
        (_PATH, inverse),
        ("the helix", inverse, helix or basis),
        (_FOLLOWS, inverse),
    )


_MINUTES = "1 / minutes of the move"
_RADIUS = "speed / radius of the arc, not of the distance"
_ARC_ALONE = "the arc in its plane; the path of all axes with parameter 1403 #5 (helical_feed)"
_FANUC = "operator's manual, linear interpolation"
_FANUC_ARC = "operator's manual, helical interpolation; inverse time: its note on arcs"
_DIAMETER = "the surface by setting 34 (rotary_diameter)"
_NO_DIAMETER = "manual of setting 34; without the key a degree counts 1 mm (decision)"

_TABLES: Mapping[str, tuple[FeedRow, ...]] = {
    "fanuc": _rows(
        _FANUC,
        (_PATH, _MINUTES),
        ("the root of the squares of mm and degrees (in G20: inches and degrees)", _MINUTES),
        (_DEGREES, _MINUTES),
        ("the arc", _RADIUS, _FANUC_ARC),
        (_ARC_ALONE, _RADIUS, _FANUC_ARC),
        (_ARC_ALONE, _RADIUS, _FANUC_ARC),
    ),
    "haas": _rows(
        "operator's manual, G1, G2, G93",
        (_PATH, _MINUTES),
        (f"the root of the squares of the path and {_DIAMETER}", _MINUTES, _NO_DIAMETER),
        (f"{_DIAMETER}; without the key degrees", _MINUTES, _NO_DIAMETER),
        ("the arc", _MINUTES),
        ("the helix", _MINUTES),
        (f"the root of the squares of the arc and {_DIAMETER}", _MINUTES, "decision: as in a line"),
    ),
    "linuxcnc": _path_counts(_MINUTES, "manual of G93, G94; LinuxCNC 2.9 takes these times"),
    "sinumerik": _path_counts(
        _MINUTES, "programming manual, F and G93; decision: FGROUP holds X, Y, Z"
    ),
    "fagor8070": _path_counts(
        "seconds of the move",
        "programming manual, F; parameter FEEDND No (feed_of_all_axes)",
        "decision: all three are main axes",
    ),
    "codesys": _path_counts("", "decision: additional axes go with the path"),
    "grbl": tuple(
        row
        for row in _path_counts(_MINUTES, "Grbl's documentation of G93 and G94")
        if "rotary" not in row.kind
    ),
    "gost": _path_counts("", "decision: ISO practice"),
    "mefi": _path_counts("", "decision: ISO practice; the page shows no feed"),
    "heidenhain": _path_counts(
        "", "user's manual, feed of rotary axes (M116); together with a path: decision"
    ),
}


def feed_rows(dialect: str) -> tuple[FeedRow, ...]:
    """What F counts in a dialect, a row for each kind of move; none for a dialect from outside."""
    return _TABLES.get(dialect, ())
