"""One program run for its verdict alone: no pictures, no recording, no part."""

import dataclasses
import json
import time
import traceback
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from twin.check.discovery import file_of
from twin.check.outcome import CheckOutcome, Finding
from twin.check.task import CheckSettings, JobVariant
from twin.compare.baseline import compare_baseline, write_baseline
from twin.compare.baseline_text import RunFigures
from twin.compare.verdict import Reason
from twin.errors import ConfigError, EmptyProgramError, ExitCode, TwinError, UsageError
from twin.files.toml_lines import place_of_key
from twin.nc.canonical import Chunk
from twin.nc.text.comments import comment_marks, without_comments
from twin.nc.text.diagnostics.diagnostics import Diagnostic, ProgramError
from twin.recording.alarms import Alarm
from twin.recording.reader import LONGEST_TEXT
from twin.run.judging.outcome import Outcome
from twin.run.messages import alarm_diagnostic, reason_text
from twin.run.preparing.preparation import Preparation, prepare
from twin.run.progress import no_progress
from twin.run.run import Run


def held_to_expectation(outcome: CheckOutcome, expected: str | None) -> CheckOutcome:
    """Pass a program that ended as its job expects, fail one that did not.

    Args:
        outcome: How it came out by itself.
        expected: The code that its job names, if any.
    """
    if expected is None or outcome.exit_code is ExitCode.CRASH:
        return outcome
    codes = {finding.code for finding in outcome.findings}
    if codes == {expected}:
        return dataclasses.replace(
            outcome, verdict="pass", exit_code=ExitCode.OK, findings=(), expected=expected
        )
    others = tuple(finding for finding in outcome.findings if finding.code != expected)
    if expected not in codes:
        happened = ", ".join(sorted(codes)) or "none"
        message = f"the job expects '{expected}', and it did not happen; what happened: {happened}"
        others = (Finding("expectation", message, outcome.program), *others)
    verdict = "fail" if outcome.passed else outcome.verdict
    code = ExitCode.FAILED if outcome.passed else outcome.exit_code
    return dataclasses.replace(outcome, verdict=verdict, exit_code=code, findings=others)


_FILES_OF_MACHINE = {"model"}
"""Keys of a machine file that name another file."""


def run_variant(variant: JobVariant, settings: CheckSettings) -> CheckOutcome:
    """Run a program and say how it came out; what is wrong with it becomes a finding."""
    began, path = time.perf_counter(), variant.path
    try:
        outcome = _checked(variant, settings)
    except TwinError as error:
        outcome = _not_run(path, error)
    except OSError as error:
        outcome = _not_run(path, UsageError(f"{error.filename or path}: {error.strerror or error}"))
    except MemoryError:
        outcome = _not_run(path, UsageError("not enough memory; a coarser stock.cell needs less"))
    except Exception:  # noqa: BLE001 - a defect at one program is reported with it, the others run on
        outcome = _crashed(path)
    return dataclasses.replace(outcome, wall_s=time.perf_counter() - began, changes=variant.changes)


def _checked(variant: JobVariant, settings: CheckSettings) -> CheckOutcome:
    preparation = prepare(
        variant.path,
        dialect=settings.dialect,
        machine=settings.machine,
        strict=settings.strict,
        changes=variant.changes,
    )
    outcome = _run(preparation, variant.path, settings)
    return held_to_expectation(outcome, preparation.job.file.expect)


def _run(preparation: Preparation, path: Path, settings: CheckSettings) -> CheckOutcome:
    try:
        run = Run(preparation)
        outcome = run.execute(None, no_progress)
    except (ProgramError, ConfigError) as error:
        if preparation.job.file.expect is not None:
            return _not_run(path, error)  # without moves there is nothing to store or to hold
        moves = preparation.interpretation().chunks()
        differing = _baseline_reasons(preparation, moves, None, settings)
        return _not_run(path, error, _findings(preparation, differing))
    if settings.reports is not None:
        from twin.compare.report.report import write_report
        from twin.run.results import report_of, result_of

        page = report_of(run, outcome, result_of(run, outcome))
        write_report(file_of(settings.reports, _path(preparation), ".html"), page)
    contour = outcome.figures.contour
    alarmed = outcome.verdict.outcome == "alarm"
    ended = not alarmed or preparation.job.file.expect is not None
    figures = _figures(outcome) if ended else None
    differing = _baseline_reasons(preparation, run.dry_run.program.chunks(), figures, settings)
    if any(found.code == "empty-program" for found in run.dry_run.warnings):
        raise EmptyProgramError(f"{path}: the program is empty: no line holds a block")
    failed = bool(differing) and not alarmed
    return CheckOutcome(
        program=str(path),
        verdict="fail" if failed else outcome.verdict.outcome,
        exit_code=ExitCode.FAILED if failed else outcome.verdict.exit_code,
        contour_um=contour.max if outcome.samples else None,
        worst_line=contour.worst_line,
        cycle_time_s=outcome.duration_s if outcome.samples else None,
        findings=(
            *(_alarm_finding(preparation, alarm) for alarm in outcome.alarms),
            *_findings(preparation, outcome.verdict.reasons[len(outcome.alarms) :]),
            *_findings(preparation, differing),
        ),
        warnings=tuple(_diagnostic_finding(found) for found in outcome.warnings),
        scope=tuple(outcome.scope.lines()),
    )


def _baseline_reasons(
    preparation: Preparation,
    chunks: Iterable[Chunk],
    figures: RunFigures | None,
    settings: CheckSettings,
) -> list[Reason]:
    """Hold the run to its baseline, or store it.

    Only a run that came to its end is stored, be that the alarm that its job expects.
    """
    if settings.baseline is None:
        return []
    file = file_of(settings.baseline, _path(preparation), ".baseline")
    axes, keys = preparation.machine.axes, _settings(preparation)
    if not settings.update_baseline:
        limits = preparation.job.file.baseline
        return compare_baseline(file, figures, axes, chunks, limits, keys, _source(preparation))
    if figures is not None:
        write_baseline(file, figures, axes, chunks, keys, _source(preparation))
    return []


def _path(preparation: Preparation) -> Path:
    return preparation.job.path or preparation.job.program


def _source(preparation: Preparation) -> list[str]:
    """The lines of the program without comments, blanks once; none of one that is too long to keep."""
    source, marks = preparation.source, comment_marks(preparation.dialect.syntax.comments)
    if source.lines.size > LONGEST_TEXT:
        return []
    text = source.text.encode("utf-8", "replace").decode("utf-8")
    return [" ".join(without_comments(line, marks)[0].split()) for line in text.split("\n")]


def _figures(outcome: Outcome) -> RunFigures:
    """What a baseline keeps of a run."""
    cut = outcome.cut
    figures = {}
    if cut is not None:
        figures = {
            "removed_mm3": cut.removed_mm3,
            **{f"tool.{tool}": mm3 for tool, mm3 in cut.removed_by_tool_mm3.items()},
            "air_share": cut.air_share,
            "gouges_count": float(len(cut.gouges)),
            "rapid_into_stock_count": float(len(cut.rapid_into_stock)),
            "spindle_off_count": float(len(cut.spindle_off)),
        }
    return RunFigures(outcome.duration_s, outcome.figures.contour.max, figures)


def _settings(preparation: Preparation) -> dict[str, str]:
    """The whole job and the machine as keys and texts, defaults and where program zero comes to lie with it."""
    file = preparation.job.file
    content = file.model_dump(mode="json", exclude={"program", "video"}, exclude_none=True)
    content["dialect"], content["machine"] = (
        preparation.dialect.name,
        _machine_keys(preparation),
    )
    content["tools"] = {str(tool.pop("number")): tool for tool in content["tools"]}
    if "stock" in content and "file" in content["stock"]:
        content["stock"]["file"] = Path(content["stock"]["file"]).name
    return dict(_flat("", content))


def _machine_keys(preparation: Preparation) -> dict[str, Any]:
    """What the machine file comes to, but for the files that it names, which lie anywhere."""
    keys = preparation.machine.file.model_dump(mode="json", exclude_none=True, by_alias=True)
    return {key: value for key, value in keys.items() if key not in _FILES_OF_MACHINE}


def _flat(key: str, value: Any) -> Iterator[tuple[str, str]]:
    if isinstance(value, dict):
        for name, inner in value.items():
            yield from _flat(f"{key}.{name}" if key else name, inner)
    else:
        yield key, json.dumps(value, ensure_ascii=False)


def _not_run(path: Path, error: TwinError, differing: tuple[Finding, ...] = ()) -> CheckOutcome:
    if isinstance(error, ProgramError):
        finding = _diagnostic_finding(error.diagnostic)
    else:
        finding = Finding("cannot-run", str(error).removeprefix(f"{path}: "), str(path))
    if isinstance(error, EmptyProgramError):
        empty = Finding("empty-program", finding.message, str(path))
        return CheckOutcome(
            program=str(path), verdict="empty", exit_code=ExitCode.FAILED, findings=(empty,)
        )
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
    return tuple(_finding(preparation, reason) for reason in reasons)


def _finding(preparation: Preparation, reason: Reason) -> Finding:
    job = preparation.job.path
    if reason.what == "baseline-job" and job is not None:
        key = reason.message.partition(" is ")[0]
        files = [layer.path for layer in preparation.job.layers if layer.path.is_file()]
        if key.startswith("machine."):
            files, key = [preparation.machine.path], key.removeprefix("machine.")
        file, line = place_of_key(files, key)
        text = f"{file}:{line}: error {reason.what}: {reason.message}"
        return Finding(reason.what, reason.message, str(file), line, text=text)
    program, text = str(preparation.job.program), reason_text(reason, preparation.source)
    return Finding(reason.what, reason.message, program, reason.line, text=text)


def _alarm_finding(preparation: Preparation, alarm: Alarm) -> Finding:
    return _diagnostic_finding(alarm_diagnostic(alarm, preparation.source))


def _diagnostic_finding(found: Diagnostic) -> Finding:
    return Finding(found.code, found.message, found.file, found.line, found.column, str(found))
