"""What LinuxCNC's own interpreter makes of a program, and whether the twin makes the same.

``rs274`` prints four decimals. A copy of it with another format in the place of that one prints nine.
"""

import dataclasses
import functools
import math
import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import NamedTuple

from tests.nc.linuxcnc.decided import (
    BREAK,
    CLARITY,
    ENDLESS,
    LENGTH_BEFORE_CHANGE,
    is_decided_refusal,
    slips_of,
    without_lasting_breaks,
)
from tests.nc.running import SETTINGS, Outcome, run
from twin.nc.canonical import Motion, Shape
from twin.nc.control.settings import ToolData

RS274 = shutil.which("rs274")
SAME = 1e-6
"""Positions that differ by less are the same [mm or deg]."""
TOOLS = {99: ToolData(0.0, 0.0), 1: ToolData(3.0, 10.0), 2: ToolData(4.0, 20.0)}
"""The first has no length, so that lengths count alike."""
ORACLE_SETTINGS = dataclasses.replace(
    SETTINGS,
    machine_zero={},
    tools=TOOLS,
    offsets={
        f"G{name}": {} for name in ("54", "55", "56", "57", "58", "59", "59.1", "59.2", "59.3")
    },
)
_INCH = 25.4
_LONGEST = 10
"""Seconds that ``rs274`` may take: an endless program prints gigabytes."""
_CALL = re.compile(r"^ *\d+ N\S* +([A-Z0-9_]+)\((.*)\)$")
_PLANES = {"XY": (0, 1, 2), "XZ": (2, 0, 1), "YZ": (1, 2, 0)}
_CONVERSATION = re.compile(r"^(?:executing|preview.*|)$")


class Made(NamedTuple):
    """A move.

    Attributes:
        kind: ``rapid``, ``feed`` or ``arc``.
        end: X, Y, Z, C in machine coordinates [mm or deg].
        center: Centre of an arc in its plane, or nothing [mm].
        turns: Turns of an arc begun, negative clockwise.
    """

    kind: str
    end: list[float]
    center: list[float]
    turns: int


class Answer(NamedTuple):
    """What an interpreter says of a program.

    Attributes:
        moves: Those that go somewhere.
        error: Why it refuses; empty: it does not.
        forgotten: Lengths that were in force when a tool was changed, and not yet when the axes moved last
            [mm]; of ``rs274``.
    """

    moves: list[Made]
    error: str
    forgotten: list[float]


class Compared(NamedTuple):
    """How two interpreters agree on a program.

    Attributes:
        said: What they say differently of it; empty: nothing, or only what was decided.
        decisions: By which decisions they differ.
    """

    said: str
    decisions: frozenset[str] = frozenset()


@functools.cache
def _folder() -> Path:
    """Where the oracle's copy and its tables lie, until this process ends."""
    made = tempfile.TemporaryDirectory(prefix="rs274-")
    _folder_kept.append(made)
    folder = Path(made.name)
    assert RS274 is not None
    copy = folder / "rs274"
    copy.write_bytes(Path(RS274).read_bytes().replace(b"%.4f", b"%.9f"))
    copy.chmod(0o755)
    table = (
        f"T{number} P{place} Z{tool.length / _INCH:.12f} D{2.0 * tool.radius / _INCH:.12f}"
        for place, (number, tool) in enumerate(TOOLS.items(), 1)
    )
    (folder / "tools.tbl").write_text("\n".join(table) + "\n")
    (folder / "linuxcnc.ini").write_text(f"[RS274NGC]\nSUBROUTINE_PATH={folder}\n")
    return folder


_folder_kept: list[tempfile.TemporaryDirectory[str]] = []


def by_linuxcnc(text: str) -> Answer:
    """Run a program by ``rs274``."""
    folder = _folder()
    program, parameters = folder / "program.ngc", folder / "parameters.var"
    program.write_text(text)
    parameters.write_text("")
    command = [folder / "rs274", "-g", "-t", folder / "tools.tbl", "-v", parameters, program]
    own_home = {**os.environ, "HOME": str(folder)}  # the tool table in use lies there
    try:
        done = subprocess.run(
            command,
            capture_output=True,
            text=True,
            check=False,
            timeout=_LONGEST,
            errors="replace",
            env=own_home,
        )
    except subprocess.TimeoutExpired:
        return Answer([], f"rs274 runs longer than {_LONGEST} s", [])
    said = [each for each in done.stderr.splitlines() if not _CONVERSATION.match(each)]
    error = said[0] if done.returncode and said else ""
    if done.returncode and not error:
        error = f"rs274 ends with {done.returncode}"
    reader = _Reader()
    return Answer(reader.moves_of(done.stdout), error, reader.forgotten)


class _Reader:
    """Follows what shifts and turns the printed coordinates."""

    def __init__(self) -> None:
        self.unit, self.plane, self.rotation = 1.0, "XY", 0.0
        self.shifts = {
            name: [0.0] * 4
            for name in ("SET_G5X_OFFSET", "SET_G92_OFFSET", "USE_TOOL_LENGTH_OFFSET")
        }
        self.here = [0.0] * 4
        self.made: list[Made] = []
        self.forgotten: list[float] = []
        self._moved_with = 0.0

    def moves_of(self, text: str) -> list[Made]:
        for line in text.splitlines():
            match = _CALL.match(line)
            if match is not None:
                self._take(match[1], match[2])
        return self.made

    def _take(self, name: str, given: str) -> None:
        if name == "SELECT_PLANE":
            self.plane = given.removeprefix("CANON_PLANE_")
        elif name == "USE_LENGTH_UNITS":
            self.unit = _INCH if given.endswith("INCHES") else 1.0
        elif name == "SET_XY_ROTATION":
            self.rotation = math.radians(float(given))
        elif name in self.shifts:
            values = [float(each) for each in given.replace(",", " ").split()]
            values = values[1:] if name == "SET_G5X_OFFSET" else values
            self.shifts[name] = self._lengths(values)
        elif name in ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "STRAIGHT_PROBE"):
            kind = "rapid" if name == "STRAIGHT_TRAVERSE" else "feed"
            self._go(kind, self._place([float(each) for each in given.split(",")]))
        elif name == "ARC_FEED":
            self._arc([float(each) for each in given.split(",")])
        elif name == "CHANGE_TOOL":
            forgotten = self.shifts["USE_TOOL_LENGTH_OFFSET"][2] - self._moved_with
            if forgotten:
                self.forgotten.append(forgotten)
        elif name == "RIGID_TAP":
            start = self.here
            values = [*(float(each) for each in given.split(",")), 0.0, 0.0, 0.0]
            self._go("feed", [*self._place(values)[:3], start[3]])
            self._go("feed", start)

    def _lengths(self, values: list[float]) -> list[float]:
        return [*(value * self.unit for value in values[:3]), values[5]]

    def _place(self, values: list[float]) -> list[float]:
        preset, system, tool = (
            self.shifts[name]
            for name in ("SET_G92_OFFSET", "SET_G5X_OFFSET", "USE_TOOL_LENGTH_OFFSET")
        )
        place = [a + b for a, b in zip(self._lengths(values), preset, strict=True)]
        cosine, sine = math.cos(self.rotation), math.sin(self.rotation)
        x, y = place[0] * cosine - place[1] * sine, place[0] * sine + place[1] * cosine
        return [a + b + c for a, b, c in zip([x, y, *place[2:]], system, tool, strict=True)]

    def _go(self, kind: str, end: list[float]) -> None:
        self._moved_with = self.shifts["USE_TOOL_LENGTH_OFFSET"][2]
        if math.dist(end, self.here) > SAME:
            self.made.append(Made(kind, end, [], 0))
        self.here = end

    def _arc(self, v: list[float]) -> None:
        self._moved_with = self.shifts["USE_TOOL_LENGTH_OFFSET"][2]
        first, second, across = _PLANES[self.plane]
        values, center = [0.0] * 6, [0.0] * 6
        values[5] = center[5] = v[8]
        values[first], values[second], values[across] = v[0], v[1], v[5]
        center[first], center[second] = v[2], v[3]
        middle = self._place(center)
        end = self._place(values)
        self.made.append(Made("arc", end, [middle[first], middle[second]], int(v[4])))
        self.here = end


def by_twin(text: str) -> Answer:
    """Run a program by the twin."""
    outcome = run(text, "linuxcnc", ORACLE_SETTINGS)
    return Answer(_moves_of(outcome), "" if outcome.error is None else str(outcome.error), [])


def _moves_of(outcome: Outcome) -> list[Made]:
    made: list[Made] = []
    moves = outcome.moves
    for row in range(len(moves)):
        end, start = moves.end[row].tolist(), moves.start[row].tolist()
        if moves.shape[row] == Shape.ARC:
            across = max(range(3), key=lambda axis: abs(moves.normal[row, axis]))
            first, second, _ = _PLANES[("YZ", "XZ", "XY")[across]]
            sweep = float(moves.sweep[row])
            turns = math.ceil(abs(sweep) / 360.0 - 1e-9)
            turns = int(math.copysign(max(turns, 1), sweep))
            center = [float(moves.center[row, axis]) for axis in (first, second)]
            made.append(Made("arc", end, center, turns))
        elif math.dist(end, start) > SAME:
            kind = "rapid" if moves.motion[row] == Motion.RAPID else "feed"
            made.append(Made(kind, end, [], 0))
    return made


def difference(text: str) -> str:
    """What the two say differently of a program that is not decided; empty: nothing."""
    return compared(text).said


def compared(text: str) -> Compared:
    """Run a program by both."""
    without = without_lasting_breaks(text)
    twin = by_twin(text)
    if "error endless-program" in twin.error:
        return Compared("", frozenset({ENDLESS}))
    control = by_linuxcnc(without)
    answers = compared_answers(twin, control)
    if without != text and _are_different(control, by_linuxcnc(text)):
        return answers._replace(decisions=answers.decisions | {BREAK})
    return answers


def compared_answers(twin: Answer, control: Answer) -> Compared:
    """Hold the twin's answer against that of ``rs274``."""
    decisions: set[str] = set()
    if bool(twin.error) != bool(control.error):
        if is_decided_refusal(twin.error):
            return Compared("", frozenset({CLARITY}))
        return Compared(f"twin: {twin.error or 'accepts'}\nrs274: {control.error or 'accepts'}")
    if twin.error:
        return Compared("")
    slips = slips_of(control.forgotten)
    for number, (ours, theirs) in enumerate(zip(twin.moves, control.moves, strict=False)):
        slip = next((each for each in slips if _agree(ours, theirs, each)), None)
        if slip is None:
            return Compared(f"move {number}: twin {ours}\n        rs274 {theirs}")
        if slip:
            decisions.add(LENGTH_BEFORE_CHANGE)
    if len(twin.moves) != len(control.moves):
        return Compared(f"twin makes {len(twin.moves)} moves, rs274 {len(control.moves)}")
    return Compared("", frozenset(decisions))


def _are_different(one: Answer, other: Answer) -> bool:
    return (one.moves, bool(one.error)) != (other.moves, bool(other.error))


def _agree(ours: Made, theirs: Made, slip: float) -> bool:
    """Whether two moves are the same, but for so much along Z."""
    if ours.kind != theirs.kind or ours.turns != theirs.turns:
        return False
    ends = [*ours.end[:2], ours.end[2] + slip, ours.end[3]]
    if any(abs(a - b) > SAME for a, b in zip(ends, theirs.end, strict=True)):
        return False
    apart = [abs(a - b) for a, b in zip(ours.center, theirs.center, strict=True)]
    return all(min(each, abs(each - abs(slip))) <= 2.0 * SAME for each in apart)
