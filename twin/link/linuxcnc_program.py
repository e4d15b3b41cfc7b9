"""Canonical moves as a program that LinuxCNC reads, a line each: what its planner is given.

A program of a dialect that LinuxCNC does not speak is driven by LinuxCNC all the same: its moves, in
absolute millimetres and degrees about G54, with the corners that the dialect asks for. Tools are
changed on the twin's side alone; program stops are passed.
"""

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np

from twin.errors import UsageError
from twin.nc.canonical import Axes, Chunk, Corner, Dwell, Event, IntArray, Motion, Moves, Shape

_PLANES = {(0, 0, 1): "G17", (0, 1, 0): "G18", (1, 0, 0): "G19"}
_CENTRE_LETTERS = "IJK"
_PASSED_ON = ("M3", "M4", "M5", "M7", "M8", "M9")
_FULL_TURN = 360.0
_TURN_ROUNDING = 1e-9


class LinuxcncProgram(NamedTuple):
    """A program for LinuxCNC.

    Attributes:
        line_of_move: Line that each of the n moves is in, shape (n,).
    """

    text: str
    line_of_move: IntArray


def linuxcnc_program(
    chunks: Iterable[Chunk], axes: Axes, named: Callable[[int], str] = "line {}".format
) -> LinuxcncProgram:
    """Write canonical moves for LinuxCNC.

    Args:
        chunks: Of the program, part coordinates.
        axes: Of the machine; their names are LinuxCNC's.
        named: What a source line is called in messages.

    Raises:
        UsageError: LinuxCNC has no words for a move.
    """
    writer = _ProgramWriter(axes, named)
    for chunk in chunks:
        events = list(chunk.events)
        for row in range(len(chunk.moves)):
            while events and events[0].before <= row:
                writer.event(events.pop(0))
            writer.move(chunk.moves, row)
        for event in events:
            writer.event(event)
    return writer.finish()


class _ProgramWriter:
    def __init__(self, axes: Axes, named: Callable[[int], str]) -> None:
        self._axes, self._named = axes, named
        self._lines = ["G90 G21 G17 G94 G91.1 G40 G49 G80 G54"]
        self._line_of_move: list[int] = []
        self._plane, self._corner = "G17", ""

    def move(self, moves: Moves, row: int) -> None:
        words = []
        if (corner := _corner(moves, row)) != self._corner:
            self._line(corner)
            self._corner = corner
        if moves.shape[row] == Shape.CURVE:
            raise UsageError(
                f"{self._named(int(moves.line[row]))}: the tip of the tool is led while axes turn, which LinuxCNC "
                "has no words for: turn the axes before, or run the program with twin run"
            )
        if moves.shape[row] == Shape.ARC:
            words += self._arc(moves, row)
        else:
            words.append("G0" if moves.motion[row] == Motion.RAPID else "G1")
        words += [
            f"{name}{_number(value)}"
            for name, value in zip(self._axes.names, moves.end[row], strict=True)
        ]
        if moves.motion[row] == Motion.FEED:
            words.append(f"F{_number(moves.feed[row])}")
        self._line(" ".join(words))
        self._line_of_move.append(len(self._lines))

    def event(self, event: Event) -> None:
        if isinstance(event, Dwell):
            self._line(f"G4 P{_number(event.seconds)}")
        elif event.word == "S" or event.word in _PASSED_ON:
            word = "" if event.word == "S" else event.word
            speed = event.arguments.get("S")
            self._line(" ".join(filter(None, (word, "" if speed is None else f"S{speed:g}"))))

    def finish(self) -> LinuxcncProgram:
        self._line("M2")
        text = "\n".join(self._lines) + "\n"
        return LinuxcncProgram(text, np.array(self._line_of_move, np.int64))

    def _line(self, text: str) -> None:
        self._lines.append(text)

    def _arc(self, moves: Moves, row: int) -> list[str]:
        normal = moves.normal[row]
        x, y, z = np.abs(np.rint(normal)).astype(int)
        principal = (int(x), int(y), int(z))
        if principal not in _PLANES or np.max(np.abs(np.abs(normal) - principal)) > _TURN_ROUNDING:
            raise UsageError(
                f"{self._named(int(moves.line[row]))}: an arc in an inclined plane; LinuxCNC has arcs only "
                "in the planes XY, ZX and YZ"
            )
        if (plane := _PLANES[principal]) != self._plane:
            self._line(plane)
            self._plane = plane
        sweep = float(moves.sweep[row] * normal.sum())
        turns = max(1, math.ceil(abs(sweep) / _FULL_TURN - _TURN_ROUNDING))
        centre = moves.center[row] - moves.start[row, :3]
        words = ["G3" if sweep > 0.0 else "G2"]
        words += [
            f"{letter}{_number(value)}"
            for letter, value, across in zip(_CENTRE_LETTERS, centre, principal, strict=True)
            if not across
        ]
        return words if turns == 1 else [*words, f"P{turns}"]


def _corner(moves: Moves, row: int) -> str:
    """How LinuxCNC passes the end of a move."""
    code = moves.corner[row]
    if code == Corner.EXACT_STOP:
        return "G61.1"
    if code == Corner.EXACT_PATH:
        return "G61"
    tolerance = float(moves.corner_tolerance[row])
    return "G64 Q0" if math.isnan(tolerance) else f"G64 P{_number(tolerance)} Q0"


def _number(value: float) -> str:
    text = f"{value:.9f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text
