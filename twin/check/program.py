"""One program run for its verdict alone: no pictures, no files left behind."""

import dataclasses
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from twin.check.outcome import CheckOutcome, Finding
from twin.check.variation import Variant
from twin.compare.baseline import RunFigures, compare_baseline, write_baseline
from twin.compare.verdict import Reason
from twin.errors import ExitCode, TwinError
from twin.nc.canonical import Moves
from twin.nc.diagnostics import ProgramError
from twin.preparation import Preparation, prepare
from twin.progress import no_progress


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class CheckSettings:
    """How programs are checked.

    Attributes:
        machine: Overrides the jobs' machines.
        strict: Warnings of the interpreter are errors.
        baseline: Folder of the baselines that runs are held to, or None.
        update_baseline: Store baselines there instead of holding runs to them.
    """

    machine: str | None = None
    strict: bool = False
    baseline: Path | None = None
    update_baseline: bool = False


def check_program(path: Path, settings: CheckSettings) -> CheckOutcome:
    """Run a job or a program and say how it came out; what is wrong with it becomes a finding."""
    return check_variant(Variant(path, ()), settings)


def check_variant(variant: Variant, settings: CheckSettings) -> CheckOutcome:
    """The same with some values of the job or the machine changed."""
    began, path = time.perf_counter(), variant.path
    try:
        outcome = _run(variant, settings)
    except TwinError as error:
        outcome = CheckOutcome(
            program=str(path),
            verdict="alarm" if error.exit_code is ExitCode.ALARM else "error",
            exit_code=error.exit_code,
            findings=(_finding_of(error, path),),
        )
    return dataclasses.replace(outcome, wall_s=time.perf_counter() - began, changes=variant.changes)


def baseline_file(folder: Path, path: Path) -> Path:
    """Where the baseline of a program lies: in the folder, under the program's own path.

    A path is taken relative to the working folder where it lies below that, so that a baseline is
    found again from another checkout.
    """
    resolved = path.resolve()
    here = Path.cwd().resolve()
    parts = (
        resolved.relative_to(here) if resolved.is_relative_to(here) else Path(*resolved.parts[1:])
    )
    return folder / parts.with_suffix(".baseline")


def _run(variant: Variant, settings: CheckSettings) -> CheckOutcome:
    from twin.chain import Run

    path = variant.path
    preparation = prepare(
        path, machine=settings.machine, strict=settings.strict, changes=variant.changes
    )
    run = Run(preparation)
    survey = run.survey()
    with tempfile.TemporaryDirectory(prefix="twin-check-") as folder:
        outcome = run.execute(survey, Path(folder), no_progress)
    figures = RunFigures(outcome.duration_s, outcome.figures.contour.max)
    reasons = list(outcome.verdict.reasons)
    verdict, exit_code = outcome.verdict.outcome, outcome.verdict.exit_code
    if settings.baseline is not None and verdict != "alarm":
        differing = _hold_to_baseline(path, preparation, figures, settings, settings.baseline)
        if differing:
            reasons += differing
            verdict, exit_code = "fail", ExitCode.FAILED
    contour = outcome.figures.contour
    return CheckOutcome(
        program=str(path),
        verdict=verdict,
        exit_code=exit_code,
        contour_um=contour.max,
        worst_line=contour.worst_line,
        cycle_time_s=outcome.duration_s,
        findings=tuple(
            Finding(reason.what, reason.message, str(preparation.job.program), reason.line)
            for reason in reasons
        ),
    )


def _hold_to_baseline(
    path: Path, preparation: Preparation, figures: RunFigures, settings: CheckSettings, folder: Path
) -> list[Reason]:
    file = baseline_file(folder, path)
    if settings.update_baseline:
        write_baseline(file, figures, _moves(preparation))
        return []
    return compare_baseline(file, figures, _moves(preparation), preparation.job.file.baseline)


def _moves(preparation: Preparation) -> Iterator[Moves]:
    for chunk in preparation.interpretation().chunks():
        yield chunk.moves


def _finding_of(error: TwinError, path: Path) -> Finding:
    if isinstance(error, ProgramError):
        found = error.diagnostic
        return Finding(
            found.code, found.message, found.file, found.line, found.column, text=str(found)
        )
    return Finding("cannot-run", str(error), str(path))
