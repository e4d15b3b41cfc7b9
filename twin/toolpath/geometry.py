"""The exact geometry of canonical moves by path fraction.

Every move, line or arc or helix, with any further axes in step, has the one form

    q(u) = base + cosine cos(angle u) + sine sin(angle u) + drift u + bend_2 u² + ... + bend_5 u⁵

with u from 0 to 1, where ``cosine`` and ``sine`` span the plane of an arc and vanish for a line, and
``bend`` is a curve's alone. Its derivatives of any order follow from it.
"""

import dataclasses

import numpy as np

from twin.columns import Columns
from twin.nc.canonical import FloatArray, IntArray, Moves, Shape
from twin.toolpath.geometry_kernels import Curves, evaluate


@dataclasses.dataclass(frozen=True, slots=True)
class Geometry(Columns):
    """The geometry of n moves over k axes, as columns, in the coordinates of the moves.

    An arc whose end misses the circle by rounding is closed on its end: the miss is spread evenly
    over the path, so that consecutive moves join without a gap.

    Attributes:
        base: Shape (n, k) [mm or deg].
        drift: Travel that goes evenly with the path, shape (n, k) [mm or deg].
        bend: Of curves, coefficients by powers 2 to 5 of u, 0 for other shapes, shape (n, k, 4) [mm or deg].
        cosine: From the centre of an arc to its start, shape (n, 3) [mm].
        sine: ``cosine`` a quarter turn counter-clockwise about the normal, shape (n, 3) [mm].
        angle: Signed sweep, shape (n,) [rad].
        end: Position at u = 1 as the move states it, shape (n, k) [mm or deg].
    """

    base: FloatArray
    drift: FloatArray
    bend: FloatArray
    cosine: FloatArray
    sine: FloatArray
    angle: FloatArray
    end: FloatArray

    def curves(self) -> Curves:
        """The columns, for compiled code."""
        return Curves(
            self.base, self.drift, self.bend, self.cosine, self.sine, self.angle, self.end
        )

    def position(self, move: IntArray, fraction: FloatArray) -> FloatArray:
        """Where the axes are.

        Args:
            move: Row of the geometry, shape (m,).
            fraction: Path fraction u of it, 0 to 1, shape (m,).

        Returns:
            Shape (m, k) [mm or deg].
        """
        return self._evaluate(move, fraction, 0)

    def derivative(self, move: IntArray, fraction: FloatArray, order: int) -> FloatArray:
        """How the axes go with the path fraction.

        Args:
            move: Row of the geometry, shape (m,).
            fraction: Path fraction u, 0 to 1, shape (m,).
            order: 1, 2 or 3.

        Returns:
            d^order q / du^order, shape (m, k) [mm or deg].
        """
        return self._evaluate(move, fraction, order)

    def curvature(self, move: IntArray, fraction: FloatArray) -> FloatArray:
        """Curvature of the path of X Y Z: ``|q' x q''| / |q'|^3``, 0 where it stands still.

        Args:
            move: Row of the geometry, shape (m,).
            fraction: Path fraction u, 0 to 1, shape (m,).

        Returns:
            Shape (m,) [1/mm].
        """
        first = self.derivative(move, fraction, 1)[:, :3]
        second = self.derivative(move, fraction, 2)[:, :3]
        speed = np.linalg.norm(first, axis=1)
        bend = np.linalg.norm(np.cross(first, second), axis=1)
        return np.divide(bend, speed**3, out=np.zeros_like(bend), where=speed > 0.0)

    def _evaluate(self, move: IntArray, fraction: FloatArray, order: int) -> FloatArray:
        out = np.zeros((len(move), self.base.shape[1]))
        evaluate(self.curves(), move, fraction, order, out)
        return out


def geometry(moves: Moves) -> Geometry:
    """Bring canonical moves into their common form (formula in ``twin.nc.canonical``)."""
    count = len(moves)
    base, drift = moves.start, moves.end - moves.start
    angle, cosine, sine = np.zeros(count), np.zeros((count, 3)), np.zeros((count, 3))
    arc = np.flatnonzero(moves.shape == Shape.ARC)
    if len(arc) > 0:
        turn, normal = np.deg2rad(moves.sweep[arc]), moves.normal[arc]
        spoke = moves.start[arc, :3] - moves.center[arc]
        along = spoke - normal * np.sum(normal * spoke, axis=1, keepdims=True)
        across = np.cross(normal, along)
        angle[arc], cosine[arc], sine[arc] = turn, along, across
        base = base.copy()
        base[arc, :3] -= along
        drift[arc, :3] = moves.end[arc, :3] - base[arc, :3]
        drift[arc, :3] -= along * np.cos(turn)[:, None] + across * np.sin(turn)[:, None]
    bend = np.zeros((*drift.shape, 4))
    if moves.curve is not None:
        curved = moves.shape == Shape.CURVE
        bend = moves.curve[:, :, 1:].copy()
        drift = np.where(curved[:, None], moves.curve[:, :, 0], drift)
    return Geometry(base, drift, bend, cosine, sine, angle, moves.end)
