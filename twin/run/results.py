"""``result.json`` and ``report.html`` of a run."""

import dataclasses
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from twin.compare.result import RunSummary, result, write_result
from twin.cutting.forces.materials import kienzle
from twin.job.job_file import StockTable
from twin.run.judging.outcome import Outcome
from twin.run.run import Run
from twin.run.run_folder import VERDICT_FILES

if TYPE_CHECKING:
    from twin.compare.report.report import Report

STILL_NAME = "still.png"
"""Picture of a run's end."""
ALARM_STILL_NAME = "collision.png"
"""Picture of the moment at which two things met."""
RESULT_FILES = (*VERDICT_FILES, "recording.h5", "video.mp4", STILL_NAME, ALARM_STILL_NAME)
"""What a run may leave; an earlier run's files of these names are removed when one begins.

The result, written last, is removed first: where it is, everything that it speaks of is whole.
"""


def write_results(
    run: Run, outcome: Outcome, folder: Path, further: Mapping[str, Any] = MappingProxyType({})
) -> None:
    """Write the verdict and every figure behind it, for programs and for people.

    Args:
        folder: Where the files go; stills that were drawn there are put on the page.
        further: Additional keys of ``result.json``.
    """
    # Its plots load Matplotlib, which is not waited for before a run.
    from twin.compare.report.report import write_report

    content = {**result_of(run, outcome), **further}
    moments = [
        (
            f"Line {alarm.line}, {alarm.time_s:.3f} s: the moment of the alarm",
            folder / ALARM_STILL_NAME,
        )
        for alarm in outcome.alarms[:1]
    ]
    drawn = [*moments, ("The end of the run", folder / STILL_NAME)]
    stills = [(title, path) for title, path in drawn if path.is_file()]
    write_report(folder / "report.html", report_of(run, outcome, content, stills))
    write_result(folder / "result.json", content)


def result_of(run: Run, outcome: Outcome) -> dict[str, Any]:
    """The content of ``result.json``."""
    tolerance = run.preparation.job.file.tolerance
    return result(
        _summary(run, outcome), outcome.figures, tolerance, outcome.verdict, outcome.alarms
    )


def report_of(
    run: Run,
    outcome: Outcome,
    content: Mapping[str, Any],
    stills: Sequence[tuple[str, Path]] = (),
) -> "Report":
    """What the page about a run is made of.

    Args:
        content: The content of ``result.json``.
        stills: Pictures for the page, with what each shows.
    """
    from twin.compare.report.report import Report

    return Report(
        header=run.header(),
        source=run.preparation.source.lines,
        figures=outcome.figures,
        verdict=outcome.verdict,
        tolerance=run.preparation.job.file.tolerance,
        trace=outcome.trace,
        result=content,
        scope=tuple(outcome.scope.lines()),
        warnings=tuple((found.line, found.code, found.message) for found in outcome.warnings),
        stills=stills,
        part=outcome.part,
    )


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
        scope=outcome.scope.as_json(),
        tools=[use.as_json() for use in outcome.tools],
        cut=_cut(outcome, preparation.job.file.stock),
        commanded=named(outcome.final_commanded),
        simulated=named(outcome.final_simulated),
    )


def _cut(outcome: Outcome, stock: StockTable | None) -> dict[str, Any] | None:
    """The object ``cut`` of ``result.json``."""
    if outcome.cut is None:
        return None
    gouge = None if outcome.gouge is None else outcome.gouge.as_json()
    cut = {
        **outcome.cut.as_json(),
        "nominal_gouge": gouge,
        "nominal": None,
        "force_simulated": False,
        "loads": [],
    }
    if outcome.inspection is not None:
        cut["nominal"] = outcome.inspection.as_json()
    material = None if stock is None or outcome.cut.force_n is None else kienzle(stock)
    if stock is not None and material is not None:
        cut["material"] = {
            "name": stock.material or "own constants",
            **dataclasses.asdict(material),
        }
    greatest = {name: each.value for name, each in outcome.loads.greatest.items()}
    if greatest:
        cut |= greatest | {"force_simulated": True, "loads": outcome.loads.as_json()}
    return cut
