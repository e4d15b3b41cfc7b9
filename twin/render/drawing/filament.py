"""Whether Filament draws here: it needs a Vulkan driver."""

import mujoco

from twin.errors import RenderError
from twin.render.drawing.canvas import Quality
from twin.render.drawing.filament_canvas import FilamentCanvas
from twin.render.drawing.gl import FILAMENT, probe

PACKAGES = "libvulkan1 mesa-vulkan-drivers"
"""What Debian and Ubuntu call a Vulkan that draws without a graphics card."""


def require_filament() -> None:
    """Make sure that Filament draws here; it is tried in a process of its own.

    Where there is no Vulkan driver, Filament ends the process that it runs in.

    Raises:
        RenderError: It does not; the message says why and what to install.
    """
    error = probe(FILAMENT).error
    if error:
        raise RenderError(
            f"the Filament renderer does not work here: {error}; it needs a Vulkan driver, "
            f"on Debian and Ubuntu: apt-get install {PACKAGES}; or use the renderer 'opengl'"
        )


def open_filament(model: mujoco.MjModel, size: tuple[int, int], quality: Quality) -> FilamentCanvas:
    """Open a Filament canvas for a model that was prepared for it.

    Raises:
        RenderError: Filament does not work here.
    """
    require_filament()
    return FilamentCanvas(model, size, quality)
