"""Teeth in a height map: the cut of a machine that turns the part about Z at most."""

from twin.coupling.cutting_kernels import Cut, PartTransform, follow_cutting, nothing_swept
from twin.coupling.cutting_process import CutSetting, CuttingProcess, Rows, SpindleTurning
from twin.coupling.turning_tool import TurningTool
from twin.cutting.heights.height_map import HeightMap, raw_walls
from twin.cutting.kernels.walls import WalledMap
from twin.machine.simulation.process import Physics
from twin.nc.canonical import FloatArray
from twin.units import SECONDS_PER_MINUTE


class HeightMapProcess(CuttingProcess):
    """Cuts a height map, which turns with at most a table about Z.

    Attributes:
        walls: Those that tools have left in it, of ``twin.cutting.kernels.walls``.
    """

    def __init__(self, material: HeightMap, setting: CutSetting) -> None:
        """Lay the material on the table; it is cut, and nobody else may."""
        super().__init__(setting)
        self.material = material
        self.walls = raw_walls(material)
        self._swept = nothing_swept()
        frame = setting.part_frame
        rotary = -1 if frame.rotary is None else frame.rotary
        self._place = PartTransform(rotary, frame.center, frame.turn_zero, 0.0)

    def begin(self, position: FloatArray) -> None:
        """Begin with the machine at rest; see ``Process``."""
        super().begin(position)
        self._swept = nothing_swept()

    def _cut_along(
        self, physics: Physics, turning: SpindleTurning, tool: TurningTool, rows: Rows
    ) -> None:
        cells = self.material.cells
        material = WalledMap(cells.heights, cells.grid, self.walls)
        place = self._place._replace(length_difference=turning.length_difference)
        follow_cutting(
            physics,
            rows.controls,
            rows.states,
            turning.speed / SECONDS_PER_MINUTE,
            Cut(material, cells, tool, place),
            self._memory,
            self._swept,
            rows.loads,
        )
