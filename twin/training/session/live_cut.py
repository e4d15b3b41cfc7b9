"""The force of the cut in a room: what the operator has in the spindle pushes the axes back."""

import numpy as np

from twin.coupling.cutting_process import CuttingProcess
from twin.coupling.operations import OperatorOperation, cutting_process
from twin.job.job_file import JobFile, StockTable, ToolTable
from twin.machine.simulation.live import LiveMachine
from twin.nc.canonical import FloatArray
from twin.nc.functions import SpindleState
from twin.toolpath.part_frame import PartFrame


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
            machine: It is pushed.
            job: Says whether force is simulated, and with which tool the machine begins.
            part_frame: How the part turns under the tool.
            zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        """
        self.process: CuttingProcess | None = None
        self._machine = machine
        self._simulated = job.cutting_force == "teeth"
        self._operation = OperatorOperation(job.tools[0])
        self._frame, self._zero = part_frame, zero

    def clamp(self, stock: StockTable) -> None:
        """Lay a new blank on the table; its cell must be given."""
        assert stock.cell is not None
        if self._simulated:
            self.process = cutting_process(
                stock,
                stock.cell,
                self._operation,
                self._machine.machine,
                self._frame,
                self._zero,
            )
        self._machine.step_with(self.process)

    def mount(self, tool: ToolTable, longer: float) -> None:
        """Put a tool into the spindle that is so much longer than the first [mm]."""
        self._operation.tool, self._operation.longer = tool, longer

    def turn(self, spindle: SpindleState, override: float, *, counter_clockwise: bool) -> None:
        """Tell the drive of the spindle what is asked of it; ``override`` is a factor."""
        speed = spindle.speed if spindle.turns else 0.0
        sense = -1.0 if counter_clockwise else 1.0
        self._operation.speed = None if speed is None else sense * override * speed

    def resume(self, heights: FloatArray) -> None:
        """Go on after an alarm, with the material as the part's own cut has left it, (ny, nx) [mm]."""
        if self.process is not None:
            np.copyto(self.process.material.heights, heights)
            self.process.lift()
