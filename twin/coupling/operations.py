"""What is in the spindle when, and how fast it shall turn: of a program, or of an operator."""

from collections.abc import Iterator

import numpy as np

from twin.coupling.cutting_process import CutSetting, CuttingProcess, Operation, SpindleTurning
from twin.coupling.height_map_process import HeightMapProcess
from twin.coupling.leaning_process import LeaningProcess
from twin.cutting.forces.materials import kienzle
from twin.cutting.heights.height_map import HeightMap, blank
from twin.cutting.program_summary import ProgramSummary
from twin.cutting.tools import default_cell
from twin.cutting.tridexel import blanks
from twin.job.job_file import JobFile, StockTable, ToolTable
from twin.machine.description.config import MachineConfig
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray
from twin.toolpath.part_frame import PartFrame


class ProgramOperation:
    """What a program brings into the spindle."""

    def __init__(self, summary: ProgramSummary) -> None:
        """Read tools and speeds off the summary of a program."""
        self._tools = summary.tools
        self._first_move = np.array(summary.spindle.first_move)
        self._speed = np.array([_known(speed) for speed in summary.spindle.values])
        self._silent = len(self._speed) == 1

    @property
    def speed_at_start(self) -> float:
        """A program that never speaks of the spindle finds it turning."""
        return (self._tools.tools[0].speed or 0.0) if self._silent else 0.0

    def speed(self, setpoints: Setpoints) -> FloatArray:
        """How fast the spindle shall turn, shape (n,) [1/min]; not a number where nobody says."""
        parts = [turning.speed for turning in self.turnings(setpoints)]
        return np.concatenate(parts) if parts else np.zeros(0)

    def turnings(self, setpoints: Setpoints) -> Iterator[SpindleTurning]:
        """Split setpoints where the tool changes; see ``Operation``."""
        # At the end of a move's path the spindle has received what comes before the next one.
        place = np.maximum(setpoints.move + np.clip(setpoints.fraction, 0.0, 1.0), 0.0)
        speed = self._speed[np.searchsorted(self._first_move, place, side="right") - 1]
        for rows, tool in self._tools.runs(setpoints.move):
            commanded = np.full(rows.stop - rows.start, _known(tool.speed))
            yield SpindleTurning(
                rows,
                tool,
                self._tools.length_difference(tool),
                commanded if self._silent else speed[rows],
            )


class OperatorOperation:
    """What an operator has put into the spindle.

    Attributes:
        length_difference: How much lower its tip is than that which positions count for [mm].
        speed: Commanded speed of the spindle [1/min], negative counter-clockwise; None: not known.
    """

    def __init__(self, tool: ToolTable) -> None:
        self.tool = tool
        self.length_difference = 0.0
        self.speed: float | None = 0.0

    @property
    def speed_at_start(self) -> float:
        """The speed as last set."""
        return self.speed or 0.0

    def turnings(self, setpoints: Setpoints) -> Iterator[SpindleTurning]:
        """All setpoints at once; see ``Operation``."""
        if len(setpoints):
            commanded = np.full(len(setpoints), _known(self.speed))
            yield SpindleTurning(
                slice(0, len(setpoints)), self.tool, self.length_difference, commanded
            )


def _known(speed: float | None) -> float:
    return np.nan if speed is None else speed


def speeds_are_known(summary: ProgramSummary) -> bool:
    """Whether the speed of the spindle is commanded wherever a program may cut."""
    said = summary.spindle.values[1:]
    return all(speed is not None for speed in said or [t.speed for t in summary.tools.tools])


def program_process(
    job: JobFile,
    machine: MachineConfig,
    summary: ProgramSummary,
    part_frame: PartFrame,
    part_zero: FloatArray,
    laid: HeightMap | None = None,
) -> CuttingProcess | None:
    """What the tools of a program do to the stock of a job.

    Args:
        job: Its blank, and whether the force of the cut is simulated.
        part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        laid: The blank, if it is on the table already; it is copied.

    Returns:
        None where the force of the cut is not simulated: the job says so, or names no stock, no
        material or no speed of the spindle.

    Raises:
        ConfigError: The stock is too large for its grid, its file cannot be read, or its material
            is not known.
    """
    speeds = [*summary.spindle.values, *(tool.speed for tool in summary.tools.tools)]
    if job.stock is None or job.cutting_force != "teeth" or not any(speeds):
        return None
    cell = job.stock.cell or default_cell(summary.tools.tools, job.stock)
    return cutting_process(
        job.stock, cell, ProgramOperation(summary), machine, part_frame, part_zero, laid
    )


def cutting_process(
    stock: StockTable,
    cell: float,
    operation: Operation,
    machine: MachineConfig,
    part_frame: PartFrame,
    part_zero: FloatArray,
    laid: HeightMap | None = None,
) -> CuttingProcess | None:
    """What tools do to a stock.

    None where its material is not named, or where it is a cylinder that lies on a machine that turns the part about Z at most.

    Args:
        cell: Of its height map, or between the lines of its tri-dexel [mm].
        part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        laid: As for ``program_process``.

    Raises:
        ConfigError: As for ``program_process``.
    """
    if part_frame.chain is None:
        return height_map_process(stock, cell, operation, machine, part_frame, part_zero, laid)
    resists = kienzle(stock)
    if resists is None:
        return None
    material = blanks.blank(stock, part_frame.program_zero(part_zero), cell)
    return LeaningProcess(
        material, CutSetting(resists, operation, part_frame, machine.file.spindle)
    )


def height_map_process(
    stock: StockTable,
    cell: float,
    operation: Operation,
    machine: MachineConfig,
    part_frame: PartFrame,
    part_zero: FloatArray,
    laid: HeightMap | None = None,
) -> HeightMapProcess | None:
    """As ``cutting_process``, on a machine that turns the part about Z at most."""
    resists = kienzle(stock)
    if resists is None or stock.lies:
        return None
    if laid is None:
        material = blank(stock, part_frame.program_zero(part_zero), cell)
    else:
        material = laid.copy()
    return HeightMapProcess(
        material, CutSetting(resists, operation, part_frame, machine.file.spindle)
    )
