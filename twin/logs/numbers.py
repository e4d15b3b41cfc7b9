"""Rows of cells as columns of numbers, piece by piece."""

import csv
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from twin.errors import UsageError
from twin.logs.channels import missing_or_number
from twin.nc.canonical import FloatArray

_MOST_ROWS = 8_000_000
"""Rows of a log: above two hours at 1 kHz."""
_COMMAS = ": are its decimals written with commas? Then its cells need ';' or tabs between them"


class NumberColumns:
    """Columns that grow with the rows of a table.

    Attributes:
        rows: So many were read.
        strange: By column, row and text of the first cell that is neither a number nor missing.
    """

    def __init__(
        self, path: Path, width: int, wanted: Sequence[int], separator: str | None
    ) -> None:
        """Begin without rows.

        Args:
            width: Cells of a row.
            wanted: Numbers of the columns that are kept, counted from 0.
            separator: Between cells; None: white space.
        """
        self.rows = 0
        self.strange: dict[int, tuple[int, str]] = {}
        self._path, self._width, self._separator = path, width, separator
        self._wanted = tuple(wanted)
        self._parts: dict[int, list[FloatArray]] = {number: [] for number in wanted}

    def take(self, lines: Sequence[str], split: Callable[[Sequence[str]], list[list[str]]]) -> None:
        """Take further lines.

        Args:
            split: Makes rows of cells of them, without empty rows.

        Raises:
            UsageError: A row has more cells or fewer, or there are too many rows.
        """
        lines = [line for line in lines if line and not line.isspace()]
        if not lines:
            return
        fast = self._all_numbers(lines)
        part = self._cell_by_cell(split(lines)) if fast is None else fast
        for number, values in zip(self._wanted, part.T, strict=True):
            self._parts[number].append(values.copy())
        self.rows += len(part)
        if self.rows > _MOST_ROWS:
            raise UsageError(
                f"{self._path}: has more than {_MOST_ROWS} rows: log for a shorter time, or leave out rows"
            )

    def take_column(self, number: int) -> FloatArray:
        """Hand over a wanted column, shape (rows,), not a number where a cell is missing, and forget it.

        A log fills much of the memory: it is not to be there twice.
        """
        parts = self._parts.pop(number, [])
        return np.concatenate(parts) if parts else np.zeros(0)

    def _all_numbers(self, lines: Sequence[str]) -> FloatArray | None:
        """The rows, where every cell is a plain number; else None."""
        mark = self._separator
        if mark is not None and any(line.count(mark) != self._width - 1 for line in lines):
            return None
        columns = self._wanted if mark is not None else None
        given = lines if mark in (",", None) else [line.replace(",", ".") for line in lines]
        try:
            part = np.loadtxt(given, delimiter=mark, comments=None, ndmin=2, usecols=columns)
        except ValueError:
            return None
        if mark is None:
            if part.shape[1] != self._width:
                return None
            part = part[:, list(self._wanted)]
        return part if len(part) == len(lines) and np.isfinite(part).all() else None

    def _cell_by_cell(self, rows: Sequence[Sequence[str]]) -> FloatArray:
        part = np.empty((len(rows), len(self._wanted)))
        for index, row in enumerate(rows):
            if len(row) != self._width:
                more = len(row) > self._width and self._separator == ","
                raise UsageError(
                    f"{self._path}: needs two rows or more, each with {self._width} values; row "
                    f"{self.rows + index + 1} of the values has {len(row)}" + _COMMAS * more
                )
            for place, number in enumerate(self._wanted):
                value = missing_or_number(row[number])
                if value is None:
                    self.strange.setdefault(number, (self.rows + index + 1, row[number]))
                    value = np.nan
                part[index, place] = value
        return part


def split_cells(lines: Sequence[str], separator: str | None) -> list[list[str]]:
    """Cells of every line; of rows in quotation marks as CSV has them."""
    if separator is None:
        return [line.split() for line in lines]
    return [[cell.strip() for cell in row] for row in csv.reader(lines, delimiter=separator)]
