"""What a run came to, judged: what result.json, the report and the exit code are made of."""

import dataclasses
from collections.abc import Iterator

from twin.compare.figures import Figures
from twin.compare.verdict import Check, Reason, Verdict, judge
from twin.cutting.cut import CutResult
from twin.cutting.forces.load_log import LoadLog
from twin.cutting.inspection import Inspection
from twin.cutting.nominal import NominalGouge
from twin.cutting.program_summary import ProgramSummary
from twin.errors import ConfigError
from twin.job.job_file import JobFile, ToleranceTable
from twin.machine.watching.alarms import Alarm, NearMiss
from twin.nc.canonical import FloatArray
from twin.nc.text.diagnostics import Diagnostic
from twin.run.cut_notices import (
    cut_notices,
    tolerance_notices,
    tooth_feed_notices,
    unjudged_limit_notices,
)
from twin.run.dry_run import DryRun
from twin.run.machining import Machining
from twin.run.messages import Notice, shown
from twin.run.observers import Reached, ToolUse
from twin.run.preparation import Preparation
from twin.run.scope import Scope, nothing_judged, scope_of
from twin.units import UM_PER_MM


@dataclasses.dataclass(frozen=True, kw_only=True)
class Outcome:
    """What a run came to.

    Attributes:
        verdict: Pass, fail or alarm, with the reasons.
        figures: Following and contour error.
        cut: What was cut; None without a stock.
        gouge: The deepest cut into the nominal part, beyond what the job allows.
        inspection: How far the part is from the nominal one; None without one.
        loads: The greatest of what the tools bore.
        alarms: Alarms of the machine, in order.
        near_miss: The closest that the tool's side and the part's came, below the machine's limit.
        warnings: Those of the interpreter, of the program and of the cut.
        scope: What the verdict looked at.
        tools: Those that were in the spindle, with their times and what they took off.
        part: A picture of the part as it was cut, PNG; empty without a stock.
        samples: How many samples were recorded, settling included.
        duration_s: Machine time of the program, settling not counted [s].
        final_commanded: Program coordinates at the end, shape (k,) [mm or deg].
        final_simulated: Program coordinates of the simulated joints at the end, shape (k,)
            [mm or deg].
    """

    verdict: Verdict
    figures: Figures
    cut: CutResult | None
    gouge: NominalGouge | None
    inspection: Inspection | None
    loads: LoadLog
    alarms: tuple[Alarm, ...]
    near_miss: NearMiss | None
    warnings: tuple[Diagnostic, ...]
    scope: Scope
    tools: tuple[ToolUse, ...] = ()
    part: bytes = b""
    samples: int
    duration_s: float
    final_commanded: FloatArray
    final_simulated: FloatArray


@dataclasses.dataclass(frozen=True, kw_only=True)
class Findings:
    """What those who followed a run have found.

    Attributes:
        reached: How far it came.
        figures: Following and contour error.
        machining: The cut.
        cut: What the cut came to; None without a stock.
        loads: The greatest of what the tools bore.
        tools: Those that were in the spindle.
        inspection: How far the part is from the nominal one; None without one.
        alarms: Alarms of the machine, in order.
        near_miss: The closest that the tool's side and the part's came.
        planned_s: Machine time of the program as planned [s]; None where nobody planned ahead.
        forces: Whether the force of the cut was simulated.
        floats: Why nothing carries the stock; None where something does.
        part: A picture of the part, PNG; empty where there is none.
    """

    reached: Reached
    figures: Figures
    machining: Machining
    cut: CutResult | None
    loads: LoadLog
    tools: tuple[ToolUse, ...]
    inspection: Inspection | None
    alarms: tuple[Alarm, ...]
    near_miss: NearMiss | None
    planned_s: float | None
    forces: bool
    floats: str | None
    part: bytes


def outcome_of(preparation: Preparation, dry_run: DryRun, found: Findings) -> Outcome:
    """Judge what was run, with what was looked at.

    Args:
        preparation: What was asked for.
        dry_run: What the program does.
        found: What happened.
    """
    job, reached, alarms = preparation.job, found.reached, found.alarms
    figures = _as_shown(found.figures, dry_run.summary)
    duration_s = min(found.planned_s or reached.last_motion_s, reached.time_s)
    checks = [
        *_nominal_checks(job.file, found.machining.gouge, found.inspection),
        *_load_checks(job.file.tolerance, found.loads),
    ]
    judged = judge(figures, job.file.tolerance, alarms, cycle_time_s=duration_s, more=checks)
    blind = () if alarms else tuple(_unjudged(preparation, judged, dry_run, figures))
    notices = [] if alarms else list(_notices(preparation, dry_run, found))
    failing = [
        Reason(each.code, each.message, each.line, 0.0)
        for each in (notices if preparation.settings.strict else ())
    ]
    scope = scope_of(
        job, dry_run, judged.checks, found.cut, forces=found.forces, unjudged=blind, alarms=alarms
    )
    return Outcome(
        verdict=judged.with_more([*failing, *blind]),
        figures=figures,
        cut=found.cut,
        gouge=found.machining.gouge,
        inspection=found.inspection,
        loads=found.loads,
        alarms=alarms,
        near_miss=found.near_miss,
        warnings=(*dry_run.warnings, *shown(notices, preparation.source, strict=False)),
        scope=scope,
        tools=found.tools,
        part=found.part,
        samples=reached.samples,
        duration_s=duration_s,
        final_commanded=reached.commanded,
        final_simulated=reached.simulated,
    )


def refuse_unjudged_loads(tolerance: ToleranceTable) -> None:
    """A tolerance on what nobody simulates would pass unseen.

    Raises:
        ConfigError: There is one.
    """
    for key, (figure, _) in _LOADS.items():
        if getattr(tolerance, key) is not None:
            raise ConfigError(
                f"tolerance.{key}: the {figure} is not simulated in this job, or not everywhere; it needs a "
                '[stock] with a material, a spindle speed wherever it is cut, and cutting_force = "teeth"'
            )


def _unjudged(
    preparation: Preparation, judged: Verdict, dry_run: DryRun, figures: Figures
) -> Iterator[Reason]:
    """What was asked for and judged nothing."""
    job = preparation.job
    if not dry_run.moves:
        yield Reason("nothing-moves", "the program makes no move", 0, 0.0)
    else:
        yield from nothing_judged(job.file.tolerance, judged.checks, job.tolerances_from, figures)


def _notices(preparation: Preparation, dry_run: DryRun, found: Findings) -> Iterator[Notice]:
    """Warnings about a run that came to its end."""
    job, watch = preparation.job.file, dry_run.watch
    if found.cut is not None:
        yield from cut_notices(job, watch, found.machining, found.cut)
    elif watch.spindle_line and watch.first_feed and job.stock is None:
        message = "the spindle turns, and the job has no [stock]: nothing that is cut is judged"
        yield Notice("no-stock", watch.spindle_line, message)
    if found.floats is not None:
        yield Notice("stock-floats", 0, f"nothing carries the stock: {found.floats}")
    yield from tolerance_notices(job.tolerance, len(preparation.source.lines))
    if not found.forces:
        yield from tooth_feed_notices(watch, found.cut)
        yield from unjudged_limit_notices(job, watch)


def _nominal_checks(
    job: JobFile, gouge: NominalGouge | None, inspection: Inspection | None
) -> Iterator[Check]:
    nominal = job.nominal
    if nominal is None:
        return
    if nominal.gouge == "fail":
        depth, line, when = (0.0, 0, 0.0)
        if gouge is not None:
            depth, line, when = gouge.depth_mm * UM_PER_MM, gouge.line, gouge.time_s
        figure = "gouge into the nominal part"
        yield Check("gouge_um", figure, depth, nominal.gouge_um, "µm", line, when)
    if nominal.standing_um is not None and inspection is not None:
        figure = "material left on the nominal part"
        left = inspection.most_standing_mm * UM_PER_MM
        bound = f" (walls are known to {inspection.bound_mm * UM_PER_MM:.0f} µm)"
        yield Check("standing_um", figure, left, nominal.standing_um, "µm", 0, 0.0, bound)


_LOADS = {
    "force_n": ("cutting force", "N"),
    "power_w": ("power of the cut", "W"),
    "deflection_um": ("deflection of the tool", "µm"),
    "chip_mm": ("chip thickness", "mm"),
}
"""What a tolerance on a load is called, and its unit."""


def _load_checks(tolerance: ToleranceTable, loads: LoadLog) -> Iterator[Check]:
    for key, (figure, unit) in _LOADS.items():
        limit, most = getattr(tolerance, key), loads.greatest.get(key)
        if limit is not None and most is not None:
            yield Check(key, figure, most.value, limit, unit, most.line, most.time_s)


def _as_shown(figures: Figures, summary: ProgramSummary) -> Figures:
    """Figures whose positions are those of the control's screen."""
    screen = summary.shown
    if screen is None:
        return figures
    worst = tuple(
        dataclasses.replace(place, position=place.position + screen.at(place.move))
        for place in figures.worst
    )
    return dataclasses.replace(figures, worst=worst)
