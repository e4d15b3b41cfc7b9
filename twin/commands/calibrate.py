"""``twin calibrate LOG...``: a machine file, a report and figures from logs of a real machine."""

import contextlib
import ctypes
import dataclasses
import json
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import typer
from rich.console import Console
from rich.table import Table

from twin.calibrate.programs import write_programs
from twin.errors import ExitCode, UsageError
from twin.extras import require_extra
from twin.files.atomic import STDOUT, write_text
from twin.files.shipped import machine_file
from twin.logs.ball_bar import read_ball_bar
from twin.logs.column_map import read_column_map
from twin.logs.machine_log import MachineLog, read_machine_log
from twin.machine.load import read_machine

if TYPE_CHECKING:
    from twin.calibrate.result import Calibration

_M_MMAP_THRESHOLD, _LARGE_BYTES = -3, 1 << 20
"""glibc's number of that setting, ``malloc.h``, and from which size on [B]."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class CalibrationRequest:
    """What is to be fitted, and what is to be written.

    Attributes:
        base: Machine that keeps what they do not determine.
        columns: Map of their columns; by default what their headings say.
        hold_out: Logs to judge the fit by.
        axes: Names, separated by commas; all that the logs have by default.
        require: Largest share of the following error that may be left on held-out logs.
        programs: Folder for test programs to run on the real machine.
    """

    logs: Sequence[Path] = ()
    base: str
    columns: Path | None = None
    hold_out: Sequence[Path] = ()
    axes: str | None = None
    out: Path | None = None
    json_file: Path | None = None
    report: Path | None = None
    require: float | None = None
    programs: Path | None = None
    ball_bars: Sequence[Path] = ()

    @property
    def fits(self) -> bool:
        """Whether there is anything to fit."""
        return bool(self.logs or self.ball_bars)


def calibrate_and_print(request: CalibrationRequest) -> ExitCode:
    """Fit the base machine's drives to logs; write what was asked for and print the figures.

    Returns:
        ``FAILED`` when ``require`` does not hold, else ``OK``.

    Raises:
        UsageError: A log, the map or the command line is wrong.
        ConfigError: The base is wrong.
    """
    machine = read_machine(machine_file(request.base))
    if not request.fits and request.programs is None:
        raise UsageError("nothing to do: give logs to fit, or --programs DIR")
    if not request.fits and any((request.out, request.json_file, request.report)):
        raise UsageError("--out, --json and --report need logs to fit")
    if not request.logs and (request.hold_out or request.require):
        raise UsageError("--hold-out and --require need logs to fit")
    if request.require is not None and not request.hold_out:
        raise UsageError("--require judges held-out logs: give --hold-out LOG")
    if request.require is not None and not 0 < request.require < float("inf"):
        raise UsageError(f"--require must be a positive share, not {request.require:g}")
    if request.programs is not None:
        named = _base_for(request.base, request.programs / "job.toml")
        for path in write_programs(machine, request.programs, named):
            typer.echo(f"wrote {path}")
    if not request.fits:
        return ExitCode.OK
    require_extra("calibrate", "twin calibrate")
    _give_large_arrays_back()
    from twin.calibrate.calibrate import calibrate
    from twin.calibrate.machine_text import machine_text

    positions = request.columns is not None and bool(request.logs)
    meant = read_column_map(request.columns) if positions and request.columns else None

    def read(paths: Sequence[Path]) -> list[MachineLog]:
        return [
            read_machine_log(path, meant, units_needed=True, gaps_allowed=True) for path in paths
        ]

    wanted = [name.strip().upper() for name in request.axes.split(",")] if request.axes else []
    circles = [read_ball_bar(path, request.columns) for path in request.ball_bars]
    fitted, held = read(request.logs), read(request.hold_out)
    result = calibrate(machine, fitted, held, wanted, circles)
    if request.out is not None:
        write_text(
            request.out,
            machine_text(result, base=_base_for(request.base, request.out), name=request.out.stem),
        )
    if request.json_file is not None:
        write_text(
            request.json_file, json.dumps(result.as_contract(), indent=2, ensure_ascii=False) + "\n"
        )
    if request.report is not None:
        from twin.calibrate.report.page import calibration_page
        from twin.calibrate.report.record import record_of

        logs = [
            (role, path, log)
            for role, paths, read_logs in (
                ("fit", request.logs, fitted), ("hold-out", request.hold_out, held)
            )
            for path, log in zip(paths, read_logs, strict=True)
        ]  # fmt: skip
        base = (request.base, machine_file(request.base))
        record = record_of(base, request.columns, logs)
        write_text(request.report, calibration_page(result, record))
    # Where the figures go to the standard output, nothing else does.
    with contextlib.redirect_stdout(sys.stderr if request.json_file == STDOUT else sys.stdout):
        _print(result)
    judged = [figures for figures in result.logs if figures.role == "hold-out"]
    failed = request.require is not None and any(
        figures.judged_share > request.require for figures in judged
    )
    return ExitCode.FAILED if failed else ExitCode.OK


def _give_large_arrays_back() -> None:
    """Let glibc return every large array to the system once it is freed.

    By default it keeps them once some were freed: of an hour's log a tenth more memory is taken then.
    """
    with contextlib.suppress(AttributeError, OSError, TypeError):
        ctypes.CDLL(None).mallopt(_M_MMAP_THRESHOLD, _LARGE_BYTES)


def _base_for(base: str, out: Path) -> str:
    """The base as a machine file beside ``out`` names it."""
    path = Path(base)
    if not path.exists():
        return base
    return os.path.relpath(path.resolve(), out.parent.resolve())


def _print(result: "Calibration") -> None:
    from twin.calibrate.fit.ball_bar import circle_line
    from twin.calibrate.result import verdict_sentence

    for log, findings in result.findings.items():
        for finding in findings:
            typer.echo(f"{log}: {finding.message}", err=True)
    console = Console(width=110)
    for name, axis in result.axes.items():
        table = Table(box=None, pad_edge=False)
        table.add_column(f"axis {name}")
        for heading in ("value", "low", "high"):
            table.add_column(heading, justify="right")
        for heading in ("unit", "given"):
            table.add_column(heading)
        conditional = axis.fit.conditional.items()
        for parameter, interval, given in [
            *((key, interval, "") for key, interval in axis.fit.fitted.items()),
            *((key, interval, ", ".join(names)) for key, (interval, names) in conditional),
        ]:
            numbers = [f"{value:.5g}" for value in (interval.value, interval.low, interval.high)]
            table.add_row(parameter, *numbers, axis.units[parameter], given)
        console.print(table)
        for parameter, why in axis.fit.undetermined.items():
            typer.echo(f"  {parameter} undetermined: {why}")
        typer.echo()
    if result.logs:
        _print_logs(console, result)
    for circle in result.ball_bars:
        typer.echo(circle_line(circle))
    for name, axis in result.axes.items():
        typer.echo(verdict_sentence(name, axis, result.logs))


def _print_logs(console: Console, result: "Calibration") -> None:
    table = Table(box=None, pad_edge=False)
    for heading in ("log", "role", "axis"):
        table.add_column(heading)
    for heading in ("logged rms", "left rms", "share", "force left", "current corr."):
        table.add_column(heading, justify="right")
    for figures in result.logs:
        unit = "µm" if figures.kind == "linear" else "mdeg"
        table.add_row(
            Path(figures.log).name, figures.role, figures.axis,
            f"{figures.logged_rms * 1e3:.2f} {unit}", f"{figures.left_rms * 1e3:.2f} {unit}",
            f"{100 * figures.share:.2f} %", _share(figures.force_share),
            "" if figures.current_correlation is None else f"{figures.current_correlation:.3f}",
        )  # fmt: skip
    console.print(table)
    for figures in result.logs:
        if figures.ramps_line:
            typer.echo(figures.ramps_line)


def _share(value: float | None) -> str:
    return "" if value is None else f"{100 * value:.1f} %"
