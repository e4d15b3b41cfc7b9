"""One program run for its verdict alone: no pictures, no recording, no part."""

import dataclasses
import time
import traceback
from collections.abc import Iterable
from pathlib import Path

from twin.check.outcome import CheckOutcome, Finding
from twin.check.settings import CheckSettings
from twin.check.variation import Variant
from twin.compare.baseline import compare_baseline, write_baseline
from twin.compare.baseline_text import RunFigures
from twin.compare.verdict import Reason
from twin.errors import ExitCode, TwinError, UsageError
from twin.job.job_file import Job
from twin.machine.alarms import Alarm
from twin.nc.text.diagnostics import Diagnostic, ProgramError
from twin.run.messages import alarm_diagnostic, reason_text
from twin.run.preparation import Preparation, prepare
from twin.run.progress import no_progress
from twin.run.run import Run


def run_variant(variant: Variant, settings: CheckSettings) -> CheckOutcome:
    """Run a program and say how it came out; what is wrong with it becomes a finding."""
    began, path = time.perf_counter(), variant.path
    try:
        outcome = _run(variant, settings)
    except TwinError as error:
        outcome = _not_run(path, error)
    except OSError as error:
        outcome = _not_run(path, UsageError(f"{error.filename or path}: {error.strerror or error}"))
    except MemoryError:
        outcome = _not_run(path, UsageError("not enough memory; a coarser stock.cell needs less"))
    except Exception:  # noqa: BLE001 - a defect at one program is told with it, the others run on
        outcome = _crashed(path)
    return dataclasses.replace(outcome, wall_s=time.perf_counter() - began, changes=variant.changes)


def file_of(folder: Path, job: Job, suffix: str) -> Path:
    """Where a job's baseline or report lies: in the folder, under the job's own path.

    A path is taken relative to the working folder where it lies below that, so that a baseline is
    found again from another checkout. A program without a job file keeps its whole name, so that
    two of the same stem do not share one.
    """
    resolved = (job.path or job.program).resolve()
    here = Path.cwd().resolve()
    parts = (
        resolved.relative_to(here) if resolved.is_relative_to(here) else Path(*resolved.parts[1:])
    )
    name = parts.name if job.path is None else parts.stem
    return folder / parts.with_name(name + suffix)


def _run(variant: Variant, settings: CheckSettings) -> CheckOutcome:
    path = variant.path
    preparation = prepare(
        path,
        dialect=settings.dialect,
        machine=settings.machine,
        strict=settings.strict,
        changes=variant.changes,
    )
    run = Run(preparation)
    try:
        dry_run = run.dry_run()
        outcome = run.execute(dry_run, None, no_progress)
    except ProgramError as error:
        differing = _baseline_reasons(preparation, None, settings)
        return _not_run(path, error, _findings(preparation, differing))
    if settings.reports is not None:
        from twin.compare.report.report import write_report
        from twin.run.results import report_of, result_of

        page = report_of(run, outcome, result_of(run, outcome))
        write_report(file_of(settings.reports, preparation.job, ".html"), page)
    contour = outcome.figures.contour
    alarmed = outcome.verdict.outcome == "alarm"
    figures = None if alarmed else RunFigures(outcome.duration_s, contour.max)
    differing = _baseline_reasons(preparation, figures, settings)
    failed = bool(differing) and not alarmed
    return CheckOutcome(
        program=str(path),
        verdict="fail" if failed else outcome.verdict.outcome,
        exit_code=ExitCode.FAILED if failed else outcome.verdict.exit_code,
        contour_um=contour.max,
        worst_line=contour.worst_line,
        cycle_time_s=outcome.duration_s,
        findings=(
            *(_alarm_finding(preparation, alarm) for alarm in outcome.alarms),
            *_findings(preparation, outcome.verdict.reasons[len(outcome.alarms) :]),
            *_findings(preparation, differing),
        ),
        warnings=tuple(_diagnostic_finding(found) for found in outcome.warnings),
    )


def _baseline_reasons(
    preparation: Preparation, figures: RunFigures | None, settings: CheckSettings
) -> list[Reason]:
    """Hold the run to its baseline, or store it; only a run that came to its end is stored."""
    if settings.baseline is None:
        return []
    file = file_of(settings.baseline, preparation.job, ".baseline")
    axes, chunks = preparation.machine.axes, preparation.interpretation().chunks()
    if not settings.update_baseline:
        limits = preparation.job.file.baseline
        return compare_baseline(file, figures, axes, chunks, limits)
    if figures is not None:
        write_baseline(file, figures, axes, chunks)
    return []


def _not_run(path: Path, error: TwinError, differing: tuple[Finding, ...] = ()) -> CheckOutcome:
    if isinstance(error, ProgramError):
        finding = _diagnostic_finding(error.diagnostic)
    else:
        finding = Finding("cannot-run", str(error).removeprefix(f"{path}: "), str(path))
    return CheckOutcome(
        program=str(path),
        verdict="alarm" if error.exit_code is ExitCode.ALARM else "error",
        exit_code=error.exit_code,
        findings=(finding, *differing),
    )


def _crashed(path: Path) -> CheckOutcome:
    message = "the twin has met a defect of its own, which says nothing about the program"
    text = f"{path}: error crash: {message}\n{traceback.format_exc().rstrip()}"
    return CheckOutcome(
        program=str(path),
        verdict="error",
        exit_code=ExitCode.CRASH,
        findings=(Finding("crash", message, str(path), text=text),),
    )


def _findings(preparation: Preparation, reasons: Iterable[Reason]) -> tuple[Finding, ...]:
    program, source = str(preparation.job.program), preparation.source
    return tuple(
        Finding(r.what, r.message, program, r.line, text=reason_text(r, source)) for r in reasons
    )


def _alarm_finding(preparation: Preparation, alarm: Alarm) -> Finding:
    return _diagnostic_finding(alarm_diagnostic(alarm, preparation.source))


def _diagnostic_finding(found: Diagnostic) -> Finding:
    return Finding(found.code, found.message, found.file, found.line, found.column, str(found))
