"""``result.json`` and ``report.html`` of a run."""

import dataclasses
from pathlib import Path

from twin.chain import Run
from twin.commands.pictures import STILL_NAME
from twin.compare.report import Report, write_report
from twin.compare.result import RunSummary, result, write_result
from twin.outcome import Outcome


def write_results(run: Run, outcome: Outcome, folder: Path) -> None:
    """Write the verdict and every figure behind it, for programs and for people.

    Args:
        run: The run.
        outcome: What it came to.
        folder: Where the files go; a still that was drawn there is put on the page.
    """
    preparation = run.preparation
    tolerance = preparation.job.file.tolerance
    content = result(
        _summary(run, outcome), outcome.figures, tolerance, outcome.verdict, outcome.alarms
    )
    still = folder / STILL_NAME
    page = Report(
        header=run.header(),
        figures=outcome.figures,
        verdict=outcome.verdict,
        tolerance=tolerance,
        trace=run.trace,
        result=content,
        stills=[("The end of the run", still)] if still.is_file() else [],
    )
    write_report(folder / "report.html", page)
    write_result(folder / "result.json", content)


def _summary(run: Run, outcome: Outcome) -> RunSummary:
    preparation = run.preparation
    named = preparation.machine.axes.named
    return RunSummary(
        program=preparation.source.name,
        dialect=preparation.dialect.name,
        machine=preparation.machine.file.name,
        duration_s=outcome.duration_s,
        wall_s=run.clock.wall_s,
        stages={f"{name}_s": seconds for name, seconds in run.clock.seconds.items()},
        near_miss=None if outcome.near_miss is None else dataclasses.asdict(outcome.near_miss),
        cut=None if outcome.cut is None else outcome.cut.as_json(),
        commanded=named(outcome.final_commanded),
        simulated=named(outcome.final_simulated),
    )
