"""The force of the cut in a room: what the operator has in the spindle pushes the axes back."""

from typing import NamedTuple

import numpy as np

from twin.coupling.cutting_process import ToolBreak
from twin.coupling.height_map_process import HeightMapProcess
from twin.coupling.operations import OperatorOperation, height_map_process
from twin.cutting.forces.tool_strength import tool_strength
from twin.job.job_file import JobFile, StockTable, ToolTable
from twin.machine.simulation.live import LiveMachine
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray
from twin.nc.functions import SpindleState
from twin.recording.form import ToolLoad
from twin.toolpath.part_frame import PartFrame


class SliceLoads(NamedTuple):
    """What tool and spindle bear, the greatest of a slice; NaN where it is not simulated.

    Attributes:
        spindle_speed: As the drive turns, without its sense [1/min].
        spindle: Torque as a share of what the spindle gives for long.
        force: Level, on the tool [N].
        bend: Deflection of its tip [mm].
        chip: Thickest chip [mm].
        chip_share: Of what breaks an edge.
    """

    spindle_speed: float = np.nan
    spindle: float = np.nan
    force: float = np.nan
    force_share: float = np.nan
    bend: float = np.nan
    chip: float = np.nan
    chip_share: float = np.nan


class LiveCut:
    """Tool, spindle and material of a room, as far as they push the axes.

    Attributes:
        process: What the machine is stepped with; None where force is not simulated.
    """

    def __init__(
        self, machine: LiveMachine, job: JobFile, part_frame: PartFrame, zero: FloatArray
    ) -> None:
        """Begin without a blank.

        Args:
            job: Says whether force is simulated, and with which tool the machine begins.
            zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        """
        self.process: HeightMapProcess | None = None
        self._machine = machine
        # Only a height map gives forces of single teeth.
        self._simulated = job.cutting_force == "teeth" and part_frame.chain is None
        self._operation = OperatorOperation(job.tools[0])
        self._frame, self._zero = part_frame, zero
        self._reported: set[int] = set()

    def clamp(self, stock: StockTable) -> None:
        """Lay a new blank on the table; its cell must be given."""
        assert stock.cell is not None
        if self._simulated:
            before = self.process
            self.process = height_map_process(
                stock,
                stock.cell,
                self._operation,
                self._machine.machine,
                self._frame,
                self._zero,
            )
            if before is not None and self.process is not None:
                self.process.breaks = before.breaks
        self._machine.step_with(self.process)

    def mount(self, tool: ToolTable, length_difference: float) -> None:
        """Put a tool into the spindle that is so much longer than the first [mm]."""
        self._operation.tool, self._operation.length_difference = tool, length_difference

    def renew(self, number: int) -> None:
        """Put a new tool into the place of one that may have lost its edge."""
        self._reported.discard(number)
        if self.process is not None:
            self.process.renew(number)

    def new_breaks(self) -> list[ToolBreak]:
        """Tools that have lost their edge since the last call."""
        breaks = [] if self.process is None else self.process.breaks
        found = [one for one in breaks if one.tool not in self._reported]
        self._reported |= {one.tool for one in found}
        return found

    def turn(self, spindle: SpindleState, override: float) -> None:
        """Tell the drive of the spindle what is asked of it; ``override`` is a factor.

        An edge that is may touch the part, as a feeler: what it must not do is the part's to see.
        """
        self._operation.speed = override * spindle.turning if spindle.turning else None

    def commanded_speed(self, setpoints: Setpoints) -> FloatArray:
        """How fast the spindle shall turn, at n setpoints, shape (n,) [1/min]; see ``turn``."""
        speed = self._operation.speed
        return np.full(len(setpoints), np.nan if speed is None else speed)

    def loads(self, loads: ToolLoad | None) -> SliceLoads:
        """What there is to show of the tool's loads."""
        if loads is None or not len(loads):
            return SliceLoads()
        strength = tool_strength(self._operation.tool)
        force, chip = float(loads.peak_force.max()), float(loads.chip.max())
        return SliceLoads(
            spindle_speed=abs(float(loads.spindle_speed[-1])),
            spindle=float(loads.spindle_load.max()),
            force=force,
            force_share=force / strength.force,
            bend=float(np.linalg.norm(loads.deflection, axis=1).max()),
            chip=chip,
            chip_share=chip / strength.chip,
        )

    def resume(self, heights: FloatArray) -> None:
        """Go on after an alarm, with the material as the part's own cut has left it, (ny, nx) [mm]."""
        if self.process is not None:
            np.copyto(self.process.material.heights, heights)
            self.process.lift()
