"""What was cut, added up: by tool and line, how hard, and how much of the path in the air."""

import numpy as np

from twin.cutting.forces.direction import tool_force
from twin.cutting.forces.materials import Kienzle
from twin.cutting.forces.mean_force import CutPieces, MeanPieces, cutting_load, each_alone
from twin.cutting.watching.cut_log import CutLog
from twin.cutting.watching.events import Stretches
from twin.job.job_file import ToolTable
from twin.nc.canonical import FloatArray
from twin.units import SECONDS_PER_MINUTE


class CutTotals:
    """Adds up what stretches took off, one after the other: in chunks they come to the same bits.

    Attributes:
        removed: What each tool took off, by its number, in the order of use [mm³].
        log: The same by line and by time.
        force: Greatest mean cutting force [N]; None where it is not known.
        power: Greatest mean cutting power [W]; None where it is not known.
    """

    def __init__(self, cell: float, material: Kienzle | None) -> None:
        """Begin with nothing.

        Args:
            cell: Side of the material's cells [mm].
            material: Without it no force is known.
        """
        self.removed: dict[int, float] = {}
        self.log = CutLog()
        self.force: float | None = None
        self.power: float | None = None
        self._material = material
        self._pieces = MeanPieces(cell)
        self._feed_path = 0.0
        self._air_path = 0.0

    @property
    def air_share(self) -> float:
        """Share of the cutting feed's path that met no material."""
        return self._air_path / self._feed_path if self._feed_path else 0.0

    def add(self, stretches: Stretches, duration: FloatArray, tool: ToolTable) -> FloatArray:
        """Enter what a tool took off.

        Args:
            stretches: n stretches.
            duration: How long each took, shape (n,) [s].

        Returns:
            Mean force on the tool along each, shape (n, 3) [N]; 0 where it is not known.
        """
        path, feeds, number = stretches.path, ~stretches.rapid, tool.number
        self.removed[number] = _added(self.removed.get(number, 0.0), stretches.removed)
        self._feed_path = _added(self._feed_path, path[feeds])
        self._air_path = _added(self._air_path, path[feeds & stretches.in_air])
        self.log.add(stretches)
        alone = each_alone(stretches, duration)
        turn = SECONDS_PER_MINUTE / tool.speed if tool.speed else 0.0
        self._note_means(self._pieces.add(alone, turn), tool)
        if self._material is None or not tool.speed:
            return np.zeros((len(path), 3))
        self.force, self.power = self.force or 0.0, self.power or 0.0
        force = cutting_load(alone, tool, self._material).force
        return tool_force(stretches, alone.width(tool.diameter), force, tool, self._material)

    def end(self, tool: ToolTable) -> None:
        """Enter what there is of the mean that a tool's last stretches belong to: another one comes, or none."""
        self._note_means(self._pieces.end(), tool)

    def _note_means(self, pieces: CutPieces, tool: ToolTable) -> None:
        pieces, force = pieces[pieces.removed > 0.0], None
        if not len(pieces):
            return
        if self._material is not None and tool.speed is not None:
            load = cutting_load(pieces, tool, self._material)
            force = load.force
            self.force = max(self.force or 0.0, float(force.max()))
            self.power = max(self.power or 0.0, float(load.power.max()))
        self.log.add_means(pieces.line, pieces.width(tool.diameter), force)


def _added(total: float, values: FloatArray) -> float:
    """A total and n values more, added one after the other."""
    return float(np.cumsum(np.append(total, values))[-1])
