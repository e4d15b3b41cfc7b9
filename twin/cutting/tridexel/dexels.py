"""The tri-dexel stock: intervals of material along lines that run in X, in Y and in Z.

The lines of all three directions go through the nodes of one cubic lattice (Müller, Surmann et al.,
"Online sculpting and visualization of multi-dexel volumes", 2003; the three directions make up for
each other's steps). Where material begins and ends along a line is a float, with the surface's normal
and the tool that left it.
"""

import dataclasses
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from twin.errors import ConfigError
from twin.nc.canonical import FloatArray, IntArray

DIRECTIONS = 3
LINE_LIMIT = 30_000_000
"""Lines that a stock may have: a gigabyte."""
SPARE_INTERVALS = 1.25
"""Intervals that there is memory for at first, and how much more whenever it is full, as a factor."""
LEAST_INTERVALS = 4096

FacetArray = npt.NDArray[np.int32]


class Lattice(NamedTuple):
    """Where the lines lie.

    A line along direction d is numbered ``base[d] + v * shape[u] + u`` by the places u and v of its
    nodes along the next two directions, in the cyclic order X, Y, Z.

    Attributes:
        origin: The first node, shape (3,) [mm].
        cell: Between neighbouring nodes [mm].
        shape: Number of nodes along X, Y, Z, shape (3,).
        base: Number of the first line along X, Y, Z, shape (3,).
    """

    origin: FloatArray
    cell: float
    shape: IntArray
    base: IntArray

    @property
    def lines(self) -> int:
        """Number of lines in all three directions."""
        x, y, z = (int(count) for count in self.shape)
        return x * y + y * z + z * x

    def nodes(self, direction: int) -> FloatArray:
        """Coordinates of the nodes along a direction [mm]."""
        return self.origin[direction] + self.cell * np.arange(self.shape[direction])


class Dexels(NamedTuple):
    """The intervals of n lines, in memory for m intervals.

    Attributes:
        first: Place of each line's first interval, shape (n,).
        filled: Intervals of each line, shape (n,).
        capacity: Intervals that each line has memory for, shape (n,).
        ends: Where material begins and ends, rising along a line, shape (m, 2) [mm].
        facet: Normal and tool of the surface there (``normals``), shape (m, 2).
        used: How much of the memory is given away, shape (1,).
    """

    first: IntArray
    filled: npt.NDArray[np.int16]
    capacity: npt.NDArray[np.int16]
    ends: FloatArray
    facet: FacetArray
    used: IntArray

    def copy(self) -> "Dexels":
        """Dexels that can be cut without touching these."""
        return Dexels(
            self.first.copy(),
            self.filled.copy(),
            self.capacity.copy(),
            self.ends.copy(),
            self.facet.copy(),
            self.used.copy(),
        )

    def grown(self) -> "Dexels":
        """The same with more memory, and without gaps in it."""
        capacity = self.capacity.astype(np.int64)
        total = int(capacity.sum())
        larger = Dexels(
            np.cumsum(capacity) - capacity,
            self.filled,
            self.capacity,
            np.zeros((LEAST_INTERVALS + round(SPARE_INTERVALS * total), 2)),
            np.zeros((LEAST_INTERVALS + round(SPARE_INTERVALS * total), 2), np.int32),
            np.array([total]),
        )
        (_, source), (_, target) = self.places(), larger.places()
        larger.ends[target], larger.facet[target] = self.ends[source], self.facet[source]
        return larger

    def places(self) -> tuple[IntArray, IntArray]:
        """Line and place in memory of every interval, line by line, shapes (k,)."""
        count = self.filled.astype(np.int64)
        line = np.repeat(np.arange(len(count)), count)
        within = np.arange(len(line)) - np.repeat(np.cumsum(count) - count, count)
        return line, self.first[line] + within


@dataclasses.dataclass(slots=True)
class TriDexel:
    """Material as intervals along three directions, in the part's frame.

    Attributes:
        dexels: Their intervals. This is what cutting changes.
        corners: Two opposite corners of the box around the blank, shape (2, 3) [mm].
    """

    lattice: Lattice
    dexels: Dexels
    corners: FloatArray

    @property
    def cell(self) -> float:
        """Between neighbouring lines [mm]."""
        return self.lattice.cell

    def intervals(self) -> tuple[FloatArray, IntArray]:
        """All intervals and the direction of each, shapes (k, 2) [mm] and (k,)."""
        line, place = self.dexels.places()
        return self.dexels.ends[place], np.searchsorted(self.lattice.base, line, "right") - 1

    def copy(self) -> "TriDexel":
        """A stock that can be cut without touching this one."""
        return dataclasses.replace(self, dexels=self.dexels.copy())

    @property
    def memory(self) -> int:
        """Bytes that it takes."""
        return sum(column.nbytes for column in self.dexels)


def lattice_around(low: FloatArray, high: FloatArray, cell: float) -> Lattice:
    """The lattice of a blank, its nodes in the middles of cells.

    Args:
        low: Lowest corner of the box around the blank, shape (3,) [mm].
        high: Its highest corner.
        cell: Between neighbouring nodes [mm].

    Raises:
        ConfigError: It would have more lines than ``LINE_LIMIT``.
    """
    extent = high - low
    shape = np.maximum(1, np.rint(extent / cell)).astype(np.int64)
    x, y, z = (int(count) for count in shape)
    lines = x * y + y * z + z * x
    if lines > LINE_LIMIT:
        coarsest = cell * (lines / LINE_LIMIT) ** 0.5
        raise ConfigError(
            f"stock: a grid of {cell:g} mm has {lines} lines of material; "
            f"{coarsest:.2g} mm is the finest for this stock"
        )
    origin = 0.5 * (low + high) - 0.5 * cell * (shape - 1) + BESIDE_MM
    return Lattice(origin, cell, shape, np.array([0, y * z, y * z + z * x]))


BESIDE_MM = np.array([1.1e-5, 1.3e-5, 1.7e-5])
"""How far the lattice is off the blank's middle, so that round numbers do not go through nodes [mm]."""


def no_material(lattice: Lattice, count: npt.NDArray[np.int16]) -> Dexels:
    """Dexels with memory for some intervals on every line, all of them empty.

    Args:
        count: Intervals that each line has memory for, shape (n,).
    """
    counted = count.astype(np.int64)
    total = int(counted.sum())
    room = max(LEAST_INTERVALS, round(SPARE_INTERVALS * total))
    return Dexels(
        np.cumsum(counted) - counted,
        np.zeros(lattice.lines, np.int16),
        count.astype(np.int16),
        np.zeros((room, 2)),
        np.zeros((room, 2), np.int32),
        np.array([total]),
    )
