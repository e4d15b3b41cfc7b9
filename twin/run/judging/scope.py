"""What a verdict looked at: watched, not watched and why, and where its tolerances come from."""

import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from twin.compare.figures import Figures
from twin.compare.verdict import Check
from twin.cutting.measuring.inspection import Inspection
from twin.cutting.watching.cut_log import TRI_DEXEL, CutResult
from twin.job.job_file import JobFile
from twin.job.load import DEFAULT
from twin.machine.description.config import MachineConfig
from twin.nc.control.settings import ControlSettings
from twin.recording.alarms import Alarm
from twin.run.dry_run.dry_run import DryRun
from twin.run.dry_run.program_watch import ProgramWatch
from twin.run.preparing.preparation import Preparation
from twin.run.reading.assumed_reading import UNKNOWN_FUNCTION

DRIVES = "travel, limit switches, following error and force of every axis"
COLLISIONS = "tool, holder, spindle and head against fixtures and machine; the table's load against the machine"
STOCK = "rapids, standing spindle, shank, holder and head in the stock"
FORCES = "force, chip, deflection and breakage of tools, load of the spindle"
WALLS = "cuts into the nominal part"


@dataclasses.dataclass(frozen=True, slots=True)
class Unwatched:
    """Something that the verdict does not cover."""

    what: str
    why: str


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class VerdictScope:
    """What a verdict looked at.

    Attributes:
        watched: What was watched, and every figure that was held to a tolerance.
        stock: What described the material, ``height map`` or ``tri-dexel``; None without a stock.
        removed_mm3: Material taken off [mm³]; None without a stock.
        air_share: Share of the feed path that met no material; None without a stock.
        tools_unused: Numbers of tools that the job lists and no move used.
        lines_never_run: How many lines with words of axes were never come to.
        nominal: How far the part is from the nominal one, and how much of it was measured; None without one.
        assumed: What was assumed of a raw program, its stock and tools among it.
        tolerances_from: Where each tolerance is set: a file, or ``default``.
        tolerances: What each of them allows, in the unit that its key names.
    """

    watched: tuple[str, ...]
    not_watched: tuple[Unwatched, ...]
    stock: str | None
    removed_mm3: float | None
    air_share: float | None
    tools_unused: tuple[int, ...]
    lines_never_run: int
    nominal: str | None
    assumed: tuple[str, ...]
    tolerances_from: Mapping[str, str]
    tolerances: Mapping[str, float]

    def as_json(self) -> dict[str, Any]:
        """The object ``scope`` of ``result.json``."""
        return dataclasses.asdict(self)

    def lines(self) -> Iterator[str]:
        """The scope for a person."""
        yield f"watched: {'; '.join(self.watched)}"
        for each in self.not_watched:
            yield f"not watched: {each.what}: {each.why}"
        if self.removed_mm3 is not None:
            air = (
                "" if self.air_share is None else f", {self.air_share:.1%} of the feed path in air"
            )
            sides = ", from several sides" if self.stock == TRI_DEXEL else ""
            yield f"cut: {self.removed_mm3:,.1f} mm³{air}{sides}"
        if self.nominal is not None:
            yield self.nominal
        if self.tools_unused:
            yield f"tools never used: {', '.join(map(str, self.tools_unused))}"
        if self.lines_never_run:
            yield f"lines with motion never run: {self.lines_never_run}"
        if self.assumed:
            yield f"assumed: {'; '.join(self.assumed)}"
        sources = (
            f"{key} = {self.tolerances[key]:.15g} from {place}"
            if key in self.tolerances
            else f"{key} from {place}"
            for key, place in self.tolerances_from.items()
        )
        yield f"tolerances: {', '.join(sources)}"


def scope_of(
    preparation: Preparation,
    dry_run: DryRun,
    checks: Sequence[Check],
    cut: CutResult | None,
    *,
    forces: bool,
    unjudged: Sequence[Unwatched],
    stopped: Alarm | None,
    inspection: Inspection | None,
) -> VerdictScope:
    """Put the scope of a run together.

    Args:
        cut: What was cut; None without a stock.
        forces: Whether the force of the cut was simulated.
        unjudged: What was asked for and judged nothing.
        stopped: The alarm that ended the run before its end; None: it came to it.
        inspection: How far the part is from the nominal one; None without one.
    """
    job, file, watch = preparation.job, preparation.job.file, dry_run.watch
    watched = [DRIVES, COLLISIONS]
    watched += [STOCK] if file.stock is not None else []
    watched += [FORCES] if forces else []
    watched += [WALLS] if file.nominal is not None else []
    watched += sorted({check.what for check in checks})
    blind = (
        *_without_limits(preparation.machine, forces=forces),
        *_blind(file, forces=forces),
        *(_silent_spindle(file, watch)),
        *_unknown_functions(file),
        *_never_read(preparation.settings),
        *_expected(file),
        *unjudged,
        *_never_run(stopped),
    )
    unused = (tool.number for tool in file.tools if tool.number not in watch.tools_used)
    listed = "tools" in file.model_fields_set
    return VerdictScope(
        watched=tuple(watched),
        not_watched=blind,
        stock=None if cut is None else cut.stock,
        removed_mm3=None if cut is None else cut.removed_mm3,
        air_share=None if cut is None else cut.air_share,
        tools_unused=tuple(unused) if listed else (),
        lines_never_run=dry_run.lines_never_run,
        nominal=None if inspection is None else inspection.summary,
        assumed=preparation.assumptions,
        tolerances_from=job.tolerances_from,
        tolerances={
            key: value
            for key, value in file.tolerance.model_dump(exclude_none=True).items()
            if key in job.tolerances_from and isinstance(value, int | float)
        },
    )


def _without_limits(machine: MachineConfig, *, forces: bool) -> Iterator[Unwatched]:
    """Limits that the machine file does not give, so that nothing is held to them."""
    axes = {name: machine.axis(name) for name in machine.axes.names}
    for what, key in (("following error", "following_error_limit"), ("force", "force_limit")):
        names = [name for name, axis in axes.items() if not getattr(axis, key)]
        if names:
            yield Unwatched(f"{what} of {', '.join(names)}", f"the machine file gives no {key}")
    endless = [name for name, axis in axes.items() if axis.kind == "linear" and not axis.travel]
    if endless:
        yield Unwatched(f"travel of {', '.join(endless)}", "the machine file gives no travel")
    if forces and not machine.file.spindle.power:
        yield Unwatched("load of the spindle", "the machine file gives no spindle.power")


def _unknown_functions(job: JobFile) -> Iterator[Unwatched]:
    """M codes of a raw program that were taken to do nothing."""
    unknown = [name for name, table in job.m_functions.items() if table.meaning == UNKNOWN_FUNCTION]
    if unknown:
        yield Unwatched(", ".join(unknown), UNKNOWN_FUNCTION)


def _never_read(settings: ControlSettings) -> Iterator[Unwatched]:
    """Values that the job gives the program, and that it never asked for."""
    for table, names in settings.never_read.items():
        yield Unwatched(f"{table} {', '.join(names)}", "the program never asks for them")


def _never_run(stopped: Alarm | None) -> Iterator[Unwatched]:
    if stopped is None:
        return
    if stopped.time_s:
        yield Unwatched(f"all behind line {stopped.line}", "the alarm ended the run")
    else:
        yield Unwatched("every line", "the alarm was raised before anything moved")


def _expected(job: JobFile) -> Iterator[Unwatched]:
    if job.expect is not None:
        yield Unwatched(f"expect = {job.expect!r}", "twin check holds the end of a job to it")


def _blind(job: JobFile, *, forces: bool) -> Iterator[Unwatched]:
    if job.stock is None:
        yield Unwatched("stock, forces and walls", "the job has no [stock]")
        return
    if not forces:
        yield Unwatched(FORCES, _why_no_forces(job))
    if job.nominal is None:
        yield Unwatched(WALLS, "the job has no [nominal]")
    elif job.nominal.standing_um is None:
        yield Unwatched("material left on the nominal part", "the job has no nominal.standing_um")


def _silent_spindle(job: JobFile, watch: ProgramWatch) -> Iterator[Unwatched]:
    if job.stock is not None and watch.taken_to_turn:
        why = "the program never starts it, so that it is taken to turn"
        yield Unwatched("a standing spindle", why)


def _why_no_forces(job: JobFile) -> str:
    assert job.stock is not None
    if job.stock.material is None:
        return "the stock has no material"
    if job.cutting_force != "teeth":
        return f'cutting_force is "{job.cutting_force}"'
    if job.stock.lies:
        return "of a blank that lies no force is simulated tooth by tooth"
    return "neither program nor job says how fast the spindle turns"


def nothing_judged(
    job: JobFile, checks: Sequence[Check], asked: Mapping[str, str], figures: Figures
) -> Iterator[Unwatched]:
    """Tolerances that the job asks for and that no check was made of.

    Args:
        asked: Where each key is set; a default was not asked for.
    """
    judged, nominal = {check.what for check in checks}, job.nominal
    if nominal is not None and nominal.standing_um is not None and "standing_um" not in judged:
        yield Unwatched("standing_um", "no surface of the part could be measured")
    for key, place in asked.items():
        if key not in judged and key != "blocks" and place != DEFAULT:
            yield Unwatched(key, _WHY.get(key, _NO_FIGURE))
    for number, part in enumerate(job.tolerance.blocks):
        first, last = part.lines
        key = f"blocks[{number}].contour_um"
        if key not in judged and figures.samples:
            yield Unwatched(key, f"no move is in lines {first} to {last}")


_NO_FIGURE = "the run holds nothing that it could be held against"
_WHY = {
    "circular_deviation_um": "the program has no arc of 90 degrees or more with the table at rest",
    "corner_um": "the program has no corner",
    "rapid_contour_um": "the program has no rapid",
    "direction_mdeg": "no axis tilts the tool against the part",
    "contour_um": "nothing moves, or other tolerances hold for every line",
    "force_n": "no tool cut",
    "power_w": "no tool cut",
    "deflection_um": "no tool cut",
    "chip_mm": "no tool cut",
}
