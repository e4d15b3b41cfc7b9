"""The outcome of a run, from which result.json, the report and the exit code are made."""

import dataclasses
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from twin.compare.figures import Figures
from twin.compare.trace import Trace
from twin.compare.verdict import Check, Reason, Verdict, judge
from twin.cutting.forces.load_log import LoadLog
from twin.cutting.measuring.inspection import Inspection
from twin.cutting.measuring.nominal import NominalGouge
from twin.cutting.program_summary import ProgramSummary
from twin.cutting.watching.cut_log import CutResult
from twin.errors import ConfigError
from twin.job.job_file import JobFile
from twin.job.tolerance import ToleranceTable
from twin.nc.canonical import FloatArray
from twin.nc.text.diagnostics.diagnostics import Diagnostic
from twin.recording.alarms import Alarm, NearMiss
from twin.recording.reader import RecordingWriter
from twin.run.dry_run.dry_run import DryRun
from twin.run.dry_run.program_watch import ProgramWatch
from twin.run.judging.cut_notices import (
    cut_notices,
    lost_length_notices,
    nominal_notices,
    tolerance_notices,
    tooth_feed_notices,
    unjudged_limit_notices,
)
from twin.run.judging.scope import Unwatched, VerdictScope, nothing_judged, scope_of
from twin.run.machining import Machining
from twin.run.messages import Notice, shown
from twin.run.observers import (
    Compared,
    Loads,
    Observer,
    Reached,
    Recorded,
    ToolTimes,
    ToolUse,
    Traced,
)
from twin.run.pipeline import MachineMotion
from twin.run.preparing.preparation import Preparation
from twin.units import UM_PER_MM


@dataclasses.dataclass(frozen=True, kw_only=True)
class Outcome:
    """The outcome of a run.

    Attributes:
        cut: What was cut; None without a stock.
        gouge: The deepest cut into the nominal part, beyond what the job allows.
        inspection: How far the part is from the nominal one; None without one, and where an alarm stopped the run.
        loads: The greatest of what the tools bore.
        near_miss: The closest that the tool's side and the part's came, below the machine's limit.
        warnings: Those of the interpreter, of the program and of the cut.
        trace: The run thinned for plots.
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
    scope: VerdictScope
    trace: Trace
    tools: tuple[ToolUse, ...] = ()
    part: bytes = b""
    samples: int
    duration_s: float
    final_commanded: FloatArray
    final_simulated: FloatArray


class Followers(NamedTuple):
    """All that follow a run, in the order in which they see it."""

    machining: Machining
    reached: Reached
    loads: Loads
    compared: Compared
    traced: Traced
    tools: ToolTimes

    def in_order(self, writer: RecordingWriter | None) -> list[Observer]:
        """They, and the recording at their end if one is written."""
        return [*self, *([] if writer is None else [Recorded(writer)])]


def outcome_of(
    preparation: Preparation,
    dry_run: DryRun,
    followers: Followers,
    motion: MachineMotion | None,
    alarms: tuple[Alarm, ...],
    floats: str | None,
) -> Outcome:
    """Judge what was run, with what was looked at.

    Args:
        motion: What moved the machine; None: nothing did.
        floats: Why nothing carries the stock; None where something does.
    """
    job, reached, machining = preparation.job, followers.reached, followers.machining
    cut = machining.result() if reached.samples else None
    stopped = next((alarm for alarm in alarms if alarm.stops), None)
    # What never ran has left material: only a part that is finished is measured.
    inspection = machining.inspect() if reached.samples and stopped is None else None
    loads, planned_s = followers.loads.result(), None if motion is None else motion.planned_s
    figures = _as_shown(followers.compared.result(), dry_run.summary)
    duration_s = min(planned_s or reached.last_motion_s, reached.time_s)
    checks = [
        *_nominal_checks(job.file, machining.gouge, inspection),
        *_load_checks(job.file.tolerance, loads),
    ]
    judged = judge(figures, job.file.tolerance, alarms, cycle_time_s=duration_s, more=checks)
    forces = motion is not None and motion.process is not None
    blind, notices = (), []
    if not alarms:
        if dry_run.moves:
            asked = job.tolerances_from
            blind = tuple(nothing_judged(job.file, judged.checks, asked, figures))
        notices = [
            *_notices(preparation, dry_run, machining, cut, loads, floats),
            *(() if forces else _unsimulated_notices(job.file, dry_run.watch, cut)),
        ]
    failing = [
        Reason(each.code, each.message, each.line, 0.0)
        for each in (notices if preparation.settings.strict else ())
    ]
    still = not (alarms or dry_run.moves)
    return Outcome(
        verdict=judged.with_more([*failing, *_blind_reasons(blind, still=still)]),
        figures=figures,
        cut=cut,
        gouge=machining.gouge,
        inspection=inspection,
        loads=loads,
        alarms=alarms,
        near_miss=_near_miss(motion, reached.time_s),
        warnings=(*dry_run.warnings, *shown(notices, preparation.source, strict=False)),
        scope=scope_of(
            preparation,
            dry_run,
            judged.checks,
            cut,
            forces=forces,
            unjudged=blind,
            stopped=stopped,
            inspection=inspection,
        ),
        trace=followers.traced.result(),
        tools=followers.tools.result(cut),
        samples=reached.samples,
        duration_s=duration_s,
        final_commanded=reached.commanded,
        final_simulated=reached.simulated,
    )


def _near_miss(motion: MachineMotion | None, until_s: float) -> NearMiss | None:
    """The closest approach, unless the machine was stepped on to it behind what stopped the run."""
    found = None if motion is None else motion.near_miss
    return None if found is None or found.time_s > until_s else found


def refuse_unjudged_loads(tolerance: ToleranceTable) -> None:
    """Refuse tolerances on loads that are not simulated: they would always pass.

    Raises:
        ConfigError: There is one.
    """
    for key, (figure, _) in LOAD_FIGURES.items():
        if getattr(tolerance, key) is not None:
            raise ConfigError(
                f"tolerance.{key}: the {figure} is not simulated in this job, or not everywhere; it needs a "
                '[stock] with a material, a spindle speed wherever it is cut, and cutting_force = "teeth"'
            )


def _blind_reasons(blind: Sequence[Unwatched], *, still: bool) -> Iterator[Reason]:
    """Why a run does not pass in which nothing moved, or something that was asked for judged nothing."""
    if still:
        yield Reason("nothing-moves", "the program makes no move", 0, 0.0)
    for each in blind:
        yield Reason(each.what, f"{each.what} has judged nothing: {each.why}", 0, 0.0)


def _notices(
    preparation: Preparation,
    dry_run: DryRun,
    machining: Machining,
    cut: CutResult | None,
    loads: LoadLog,
    floats: str | None,
) -> Iterator[Notice]:
    """Warnings about a run that came to its end."""
    job, watch = preparation.job.file, dry_run.watch
    if cut is not None:
        yield from cut_notices(job, dry_run, machining, cut, loads)
        yield from lost_length_notices(dry_run.fed_without_length, cut)
    elif watch.spindle_line and watch.first_feed and job.stock is None:
        message = "the spindle turns, and the job has no [stock]: nothing that is cut is judged"
        yield Notice("no-stock", watch.spindle_line, message)
    if floats is not None:
        yield Notice("stock-floats", 0, f"nothing carries the stock: {floats}")
    yield from nominal_notices(job)
    yield from tolerance_notices(job.tolerance, len(preparation.source.lines), preparation.machine)


def _unsimulated_notices(
    job: JobFile, watch: ProgramWatch, cut: CutResult | None
) -> Iterator[Notice]:
    """What only a simulated force would show."""
    yield from tooth_feed_notices(watch, cut)
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
    if nominal.standing_um is not None and inspection is not None and inspection.measured.any():
        figure = "material left on the nominal part"
        left = inspection.most_standing_mm * UM_PER_MM
        bound = (
            f" ({inspection.measured_share:.1%} measured, walls are known to "
            f"{inspection.bound_mm * UM_PER_MM:.0f} µm)"
        )
        yield Check("standing_um", figure, left, nominal.standing_um, "µm", 0, 0.0, bound)


LOAD_FIGURES = {
    "force_n": ("cutting force", "N"),
    "power_w": ("power of the cut", "W"),
    "deflection_um": ("deflection of the tool", "µm"),
    "chip_mm": ("chip thickness", "mm"),
}
"""What a tolerance on a load is called, and its unit."""


def _load_checks(tolerance: ToleranceTable, loads: LoadLog) -> Iterator[Check]:
    for key, (figure, unit) in LOAD_FIGURES.items():
        limit, most = getattr(tolerance, key), loads.greatest.get(key)
        if limit is not None and most is not None:
            yield Check(key, figure, most.value, limit, unit, most.line, most.time_s)


def _as_shown(figures: Figures, summary: ProgramSummary) -> Figures:
    """Figures whose positions are those of the control's screen."""
    worst = tuple(
        dataclasses.replace(place, position=summary.shown(place.move, place.position))
        for place in figures.worst
    )
    return dataclasses.replace(figures, worst=worst)
