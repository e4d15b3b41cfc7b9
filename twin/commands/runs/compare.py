"""``twin compare A B``: two recordings, or a recording and a log of the real machine."""

import dataclasses
import json
from pathlib import Path

import typer
from rich.table import Table

from twin.commands.console import table_console
from twin.compare.track_comparison import TrackDifference, compare_files
from twin.errors import ExitCode, UsageError
from twin.logs.column_map import read_column_map


def compare_and_print(
    first: Path,
    second: Path,
    *,
    form: str = "text",
    period_s: float | None = None,
    offset_s: float | None = None,
    tolerance: float | None = None,
    columns: Path | None = None,
) -> ExitCode:
    """Compare two runs and print how they differ.

    Args:
        second: Recording or log that is compared with the first.
        form: ``text`` or ``json``.
        period_s: Time between the samples of logs without a time column [s].
        offset_s: Known offset in time [s]; found by the commanded positions by default.
        tolerance: Largest difference of the actual positions [mm or deg]; none: not judged.
        columns: A map of the columns of logs; by default what their headings say.

    Returns:
        ``FAILED`` when a tolerance was given and does not hold, else ``OK``.

    Raises:
        UsageError: A file cannot be read, or the two have nothing in common.
    """
    if form not in ("text", "json"):
        raise UsageError(f"--format {form}: use text or json")
    meant = None if columns is None else read_column_map(columns)
    found = compare_files(first, second, period_s=period_s, offset_s=offset_s, columns=meant)
    if form == "json":
        typer.echo(json.dumps(dataclasses.asdict(found), indent=2))
    else:
        _print_table(found)
    greatest = max(axis.actual_max for axis in found.axes.values())
    failed = tolerance is not None and greatest > tolerance
    return ExitCode.FAILED if failed else ExitCode.OK


def _print_table(found: TrackDifference) -> None:
    table = Table(box=None, pad_edge=False)
    headings = (
        "axis", "commanded max", "actual max", "actual rms", "following max", "following rms",
        "at time", "line",
    )  # fmt: skip
    for heading in headings:
        table.add_column(heading, justify="left" if heading == "axis" else "right")
    for name, axis in found.axes.items():
        values = (
            axis.commanded_max, axis.actual_max, axis.actual_rms, axis.following_max,
            axis.following_rms,
        )  # fmt: skip
        cells = [f"{value:.4f}" for value in values]
        table.add_row(name, *cells, f"{axis.time_s:.3f} s", str(axis.line or "–"))
    table_console().print(table)
    typer.echo(
        f"differences in mm or deg; offset {found.offset_s:.4f} s, overlap {found.overlap_s:.3f} s"
    )
