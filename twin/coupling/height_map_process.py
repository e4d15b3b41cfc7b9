"""Teeth in a height map: the cut of a machine that turns the part about Z at most."""

from twin.coupling.cutting_kernels import Cut, PartTransform, follow_cutting, nothing_swept
from twin.coupling.cutting_process import CuttingProcess, Operation, Rows, SpindleTurning
from twin.coupling.turning_tool import TurningTool
from twin.cutting.forces.materials import Kienzle
from twin.cutting.heights.height_map import HeightMap, raw_walls
from twin.cutting.kernels.walls import Material
from twin.machine.description.machine_file import SpindleTable
from twin.machine.simulation.process import Physics
from twin.nc.canonical import FloatArray
from twin.toolpath.part_frame import PartFrame
from twin.units import SECONDS_PER_MINUTE


class HeightMapProcess(CuttingProcess):
    """Cuts a height map, which turns with at most a table about Z.

    Attributes:
        walls: Those that tools have left in it, of ``twin.cutting.kernels.walls``.
    """

    def __init__(
        self,
        material: HeightMap,
        resists: Kienzle,
        operation: Operation,
        part_frame: PartFrame,
        spindle: SpindleTable,
    ) -> None:
        """Lay the material on the table.

        Args:
            material: It is cut; nobody else may.
            resists: As for ``CuttingProcess``; so on.
        """
        super().__init__(resists, operation, spindle)
        self.material = material
        self.walls = raw_walls(material)
        self._swept = nothing_swept()
        frame, rotary = part_frame, -1 if part_frame.rotary is None else part_frame.rotary
        self._place = PartTransform(rotary, frame.center, frame.turn_zero, 0.0)

    def begin(self, position: FloatArray) -> None:
        """Begin with the machine at rest; see ``Process``."""
        super().begin(position)
        self._swept = nothing_swept()

    def _cut_along(
        self, physics: Physics, turning: SpindleTurning, tool: TurningTool, rows: Rows
    ) -> None:
        material = Material(self.material.heights, self.material.grid, self.walls)
        follow_cutting(
            physics,
            rows.controls,
            rows.states,
            turning.speed / SECONDS_PER_MINUTE,
            Cut(material, tool, self._place._replace(length_difference=turning.length_difference)),
            self._memory,
            self._swept,
            rows.loads,
        )
