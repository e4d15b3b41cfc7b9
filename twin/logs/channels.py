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
        name: Its heading.
        cells: Its n values, as numbers or as the file writes them.
        time: When each was recorded, shape (n,) [s]; None where one clock serves all channels.
        aliases: Other names that the file gives it, such as the path of its symbol.
        unit: As the file writes it; empty where it does not say.
    """

    name: str
    cells: Sequence[str] | FloatArray
    time: FloatArray | None = None
    aliases: tuple[str, ...] = ()
    unit: str = ""

    def numbers(self, path: Path) -> FloatArray:
        """Its values, shape (n,).

        Raises:
            UsageError: One is not a finite number; the message says which row.
        """
        if isinstance(self.cells, np.ndarray):
            values = np.asarray(self.cells, np.float64)
        else:
            values = np.array([_number(cell) for cell in self.cells])
        wrong = np.flatnonzero(~np.isfinite(values))
        if len(wrong):
            raise UsageError(
                f"{path}: column '{self.name}' is not a number in row {wrong[0] + 1} of the values: "
                f"{self.cells[int(wrong[0])]!r}"
            )
        return values


@dataclasses.dataclass(frozen=True, slots=True)
class RawLog:
    """A file as it was read, before anybody says what its columns mean.

    Attributes:
        path: The file.
        channels: In the order of the file.
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


def is_number(cell: str) -> bool:
    """Whether a cell holds a finite number, written with a point."""
    return bool(np.isfinite(_number(cell)))


def joined_names(channels: Iterable[str]) -> str:
    """Headings for a message, or ``none``."""
    return ", ".join(channels) or "none"
