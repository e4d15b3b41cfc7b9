"""Take material off along stretches, up to where something meets it that must not."""

import dataclasses

import numpy as np

from twin.cutting.kernels.sweep import Removal
from twin.cutting.material import Contact, Material, Points
from twin.cutting.tools import profile
from twin.job.job_file import ToolTable
from twin.nc.canonical import BoolArray, FloatArray


@dataclasses.dataclass(frozen=True, slots=True)
class TakingOff:
    """A tool that goes along stretches through the material.

    Attributes:
        contact: Measures the tool against the material.
        edge: Whether it has its edge: without one it takes nothing off, and what it must not
            meet it still meets.
        halts: Whether it goes no further once something has met the material that must not.
    """

    material: Material
    tool: ToolTable
    contact: Contact
    edge: bool
    halts: bool

    def along(
        self, points: Points, suspect: BoolArray, travelled: FloatArray, *, stood: bool
    ) -> tuple[Removal, dict[str, FloatArray]]:
        """Take off what the tool meets.

        Args:
            points: Ends of n stretches.
            suspect: In which of them the edge must not cut, shape (n,).
            travelled: Distance of all tools up to the end of each, shape (n,) [mm].
            stood: Whether the tool has been at the first of the points.

        Returns:
            What each stretch took off, and by name how deep something was in the material that
            must not be, shape (n,) [mm]; fewer than n stretches where it halted.
        """
        provisional = self.contact.measure(points, suspect, provisional=True)
        count, done = len(suspect), 0
        removal = Removal(*np.zeros((4, count)))
        met = {name: np.zeros(count) for name in provisional}

        def sweep(part: slice) -> None:
            if self.edge and part.start < part.stop:
                found = self.material.take_off(
                    points[part.start : part.stop + 1], self.tool, profile(self.tool), travelled[part],
                    stood=stood or part.start > 0,
                )  # fmt: skip
                for column, swept in zip(removal, found, strict=True):
                    column[part] = swept

        flagged = np.flatnonzero(
            np.any([o.depth for o in provisional.values()], axis=0) & (count > 0)
        )
        # Against the material as the stretches before have left it.
        for k in flagged.tolist():
            sweep(slice(done, k))
            done = k
            here = slice(k, k + 1)
            for name, overlap in self.contact.measure(points[k : k + 2], suspect[here]).items():
                met[name][here] = overlap.depth
            if self.halts and any(depth[k] for depth in met.values()):
                count = k + 1
                break
        sweep(slice(done, count))
        removal = Removal(*(column[:count] for column in removal))
        return removal, {name: depth[:count] for name, depth in met.items()}
