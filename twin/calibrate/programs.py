"""Test programs for a real machine: ten minutes in the air that show what a fit needs.

Strokes at five feeds and at rapid tell the loop, slow reversals friction, circles the reversals under
way, a square with exact stops its corners, a rapid of three axes the planner's limits, dwells the
noise and whatever pulls at rest. Every dialect gets the same motion.
"""

import dataclasses
import json
from collections.abc import Iterator
from pathlib import Path

from twin.files.atomic import write_text
from twin.machine.description.config import Machine
from twin.nc.canonical import SPATIAL_AXES

FEEDS = (500.0, 1000.0, 2000.0, 4000.0, 8000.0)
"""Of the strokes [mm/min]."""
CIRCLE_FEEDS = (1000.0, 3000.0)
_LONGEST = 200.0
"""Of a stroke [mm]."""
_SHARE = 0.25
"""Of the travel that a stroke takes at most: the machine may stand anywhere near its middle."""
_CREEP, _CREEP_FEED, _CREEPS = 1.0, 60.0, 6
_DWELL_S = 2.0
_CLEAR = 100.0
"""Lowest height over part zero: should that be set on the table, all is in the air even so [mm]."""
_MARGIN = 5.0
"""From the upper end of Z's travel [mm]."""
_JUDGED_UM = 1000.0
"""Contour tolerance of the jobs: the motion is to be measured, not judged [µm]."""
_RAPIDS = 3


@dataclasses.dataclass(frozen=True, slots=True)
class Wording:
    """What the dialects say differently.

    Attributes:
        first: Line that begins a program.
        comment: Around a comment.
        dwell: Word of the seconds behind G4.
        exact: Words that begin and end exact stops; none where every corner is left to a dwell.
        per_second: Feeds are per second, not per minute.
    """

    first: str
    comment: tuple[str, str]
    dwell: str
    exact: tuple[str, str] | None
    per_second: bool = False


WORDINGS = {
    "gost": Wording("%", ("$ ", ""), "P", ("G61", "G64")),
    "codesys": Wording("", ("(", ")"), "T", None, per_second=True),
    "fagor8070": Wording("", ("; ", ""), "K", ("G7", "G50")),
    "mefi": Wording("%", ('"', ""), "P", None),
}


def write_programs(machine: Machine, folder: Path, named: str = "") -> list[Path]:
    """Write the test programs of a machine, one in each dialect, each with its job file.

    Args:
        machine: Within whose travel they stay.
        folder: Where they go.
        named: What jobs there call the machine: a shipped one's name, its own by default, or the path of
            its file from there.

    Returns:
        The programs.
    """
    written = []
    for dialect, wording in WORDINGS.items():
        path = folder / f"calibrate_{dialect}.nc"
        write_text(path, "\n".join(_lines(machine, wording)) + "\n")
        job = [f'program = "{path.name}"', f'dialect = "{dialect}"']
        job += [f"machine = {json.dumps(named or machine.file.name)}", "", "[part_zero]"]
        job += [f"{axis} = {_zero(machine, axis):.6f}" for axis in SPATIAL_AXES]
        job += ["", "[start]", f"Z = {_CLEAR}", "", "[tolerance]", f"contour_um = {_JUDGED_UM}"]
        write_text(path.with_suffix(".toml"), "\n".join(job) + "\n")
        written.append(path)
    return written


def _lines(machine: Machine, wording: Wording) -> Iterator[str]:
    if wording.first:
        yield wording.first
    yield _comment(wording, "test motions in the air: no tool, nothing on the table")
    zero = " ".join(f"{axis}{_zero(machine, axis):g}" for axis in SPATIAL_AXES)
    yield _comment(
        wording, f"part zero at machine {zero}: the middle of X and Y, the upper end of Z"
    )
    yield "G90 G17"
    yield f"G0 Z{_CLEAR:g}"
    yield "G0 X0 Y0"
    yield from _dwell(wording)
    for axis in SPATIAL_AXES:
        yield from _strokes(machine, wording, axis)
    yield from _circles(machine, wording)
    yield from _square(machine, wording)
    yield from _rapids(machine, wording)
    yield "M30"


def _comment(wording: Wording, text: str) -> str:
    return f"{wording.comment[0]}{text}{wording.comment[1]}"


def _dwell(wording: Wording) -> Iterator[str]:
    yield f"G4 {wording.dwell}{_DWELL_S:g}"


def _feed(wording: Wording, machine: Machine, feed: float) -> str:
    slowest = min(machine.axis(name).velocity for name in SPATIAL_AXES) * 60.0
    value = min(feed, slowest)
    return f"F{value / 60.0 if wording.per_second else value:.6g}"


def _ends(machine: Machine, axis: str) -> tuple[float, float]:
    """Where the strokes of an axis turn round, program coordinates [mm]."""
    travel = machine.axis(axis).travel
    length = _LONGEST if travel is None else min(_LONGEST, _SHARE * (travel[1] - travel[0]))
    return (_CLEAR, _CLEAR + length) if axis == "Z" else (-length / 2, length / 2)


def _zero(machine: Machine, axis: str) -> float:
    """Where part zero is to be set, machine coordinates [mm]."""
    travel = machine.axis(axis).travel
    if travel is None:
        return 0.0
    if axis != "Z":
        return (travel[0] + travel[1]) / 2.0
    return travel[1] - _MARGIN - _ends(machine, axis)[1]


def _home(axis: str) -> float:
    return _CLEAR if axis == "Z" else 0.0


def _strokes(machine: Machine, wording: Wording, axis: str) -> Iterator[str]:
    low, high = _ends(machine, axis)
    yield _comment(wording, f"strokes of {axis}")
    for feed in FEEDS:
        yield f"G1 {axis}{high:g} {_feed(wording, machine, feed)}"
        yield f"G1 {axis}{low:g}"
    for _ in range(_RAPIDS):
        yield f"G0 {axis}{high:g}"
        yield f"G0 {axis}{low:g}"
    home = _home(axis)
    yield f"G0 {axis}{home:g}"
    yield from _dwell(wording)
    yield _comment(wording, f"slow reversals of {axis}")
    for _ in range(_CREEPS):
        yield f"G1 {axis}{home + _CREEP:g} {_feed(wording, machine, _CREEP_FEED)}"
        yield f"G1 {axis}{home:g}"
    yield from _dwell(wording)


def _circles(machine: Machine, wording: Wording) -> Iterator[str]:
    radius = min(_ends(machine, "X")[1], _ends(machine, "Y")[1], 50.0)
    yield _comment(wording, "circles both ways")
    yield f"G0 X{radius:g} Y0"
    for feed in CIRCLE_FEEDS:
        for word in ("G2", "G3"):
            yield f"{word} X{radius:g} Y0 I{-radius:g} J0 {_feed(wording, machine, feed)}"
            yield from _dwell(wording)


def _square(machine: Machine, wording: Wording) -> Iterator[str]:
    half = min(_ends(machine, "X")[1], _ends(machine, "Y")[1], 25.0)
    yield _comment(wording, "a square with exact stops")
    yield f"G0 X{-half:g} Y{-half:g}"
    if wording.exact:
        yield wording.exact[0]
    for x, y in ((half, -half), (half, half), (-half, half), (-half, -half)):
        yield f"G1 X{x:g} Y{y:g} {_feed(wording, machine, 2000.0)}"
        if not wording.exact:
            yield f"G4 {wording.dwell}0.2"
    if wording.exact:
        yield wording.exact[1]


def _rapids(machine: Machine, wording: Wording) -> Iterator[str]:
    ends = {axis: _ends(machine, axis) for axis in SPATIAL_AXES}
    yield _comment(wording, "rapids of three axes")
    for _ in range(_RAPIDS):
        for side in (1, 0):
            yield "G0 " + " ".join(f"{axis}{ends[axis][side]:g}" for axis in SPATIAL_AXES)
        yield from _dwell(wording)
