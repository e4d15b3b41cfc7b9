"""What a file of any form comes to: named channels of numbers, each with its time where it has one."""

import dataclasses
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from twin.errors import UsageError
from twin.nc.canonical import FloatArray


@dataclasses.dataclass(frozen=True, slots=True)
class Channel:
    """One recorded variable.

    Attributes:
        cells: Its n values, as numbers or as the file writes them.
        time: When each was recorded, shape (n,) [s]; None where one clock serves all channels.
        aliases: Other names that the file gives it, such as the path of its symbol.
        unit: As the file writes it; empty where it does not say.
        strange: Row and text of the first cell that is neither a number nor missing, counted from 1.
    """

    name: str
    cells: Sequence[str] | FloatArray
    time: FloatArray | None = None
    aliases: tuple[str, ...] = ()
    unit: str = ""
    strange: tuple[int, str] | None = None

    def numbers(self, path: Path) -> FloatArray:
        """Its values, shape (n,), not a number where a cell is missing.

        Raises:
            UsageError: A cell is something else than a finite number; the message says which row.
        """
        strange = self.strange
        if isinstance(self.cells, np.ndarray):
            values = np.asarray(self.cells, np.float64)
        else:
            found = [missing_or_number(cell) for cell in self.cells]
            if None in found:
                strange = (found.index(None) + 1, self.cells[found.index(None)])
            values = np.array([np.nan if value is None else value for value in found])
        if np.isinf(values).any():
            strange = (int(np.flatnonzero(np.isinf(values))[0]) + 1, "inf")
        if strange is not None:
            raise UsageError(
                f"{path}: column '{self.name}' is not a number in row {strange[0]} of the values: "
                f"{strange[1]!r}"
            )
        return values


@dataclasses.dataclass(frozen=True, slots=True)
class RawLog:
    """A file as it was read, before anybody says what its columns mean.

    Attributes:
        period_s: Between the samples, where the file states it without a time column [s].
    """

    path: Path
    channels: tuple[Channel, ...]
    period_s: float | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """Headings in the order of the file."""
        return tuple(channel.name for channel in self.channels)

    def find(self, column: str | int) -> Channel | None:
        """The channel of a heading, of an alias, or of a number that counts from 1."""
        if isinstance(column, int):
            return self.channels[column - 1] if 0 < column <= len(self.channels) else None
        named = [channel for channel in self.channels if channel.name == column]
        also = [channel for channel in self.channels if column in channel.aliases]
        return next(iter(named + also), None)


def _number(cell: str) -> float:
    try:
        return float(cell)
    except ValueError:
        return float("nan")


_MISSING = ("", "nan", "n/a", "#n/a", "na", "null", "none", "-", "--")
"""How logs write that there is no value."""


def missing_or_number(cell: str) -> float | None:
    """A cell's number, NaN where it is missing, None where it holds something else."""
    value = _number(cell)
    if np.isfinite(value):
        return value
    return float("nan") if cell.strip().lower() in _MISSING else None


def is_number(cell: str) -> bool:
    """Whether a cell holds a finite number, written with a point."""
    return bool(np.isfinite(_number(cell)))


def joined_names(channels: Iterable[str]) -> str:
    """Headings for a message, or ``none``."""
    return ", ".join(channels) or "none"
