"""Test programs for a real machine: ten minutes in the air that show what a fit needs.

Strokes at five feeds and at rapid tell the loop, slow reversals friction, circles the reversals in
motion, a square with exact stops its corners, a rapid of three axes the planner's limits, dwells the
noise and whatever pulls at rest. Rotary axes make the same strokes in degrees, with Z at its upper end. Every
dialect gets the same motion.
"""

import dataclasses
import json
from collections.abc import Iterator, Sequence
from pathlib import Path

from twin.files.atomic import write_text
from twin.machine.description.config import MachineConfig
from twin.nc.canonical import SPATIAL_AXES
from twin.units import SECONDS_PER_MINUTE

FEEDS = (500.0, 1000.0, 2000.0, 4000.0, 8000.0)
"""Of the strokes [mm/min or deg/min]."""
CIRCLE_FEEDS = (1000.0, 3000.0)
_LONGEST, _WIDEST = 200.0, 90.0
"""Of a stroke [mm], [deg]."""
_SHARE = 0.25
"""Of the travel that a stroke takes at most: the machine may stand anywhere near its middle."""
_CREEP, _CREEP_FEED, _CREEPS = 1.0, 60.0, 6
"""Slow reversals: how far [mm or deg], how fast [mm/min or deg/min], how often."""
_DWELL_S = 2.0
_CLEAR = 100.0
"""Lowest height over part zero: should that be set on the table, all is in the air even so [mm]."""
_MARGIN = 5.0
"""From the upper end of Z's travel [mm]."""
_JUDGED_UM = 1000.0
"""Contour tolerance of the jobs: the motion is to be measured, not judged [µm]."""
_RAPIDS = 3
_SQUARE_FEED = 2000.0
"""Of the square's sides [mm/min]."""
_CORNER_S = 0.2
"""Dwell at its corners where a dialect has no exact stop [s]."""


@dataclasses.dataclass(frozen=True, slots=True)
class Wording:
    """What the dialects say differently.

    Attributes:
        first: Lines that begin a program.
        comment: Around a comment.
        dwell: Word of the seconds behind G4.
        exact: Words that begin and end exact stops; none where every corner is left to a dwell.
        modal: Codes that the motions rest on.
        last: Lines behind the end of the program.
        rapid: Word of the feed of G0, where a dialect moves at F without it.
        per_second: Feeds are per second, not per minute.
        point: Every number has a decimal point: without one it would count least increments.
    """

    first: tuple[str, ...]
    comment: tuple[str, str]
    dwell: str
    exact: tuple[str, str] | None
    modal: str = "G90 G17"
    last: tuple[str, ...] = ()
    rapid: str = ""
    per_second: bool = False
    point: bool = False

    def number(self, value: float) -> str:
        """A number as the dialect wants it."""
        text = f"{value:.6g}"
        return text + "." if self.point and "." not in text else text


WORDINGS = {
    "gost": Wording(("%",), ("$ ", ""), "P", ("G61", "G64")),
    "codesys": Wording((), ("(", ")"), "T", None, rapid="FF", per_second=True),
    "fagor8070": Wording((), ("; ", ""), "K", ("G7", "G50")),
    "mefi": Wording(("%",), ('"', ""), "P", None),
    "fanuc": Wording(
        ("%", "O0019"), ("(", ")"), "X", ("G61", "G64"), "G90 G94 G17 G21", ("%",), point=True
    ),
    "haas": Wording(
        ("%", "O00019"), ("(", ")"), "P", ("G61", "G64"), "G90 G94 G17 G21", ("%",), point=True
    ),
    "linuxcnc": Wording((), ("(", ")"), "P", ("G61.1", "G64"), "G90 G94 G17 G21 G64"),
}


def write_programs(machine: MachineConfig, folder: Path, named: str = "") -> list[Path]:
    """Write the test programs of a machine, one in each dialect, each with its job file.

    Args:
        named: What jobs there call the machine: a shipped one's name, its own by default, or the path of
            its file from there.
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


def _lines(machine: MachineConfig, wording: Wording) -> Iterator[str]:
    yield from wording.first
    yield _comment(wording, "test motions in the air: no tool, nothing on the table")
    zero = " ".join(f"{axis}{_zero(machine, axis):g}" for axis in SPATIAL_AXES)
    yield _comment(
        wording, f"part zero at machine {zero}: the middle of X and Y, the upper end of Z"
    )
    yield wording.modal
    if wording.rapid:
        fastest = max(machine.axis(name).velocity for name in SPATIAL_AXES)
        yield _line(wording, "G0", **{wording.rapid: fastest})
    yield _line(wording, "G0", Z=_CLEAR)
    yield _line(wording, "G0", X=0.0, Y=0.0)
    yield _dwell(wording)
    for axis in SPATIAL_AXES:
        yield from _strokes(machine, wording, axis)
    yield from _turns(machine, wording)
    yield from _circles(machine, wording)
    yield from _square(machine, wording)
    yield from _rapids(machine, wording)
    yield "M30"
    yield from wording.last


def _comment(wording: Wording, text: str) -> str:
    return f"{wording.comment[0]}{text.upper()}{wording.comment[1]}"


def _line(wording: Wording, code: str, **words: float) -> str:
    return " ".join([code, *(f"{word}{wording.number(value)}" for word, value in words.items())])


def _dwell(wording: Wording, seconds: float = _DWELL_S) -> str:
    return _line(wording, "G4", **{wording.dwell: seconds})


def _feed(
    wording: Wording, machine: MachineConfig, feed: float, axes: Sequence[str] = SPATIAL_AXES
) -> float:
    slowest = min(machine.axis(name).velocity for name in axes) * SECONDS_PER_MINUTE
    value = min(feed, slowest)
    return value / SECONDS_PER_MINUTE if wording.per_second else value


def _ends(machine: MachineConfig, axis: str) -> tuple[float, float]:
    """Where the strokes of an axis turn round, program coordinates [mm or deg]."""
    travel = machine.axis(axis).travel
    if axis not in SPATIAL_AXES:
        return _turned(travel)
    length = _LONGEST if travel is None else min(_LONGEST, _SHARE * (travel[1] - travel[0]))
    return (_CLEAR, _CLEAR + length) if axis == "Z" else (-length / 2, length / 2)


def _turned(travel: tuple[float, float] | None) -> tuple[float, float]:
    """The same of a rotary axis: about the middle of its travel, on from 0 where it turns without an end [deg]."""
    if travel is None:
        return 0.0, _WIDEST
    middle, half = (
        (travel[0] + travel[1]) / 2.0,
        min(_WIDEST, _SHARE * (travel[1] - travel[0])) / 2.0,
    )
    return middle - half, middle + half


def _zero(machine: MachineConfig, axis: str) -> float:
    """Where part zero is to be set, machine coordinates [mm]."""
    travel = machine.axis(axis).travel
    if travel is None:
        return 0.0
    if axis != "Z":
        return (travel[0] + travel[1]) / 2.0
    return travel[1] - _MARGIN - _ends(machine, axis)[1]


def _home(axis: str) -> float:
    return _CLEAR if axis == "Z" else 0.0


def _strokes(machine: MachineConfig, wording: Wording, axis: str) -> Iterator[str]:
    low, high = _ends(machine, axis)
    axes = SPATIAL_AXES if axis in SPATIAL_AXES else axis
    yield _comment(wording, f"strokes of {axis}")
    for feed in FEEDS:
        yield _line(wording, "G1", **{axis: high}, F=_feed(wording, machine, feed, axes))
        yield _line(wording, "G1", **{axis: low})
    for _ in range(_RAPIDS):
        yield _line(wording, "G0", **{axis: high})
        yield _line(wording, "G0", **{axis: low})
    home = _home(axis)
    yield _line(wording, "G0", **{axis: home})
    yield _dwell(wording)
    yield _comment(wording, f"slow reversals of {axis}")
    for _ in range(_CREEPS):
        creep = _feed(wording, machine, _CREEP_FEED, axes)
        yield _line(wording, "G1", **{axis: home + _CREEP}, F=creep)
        yield _line(wording, "G1", **{axis: home})
    yield _dwell(wording)


def _turns(machine: MachineConfig, wording: Wording) -> Iterator[str]:
    """Strokes of the rotary axes, one after the other."""
    rotary = [name for name in machine.axes.names if name not in SPATIAL_AXES]
    if rotary:
        yield _line(wording, "G0", Z=_ends(machine, "Z")[1])
    for axis in rotary:
        yield from _strokes(machine, wording, axis)
    if rotary:
        yield _line(wording, "G0", Z=_CLEAR)


def _circles(machine: MachineConfig, wording: Wording) -> Iterator[str]:
    radius = min(_ends(machine, "X")[1], _ends(machine, "Y")[1], 50.0)
    yield _comment(wording, "circles in both directions")
    yield _line(wording, "G0", X=radius, Y=0.0)
    for feed in CIRCLE_FEEDS:
        for code in ("G2", "G3"):
            speed = _feed(wording, machine, feed)
            yield _line(wording, code, X=radius, Y=0.0, I=-radius, J=0.0, F=speed)
            yield _dwell(wording)


def _square(machine: MachineConfig, wording: Wording) -> Iterator[str]:
    half = min(_ends(machine, "X")[1], _ends(machine, "Y")[1], 25.0)
    yield _comment(wording, "a square with exact stops")
    yield _line(wording, "G0", X=-half, Y=-half)
    if wording.exact:
        yield wording.exact[0]
    for x, y in ((half, -half), (half, half), (-half, half), (-half, -half)):
        yield _line(wording, "G1", X=x, Y=y, F=_feed(wording, machine, _SQUARE_FEED))
        if not wording.exact:
            yield _dwell(wording, _CORNER_S)
    if wording.exact:
        yield wording.exact[1]


def _rapids(machine: MachineConfig, wording: Wording) -> Iterator[str]:
    ends = {axis: _ends(machine, axis) for axis in SPATIAL_AXES}
    yield _comment(wording, "rapids of three axes")
    for _ in range(_RAPIDS):
        for side in (1, 0):
            yield _line(wording, "G0", **{axis: ends[axis][side] for axis in SPATIAL_AXES})
        yield _dwell(wording)
