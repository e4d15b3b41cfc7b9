"""Tables held as columns: the form in which chunks go from room to room."""

import dataclasses
import functools
from collections.abc import Sequence
from typing import Any, Self, TypeVar

import numpy as np
import numpy.typing as npt

Rows = slice | npt.NDArray[np.bool_] | npt.NDArray[np.int64]


@dataclasses.dataclass(frozen=True, slots=True)
class Columns:
    """n rows; every field is an array whose first axis counts the rows, or again a table of n rows."""

    def __len__(self) -> int:
        return len(getattr(self, _names(type(self))[0]))

    def __getitem__(self, rows: Rows) -> Self:
        """A selection of the rows, as columns again; of a slice, views."""
        kind = type(self)
        return kind(*[_selected(getattr(self, name), rows) for name in _names(kind)])


ColumnsT = TypeVar("ColumnsT", bound=Columns)


def join(parts: Sequence[ColumnsT]) -> ColumnsT:
    """Consecutive tables as one; one alone is returned as it is.

    Raises:
        ValueError: There is nothing to join.
    """
    if not parts:
        raise ValueError("nothing to join")
    if len(parts) == 1:
        return parts[0]
    kind = type(parts[0])
    return kind(*[_joined([getattr(part, name) for part in parts]) for name in _names(kind)])


@functools.cache
def _names(kind: type[Columns]) -> tuple[str, ...]:
    return tuple(field.name for field in dataclasses.fields(kind))


def _joined(values: Sequence[Any]) -> Any:
    return join(values) if isinstance(values[0], Columns) else np.concatenate(values)


def _selected(values: Any, rows: Rows) -> Any:
    if isinstance(values, Columns) or isinstance(rows, slice):
        return values[rows]
    # ``values[rows]`` would copy the rows of a table number by number.
    if rows.dtype == np.bool_:
        return values.compress(rows, axis=0)
    return values.take(rows, axis=0)
