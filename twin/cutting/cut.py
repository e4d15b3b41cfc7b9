"""Cutting: the recorded motion takes material off the stock, and what it did is noted."""

import copy
import dataclasses
from collections.abc import Mapping
from typing import Literal

import numpy as np

from twin.cutting.cut_totals import CutTotals
from twin.cutting.forces.materials import kienzle
from twin.cutting.height_map_material import HeightMapMaterial
from twin.cutting.heights.height_map import BoolArray, HeightMap, blank
from twin.cutting.heights.sweeping import Rectangle
from twin.cutting.kernels.sweep import Removal
from twin.cutting.material import EDGE, Contact, Head, Material, Points
from twin.cutting.taking_off import TakingOff
from twin.cutting.tool_motion import ToolMotion, by_edge, tool_motion
from twin.cutting.tools import default_cell, profile
from twin.cutting.tridexel import blanks
from twin.cutting.tridexel.material import TriDexelMaterial
from twin.cutting.watching.cut_log import HEIGHT_MAP, TRI_DEXEL, CutResult
from twin.cutting.watching.cut_watch import CutWatch
from twin.cutting.watching.events import CutEvent, EventLog, StockWatch, Stretches
from twin.cutting.watching.stock_contact import above_edge
from twin.errors import ConfigError
from twin.job.job_file import StockTable, ToolTable
from twin.nc.canonical import FloatArray, IntArray
from twin.recording.reader import Samples
from twin.toolpath.part_frame import PartFrame
from twin.toolpath.tool_plan import ToolPlan


class Cutter:
    """Cuts stock along recorded motion, chunk by chunk; memory does not grow with the time.

    Attributes:
        material: The material as cut so far; look, but let only the cutter change it.
        plan: What is in the spindle when.
        tool: What is in the spindle after the last ``add``.
        force: Mean cutting force on the tool during each sample of the last ``add``, in the part's
            frame, shape (n, 3) [N]; 0 in the air and where it is not known.
        halted: What met material that must not, at which cutting ended, if it shall.
        watch: What the cut should not do, though nothing stops at it.
        until: Up to when it has cut [s].
        start_depth: How deep the tool was in the material before anything moved [mm].
    """

    def __init__(
        self,
        stock: StockTable,
        tool: ToolTable | ToolPlan,
        part_frame: PartFrame,
        part_zero: FloatArray,
        *,
        along: Literal["joints", "setpoints"] = "joints",
        keep_marks: bool = False,
        halts: bool = False,
        head: Head | None = None,
        tilts: bool = False,
    ) -> None:
        """Lay the uncut stock on the table.

        Args:
            tool: What is in the spindle, or what is in it when.
            part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].
            along: Whether the simulated motion cuts or the commanded one.
            keep_marks: Whether to note the cutter's marks, for pictures.
            halts: Whether to cut no further once something has met material that must not: a
                rapid, a feed with the spindle off, shank, holder or head. The part is then as it
                was at that moment.
            head: What is above a tool's holder; None: nothing.
            tilts: Whether the tool is ever tilted from the part's Z: the material is then described by
                intervals along three directions, else by a height map.

        Raises:
            ConfigError: The stock is too large for its grid, its file cannot be read, or its
                material is not known.
        """
        self.plan = tool if isinstance(tool, ToolPlan) else ToolPlan((tool,))
        self.tool = self.plan.tools[0]
        corner = part_frame.program_zero(part_zero)
        cell = stock.cell or default_cell(self.plan.tools, stock)
        self.material: Material
        if tilts:
            self.material = TriDexelMaterial(blanks.blank(stock, corner, cell))
        else:
            self.material = HeightMapMaterial(blank(stock, corner, cell), keep_marks=keep_marks)
        self.force = np.zeros((0, 3))
        self._travelled = 0.0
        self._along = along
        self._part_frame = part_frame
        self._last: tuple[Points, float] | None = None
        self._waiting: tuple[ToolMotion, bool] | None = None
        self._changes = 0
        self._stand: ToolMotion | None = None
        self._gouges = EventLog()
        self._rapids = StockWatch("rapid")
        self._standing = StockWatch("standing")
        self._halts, self._head = halts, head
        self._carriers = {each.beyond for each in above_edge(self.tool, head) if each.beyond}
        self.halted: CutEvent | None = None
        self._totals = CutTotals(self.material.cell, kienzle(stock))
        self.watch = CutWatch()
        self.start_depth = 0.0
        self.until = -np.inf

    def add(
        self,
        samples: Samples,
        rapid: BoolArray,
        standing: BoolArray | None = None,
        *,
        goes_on: bool = False,
    ) -> float:
        """Cut along a chunk that follows the last one.

        Args:
            samples: n samples.
            rapid: Which of them belong to rapids, shape (n,).
            standing: During which of them the spindle is off, shape (n,); none of them by default.
            goes_on: Whether samples that may be joined with the next ones wait for these, or for ``catch_up``: what is cut,
                and all that is told of it, is then the same however samples come in chunks. ``force`` is not known.

        Returns:
            Material that was taken off [mm³].
        """
        before = sum(self._totals.removed.values())
        if not goes_on:
            self.catch_up()
        self.material.begin_chunk()
        self.force = np.zeros((len(samples), 3))
        if not len(samples):
            return 0.0
        setpoint, frame = samples.setpoint, self._part_frame
        joints = samples.real(frame) if self._along == "joints" else setpoint.position
        off = np.zeros(len(samples), np.bool_) if standing is None else standing
        reach = self.tool.flute if self.tilts else None
        motion = tool_motion(samples, joints, frame, reach, rapid, off, self._carriers)
        if self._stand is None:
            self.start_depth = self._depth_at(
                motion[:1].lowered(self.plan.length_difference(self.tool))
            )
        self._stand = motion[-1:]
        for run, tool in self.plan.runs(setpoint.move):
            self._change_tools(
                motion[run.start : run.start + 1], max(int(setpoint.move[run.start]), 0)
            )
            if self.halted is not None:
                break
            self._take(tool)
            for part, edge in by_edge(samples, run):
                here = motion[part].lowered(self.plan.length_difference(tool))
                force = self._cut(here, edge=edge, wait=goes_on and part.stop == len(samples))
                if not goes_on:
                    self.force[part.start : part.start + len(force)] = force
        return sum(self._totals.removed.values()) - before

    def catch_up(self) -> None:
        """Cut along the samples that wait."""
        if self._waiting is not None:
            motion, edge = self._waiting
            self._cut(motion[:0], edge=edge)

    @property
    def tilts(self) -> bool:
        """Whether the tool may stand off the part's Z: there is no height map then."""
        return isinstance(self.material, TriDexelMaterial)

    @property
    def map(self) -> HeightMap:
        """The height map as cut so far.

        Raises:
            ConfigError: The part is cut from more sides than a height map can hold.
        """
        return self._of_height_map.map

    @property
    def marks(self) -> FloatArray:
        """Path of the tool at which each cell was last cut, shape (ny, nx) [mm]; of no size unless asked for."""
        return self._of_height_map.marks

    @property
    def changed(self) -> Rectangle:
        """Cells of the height map that changed in the last ``add``."""
        return self._of_height_map.changed

    @property
    def _of_height_map(self) -> HeightMapMaterial:
        if not isinstance(self.material, HeightMapMaterial):
            raise ConfigError(
                "the program cuts the part from more than one side, of which there is no height map: "
                "part.stl, the report and the film have the part"
            )
        return self.material

    def end_program(self) -> None:
        """Hold the tools that come behind the last move against the material where the axes are."""
        self.catch_up()
        if self._stand is not None and self.halted is None:
            self._change_tools(self._stand, None)

    def events(self) -> tuple[CutEvent, ...]:
        """Gouges, rapids into stock and feeds with the spindle off so far."""
        return (*self._gouges.events(), *self._rapids.events(), *self._standing.events())

    def result(self) -> CutResult:
        """What was cut so far."""
        self.catch_up()
        self._totals.end(self.tool)
        totals, log = self._totals, self._totals.log
        bin_s, over_time = log.over_time
        return CutResult(
            removed_mm3=sum(totals.removed.values()),
            removed_by_tool_mm3=dict(totals.removed),
            stock=TRI_DEXEL if self.tilts else HEIGHT_MAP,
            cell_mm=self.material.cell,
            air_share=totals.air_share,
            gouges=self._gouges.events(),
            rapid_into_stock=self._rapids.events(),
            spindle_off=self._standing.events(),
            blocks=log.blocks,
            blocks_forgotten=log.forgotten,
            bin_s=bin_s,
            removed_over_time=tuple(over_time.tolist()),
            force_n=totals.force,
            power_w=totals.power,
        )

    def _change_tools(self, stand: ToolMotion, move: int | None) -> None:
        """Bring the tools that come before a move into the spindle, one after the other.

        Args:
            stand: Where the axes are then, one sample.
            move: Its number; None: the program has ended.
        """
        changes = self.plan.changes
        while self.halted is None and self._changes < len(changes):
            change = changes[self._changes]
            if move is not None and change.move > move:
                return
            self._changes += 1
            if change.tool.number != self.tool.number:
                self._take(change.tool)
                self._note_arrival(
                    stand.lowered(self.plan.length_difference(change.tool)), change.line
                )

    def _take(self, tool: ToolTable) -> None:
        """Have a tool in the spindle, or the same one at another speed."""
        if tool == self.tool:
            return
        self.catch_up()
        self._totals.end(self.tool)
        if tool.number != self.tool.number:
            self._last = None
        self.tool = tool

    def _note_arrival(self, stand: ToolMotion, line: int) -> None:
        """Note that the tool which has just come into the spindle is in the material."""
        depth = self._depth_at(stand)
        if not depth:
            return
        removal = Removal(*np.zeros((4, 1)))
        tip = np.repeat(stand.ends.tip, 2, axis=0)
        stretches = Stretches(
            tip, stand.time, np.array([line]), stand.rapid, *removal, stand.off, stand.ends.axis
        )
        self._gouges.note(("arrival", line), "arrival", stretches, 0, depth)
        if self._halts:
            self.halted = self._gouges.event(("arrival", line))

    def _depth_at(self, stand: ToolMotion) -> float:
        """How deep the tool is in the material [mm].

        Args:
            stand: Where its tip is, one sample.
        """
        here = stand.ends[np.zeros(2, np.int64)]
        met = self._contact().measure(here, np.ones(1, np.bool_))
        return max((float(overlap.depth[0]) for overlap in met.values()), default=0.0)

    def _cut(self, motion: ToolMotion, *, edge: bool, wait: bool = False) -> FloatArray:
        """Cut with one tool from the last point of the run before through all of this one's.

        Args:
            edge: Whether it has its edge: without one it takes nothing off, and what it must not
                meet it still meets.
            wait: Whether the last stretch waits for the samples that follow, unless it meets what it must not.

        Returns:
            Force on the tool during each sample that was cut along, shape (m, 3) [N].
        """
        if self._waiting is not None:
            waiting, had_edge = self._waiting
            if had_edge != edge:
                self._waiting = None
                self._cut(waiting, edge=had_edge)
            else:
                motion = waiting.followed_by(motion)
        self._waiting = None
        if self.halted is not None or not len(motion):
            return np.zeros((0, 3))
        before, _ = self._before(motion)
        group, points = motion.group, before.followed_by(motion.ends)
        chosen = self.material.straight(
            points, np.concatenate([group[:1], group]), profile(self.tool)
        )
        if not wait:
            return self._cut_along(motion, chosen, edge=edge)
        decided = int(chosen[-2])
        force = self._cut_along(motion[:decided], chosen[:-1], edge=edge)
        self._waiting = motion[decided:], edge
        if self._halts and self.halted is None and self._meets(motion[decided:]):
            self.catch_up()
        return force

    def _before(self, motion: ToolMotion) -> tuple[Points, float]:
        """Where the tool was before a motion, and when [s]."""
        return self._last or (motion.ends[:1], float(motion.time[0]))

    def _cut_along(self, motion: ToolMotion, chosen: IntArray, *, edge: bool) -> FloatArray:
        """Cut along straight stretches.

        Args:
            chosen: Their ends, among the last point before the motion and the motion's.
            edge: As for ``_cut``.

        Returns:
            As for ``_cut``.
        """
        if not len(motion):
            return np.zeros((0, 3))
        stood, (before, since) = self._last is not None, self._before(motion)
        self._last = motion.ends[-1:].copy(), float(motion.time[-1])
        self.until = float(motion.time[-1])
        points, sample = before.followed_by(motion.ends)[chosen], chosen[1:] - 1
        rapid, off, lag = motion.rapid[sample], motion.standing[sample], motion.lag[sample]
        tip, ends, reach = points.tip, points.axis, self.tool.flute
        rapids = self._rapids.suspects(tip, rapid, lag, ends, reach)
        standing = self._standing.suspects(tip, ~rapid & off, lag, ends, reach)
        suspect = (rapids > 0) | (standing > 0)
        taking = TakingOff(self.material, self.tool, self._contact(), edge, self._halts)
        mark = self._travelled + np.cumsum(_lengths(points.tip))
        found, met = taking.along(points, suspect, mark, stood=stood)
        count = len(found.volume)
        points, sample = points[: count + 1], sample[:count]
        rapids, standing = rapids[:count], standing[:count]
        self._travelled += float(_lengths(points.tip).sum())
        time, line = motion.time[sample], motion.line[sample]
        axis = None if points.axis is None else points.axis[1:]
        stretches = Stretches(
            points.tip, time, line, rapid[:count], *found, motion.off[sample], axis
        )
        latest = self._note_contacts(stretches, met)
        reached = met.pop(EDGE, np.zeros(count))
        hits = reached > 0.0
        # A wall is met before a cell of it is lost.
        watched = dataclasses.replace(stretches, depth=np.maximum(stretches.depth, reached))
        self._rapids.add(watched, rapids, hits)
        self._standing.add(watched, standing, hits)
        if self._halts and (latest is not None or hits.any()):
            (self.halted,) = (*self._rapids.events(), *self._standing.events()) or (latest,)
        self.watch.add(stretches, self.tool)
        force = self._totals.add(stretches, np.diff(stretches.time, prepend=since), self.tool)
        return np.repeat(force, np.diff(sample, prepend=-1), axis=0)

    def _meets(self, motion: ToolMotion) -> bool:
        """Whether anything that must not is in the material on a straight way from the last point."""
        points = self._before(motion)[0].followed_by(motion.ends[-1:])
        rapid, off = motion.rapid[-1:], motion.standing[-1:]
        ways = points.tip, motion.lag[-1:], points.axis, self.tool.flute
        suspect = copy.copy(self._rapids).suspects(ways[0], rapid, *ways[1:]) > 0
        suspect |= copy.copy(self._standing).suspects(ways[0], ~rapid & off, *ways[1:]) > 0
        met = self._contact().measure(points, suspect)
        return any(overlap.depth.any() for overlap in met.values())

    def _contact(self) -> Contact:
        """What measures the tool in the spindle, and what is above it, against the material."""
        return self.material.contact(self.tool, profile(self.tool), self._head)

    def _note_contacts(
        self, stretches: Stretches, met: Mapping[str, FloatArray]
    ) -> CutEvent | None:
        """Note what of the tool's side was in the material; the event of the last stretch, if any."""
        latest = None
        for what, depth in met.items():
            for i in np.flatnonzero(depth) if what != EDGE else ():
                key = (what, int(stretches.line[i]))
                self._gouges.note(key, what, stretches, int(i), float(depth[i]))
                if i == len(depth) - 1:
                    latest = self._gouges.event(key)
        return latest


def _lengths(points: FloatArray) -> FloatArray:
    return np.linalg.norm(np.diff(points, axis=0), axis=1)
