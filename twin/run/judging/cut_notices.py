"""Warnings about a finished run: cuts of air, mistakes in the material, unjudged limits."""

import math
from collections.abc import Iterator

from twin.cutting.forces.load_log import LoadLog
from twin.cutting.watching.cut_log import CutResult
from twin.cutting.watching.cut_watch import CutSlip
from twin.job.job_file import JobFile, ToolTable
from twin.job.tolerance import ToleranceTable
from twin.machine.description.config import MachineConfig
from twin.run.dry_run.dry_run import DryRun
from twin.run.dry_run.program_watch import ProgramWatch, ToothFeed
from twin.run.machining import Machining
from twin.run.messages import Notice

LEAST_CUT_MM3 = 1e-3
"""A line that takes less off than this does not cut [mm³]."""


def cut_notices(
    job: JobFile, dry_run: DryRun, machining: Machining, cut: CutResult, loads: LoadLog
) -> Iterator[Notice]:
    """Warnings about the cut of a whole program.

    Args:
        loads: What the tools bore: a cut on a side that is thinner than a cell shows there alone.
    """
    cutter, watch = machining.cutter, dry_run.watch
    assert cutter is not None
    begins = watch.first_feed or watch.spindle_line or watch.first_line
    force = loads.greatest.get("force_n")
    cuts = cut.removed_mm3 > 0.0 or (force is not None and force.value > 0.0)
    if not cuts and begins:
        yield Notice("nothing-cut", begins, "no move of the program takes anything off the stock")
    if cutter.start_depth:
        yield Notice(
            "starts-in-stock",
            watch.first_line,
            f"the tool is {cutter.start_depth:.2f} mm deep in the stock before it moves",
        )
    if machining.misfit is not None:
        yield Notice("nominal-misfit", 0, machining.misfit)
    for stop in machining.stopped:
        yield Notice("stops-in-cut", stop.line, f"{stop.what} while the tool is in the cut")
    if machining.ended_in_cut:
        yield Notice("ends-in-cut", watch.last_line, "the program ends with the tool in the cut")
    tools = {tool.number: tool for tool in job.tools}
    for number, line in watch.tools_used.items():
        tool = tools.get(number, job.tools[0])
        if cut.cell_mm > 0.5 * tool.diameter:
            message = (
                f"the stock's cells are {cut.cell_mm:g} mm wide, between whose middles tool {number} of "
                f"{tool.diameter:g} mm can pass unseen: stock.cell is to be half of that at most"
            )
            yield Notice("coarse-cell", line, message)
    for slip in cutter.watch.slips:
        yield from _slip_notices(slip, tools.get(slip.tool, job.tools[0]), dry_run.drilled)
    if cut.removed_mm3 and watch.changed_at and watch.taken_to_turn and job.tools[0].speed is None:
        yield Notice(
            "spindle-never-started",
            watch.changed_at,
            "the program changes tools, cuts, and never starts the spindle: it is taken to turn",
        )


def _slip_notices(slip: CutSlip, tool: ToolTable, drilled: frozenset[int]) -> Iterator[Notice]:
    if slip.what == "sideways":
        message = f"drill {slip.tool} moves sideways in the material"
        yield Notice("drill-sideways", slip.line, message)
    elif not tool.plunges:
        message = (
            f"tool {slip.tool} plunges, and is not known to cut over its centre: ramp in, or say "
            "center_cutting = true in its [[tools]] table"
        )
        yield Notice("blunt-plunge", slip.line, message)
    elif slip.line in drilled and tool.center_cutting is None:
        message = (
            f'a drilling cycle drives tool {slip.tool}, which is no drill (kind = "{tool.kind}"), into '
            "the full material; where that is meant, say center_cutting = true in its [[tools]] table"
        )
        yield Notice("cutter-in-cycle", slip.line, message)


def lost_length_notices(fed_without_length: frozenset[int], cut: CutResult) -> Iterator[Notice]:
    """Cuts of a tool whose length does not count."""
    for line in sorted(fed_without_length):
        if line in cut.blocks and cut.blocks[line].removed_mm3 >= LEAST_CUT_MM3:
            message = (
                "the tool cuts here without its length: that was ended, or the one that counts is of "
                "a tool which is not in the spindle any more"
            )
            yield Notice("length-lost", line, message)
            return


def tooth_feed_notices(watch: ProgramWatch, cut: CutResult | None) -> Iterator[Notice]:
    """Feeds per tooth that no edge bears, where no force is simulated that would show it.

    Args:
        cut: What was cut; None without a stock: then only what no tool at all could bear is reported.
    """
    for line, feed in watch.tooth_feeds.items():
        if cut is None:
            if feed.value <= 0.5 * feed.tool.diameter:
                continue
        elif line not in cut.blocks or cut.blocks[line].removed_mm3 < LEAST_CUT_MM3:
            continue
        yield Notice("feed-per-tooth", line, _tooth_feed_text(feed))


def _tooth_feed_text(feed: ToothFeed) -> str:
    return f"{feed.value:.3g} mm per tooth: tool {feed.tool.number} bears a chip of {feed.bears:.3g} mm"


def unjudged_limit_notices(job: JobFile, watch: ProgramWatch) -> Iterator[Notice]:
    """Limits of tools that only a simulated force could judge, where none is simulated."""
    for tool in job.tools:
        given = [limit for limit in _LIMITS_OF_FORCE if getattr(tool, limit) is not None]
        if given and tool.number in watch.tools_used:
            limits, are = " and ".join(given), "is" if len(given) == 1 else "are"
            yield Notice(
                "limit-not-judged",
                watch.first_feed,
                f"{limits} of tool {tool.number} {are} not judged: no force is simulated; it needs a "
                '[stock] with a material, a spindle speed, and cutting_force = "teeth"',
            )


_LIMITS_OF_FORCE = ("force_limit", "torque_limit", "thrust_limit")


def tolerance_notices(
    tolerance: ToleranceTable, lines: int, machine: MachineConfig
) -> Iterator[Notice]:
    """Ranges of lines behind the program's last line, and tolerances of the motion that nothing fails.

    Args:
        lines: How many the program has.
        machine: Stops by its following error before a tolerance that is wider than that.
    """
    for number, part in enumerate(tolerance.blocks):
        if part.lines[1] > lines:
            message = (
                f"tolerance.blocks[{number}] names lines {part.lines[0]} to {part.lines[1]}, and the "
                f"program has {lines}"
            )
            yield Notice("tolerance-lines", lines, message)
    widest = _widest_errors(machine)
    allowed = {key: getattr(tolerance, key) for key in widest}
    for number, part in enumerate(tolerance.blocks):
        key = f"blocks[{number}].contour_um"
        allowed[key], widest[key] = part.contour_um, widest["contour_um"]
    for key, limit in allowed.items():
        if limit is not None and limit > 1e3 * widest[key]:
            unit = "deg" if key.endswith("mdeg") else "mm"
            message = (
                f"tolerance.{key} allows {1e-3 * limit:,.15g} {unit}, and the machine's following_error_limit stops "
                f"it before it is {widest[key]:.3g} {unit} off: the tolerance fails nothing"
            )
            yield Notice("tolerance-too-wide", 0, message)


def _widest_errors(machine: MachineConfig) -> dict[str, float]:
    """How far what a tolerance limits can be off before a following error stops the machine [mm or deg].

    A tool is off the path by what all axes together are off at most, a rotary one as far from its axis as the
    travels let it be; on a circle, to either side. An axis without a limit is off by any amount.
    """
    axes = [machine.axis(name) for name in machine.axes.names]
    linear, rotary = (
        [axis.following_error_limit or math.inf for axis in axes if axis.kind == kind]
        for kind in ("linear", "rotary")
    )
    travels = (axis.travel for axis in axes if axis.kind == "linear")
    across = math.hypot(*(math.inf if not travel else travel[1] - travel[0] for travel in travels))
    off = math.hypot(*linear) + sum(math.radians(limit) * across for limit in rotary)
    return {
        "contour_um": off,
        "rapid_contour_um": off,
        "circular_deviation_um": 2.0 * off,
        "following_um": max(linear, default=math.inf),
        "following_mdeg": max(rotary, default=math.inf),
        "direction_mdeg": sum(rotary) or math.inf,
    }


def nominal_notices(job: JobFile) -> Iterator[Notice]:
    """Tolerances of the part that are wider than its stock."""
    if job.nominal is None or job.stock is None:
        return
    widest_mm = max(job.stock.extent)
    for key in ("gouge_um", "standing_um"):
        limit_um = getattr(job.nominal, key)
        if limit_um is not None and limit_um > 1e3 * widest_mm:
            message = (
                f"nominal.{key} allows {1e-3 * limit_um:,.15g} mm, and the stock measures {widest_mm:g} mm: "
                "the tolerance fails nothing"
            )
            yield Notice("tolerance-too-wide", 0, message)
