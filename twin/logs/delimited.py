"""Tables of text: CSV with any separator, decimal commas, a preamble, TwinCAT Scope, halsampler.

What separates the cells and where the numbers begin is seen from the file. A table without a heading
(LinuxCNC's ``halsampler``) has columns that are named by their numbers.

TwinCAT Scope View exports a block of properties per channel, each row as ``key; value; key; value``;
where channels share a time column, the key is over the time column and one value over each
channel. Times are milliseconds since the start, or ticks of 100 ns (Beckhoff, TE13xx, "Export to csv").
"""

import csv
import itertools
import re
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path

import numpy as np

from twin.errors import UsageError
from twin.logs.channels import Channel, RawLog, is_number
from twin.logs.numbers import NumberColumns, split_cells
from twin.logs.text_pieces import whole_text
from twin.logs.units import UNITS

_SEPARATORS = (";", "\t", ",")
_DECIMAL_COMMA = re.compile(r"[-+]?\d*,\d+([eE][-+]?\d+)?")
_PREAMBLE = 200
"""Rows that may stand before the numbers."""
_TICKS = 1e12
"""A time above this is in ticks of 100 ns since 1601, not in milliseconds since the start."""
_TICK_S, _MILLISECOND_S = 1e-7, 1e-3
_END = "EOF"


def read_delimited(
    path: Path, first: str, more: Iterator[str], wanted: Collection[str | int] | None
) -> RawLog:
    """Read a table of text.

    Args:
        first: Its first lines, all that stand above its numbers among them.
        more: The others, some at a time.
        wanted: Names or numbers of the columns that are kept; all by default.

    Raises:
        UsageError: It holds no table of numbers, or rows of unequal length.
    """
    lines = first.splitlines()
    separator = _separator(lines[:_PREAMBLE])
    try:
        rows = _rows(lines[: 2 * _PREAMBLE], separator)
        if rows and rows[0][0] == "Name":
            rows = _rows(whole_text(path, first, more).splitlines(), separator)
            start = _first_row_of_numbers(rows)
            return _twincat(path, rows[:start], rows[start:])
        start = _first_row_of_numbers(rows)
        heading, units = _heading(rows[:start], rows[start:])
        if not heading:
            raise UsageError(
                f"{path}: is empty; a log has a heading such as time_s,X_commanded,X_actual"
            )
        kept = [
            number for number, name in enumerate(heading)
            if wanted is None or name in wanted or number + 1 in wanted
        ]  # fmt: skip
        columns = NumberColumns(path, len(heading), kept, separator)
        below = lines[_line_of_row(lines, start, separator) :]
        for piece in itertools.chain([below], (text.splitlines() for text in more)):
            columns.take(piece, lambda part: _rows(part, separator))
    except csv.Error as error:
        raise UsageError(f"{path}: is not a log: {error}") from error
    if columns.rows < 2:
        raise UsageError(f"{path}: needs two rows or more, each with {len(heading)} values")
    return RawLog(
        path,
        tuple(
            Channel(
                name,
                columns.take_column(index),
                unit=units[index],
                strange=columns.strange.get(index),
            )
            for index, name in enumerate(heading)
        ),
    )


def _separator(lines: Sequence[str]) -> str | None:
    sample = "\n".join(lines)
    return next((mark for mark in _SEPARATORS if mark in sample), None)


def _rows(lines: Sequence[str], separator: str | None) -> list[list[str]]:
    rows = split_cells(lines, separator)
    if separator != ",":
        rows = [
            [cell.replace(",", ".") if _DECIMAL_COMMA.fullmatch(cell) else cell for cell in row]
            for row in rows
        ]
    return [row for row in rows if any(row) and row != [_END]]


def _line_of_row(lines: Sequence[str], row: int, separator: str | None) -> int:
    """The line in which a row is: empty lines and rows count for lines alone."""
    filled = (number for number, line in enumerate(lines) if _rows([line], separator))
    return next(itertools.islice(filled, row, None), len(lines))


def _first_row_of_numbers(rows: list[list[str]]) -> int:
    """Where two rows of numbers in turn begin; under rows of properties, where a time begins one."""
    if rows and rows[0][0] == "Name":
        return next((index for index, row in enumerate(rows) if is_number(row[0])), len(rows))
    numeric = [_is_numeric(row) for row in rows[:_PREAMBLE]]
    for index in range(len(numeric)):
        if all(numeric[index : index + 2]):
            return index
    return min(1, len(rows))


def _is_numeric(row: list[str]) -> bool:
    cells = [cell for cell in row if cell]
    return bool(cells) and 2 * sum(map(is_number, cells)) >= len(cells)


def _heading(above: list[list[str]], body: list[list[str]]) -> tuple[list[str], list[str]]:
    """Names and units of the columns, from the rows above the numbers."""
    width = len(body[0]) if body else len(above[-1]) if above else 0
    units = [""] * width
    if len(above) > 1 and len(above[-1]) == width and _are_units(above[-1]):
        units = [cell.strip("[]()") for cell in above.pop()]
    if not above:
        return [str(number) for number in range(1, width + 1)], units
    heading = above[-1]
    return heading, (units + [""] * len(heading))[: len(heading)]


def _are_units(row: list[str]) -> bool:
    return all(cell.strip("[]()") in UNITS or not cell for cell in row)


def _twincat(path: Path, above: list[list[str]], body: list[list[str]]) -> RawLog:
    names = next((row for row in reversed(above) if row[0] == "Name"), [])
    symbols = next((row for row in reversed(above) if row[0] == "SymbolName"), names)
    channels, time = [], None
    for column, name in enumerate(names):
        if name == "Name":
            time = column
            continue
        cells = [(row[time or 0], row[column]) for row in body if column < len(row) and row[column]]
        if time is None or not cells or not all(is_number(cell[0]) for cell in cells):
            raise UsageError(f"{path}: channel '{name}' has no time column; export it with one")
        clock = np.array([float(cell[0]) for cell in cells])
        scale = _TICK_S if clock[0] > _TICKS else _MILLISECOND_S
        alias = symbols[column] if column < len(symbols) else name
        begin = clock[0] if scale == _TICK_S else 0.0
        channels.append(
            Channel(name, [cell[1] for cell in cells], (clock - begin) * scale, (alias,))
        )
    if not channels:
        raise UsageError(f"{path}: has no channels under its rows of properties")
    return RawLog(path, tuple(channels))
