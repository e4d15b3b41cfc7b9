"""Where a blank ends sideways."""

import dataclasses

import numpy as np
import numpy.typing as npt

from twin.job.job_file import StockTable
from twin.nc.canonical import FloatArray

BoolArray = npt.NDArray[np.bool_]


@dataclasses.dataclass(frozen=True, slots=True)
class BlankOutline:
    """A rectangle along X and Y, or a circle, perhaps with a hole in its middle.

    Attributes:
        center: X and Y of its middle [mm].
        half: Half of its size along X and Y [mm].
        bore: Radius of the hole [mm]; 0 for none.
    """

    center: tuple[float, float]
    half: tuple[float, float]
    round: bool
    bore: float = 0.0

    @property
    def convex(self) -> bool:
        """Whether every point of it can be seen from its middle."""
        return not self.bore

    def contains(self, x: FloatArray, y: FloatArray) -> BoolArray:
        """Which points lie inside or on the edge."""
        across, along = np.abs(x - self.center[0]), np.abs(y - self.center[1])
        if self.round:
            squared = across**2 + along**2
            return (squared <= self.half[0] ** 2) & (squared >= self.bore**2)
        return (across <= self.half[0]) & (along <= self.half[1])

    def inside(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """How far points lie inside of the edge, negative outside [mm]."""
        across, along = np.abs(x - self.center[0]), np.abs(y - self.center[1])
        if not self.round:
            return np.minimum(self.half[0] - across, self.half[1] - along)
        distance = np.hypot(across, along)
        outer = self.half[0] - distance
        return np.minimum(outer, distance - self.bore) if self.bore else outer

    def inwards(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Unit vectors from the nearest edge into the material, shape (n, 2)."""
        across, along = x - self.center[0], y - self.center[1]
        if self.round:
            distance = np.maximum(np.hypot(across, along), 1e-12)
            sign = np.where(distance - self.bore < self.half[0] - distance, 1.0, -1.0)
            sign = sign if self.bore else np.full(np.shape(distance), -1.0)
            return np.column_stack([sign * across / distance, sign * along / distance])
        by_x = self.half[0] - np.abs(across) < self.half[1] - np.abs(along)
        return np.column_stack(
            [np.where(by_x, -np.sign(across), 0.0), np.where(by_x, 0.0, -np.sign(along))]
        )

    def snap(self, x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Move points that lie outside onto the edge."""
        across, along = x - self.center[0], y - self.center[1]
        if self.round:
            distance = np.maximum(np.hypot(across, along), 1e-12)
            factor = np.clip(distance, self.bore, self.half[0]) / distance
            across, along = across * factor, along * factor
        else:
            across = np.clip(across, -self.half[0], self.half[0])
            along = np.clip(along, -self.half[1], self.half[1])
        return self.center[0] + across, self.center[1] + along


def outline(stock: StockTable, center: tuple[float, float]) -> BlankOutline:
    """The outline of a blank whose top face has its middle at ``center`` [mm]."""
    width, depth, _ = stock.extent
    return BlankOutline(
        center, (0.5 * width, 0.5 * depth), stock.diameter is not None, 0.5 * (stock.bore or 0.0)
    )
