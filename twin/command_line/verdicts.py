"""Verdicts on many runs and on recordings: ``twin check``, ``compare`` and ``export``."""

from pathlib import Path
from typing import Annotated

import typer

from twin.command_line.options import (
    ClusterOption,
    DialectOption,
    FormatOption,
    JobsOption,
    JsonOption,
    MachineOption,
    ProgramOrJob,
    StrictOption,
    json_file_of,
)
from twin.errors import UsageError


def check(
    paths: Annotated[list[str], typer.Argument(help="Programs, job files, folders, globs.")],
    junit: Annotated[Path | None, typer.Option("--junit", help="JUnit XML file to write.")] = None,
    json_file: JsonOption = None,
    form: FormatOption = "text",
    baseline: Annotated[
        Path | None,
        typer.Option("--baseline", help="Compare runs with the baselines in this folder."),
    ] = None,
    update_baseline: Annotated[
        bool,
        typer.Option("--update-baseline", help="Store baselines instead of comparing with them."),
    ] = False,
    changed: Annotated[
        bool,
        typer.Option(
            "--changed",
            help="PATHS are files that a commit changes: check the programs and jobs among them, and the jobs that read the others.",
        ),
    ] = False,
    reports: Annotated[
        Path | None, typer.Option("--reports", help="Folder for a report on each program.")
    ] = None,
    jobs: JobsOption = None,
    cluster: ClusterOption = None,
    dialect: DialectOption = None,
    machine: MachineOption = None,
    strict: StrictOption = False,
) -> None:
    """Run many programs without pictures; one table, exit 1 if any falls short."""
    from twin.check.dependents import dependents
    from twin.check.task import CheckSettings
    from twin.commands.programs.check import check_and_print, write_forms

    settings = CheckSettings(
        dialect=dialect, machine=machine, strict=strict, baseline=baseline,
        update_baseline=update_baseline, reports=reports,
    )  # fmt: skip
    if changed:
        paths = [str(path) for path in dependents(map(Path, paths), machine=machine)]
        if not paths:
            typer.echo(
                "no program or job has to do with these files: nothing was checked", err=True
            )
            # An earlier check's file would say that something was.
            unwritten = write_forms([], junit, json_file_of(form, json_file))
            if unwritten is not None:
                raise unwritten
            return
    code = check_and_print(
        paths,
        settings=settings,
        junit=junit,
        json_file=json_file_of(form, json_file),
        jobs=jobs,
        cluster=cluster,
    )
    raise typer.Exit(code)


def sweep(
    job: ProgramOrJob,
    vary: Annotated[
        list[str],
        typer.Option(
            "--vary",
            help="machine.KEY=VALUES or job.KEY=VALUES: a,b,c or FROM:TO:COUNT; repeatable.",
        ),
    ],
    json_file: JsonOption = None,
    form: FormatOption = "text",
    jobs: JobsOption = None,
    cluster: ClusterOption = None,
    dialect: DialectOption = None,
    machine: MachineOption = None,
    strict: StrictOption = False,
) -> None:
    """Run a job for every combination of values; exit 1 if any falls short."""
    from twin.check.task import CheckSettings
    from twin.commands.runs.sweep import sweep_and_print

    code = sweep_and_print(
        job,
        vary,
        settings=CheckSettings(dialect=dialect, machine=machine, strict=strict),
        json_file=json_file_of(form, json_file),
        jobs=jobs,
        cluster=cluster,
    )
    raise typer.Exit(code)


def compare(
    first: Annotated[Path, typer.Argument(help="Recording, or log.", show_default=False)],
    second: Annotated[Path, typer.Argument(help="Recording, or log.", show_default=False)],
    form: FormatOption = "text",
    period: Annotated[
        float | None, typer.Option("--period", help="Sample period of logs without time (s).")
    ] = None,
    offset: Annotated[
        float | None,
        typer.Option("--offset", help="Known offset in time (s); default: found by alignment."),
    ] = None,
    tolerance: Annotated[
        float | None, typer.Option("--tolerance", help="Largest actual difference (mm or deg).")
    ] = None,
    columns: Annotated[
        Path | None, typer.Option("--columns", help="Map of the columns of logs (TOML).")
    ] = None,
) -> None:
    """Compare two recordings, or a recording with a log of the real machine."""
    from twin.commands.runs.compare import compare_and_print

    code = compare_and_print(
        first, second, form=form, period_s=period, offset_s=offset, tolerance=tolerance,
        columns=columns,
    )  # fmt: skip
    raise typer.Exit(code)


def export(
    recording: Annotated[
        Path | None, typer.Argument(help="recording.h5", show_default=False)
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", help="CSV file; default: next to the recording.")
    ] = None,
    every: Annotated[int, typer.Option("--every", help="Write every Nth sample.")] = 1,
    fmu: Annotated[
        str | None,
        typer.Option(
            "--fmu",
            metavar="MACHINE",
            help="Write a unit for co-simulation (FMI 3) instead of CSV.",
        ),
    ] = None,
) -> None:
    """Write a recording as CSV, units in the header; or a machine for other simulators."""
    from twin.commands.runs.export import export_and_print, export_unit

    if (recording is None) == (fmu is None):
        raise UsageError("give a recording.h5, or --fmu and a machine")
    if fmu is not None:
        raise typer.Exit(export_unit(fmu, out))
    assert recording is not None
    raise typer.Exit(export_and_print(recording, out, every=every))
