"""Cutting: the recorded motion takes material off the stock, and what it did is noted."""

import dataclasses
from collections.abc import Mapping
from typing import Literal

import numpy as np

from twin.cutting.forces.direction import tool_force
from twin.cutting.forces.materials import kienzle
from twin.cutting.forces.mean_force import MeanPieces, Pieces, cutting_load, each_alone
from twin.cutting.height_map_material import HeightMapMaterial
from twin.cutting.heights.height_map import BoolArray, HeightMap, blank
from twin.cutting.heights.sweeping import Rectangle
from twin.cutting.kernels.sweep import Removal
from twin.cutting.material import EDGE, Head, Material, Points
from twin.cutting.tool_motion import ToolMotion, by_edge, tool_motion
from twin.cutting.tools import Profile, default_cell, profile
from twin.cutting.tridexel import blanks
from twin.cutting.tridexel.material import TriDexelMaterial
from twin.cutting.watching.cut_log import HEIGHT_MAP, TRI_DEXEL, CutLog, CutResult
from twin.cutting.watching.cut_watch import CutWatch
from twin.cutting.watching.events import CutEvent, EventLog, StockWatch, Stretches
from twin.cutting.watching.stock_contact import above_edge
from twin.errors import ConfigError
from twin.job.job_file import StockTable, ToolTable
from twin.nc.canonical import FloatArray
from twin.recording.reader import Samples
from twin.toolpath.part_frame import PartFrame
from twin.toolpath.tool_plan import ToolPlan
from twin.units import SECONDS_PER_MINUTE


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
        self._material = kienzle(stock)
        self._along = along
        self._part_frame = part_frame
        self._last: tuple[Points, float] | None = None
        self._changes = 0
        self._stand: ToolMotion | None = None
        self._removed: dict[int, float] = {}
        self._feed_path = 0.0
        self._air_path = 0.0
        self._force: float | None = None
        self._power: float | None = None
        self._gouges = EventLog()
        self._rapids = StockWatch("rapid")
        self._standing = StockWatch("standing")
        self._halts, self._head = halts, head
        self._carriers = {each.beyond for each in above_edge(self.tool, head) if each.beyond}
        self.halted: CutEvent | None = None
        self._cut_log = CutLog()
        self._pieces = MeanPieces(self.material.cell)
        self.watch = CutWatch(self.material.cell)
        self.start_depth = 0.0

    def add(self, samples: Samples, rapid: BoolArray, standing: BoolArray | None = None) -> float:
        """Cut along a chunk that follows the last one.

        Args:
            samples: n samples.
            rapid: Which of them belong to rapids, shape (n,).
            standing: During which of them the spindle is off, shape (n,); none of them by default.

        Returns:
            Material that this chunk took off [mm³].
        """
        before = sum(self._removed.values())
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
                force = self._cut(
                    motion[part].lowered(self.plan.length_difference(tool)), edge=edge
                )
                self.force[part.start : part.start + len(force)] = force
        return sum(self._removed.values()) - before

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
        if self._stand is not None and self.halted is None:
            self._change_tools(self._stand, None)

    def events(self) -> tuple[CutEvent, ...]:
        """Gouges, rapids into stock and feeds with the spindle off so far."""
        return (*self._gouges.events(), *self._rapids.events(), *self._standing.events())

    def result(self) -> CutResult:
        """What was cut so far."""
        self._note_means(self._pieces.rest())
        bin_s, over_time = self._cut_log.over_time
        return CutResult(
            removed_mm3=sum(self._removed.values()),
            removed_by_tool_mm3=dict(self._removed),
            stock=TRI_DEXEL if self.tilts else HEIGHT_MAP,
            cell_mm=self.material.cell,
            air_share=self._air_path / self._feed_path if self._feed_path else 0.0,
            gouges=self._gouges.events(),
            rapid_into_stock=self._rapids.events(),
            spindle_off=self._standing.events(),
            blocks=self._cut_log.blocks,
            blocks_forgotten=self._cut_log.forgotten,
            bin_s=bin_s,
            removed_over_time=tuple(over_time.tolist()),
            force_n=self._force,
            power_w=self._power,
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
        self._note_means(self._pieces.end())
        if tool.number != self.tool.number:
            self._last = None
        self.tool = tool

    def _note_arrival(self, stand: ToolMotion, line: int) -> None:
        """Note that the tool which has just come into the spindle is in the material."""
        depth = self._depth_at(stand)
        if not depth:
            return
        removal = Removal(*np.zeros((3, 1)))
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
        contact = self.material.contact(self.tool, profile(self.tool), self._head)
        met = contact.measure(here, np.ones(1, np.bool_))
        return max((float(overlap.depth[0]) for overlap in met.values()), default=0.0)

    def _cut(self, motion: ToolMotion, *, edge: bool) -> FloatArray:
        """Cut with one tool from the last point of the run before through all of this one's.

        Args:
            edge: Whether it has its edge: without one it takes nothing off, and what it must not
                meet it still meets.

        Returns:
            Force on the tool during each sample that was cut along, shape (m, 3) [N].
        """
        stood = self._last is not None
        before, since = (motion.ends[:1], motion.time[0]) if self._last is None else self._last
        self._last = motion.ends[-1:].copy(), float(motion.time[-1])
        points = before.followed_by(motion.ends)
        cutter = profile(self.tool)
        group = motion.group
        chosen = self.material.straight(points, np.concatenate([group[:1], group]), cutter)
        points, sample = points[chosen], chosen[1:] - 1
        rapid, off, lag = motion.rapid[sample], motion.standing[sample], motion.lag[sample]
        tip, ends, reach = points.tip, points.axis, self.tool.flute
        rapids = self._rapids.suspects(tip, rapid, lag, ends, reach)
        standing = self._standing.suspects(tip, ~rapid & off, lag, ends, reach)
        suspect = (rapids > 0) | (standing > 0)
        found, met = self._take_off(points, cutter, suspect, edge=edge, stood=stood)
        count = len(found.volume)
        points, sample = points[: count + 1], sample[:count]
        rapids, standing = rapids[:count], standing[:count]
        self._travelled += float(_lengths(points.tip).sum())
        so_far = self._removed.get(self.tool.number, 0.0)
        self._removed[self.tool.number] = so_far + float(found.volume.sum())
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
        force = self._note(stretches, np.diff(stretches.time, prepend=since))
        return np.repeat(force, np.diff(sample, prepend=-1), axis=0)

    def _take_off(
        self, points: Points, cutter: Profile, suspect: BoolArray, *, edge: bool, stood: bool
    ) -> tuple[Removal, dict[str, FloatArray]]:
        """Take off what the tool meets, up to where something meets that must not, if that halts.

        Args:
            points: Ends of n stretches.
            suspect: In which of them the edge must not cut, shape (n,).
            edge: As for ``_cut``.
            stood: Whether the tool has been at the first of them.

        Returns:
            What each stretch took off, and by name how deep something was in the material that
            must not be, shape (n,) [mm]; fewer than n stretches where cutting halted.
        """
        contact = self.material.contact(self.tool, cutter, self._head)
        doubtful = contact.measure(points, suspect, doubtful=True)
        count, done = len(suspect), 0
        removal = Removal(*np.zeros((3, count)))
        met = {name: np.zeros(count) for name in doubtful}
        mark = self._travelled + np.cumsum(_lengths(points.tip))
        flagged = np.flatnonzero(np.any([o.depth for o in doubtful.values()], axis=0) & (count > 0))
        # Against the material as the stretches before have left it.
        for k in flagged.tolist():
            if edge:
                self._sweep(points, cutter, removal, mark, slice(done, k), stood=stood)
            done = k
            here = slice(k, k + 1)
            for name, overlap in contact.measure(points[k : k + 2], suspect[here]).items():
                met[name][here] = overlap.depth
            if self._halts and any(depth[k] for depth in met.values()):
                count = k + 1
                break
        if edge:
            self._sweep(points, cutter, removal, mark, slice(done, count), stood=stood)
        removal = Removal(*(column[:count] for column in removal))
        return removal, {name: depth[:count] for name, depth in met.items()}

    def _sweep(
        self,
        points: Points,
        cutter: Profile,
        removal: Removal,
        mark: FloatArray,
        part: slice,
        *,
        stood: bool,
    ) -> None:
        """Take off what some of the stretches meet."""
        if part.start >= part.stop:
            return
        path, stood = points[part.start : part.stop + 1], stood or part.start > 0
        found = self.material.take_off(path, self.tool, cutter, mark[part], stood=stood)
        for column, swept in zip(removal, found, strict=True):
            column[part] = swept

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

    def _note(self, stretches: Stretches, duration: FloatArray) -> FloatArray:
        """Enter air and removal, and the force where it can be computed.

        Returns:
            Mean force on the tool along each stretch, shape (n, 3) [N]; 0 where it is not known.
        """
        path = stretches.path
        air = stretches.in_air(self.material.cell)
        self.watch.add(stretches, self.tool)
        self._feed_path += float(path[~stretches.rapid].sum())
        self._air_path += float(path[~stretches.rapid & air].sum())
        self._cut_log.add(stretches)
        alone, speed = each_alone(stretches, duration), self.tool.speed
        self._note_means(self._pieces.add(alone, SECONDS_PER_MINUTE / speed if speed else 0.0))
        if self._material is None or not speed:
            return np.zeros((len(path), 3))
        width = alone.width(self.tool.diameter)
        force = cutting_load(alone, self.tool, self._material).force
        return tool_force(stretches, width, force, self.tool, self._material)

    def _note_means(self, pieces: Pieces) -> None:
        """Enter width of cut and force of pieces that the tool in the spindle has cut."""
        pieces, force = pieces[pieces.removed > 0.0], None
        if not len(pieces):
            return
        if self._material is not None and self.tool.speed is not None:
            load = cutting_load(pieces, self.tool, self._material)
            force = load.force
            self._force = max(self._force or 0.0, float(force.max()))
            self._power = max(self._power or 0.0, float(load.power.max()))
        self._cut_log.add_means(pieces.line, pieces.width(self.tool.diameter), force)


def _lengths(points: FloatArray) -> FloatArray:
    return np.linalg.norm(np.diff(points, axis=0), axis=1)
