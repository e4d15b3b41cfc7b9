"""The way of moves from the control to the columns, through compensation where it is in force."""

import dataclasses
from collections.abc import Callable

from twin.nc.arcs import SAME_POINT, distance
from twin.nc.canonical import Axes, Chunk, FloatArray, IntArray
from twin.nc.compensation import Compensation, Refuse
from twin.nc.move_columns import MoveColumns, Segment
from twin.nc.planes import Plane


class Path:
    """Takes moves and events in program order.

    Attributes:
        position: Where the emitted path has come to, shape (k,) [mm or deg].
    """

    def __init__(self, axes: Axes, start: list[float], refuse: Refuse) -> None:
        self._columns = MoveColumns(axes)
        self._refuse = refuse
        self._compensation: Compensation | None = None
        self._leading_out: Plane | None = None
        self.position = start

    def __len__(self) -> int:
        return len(self._columns)

    def take(self) -> Chunk:
        """All that has been emitted, as columns."""
        return self._columns.take()

    def add(self, move: Segment) -> None:
        """The next programmed move."""
        if self._compensation is not None:
            self._compensation.add(move)
            return
        if self._leading_out is not None:
            move = self._lead_out(move, self._leading_out)
        self._emit(move)

    def add_rows(self, codes: IntArray, values: FloatArray, positions: FloatArray) -> None:
        """Moves as columns, shapes as in ``MoveColumns.add_rows``; never while compensating."""
        assert self._compensation is None
        self._columns.add_rows(codes, values, positions)
        self.position = positions[-1, 1].tolist()

    def _emit(self, move: Segment) -> None:
        if move.center is None and move.start == move.end:
            return
        self._columns.add(move)
        self.position = move.end

    def _lead_out(self, move: Segment, plane: Plane) -> Segment:
        """The first line in the plane leads out; until then only its normal and others move."""
        if move.center is not None:
            self._refuse(move, "compensation-end", "compensation must end on a line")
        start, end = plane.local(move.start), plane.local(move.end)
        if distance(start[:2], end[:2]) >= SAME_POINT:
            self._leading_out = None
            return dataclasses.replace(move, start=self.position)
        here = plane.local(self.position)
        level = [*plane.world(here.abscissa, here.ordinate, end.height), *move.end[3:]]
        return dataclasses.replace(move, start=self.position, end=level)

    def event(self, happen: Callable[[MoveColumns], None]) -> None:
        """Something that happens between the moves so far and the next."""
        if self._compensation is None:
            happen(self._columns)
        else:
            self._compensation.event(lambda: happen(self._columns))

    @property
    def leading_out(self) -> bool:
        """Compensation has ended, and no line has led out yet."""
        return self._leading_out is not None

    @property
    def compensating(self) -> bool:
        """Compensation is in force."""
        return self._compensation is not None

    def start_compensation(self, plane: Plane, side: float, radius: float, *, square: bool) -> None:
        """Compensate from the next move on.

        Args:
            plane: Working plane in part coordinates.
            side: +1 left of the contour, -1 right of it.
            radius: Of the tool [mm].
            square: Outside corners between lines are extended as far as 90°.
        """
        self._compensation = Compensation(
            plane, side, radius, self._emit, self._refuse, square=square
        )

    def end_compensation(self) -> None:
        """The next line leads out."""
        if self._compensation is not None:
            if self._compensation.finish():
                self._leading_out = self._compensation.plane
            self._compensation = None
