"""Teeth in a part that is cut from any side: the cut of any machine."""

import numpy as np

from twin.coupling.cutting_process import CutSetting, CuttingProcess, Rows, SpindleTurning
from twin.coupling.leaning_kernels import JointChain, LeaningCut, follow_leaning, nowhere
from twin.coupling.turning_tool import ToolLoads, TurningTool
from twin.cutting.tools import profile
from twin.cutting.tridexel.dexels import TriDexel
from twin.cutting.tridexel.engagement import longest_step
from twin.cutting.tridexel.normals import MOST_TOOLS
from twin.cutting.tridexel.solids.solids import cutting_edge
from twin.machine.simulation.process import Physics
from twin.nc.canonical import FloatArray
from twin.units import SECONDS_PER_MINUTE


class LeaningProcess(CuttingProcess):
    """Cuts a tri-dexel stock with a tool that leans against the part."""

    def __init__(self, material: TriDexel, setting: CutSetting) -> None:
        """Lay the material on the table; it is cut, and nobody else may. The axes are a chain."""
        super().__init__(setting)
        frame = setting.part_frame
        assert frame.chain is not None
        assert frame.zero is not None
        self.material = material
        self._chain = JointChain(frame.chain, frame.zero, 0.0)
        self._pose = nowhere(len(frame.zero))

    def begin(self, position: FloatArray) -> None:
        """Begin with the machine at rest; see ``Process``."""
        super().begin(position)
        self._pose = nowhere(len(position))

    def _cut_along(
        self, physics: Physics, turning: SpindleTurning, tool: TurningTool, rows: Rows
    ) -> None:
        job, stock = turning.tool, self.material
        solids = cutting_edge(profile(job), job.flute)
        number = min(max(job.number, 1), MOST_TOOLS)
        speed, chain = (
            turning.speed / SECONDS_PER_MINUTE,
            self._chain._replace(length_difference=turning.length_difference),
        )
        done = 0
        while done < len(speed):
            left = slice(done, None)
            cut = LeaningCut(
                stock.dexels, stock.lattice, np.array(solids, np.float64), number,
                longest_step(solids), tool, chain,
            )  # fmt: skip
            done += follow_leaning(
                physics,
                rows.controls[left],
                rows.states[left],
                speed[left],
                cut,
                self._memory,
                self._pose,
                ToolLoads(*(column[left] for column in rows.loads)),
            )
            if done < len(speed):
                stock.dexels = stock.dexels.grown()
