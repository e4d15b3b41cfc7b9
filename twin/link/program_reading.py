"""A program of LinuxCNC's own language, read by LinuxCNC's own interpreter, ``rs274``.

``rs274`` runs loops, calls and expressions and prints the canonical calls that come of them. They
are written down as a program without any of it, in a dialect of the twin: what the run is judged by.
Where the program allows it, each line keeps its number; the N words are LinuxCNC's lines always.
"""

import itertools
import re
import shutil
import signal
import subprocess
import tempfile
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple, TextIO

import numpy as np

from twin.errors import ExitCode, TwinError, UsageError
from twin.job.job_file import JobFile
from twin.link.configuration import LETTERS, offsets_text, tools_text
from twin.nc.canonical import Axes, FloatArray
from twin.nc.text.diagnostics.diagnostics import Diagnostic

DIALECT = "gost"
"""The dialect in which the program is written down: plain ISO codes, arcs by their centre."""
_INCH_MM = 25.4
_READER = "rs274"
_TIMEOUT_S = 300.0
_MOST_CALLS = 2_000_000
"""A program that makes more has no end."""
_LONGEST_REFUSAL = 10_000
_CALL = re.compile(r"\s*\d+ N([0-9]+|\.+)\s+([A-Z0-9_]+)\((.*)\)\s*$")
_OWN_NUMBER = re.compile(r"^(\s*/?\s*)(?:[Nn]\s*[0-9.]+)?(?=\s*\S)")
_N_WORD = re.compile(r"\s*/?\s*N([0-9]+)")
_NOT_NUMBERED = re.compile(r"^\s*(?:%|\(|;|$)")
_NUMBER = re.compile(r"[-+]?[0-9.]+")
_PLANES = {"CANON_PLANE_XY": "G17", "CANON_PLANE_XZ": "G18", "CANON_PLANE_YZ": "G19"}
_IN_PLANE = {"G17": (0, 1, 2), "G18": (2, 0, 1), "G19": (1, 2, 0)}
"""Columns of a plane's first and second axis, and of the third."""
_SPINDLE = {"START_SPINDLE_CLOCKWISE": "M3", "START_SPINDLE_COUNTERCLOCKWISE": "M4"}
_REFUSED = ("PROBE", "TAP", "NURBS", "SYNCH")
"""Parts of the names of calls that the twin does not support: probing, tapping, threads."""
_READ_BY_THE_TWIN = "--dialect linuxcnc: the twin reads the program, and LinuxCNC drives its moves"
_FULL_TURN = 2.0 * np.pi
_PRINTED = 1e-4
"""To what a length is printed, in the program's unit: two that differ by no more are one."""


class LinuxcncProgramError(TwinError):
    """LinuxCNC's interpreter refuses the program."""

    exit_code = ExitCode.PROGRAM


class Listing(NamedTuple):
    """A program of LinuxCNC's own language, as it was when it was read."""

    path: Path
    text: str

    def error(self, line: int, message: str, hint: str | None = None) -> LinuxcncProgramError:
        """What is wrong in a line, counted from 1."""
        lines = self.text.splitlines()
        text = lines[line - 1] if 0 < line <= len(lines) else ""
        stripped = len(text) - len(text.lstrip())
        diagnostic = Diagnostic(
            severity="error", code="linuxcnc", message=message, file=str(self.path), line=line,
            column=stripped + 1, width=max(len(text.strip()), 1), source=text, hint=hint,
        )  # fmt: skip
        return LinuxcncProgramError(str(diagnostic))


def listing_of(program: Path) -> Listing:
    """Read the text of a program, whatever its bytes."""
    return Listing(program, program.read_text(encoding="utf-8", errors="replace"))


def read_program(
    listing: Listing, axes: Axes, start: FloatArray, part_zero: FloatArray, job: JobFile
) -> str:
    """Let LinuxCNC's interpreter read a program, and write it down.

    Args:
        start: Where the axes stand, machine coordinates, shape (k,) [mm or deg].
        part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].

    Returns:
        The program in the dialect ``DIALECT``; its N words are the lines of LinuxCNC's program.

    Raises:
        LinuxcncProgramError: The program is wrong, does not come to its end, or does what the twin has nothing for.
        UsageError: ``rs274`` is not installed.
    """
    found = shutil.which(_READER)
    if found is None:
        raise UsageError(f"{_READER} is missing: it comes with LinuxCNC")
    writer = _CanonicalWriter(axes, part_zero, listing)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        # By itself rs274 takes the lengths of its files for inches.
        inches = np.where(axes.rotary(), part_zero, part_zero / _INCH_MM)
        (folder / "offsets.var").write_text(offsets_text(axes, inches), encoding="utf-8")
        (folder / "tools.tbl").write_text(tools_text(job, _INCH_MM), encoding="utf-8")
        there = " ".join(f"{name}{value:.6f}" for name, value in axes.named(start).items())
        numbered = [f"G21 G53 G0 {there}", *_numbered(listing.text.splitlines())]
        if numbered[-1].strip() == "%":
            numbered.insert(0, "%")
        (folder / "program.ngc").write_text("\n".join(numbered) + "\n", encoding="utf-8")
        command = [
            found, "-g", "-t", str(folder / "tools.tbl"),
            "-v", str(folder / "offsets.var"), str(folder / "program.ngc"),
        ]  # fmt: skip
        with (folder / "refusal").open("w+", encoding="utf-8", errors="replace") as refusal:
            code = _run(command, listing.path.resolve().parent, refusal, writer)
            refusal.seek(0)
            if code == -signal.SIGKILL:
                raise listing.error(writer.line, f"{_READER} does not come to its end")
            if code:
                raise _refused(listing, refusal.read(_LONGEST_REFUSAL))
    return writer.finish()


def _run(command: Sequence[str], folder: Path, refusal: TextIO, writer: "_CanonicalWriter") -> int:
    """Hand what the interpreter prints to the writer; returns its code, of a process killed where it never ends."""
    with subprocess.Popen(  # noqa: S603 - the program is the user's own
        command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=refusal,
        text=True, errors="replace",
    ) as reader:  # fmt: skip
        late = threading.Timer(_TIMEOUT_S, reader.kill)
        late.start()
        try:
            for text in itertools.islice(reader.stdout or (), _MOST_CALLS):
                if call := _CALL.match(text):
                    writer.take(int(call[1]) if call[1].isdigit() else None, call[2], call[3])
            if reader.stdout is not None and reader.stdout.readline():
                reader.kill()
            return reader.wait()
        finally:
            late.cancel()
            reader.kill()


def _numbered(lines: Sequence[str]) -> list[str]:
    """The program with its lines' numbers as N words, which ``rs274`` repeats with each call.

    What is before and behind a pair of ``%`` is no program; the second one ends it.
    """
    marks = [number for number, line in enumerate(lines) if line.strip() == "%"]
    first = marks[0] + 1 if marks else 0
    last = marks[1] + 1 if len(marks) > 1 else len(lines)
    return [
        line if _NOT_NUMBERED.match(line) else _OWN_NUMBER.sub(rf"\g<1>N{number} ", line, count=1)
        for number, line in enumerate(lines[first:last], first + 1)
    ]


def _refused(listing: Listing, output: str) -> LinuxcncProgramError:
    said = [line for line in output.splitlines() if line.strip() and line.strip() != "executing"]
    message = said[0] if said else "it does not say why"
    number = next((int(found[1]) for line in said[1:] if (found := _N_WORD.match(line))), 1)
    return listing.error(number, message)


class _CanonicalWriter:
    """Follows canonical calls and writes what moves, and what else the twin needs to know."""

    def __init__(self, axes: Axes, part_zero: FloatArray, listing: Listing) -> None:
        self._axes, self._listing = axes, listing
        self._columns = [LETTERS.index(name) for name in axes.names]
        self._zero = part_zero
        self._lines: list[str] = []
        self.line = 0
        self._unit = 1.0
        self._offsets = {"g5x": np.zeros(9), "g92": np.zeros(9), "tool": np.zeros(9)}
        self._turn = np.eye(2)
        self._plane, self._feed, self._speed = "G17", 0.0, 0.0
        self._feed_mode, self._turns = "G94", False
        self._at = np.zeros(len(axes))
        self._begun = False

    def take(self, line: int | None, call: str, arguments: str) -> None:
        self.line = line or self.line
        if any(part in call for part in _REFUSED):
            message = f"the twin has nothing for LinuxCNC's {call}"
            raise self._listing.error(self.line, message, _READ_BY_THE_TWIN)
        values = (
            [float(text) for text in _NUMBER.findall(arguments)] if call in _WITH_NUMBERS else []
        )
        action = _ACTIONS.get(call)
        if action is not None:
            action(self, call, arguments, values)

    def finish(self) -> str:
        return "\n".join([*self._lines, "M30"]) + "\n"

    def unit(self, _call: str, arguments: str, _values: list[float]) -> None:
        self._unit = _INCH_MM if "INCHES" in arguments else 1.0

    def offset(self, call: str, _arguments: str, values: list[float]) -> None:
        kind = {"SET_G5X_OFFSET": "g5x", "SET_G92_OFFSET": "g92"}.get(call, "tool")
        given = values[1:] if kind == "g5x" else values
        row = np.zeros(9)
        row[: len(given)] = given[:9]
        self._offsets[kind] = self._in_mm(row)

    def rotation(self, _call: str, _arguments: str, values: list[float]) -> None:
        angle = np.deg2rad(values[0])
        self._turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])

    def plane(self, _call: str, arguments: str, _values: list[float]) -> None:
        self._plane = _PLANES[arguments.strip()]

    def feed(self, _call: str, _arguments: str, values: list[float]) -> None:
        self._feed = values[0]

    def feed_mode(self, _call: str, _arguments: str, values: list[float]) -> None:
        self._feed_mode = "G95" if values[-1] else "G94"

    def speed(self, _call: str, _arguments: str, values: list[float]) -> None:
        self._speed = values[-1]
        if self._turns:
            self._write(f"S{_number(self._speed)}")

    def spindle(self, call: str, _arguments: str, _values: list[float]) -> None:
        self._turns = True
        self._write(f"{_SPINDLE[call]} S{_number(self._speed)}")

    def spindle_stop(self, _call: str, _arguments: str, _values: list[float]) -> None:
        self._turns = False
        if self._begun:
            self._write("M5")

    def tool(self, _call: str, _arguments: str, values: list[float]) -> None:
        self._write(f"T{int(values[0])} M6")

    def dwell(self, _call: str, _arguments: str, values: list[float]) -> None:
        self._write(f"G4 P{_number(values[0])}")

    def straight(self, call: str, _arguments: str, values: list[float]) -> None:
        end = self._part(np.array([*values, *[0.0] * 9][:9]))
        if not self._begun:
            # The move to where the axes are.
            self._begun, self._at = True, end
            return
        if call == "STRAIGHT_TRAVERSE":
            self._move("G0", end)
        else:
            self._move("G1", end, feed=True)

    def arc(self, _call: str, _arguments: str, values: list[float]) -> None:
        first_end, second_end, first, second, turns, third_end, *further = values
        one, two, three = _IN_PLANE[self._plane]
        end, centre = np.zeros(9), np.zeros(9)
        end[[one, two, three]] = first_end, second_end, third_end
        end[3 : 3 + len(further)] = further
        centre[[one, two, three]] = first, second, third_end
        if self._plane != "G17" and not np.array_equal(self._turn, np.eye(2)):
            raise self._listing.error(self.line, "an arc in an inclined plane", _READ_BY_THE_TWIN)
        self._arc(self._part(end), self._part(centre)[:3], turns)

    def _arc(self, end: FloatArray, centre: FloatArray, turns: float) -> None:
        """Write an arc, each further turn as a full circle of its own: the dialect has no turns."""
        one, two, _ = _IN_PLANE[self._plane]
        start = self._at
        sense = np.sign(turns)
        angles = [
            np.arctan2(at[two] - centre[two], at[one] - centre[one]) for at in (start[:3], end[:3])
        ]
        rest = (sense * (angles[1] - angles[0])) % _FULL_TURN
        if rest < _CLOSED or rest > _FULL_TURN - _CLOSED:
            rest = _FULL_TURN
        whole = rest + (abs(turns) - 1.0) * _FULL_TURN
        for number in range(1, round(abs(turns)) + 1):
            goal = end
            if number < round(abs(turns)):
                goal = start + (end - start) * (number * _FULL_TURN / whole)
                goal[[one, two]] = start[[one, two]]
            words = [self._plane, "G3" if sense > 0.0 else "G2"]
            words += [
                f"{'IJK'[axis]}{_number(centre[axis] - self._at[axis])}"
                for axis in sorted((one, two))
            ]
            self._move(" ".join(words), goal, feed=True)

    def _move(self, words: str, end: FloatArray, *, feed: bool = False) -> None:
        target = " ".join(
            f"{name}{_number(value)}" for name, value in zip(self._axes.names, end, strict=True)
        )
        rate = (
            f" {self._feed_mode} F{_number(self._rate(end))}" if feed and self._feed > 0.0 else ""
        )
        self._write(f"{words} {target}{rate}")
        self._at = end

    def _rate(self, end: FloatArray) -> float:
        """F towards an end; degrees are converted as lengths where they count per revolution."""
        moved = np.abs(end - self._at)[~self._axes.rotary()]
        linear = np.any(moved > _PRINTED * self._unit)
        return self._feed * (self._unit if linear or self._feed_mode == "G95" else 1.0)

    def _write(self, text: str) -> None:
        self._lines += [""] * (self.line - 1 - len(self._lines))
        self._lines.append(f"N{self.line} {text}")

    def _in_mm(self, values: FloatArray) -> FloatArray:
        scale = np.array([self._unit] * 3 + [1.0] * 3 + [self._unit] * 3)
        return values * scale

    def _part(self, values: FloatArray) -> FloatArray:
        """Part coordinates of a position in LinuxCNC's program."""
        at = self._in_mm(values) + self._offsets["g92"]
        at[:2] = self._turn @ at[:2]
        machine = at + self._offsets["g5x"] + self._offsets["tool"]
        return np.round(machine[self._columns] - self._zero, 6)


_CLOSED = 1e-7
"""Angle below which an arc ends where it starts [rad]."""
_ACTIONS = {
    "USE_LENGTH_UNITS": _CanonicalWriter.unit,
    "SET_G5X_OFFSET": _CanonicalWriter.offset,
    "SET_G92_OFFSET": _CanonicalWriter.offset,
    "USE_TOOL_LENGTH_OFFSET": _CanonicalWriter.offset,
    "SET_XY_ROTATION": _CanonicalWriter.rotation,
    "SELECT_PLANE": _CanonicalWriter.plane,
    "SET_FEED_RATE": _CanonicalWriter.feed,
    "SET_FEED_MODE": _CanonicalWriter.feed_mode,
    "SET_SPINDLE_SPEED": _CanonicalWriter.speed,
    "START_SPINDLE_CLOCKWISE": _CanonicalWriter.spindle,
    "START_SPINDLE_COUNTERCLOCKWISE": _CanonicalWriter.spindle,
    "STOP_SPINDLE_TURNING": _CanonicalWriter.spindle_stop,
    "CHANGE_TOOL": _CanonicalWriter.tool,
    "DWELL": _CanonicalWriter.dwell,
    "STRAIGHT_TRAVERSE": _CanonicalWriter.straight,
    "STRAIGHT_FEED": _CanonicalWriter.straight,
    "ARC_FEED": _CanonicalWriter.arc,
}
"""What is done at each canonical call; the others mean nothing to the twin."""
_WITH_NUMBERS = frozenset(_ACTIONS) - {"USE_LENGTH_UNITS", "SELECT_PLANE"}


def _number(value: float) -> str:
    text = f"{value:.6f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text
