"""Which move of the program a commanded position belongs to, and how far along it is.

LinuxCNC says with each position the program line that it works on. Where one line makes several
moves (a drilling cycle, a loop), the next one begins when the last is done.
"""

import numpy as np

from twin.nc.canonical import FloatArray, IntArray, Moves, Shape
from twin.toolpath.geometry import geometry

_FULL_TURN = 360.0
_DONE = 1.0 - 1e-4
"""Share of a move's path from which the next one of the same line begins."""
_SEEN = 0.01
"""What is shorter may begin and end within one servo period [mm or deg]."""
_NEARER = 1e-6
"""How much nearer a position must be to the next move of the same line to belong to it [mm]."""


class Places:
    """Finds the places of commanded positions, which come in order."""

    def __init__(self, moves: Moves, control_line: IntArray) -> None:
        """Take a program.

        Args:
            control_line: Line of LinuxCNC's program that each of them comes from, shape (n,).
        """
        self._moves = moves
        self._control_line = control_line
        self._move, self._fraction = -1, 0.0

    @property
    def done(self) -> bool:
        """Whether the program was driven to its end, but for a last step that no period may have seen."""
        length = self._moves.length
        seen = np.flatnonzero(length > _SEEN)
        if not len(seen) or self._move != seen[-1]:
            return not len(seen) or self._move > seen[-1]
        return bool((1.0 - self._fraction) * length[self._move] <= _SEEN)

    def find(self, line: IntArray, position: FloatArray) -> tuple[IntArray, FloatArray, IntArray]:
        """Move, fraction and source line of the next positions.

        Args:
            line: Of LinuxCNC's program, shape (n,).
            position: Commanded, part coordinates, shape (n, k) [mm or deg].

        Returns:
            Number of the move, -1 before the first, how much of its path lies behind (neither ever
            goes back), and line of the twin's program, each of shape (n,);
            without moves, LinuxCNC's own line.
        """
        number, share = np.full(len(line), self._move), np.zeros(len(line))
        changes = np.flatnonzero(np.diff(line, prepend=np.int64(-1)))
        for first, end in zip(changes, [*changes[1:], len(line)], strict=True):
            self._go_to(int(line[first]))
            self._along(position[first:end], number[first:end], share[first:end])
        if not len(self._moves):
            return number, share, line
        return number, share, np.where(number < 0, 0, self._moves.line[np.maximum(number, 0)])

    def _go_to(self, line: int) -> None:
        """Go on to the next move that comes from a line of LinuxCNC's program, if there is one."""
        here = self._move
        if here >= 0 and self._control_line[here] == line:
            return
        ahead = np.flatnonzero(self._control_line[here + 1 :] == line)
        if len(ahead):
            self._move, self._fraction = here + 1 + int(ahead[0]), 0.0

    def _along(self, position: FloatArray, number: IntArray, share: FloatArray) -> None:
        """Positions of one line: along its moves, one after the other; writes the last two."""
        while len(position) and self._move >= 0:
            move = self._move
            found = _fractions(self._moves, move, position, self._fraction)
            found = np.maximum.accumulate(np.append(self._fraction, found))[1:]
            done = len(found)
            left = self._left(position, found) if self._goes_on() else np.zeros(0, np.int64)
            if len(left):
                done = int(left[0])
            number[:done], share[:done] = move, found[:done]
            if done:
                self._fraction = float(found[done - 1])
            if len(left):
                self._move, self._fraction = move + 1, 0.0
            position, number, share = position[done:], number[done:], share[done:]

    def _left(self, position: FloatArray, share: FloatArray) -> IntArray:
        """Which positions no longer belong to the move, but to the next one of the same line."""
        both = geometry(self._moves[self._move : self._move + 2])
        following = _fractions(self._moves, self._move + 1, position, 0.0)
        row = np.zeros(len(position), np.int64)
        here = np.linalg.norm(both.position(row, share) - position, axis=1)
        there = np.linalg.norm(both.position(row + 1, following) - position, axis=1)
        done = np.append(0.0, share)[:-1] >= _DONE
        return np.flatnonzero(done | (there < here - _NEARER))

    def _goes_on(self) -> bool:
        """Whether the next move comes from the same line of LinuxCNC's program."""
        lines, following = self._control_line, self._move + 1
        return following < len(lines) and bool(lines[following] == lines[self._move])


def _fractions(moves: Moves, move: int, position: FloatArray, before: float) -> FloatArray:
    """How much of a move's path lies behind, nearest to positions, 0 to 1, shape (n,).

    Args:
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
    displacement = end - start
    spatial = displacement[:3] if np.any(displacement[:3]) else displacement
    moved = position[:, : len(spatial)] - start[: len(spatial)]
    square = float(spatial @ spatial)
    return np.clip(moved @ spatial / square, 0.0, 1.0) if square > 0.0 else np.ones(len(position))
