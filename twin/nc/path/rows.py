"""Moves as rows of columns, and the room that a run of either tier writes them to."""

import math
from typing import NamedTuple, TypeVar

import numpy as np

from twin.compilation.compilable import compilable_as
from twin.nc.canonical import Corner, FloatArray, IntArray, Motion
from twin.nc.path.move_columns import Segment

Column = TypeVar("Column", FloatArray, IntArray)


class Row(NamedTuple):
    """One move, as in ``Rows``.

    Attributes:
        codes: Motion, shape, line, block and corner, shape (5,).
        values: Centre, normal, sweep, feed, corner tolerance, acceleration and deceleration,
            shape (11,).
        positions: Start, end and display, shape (3, k).
    """

    codes: IntArray
    values: FloatArray
    positions: FloatArray

    def put(self, move: Segment) -> None:
        """Become a move."""
        self.codes[:], self.values[:] = move.codes, move.values
        self.positions[:] = (move.start, move.end, move.display)

    @property
    def segment(self) -> Segment:
        """The move."""
        motion, _, line, block, corner = self.codes.tolist()
        a, b, c, i, j, k, *others = self.values.tolist()
        sweep, feed, tolerance, acceleration, deceleration = others
        center = None if math.isnan(a) else (a, b, c)
        start, end, display = self.positions.tolist()
        begun = (Motion(motion), line, block, start, end, display, feed, Corner(corner))
        return Segment(*begun, tolerance, acceleration, deceleration, center, (i, j, k), sweep)


class Rows(NamedTuple):
    """Room for the moves of a run, as ``MoveColumns`` keeps them.

    Attributes:
        codes: Shape (n, 5).
        values: Shape (n, 11).
        positions: Start, end and display, shape (n, 3, k).
        events: Moves before each event, its line, kind and number, shape (m, 4).
        event_values: What it counts, NaN for nothing, shape (m,).
    """

    codes: IntArray
    values: FloatArray
    positions: FloatArray
    events: IntArray
    event_values: FloatArray

    def first(self, count: int) -> "Rows":
        """The first moves, as columns again."""
        return self._replace(
            codes=self.codes[:count],
            values=self.values[:count],
            positions=self.positions[:count],
        )

    def row(self, number: int) -> Row:
        """One of the moves."""
        return Row(self.codes[number], self.values[number], self.positions[number])


def new_rows(moves: int, events: int, axes: int) -> Rows:
    """Room for so many moves and events."""
    return Rows(
        np.zeros((moves, 5), np.int64),
        np.zeros((moves, 11)),
        np.zeros((moves, 3, axes)),
        np.zeros((events, 4), np.int64),
        np.zeros(events),
    )


def _copy_one_by_one(source: Column, target: Column) -> None:
    """Assigning a slice would bring NumPy's error messages into a kernel, which are made of objects."""
    for index in range(len(source)):
        target[index] = source[index]


@compilable_as(_copy_one_by_one)
def copy(source: Column, target: Column) -> None:
    """Copy a column to the first places of another."""
    target[: len(source)] = source


def _copy_rows_one_by_one(source: FloatArray, target: FloatArray) -> None:
    for row in range(source.shape[0]):
        for index in range(source.shape[1]):
            target[row, index] = source[row, index]


@compilable_as(_copy_rows_one_by_one)
def copy_rows(source: FloatArray, target: FloatArray) -> None:
    """Copy a table, shape (n, k), to the first places of another."""
    target[: source.shape[0], : source.shape[1]] = source
