"""What is set up at the machine: the blank on the table, the tool in the spindle, and the control's tables of both."""

import dataclasses

import numpy as np

from twin.cutting.tools import default_cell
from twin.errors import ConfigError, UsageError
from twin.job.job_file import StockTable
from twin.machine.simulation.growth import Growth
from twin.machine.simulation.live import LiveMachine, moving
from twin.nc.canonical import FloatArray
from twin.nc.functions import SpindleState
from twin.recording.alarms import Alarm
from twin.recording.reader import Samples
from twin.training.program.program_run import ProgramRun
from twin.training.room.control.tables import Tables
from twin.training.room.setup.edge_finder import EdgeFinder, broken_alarm, edge_finder
from twin.training.room.setup.live_cut import LiveCut
from twin.training.room.setup.workpiece import Workpiece
from twin.training.scene.scene_file import Scene

WORK_OFFSETS = ("G54", "G55", "G56", "G57", "G58", "G59")
"""Rows of the table of work offsets, where the control knows them."""


class Setup:
    """Blank, tool and tables; other files read it and call its methods.

    Attributes:
        tables: Part zero and tools, as the control has them and as they are.
        part_frame: How the part turns under the tool.
        finder: The edge finder in the magazine; None: there is nothing to be found with it.
    """

    def __init__(self, scene: Scene, machine: LiveMachine, tables: Tables) -> None:
        """Clamp a scene's blank and mount its first tool.

        Raises:
            ConfigError: The stock is wrong.
        """
        job = scene.preparation.job.file
        self._machine = machine
        self._first_tool = job.tools[0]
        self._stock = None if job.stock is None else _fine(job.stock, scene)
        self.tables = tables
        self.part_frame = scene.preparation.machine.part_frame.at(
            tables.true_zero, self._first_tool.length
        )
        chain = self.part_frame.chain
        if self._stock is not None and chain is not None and (chain.rotary & chain.on_tool).any():
            raise ConfigError(
                "job key 'stock': a blank is cut live where the tool does not swivel; put a fixture in its place"
            )
        self.cut = LiveCut(machine, job, self.part_frame, tables.true_zero)
        self.work = self._clamped_blank()
        self.finder = None if tables.finder is None else EdgeFinder(tables.finder)
        self._growth = Growth(machine.machine, self.cut.commanded_speed)

    def _clamped_blank(self) -> Workpiece | None:
        if self._stock is None:
            return None
        self.cut.clamp(self._stock)
        head = self._machine.head.above_tip
        return Workpiece(
            self._stock, self._first_tool, self.part_frame, self.tables.true_zero, head
        )

    def new_blank(self) -> None:
        """Clamp a new blank."""
        self.work = self._clamped_blank()
        if self.work is not None:
            self.work.mount(self.tables.tool)

    def mount(self, number: int | None) -> None:
        """Put a tool of the scene into the spindle.

        Raises:
            UsageError: The scene has no such tool.
        """
        if number not in self.tables.tools:
            raise UsageError(f"no tool {number}")
        self.tables.mount(number)
        self._machine.mount(self.tables.tool)
        self.cut.mount(self.tables.tool, float(self.tables.length_difference[2]))
        if self.work is not None:
            self.work.mount(self.tables.tool)

    def warm(self, samples: Samples) -> Samples:
        """The samples of a slice, with what the machine has grown."""
        return self._growth.warm(samples)

    def renew(self, number: int) -> None:
        """Put a new tool into the place of one that may have broken."""
        self.cut.renew(number)
        if self.finder is not None and number == self.finder.number:
            self.finder.renew()

    @property
    def sound_finder(self) -> EdgeFinder | None:
        """The edge finder, where it is in the spindle and not broken."""
        finder = self.finder
        here = finder is not None and finder.number == self.tables.spindle and not finder.broken
        return finder if here else None

    def _push_finder(
        self, finder: EdgeFinder, work: Workpiece, samples: Samples, turns: bool
    ) -> Alarm | None:
        """Let the edge finder give way; the alarm with which it breaks."""
        last = samples.joint_position[-1] - self.tables.length_difference
        said = finder.push(work.touch(last), turns=turns)
        setpoint = samples.setpoint
        alarm = broken_alarm(said, int(setpoint.line[-1]), float(setpoint.time[-1]))
        return alarm if said else None

    def cut_along(
        self, samples: Samples, run: ProgramRun | None, *, edges_stand: bool
    ) -> Alarm | None:
        """Cut along the samples of a slice.

        Args:
            run: What moves the axes; None: nothing.
            edges_stand: The spindle does not turn.

        Returns:
            The alarm of a cut that must not be.
        """
        if self.work is None:
            return None
        finder = self.sound_finder
        if finder is not None:
            return self._push_finder(finder, self.work, samples, turns=not edges_stand)
        length_difference = self.tables.length_difference
        tips = dataclasses.replace(
            samples,
            setpoint=dataclasses.replace(
                samples.setpoint, position=samples.setpoint.position - length_difference
            ),
            joint_position=samples.joint_position - length_difference,
        )
        moves = [] if run is None else [run.reader.moves.rapid(int(i)) for i in tips.setpoint.move]
        rapid = np.array(moves or [False] * len(tips), np.bool_)
        standing = np.full(len(tips), edges_stand)
        # Only what a feed with a turning spindle does to the stock may be cut a little later.
        at_once = moving(samples) and bool(rapid.any() or standing.any())
        return self.work.cut(tips, rapid, standing, at_once=at_once)

    def catch_up(self) -> Alarm | None:
        """Cut along the samples that wait; the alarm of a cut that must not be."""
        return None if self.work is None else self.work.catch_up()

    def forgive(self) -> None:
        """An alarm has been cleared: only what comes from now on counts."""
        if self.work is not None:
            self.work.forgive()
            if self.work.map is not None:
                self.cut.resume(self.work.map.heights)

    @property
    def tip(self) -> FloatArray:
        """Where the tool's tip is, seen from the part, shape (3,) [mm]."""
        place = self._machine.position - self.tables.length_difference
        return self.part_frame.position(place[None])[0]

    def touches(self, spindle: SpindleState) -> bool:
        """Whether the feeler lamp is lit: the tool, which is whole, stands still and touches the part."""
        finder_is_gone = self.tables.spindle == self.tables.finder and self.sound_finder is None
        if self.work is None or spindle.turns or finder_is_gone:
            return False
        return self.work.touches(self._machine.position - self.tables.length_difference)


def scene_tables(scene: Scene, zero: FloatArray) -> Tables:
    """The control's tables as a scene begins with them, with the errors that it has put in.

    Args:
        zero: Machine coordinates of the part's true zero, shape (k,) [mm or deg].
    """
    start, machine = scene.file.start, scene.preparation.machine
    tables = Tables(zero, scene.preparation.job.file.tools, _offsets(scene))
    if scene.preparation.job.file.stock is not None:
        tables.add_finder(edge_finder(tables.tools))
    for axis, error in start.zero_error.items():
        tables.shift_zero(machine.axes.index(axis), error)
    length = tables.lengths[tables.spindle] + start.tool_length_error
    tables.set_tool(tables.spindle, length, None)
    return tables


def _offsets(scene: Scene) -> dict[str, dict[str, float]]:
    """The work offsets that the control's table has, with the values of the job."""
    job, dialect = scene.preparation.job.file, scene.preparation.dialect
    names = [
        f"G{number:g}"
        for number in sorted(dialect.codes.g)
        if dialect.codes.g[number].group == "offset"
    ]
    wanted = [name for name in names if name in WORK_OFFSETS]
    return {name: dict(job.offsets.get(name, {})) for name in wanted} | dict(job.offsets)


def _fine(stock: StockTable, scene: Scene) -> StockTable:
    """The stock with a grid that is as fine as the scene is looked at closely."""
    cell = stock.cell or default_cell(scene.preparation.job.file.tools, stock)
    if scene.cells_across and scene.preparation.machine.part_frame.chain is None:
        cell = min(cell, min(stock.extent[:2]) / scene.cells_across)
    return stock.model_copy(update={"cell": cell})
