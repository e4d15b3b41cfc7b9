"""What pictures are made of: a recording, and the machine and job that it was made with."""

import dataclasses
from collections.abc import Sequence

import mujoco

from twin.cutting.program_summary import ProgramSummary
from twin.errors import RenderError
from twin.job.job_file import StockTable
from twin.machine.description.config import MachineConfig
from twin.recording.reader import Recording
from twin.render.scene.cameras import PART_CAMERAS


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class RenderScene:
    """What is to be seen: a recording, and the machine and job that it was made with."""

    recording: Recording
    spec: mujoco.MjSpec
    """Machine, tool and named cameras, as the machine room builds it; it is not changed."""
    machine: MachineConfig
    summary: ProgramSummary
    """What is in the spindle when, which moves are rapids, what the screen shows."""
    source: Sequence[str] = ()
    """Lines of the program."""
    stock: StockTable | None = None
    error_scale_um: float | None = None
    """Contour error that has the trail's last colour [µm]; none: the greatest."""

    def camera_names(self) -> list[str]:
        """Names of the cameras that can be asked for."""
        own = [camera.name for camera in self.spec.cameras if camera.name]
        return own + [name for name in PART_CAMERAS if name not in own]

    @property
    def error_scale(self) -> float:
        """Contour error that has the trail's last colour [µm]."""
        if self.error_scale_um is not None:
            return self.error_scale_um
        errors = self.recording.contour_um(0, len(self.recording))
        return 0.0 if errors is None else float(errors.max(initial=0.0))

    def require(self, cameras: Sequence[str]) -> None:
        """Refuse a scene that cannot be shown.

        Raises:
            RenderError: The recording is empty, or the machine lacks a camera; the message names
                those that there are.
        """
        if not len(self.recording):
            raise RenderError("the recording has no samples: there is nothing to show")
        known = ", ".join(self.camera_names())
        if not cameras:
            raise RenderError(f"no camera is named: the machine has {known}")
        for name in cameras:
            if name not in self.camera_names():
                raise RenderError(f"no camera '{name}': the machine has {known}")
