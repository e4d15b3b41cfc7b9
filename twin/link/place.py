"""Which move of the program a commanded position belongs to, and how far along it is.

LinuxCNC says with each position the program line that it works on.
"""

import numpy as np

from twin.nc.canonical import FloatArray, IntArray, Moves, Shape

_FULL_TURN = 360.0


class Places:
    """Finds the places of commanded positions, which come in order."""

    def __init__(self, moves: Moves, move_of_line: IntArray) -> None:
        """Take a program.

        Args:
            moves: All of it, part coordinates.
            move_of_line: Number of the move that each line of LinuxCNC's program makes.
        """
        self._moves = moves
        self._move_of_line = move_of_line
        self._move, self._fraction = -1, 0.0

    def source_line(self, line: int) -> int:
        """Line of the twin's program that a line of LinuxCNC's comes from, 0 before the first."""
        move = self._move_of_line[min(max(line, 0), len(self._move_of_line) - 1)]
        return 0 if move < 0 else int(self._moves.line[move])

    def find(self, line: IntArray, position: FloatArray) -> tuple[IntArray, FloatArray]:
        """Move and fraction of the next positions.

        Args:
            line: Of LinuxCNC's program, shape (n,).
            position: Commanded, part coordinates, shape (n, k) [mm or deg].

        Returns:
            Number of the move, -1 before the first, and how much of its path lies behind, each of
            shape (n,); neither ever goes back.
        """
        number, share = np.zeros(len(line), np.int64), np.zeros(len(line))
        last = len(self._move_of_line) - 1
        named = self._move_of_line[np.clip(line, 0, last)]
        begins = np.flatnonzero(np.diff(named, prepend=np.int64(-2)))
        for first, end in zip(begins, [*begins[1:], len(line)], strict=True):
            move = max(int(named[first]), self._move)
            if move != self._move:
                self._move, self._fraction = move, 0.0
            if move >= 0:
                found = _fractions(self._moves, move, position[first:end], self._fraction)
                found = np.maximum.accumulate(np.append(self._fraction, found))[1:]
                share[first:end] = found
                self._fraction = float(found[-1])
            number[first:end] = move
        return number, share


def _fractions(moves: Moves, move: int, position: FloatArray, before: float) -> FloatArray:
    """How much of a move's path lies behind, nearest to positions, 0 to 1, shape (n,).

    Args:
        moves: Of the program.
        move: Which of them.
        position: Part coordinates, shape (n, k) [mm or deg].
        before: How much lay behind just before: tells the turns of an arc apart.
    """
    start, end = moves.start[move], moves.end[move]
    if moves.shape[move] == Shape.ARC:
        normal, spoke = moves.normal[move], start[:3] - moves.center[move]
        arm = position[:, :3] - moves.center[move]
        angle = np.unwrap(np.arctan2(arm @ np.cross(normal, spoke), arm @ spoke))
        share = np.rad2deg(angle) / moves.sweep[move]
        turn = _FULL_TURN / abs(moves.sweep[move])
        return np.clip(share + turn * np.rint((before - share[0]) / turn), 0.0, 1.0)
    way = end - start
    spatial = way[:3] if np.any(way[:3]) else way
    moved = position[:, : len(spatial)] - start[: len(spatial)]
    square = float(spatial @ spatial)
    return np.clip(moved @ spatial / square, 0.0, 1.0) if square > 0.0 else np.ones(len(position))
