"""Tables held as columns: the form in which packages exchange chunks."""

import dataclasses
import functools
from collections.abc import Sequence
from typing import Any, Generic, Self, TypeVar

import numpy as np
import numpy.typing as npt

Rows = slice | npt.NDArray[np.bool_] | npt.NDArray[np.int64]


@dataclasses.dataclass(frozen=True, slots=True)
class Columns:
    """n rows; every field is an array whose first axis counts the rows, or again a table of n rows.

    A field may be None where nothing is known of it.
    """

    def __len__(self) -> int:
        return len(getattr(self, _names(type(self))[0]))

    def __getitem__(self, rows: Rows) -> Self:
        """A selection of the rows, as columns again; of a slice, views."""
        kind = type(self)
        return kind(*[_selected(getattr(self, name), rows) for name in _names(kind)])


ColumnsT = TypeVar("ColumnsT", bound=Columns)


@dataclasses.dataclass(frozen=True, slots=True)
class Picked(Columns, Generic[ColumnsT]):
    """n rows of another table by their numbers, for rows that are repeated.

    Attributes:
        row: Rows of ``table``, shape (n,).
    """

    row: npt.NDArray[np.int64]
    table: ColumnsT

    def __getitem__(self, rows: Rows) -> Self:
        """A selection of the rows; they are still picked from the same table."""
        return type(self)(_selected(self.row, rows), self.table)

    def whole(self) -> ColumnsT:
        """The rows themselves."""
        return self.table[self.row]


def join(parts: Sequence[ColumnsT]) -> ColumnsT:
    """Consecutive tables as one; one alone is returned as it is.

    Raises:
        ValueError: There is nothing to join.
    """
    if not parts:
        raise ValueError("nothing to join")
    if len(parts) == 1:
        return parts[0]
    return _joined(parts)


@functools.cache
def _names(kind: type[Columns]) -> tuple[str, ...]:
    return tuple(field.name for field in dataclasses.fields(kind))


def _joined(values: Sequence[Any]) -> Any:
    if any(value is None for value in values):
        return None
    if not isinstance(values[0], Columns):
        return np.concatenate(values)
    if isinstance(values[0], Picked):
        return _joined_picked(values)
    kind = type(values[0])
    return kind(*[_joined([getattr(value, name) for value in values]) for name in _names(kind)])


def _joined_picked(parts: Sequence[Any]) -> Any:
    """Of each table no more than from the first to the last row that is picked."""
    rows, tables, before = [], [], 0
    for part in parts:
        first, end = part.row.min(initial=len(part.table)), part.row.max(initial=-1) + 1
        rows.append(part.row + (before - first))
        tables.append(part.table[first:end])
        before += max(0, end - first)
    return type(parts[0])(np.concatenate(rows), join(tables))


def _selected(values: Any, rows: Rows) -> Any:
    if values is None:
        return None
    if isinstance(values, Columns) or isinstance(rows, slice):
        return values[rows]
    # ``values[rows]`` would copy the rows of a table number by number.
    if rows.dtype == np.bool_:
        return values.compress(rows, axis=0)
    return values.take(rows, axis=0)
