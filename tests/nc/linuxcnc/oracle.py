"""What LinuxCNC's own interpreter makes of a program, and whether the twin makes the same.

``rs274`` prints four decimals. A copy of it with another format in the place of that one prints nine.
"""

import dataclasses
import functools
import itertools
import math
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from tests.nc.linuxcnc.decided import (
    CENTER,
    CLARITY,
    ENDLESS,
    LAST_PECK,
    LENGTH_BEFORE_CHANGE,
    NO_SLIP,
    PASSED_OVER,
    Slip,
    Slips,
    for_rs274,
    is_computed_too_early,
    is_decided_refusal,
    slips_of,
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
_PRINTED = 2e-7
"""What the distance from a centre may lose where the oracle prints nine decimals [mm]."""
_MOST_RAPIDS_OF_A_PECK = 2
_DIGITS = 5
Place = tuple[float, float, float]
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
        center: Centre of an arc at the height of its start, X, Y, Z, or nothing [mm].
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
        curves: Control points of each NURBS; of ``rs274``, which draws none of them.
    """

    moves: list[Made]
    error: str
    forgotten: list[Slip]
    curves: tuple[int, ...] = ()


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


def run_rs274(command: Sequence[str | Path], folder: Path) -> subprocess.CompletedProcess[str]:
    """Run ``rs274`` in a folder, which is its home too: two at once must not share the tool table that is mapped there."""
    return subprocess.run(
        command,
        capture_output=True,
        text=True,
        check=False,
        timeout=_LONGEST,
        errors="replace",
        cwd=folder,
        env={**os.environ, "HOME": str(folder)},
    )


def printed_by_rs274(folder: Path, *arguments: str | Path) -> str:
    """What the installed ``rs274`` prints of a program that it takes."""
    done = run_rs274([str(RS274), *arguments], folder)
    done.check_returncode()
    return done.stdout


def by_linuxcnc(text: str) -> Answer:
    """Run a program by ``rs274``."""
    folder = _folder()
    program, parameters = folder / "program.ngc", folder / "parameters.var"
    program.write_text(text)
    parameters.write_text("")
    command = [folder / "rs274", "-g", "-t", folder / "tools.tbl", "-v", parameters, program]
    try:
        done = run_rs274(command, folder)
    except subprocess.TimeoutExpired:
        return Answer([], f"rs274 runs longer than {_LONGEST} s", [])
    said = [each for each in done.stderr.splitlines() if not _CONVERSATION.match(each)]
    error = "\n".join(said[:2]) if done.returncode else ""
    if done.returncode and not error:
        error = f"rs274 ends with {done.returncode}"
    reader = _Reader()
    return Answer(reader.moves_of(done.stdout), error, reader.forgotten, tuple(reader.curves))


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
        self.forgotten: list[Slip] = []
        self.curves: list[int] = []
        self._moved_with, self._changed = NO_SLIP, False

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
            self._forget()
        elif name == "CHANGE_TOOL":
            self._changed = True
            self._forget()
        elif name in ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "STRAIGHT_PROBE"):
            kind = "rapid" if name == "STRAIGHT_TRAVERSE" else "feed"
            self._go(kind, self._place([float(each) for each in given.split(",")]))
        elif name == "NURBS_FEED":
            self.curves.append(int(given.partition(",")[0]))
        elif name == "ARC_FEED":
            self._arc([float(each) for each in given.split(",")])
        elif name == "RIGID_TAP":
            start = self.here
            # The model of rs274 stands still meanwhile.
            stands = self._moved_with, self._changed
            values = [*(float(each) for each in given.split(",")), 0.0, 0.0, 0.0]
            self._go("feed", [*self._place(values)[:3], start[3]])
            self._go("feed", start)
            self._moved_with, self._changed = stands

    def _forget(self) -> None:
        """A length that came into force between the last move and a tool change, or in its block."""
        x, y, z = (a - b for a, b in zip(self._length(), self._moved_with, strict=True))
        forgotten = (x, y, z)
        if self._changed and any(forgotten):
            self.forgotten.append(forgotten)

    def _length(self) -> Slip:
        x, y, z, _ = self.shifts["USE_TOOL_LENGTH_OFFSET"]
        return x, y, z

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

    def _programmed_here(self) -> list[float]:
        """The place of the axes as it would be printed, shape (6,)."""
        preset, system, tool = (
            self.shifts[name]
            for name in ("SET_G92_OFFSET", "SET_G5X_OFFSET", "USE_TOOL_LENGTH_OFFSET")
        )
        x, y, z, c = (a - b - d for a, b, d in zip(self.here, system, tool, strict=True))
        cosine, sine = math.cos(self.rotation), math.sin(self.rotation)
        turned = [x * cosine + y * sine, y * cosine - x * sine, z, c]
        x, y, z, c = (a - b for a, b in zip(turned, preset, strict=True))
        return [x / self.unit, y / self.unit, z / self.unit, 0.0, 0.0, c]

    def _go(self, kind: str, end: list[float]) -> None:
        self._moved_with, self._changed = self._length(), False
        if math.dist(end, self.here) > SAME:
            self.made.append(Made(kind, end, [], 0))
        self.here = end

    def _arc(self, v: list[float]) -> None:
        self._moved_with, self._changed = self._length(), False
        first, second, across = _PLANES[self.plane]
        values, center = [0.0] * 6, self._programmed_here()
        values[5] = center[5] = v[8]
        values[first], values[second], values[across] = v[0], v[1], v[5]
        center[first], center[second] = v[2], v[3]
        middle = self._place(center)
        end = self._place(values)
        self.made.append(Made("arc", end, middle[:3], int(v[4])))
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
            sweep = float(moves.sweep[row])
            turns = math.ceil(abs(sweep) / 360.0 - 1e-9)
            turns = int(math.copysign(max(turns, 1), sweep))
            made.append(Made("arc", end, moves.center[row].tolist(), turns))
        elif math.dist(end, start) > SAME:
            kind = "rapid" if moves.motion[row] == Motion.RAPID else "feed"
            made.append(Made(kind, end, [], 0))
    return made


def difference(text: str) -> str:
    """What the two say differently of a program that is not decided; empty: nothing."""
    return compared(text).said


def compared(text: str) -> Compared:
    """Run a program by both."""
    changed, decisions = for_rs274(text)
    twin = by_twin(text)
    if "error endless-program" in twin.error:
        return Compared("", frozenset({ENDLESS}))
    control = by_linuxcnc(changed)
    answers = compared_answers(twin, control)
    if decisions and _are_different(control, by_linuxcnc(text)):
        return answers._replace(decisions=answers.decisions | decisions)
    return answers


def compared_answers(twin: Answer, control: Answer) -> Compared:
    """Hold the twin's answer against that of ``rs274``."""
    if bool(twin.error) != bool(control.error):
        if is_decided_refusal(twin.error):
            return Compared("", frozenset({CLARITY}))
        if not twin.error and is_computed_too_early(control.error):
            return Compared("", frozenset({PASSED_OVER}))
        return Compared(f"twin: {twin.error or 'accepts'}\nrs274: {control.error or 'accepts'}")
    if twin.error:
        return Compared("")
    compared = _compared_moves(twin.moves, control.moves, slips_of(control.forgotten))
    if not compared.said:
        return compared
    settled = _compared_moves(_settled(twin.moves), _settled(control.moves), slips_of([]))
    if not settled.said and len(twin.moves) != len(control.moves):
        return Compared("", settled.decisions | {LAST_PECK})
    ours, theirs = _places(twin.moves), _places(control.moves)
    other_lifts = ours != theirs and _each_once(ours) == _each_once(theirs)
    if other_lifts and control.forgotten:
        return Compared("", frozenset({LENGTH_BEFORE_CHANGE}))
    return compared


def _compared_moves(twin: list[Made], control: list[Made], slips: Slips) -> Compared:
    """Hold moves against each other; those of ``rs274`` may lie beside the twin's by a slip."""
    decisions: set[str] = set()
    start = [0.0] * 4
    for number, (ours, theirs) in enumerate(zip(twin, control, strict=False)):
        slip = _slip_between(ours, theirs, slips)
        if slip is None and _center_fits(ours, theirs, start):
            slip, _ = NO_SLIP, decisions.add(CENTER)
        if slip is None:
            return Compared(f"move {number}: twin {ours}\n        rs274 {theirs}")
        if slip != NO_SLIP:
            decisions.add(LENGTH_BEFORE_CHANGE)
        start = theirs.end
    if len(twin) != len(control):
        return Compared(f"twin makes {len(twin)} moves, rs274 {len(control)}")
    return Compared("", frozenset(decisions))


def _settled(moves: list[Made]) -> list[Made]:
    """Moves without those pecks that drill nothing, since the one before ended at the bottom but for rounding."""
    kept: list[Made] = []
    for move in moves:
        drills = next((at for at in range(len(kept) - 1, -1, -1) if kept[at].kind != "rapid"), None)
        if (
            move.kind == "feed"
            and drills is not None
            and 1 <= len(kept) - 1 - drills <= _MOST_RAPIDS_OF_A_PECK
            and kept[drills].kind == "feed"
            and math.dist(kept[drills].end, move.end) <= SAME
        ):
            del kept[drills + 1 :]
        else:
            kept.append(move)
    return kept


def _places(moves: list[Made]) -> list[Place]:
    """Where the moves lead but for their heights [mm, mm, deg]."""
    found: list[Place] = []
    for move in moves:
        x, y, _, c = (round(each, _DIGITS) + 0.0 for each in move.end)
        found.append((x, y, c))
    return found


def _each_once(places: list[Place]) -> list[Place]:
    """The places without those that repeat the one before."""
    return [place for place, _ in itertools.groupby(places)]


def _center_fits(ours: Made, theirs: Made, start: list[float]) -> bool:
    """Whether an arc's centre was moved to lie as far from its start as from its end."""
    if (
        not _agree(ours._replace(center=[]), theirs._replace(center=[]), NO_SLIP)
        or ours.kind != "arc"
    ):
        return False
    for first, second, _ in _PLANES.values():
        begin, end, given, fitted = (
            (place[first], place[second])
            for place in (start, theirs.end, theirs.center, ours.center)
        )
        apart = abs(math.dist(begin, given) - math.dist(end, given)) + _PRINTED
        chord, moved = math.dist(begin, end), math.dist(given, fitted)
        fits = abs(math.dist(begin, fitted) - math.dist(end, fitted)) <= SAME
        if fits and moved * chord <= 1.01 * math.dist(end, given) * apart:
            return True
    return False


def _are_different(one: Answer, other: Answer) -> bool:
    return (one.moves, bool(one.error)) != (other.moves, bool(other.error))


def _slip_between(ours: Made, theirs: Made, slips: Slips) -> Slip | None:
    """By which slip two moves are the same; None: by none."""
    slip = [
        next((each for each in axis if abs(a + each - b) <= SAME), None)
        for a, b, axis in zip(ours.end, theirs.end, slips, strict=False)
    ]
    x, y, z = slip
    if x is None or y is None or z is None or not _agree(ours, theirs, (x, y, z)):
        return None
    return x, y, z


def _agree(ours: Made, theirs: Made, slip: Slip) -> bool:
    """Whether two moves are the same, but for a slip."""
    if ours.kind != theirs.kind or ours.turns != theirs.turns:
        return False
    ends = [a + b for a, b in zip(ours.end, (*slip, 0.0), strict=True)]
    if any(abs(a - b) > SAME for a, b in zip(ends, theirs.end, strict=True)):
        return False
    apart = zip(ours.center, theirs.center, slip, strict=False)
    return all(min(abs(a - b), abs(a + c - b), abs(a - c - b)) <= 2.0 * SAME for a, b, c in apart)
