"""Canned cycles of the Fagor CNC 8070.

Z names the reference plane, I the depth: absolute with G90, from the reference plane with G91; D is
the distance from the reference plane to the surface of the part. Every block that names a point of
the plane runs the cycle there, until G80 or another motion code; with G98 the tool goes back to the
height at which the cycle was called, with G99 to the reference plane.

Decisions, since the manuals are only partly known: K is a dwell at the bottom [s]. In G83, I is the
depth of one peck and J their number. In G82, B is the first peck, R the factor of each next one, L
the least; after each the tool lifts by H, after every J of them (or where H is missing) to the
reference plane, and returns with rapid to C, 1 mm, above where it was. G84 with B taps in passes of
B that break the chip, back by H, or without it to the reference plane.
"""

import dataclasses
from collections.abc import Mapping
from typing import Any

from twin.nc.control.codes import Basis, GCode, Interpolation
from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070.cycles.pockets import call_pocket, mill_pocket
from twin.nc.dialects.fagor8070.polar import take_goal
from twin.nc.iso.drilling.drilling import Cycle, Holes, Pecking, cycle_code
from twin.nc.iso.drilling.hole import Retract

_CLEARANCE = 1.0
"""G82: C where it is missing [mm]."""


def _drilling(
    number: int,
    meaning: str,
    words: Mapping[str, str],
    basis: Basis = "decision",
    **peculiar: Any,
) -> GCode:
    """A cycle that drills, by its words besides Z and I, and what is peculiar to it: fields of ``Cycle``."""
    cycle = Cycle(
        name=f"G{number}",
        words={**words, "I": "bottom"},
        **{"across": "reference", "needed": ("bottom",), "lasting": False, **peculiar},
    )
    return cycle_code(cycle, f"{meaning}: Z I {' '.join(words)}", Holes(_hole, basis))


def _hole(control: Control) -> list[float]:
    return take_goal(control, arc=False).target


def _tapping(code: GCode) -> GCode:
    """Tapping: with B in passes, which are rigid; H is else the word of a function."""
    action = code.action
    assert action is not None

    def call(control: Control) -> None:
        passes = "B" in control.words
        options = [control.words[letter] for letter in "RJ" if letter in control.words]
        if passes and any(control.number(word) != 1.0 for word in options):
            message = "only rigid tapping, R1, goes in passes, and back with the same feed"
            control.fail("unsupported-word", f"G84: {message}")
        function = None if passes else control.take("H")
        action(control)
        if function is not None:
            control.words["H"] = function

    meaning = "tapping: Z I K R J; in passes: B H"
    return dataclasses.replace(code, meaning=meaning, action=call)


def _pocket(
    number: int, meaning: str, words: str, lengths: str, *, circular: bool = False
) -> GCode:
    """A cycle that mills, by its words besides Z and I; ``lengths`` are those that count lengths."""
    name = f"G{number}"
    mill = Interpolation(lambda control: mill_pocket(control, name, circular=circular))
    return GCode(
        meaning=f"{meaning}: Z I {' '.join(words)}",
        group="cycle",
        sets={"cycle": mill},
        action=lambda control: call_pocket(control, words, lengths),
        consumes="" if circular else "M",
        basis="manual",
    )


_DWELL = {"K": "dwell"}
_SPINDLE = {"A": (0.0,)}
"""A: what the spindle does on the return; 0 as without it."""
_RIGID = {"R": (0.0, 1.0), "J": (1.0,)}
"""R: 0 with a tapping chuck, 1 rigid: one path. J: how much faster the return is."""

CYCLES = {
    80: GCode(meaning="cycles off", group="cycle", sets={"cycle": None}, basis="manual"),
    81: _drilling(81, "drilling", _DWELL, basis="manual", options=_SPINDLE),
    82: _drilling(
        82,
        "drilling in variable pecks",
        {
            "B": "peck",
            "D": "surface",
            "R": "factor",
            "L": "least",
            "H": "lift",
            "J": "every",
            "C": "clearance",
            "K": "dwell",
        },
        needed=("bottom", "peck"),
        pecking=Pecking.TO_BOTTOM,
        clearance=_CLEARANCE,
    ),
    83: _drilling(
        83,
        "deep drilling in equal pecks",
        {"J": "count", "D": "surface", "K": "dwell"},
        needed=("bottom", "count"),
        pecking=Pecking.COUNTED,
    ),
    84: _tapping(
        _drilling(
            84,
            "tapping",
            {"B": "peck", "H": "lift", "K": "dwell"},
            pecking=Pecking.UNSIGNED_PASSES,
            retract=Retract.REVERSED,
            options=_RIGID,
        )
    ),
    85: _drilling(
        85,
        "reaming, back with the feed",
        _DWELL,
        retract=Retract.FEED,
        options=_SPINDLE,
    ),
    86: _drilling(
        86,
        "boring, back with the spindle stopped",
        _DWELL,
        retract=Retract.STOPPED,
        options=_SPINDLE,
    ),
    87: _pocket(87, "rectangular pocket", "DAJKBCLHVMQ", "DJKBCLHVQ"),
    88: _pocket(88, "circular pocket", "DJBCLHV", "DJBCLHV", circular=True),
}
