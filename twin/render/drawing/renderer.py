"""Which renderer draws: MuJoCo's OpenGL one, or the physically based Filament."""

import contextlib
from collections.abc import Iterator
from typing import Literal

import mujoco

from twin.errors import RenderError
from twin.render.drawing import filament_canvas, opengl_canvas
from twin.render.drawing.canvas import Canvas, Quality
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


Renderer = Literal["opengl", "filament"]


def prepare(
    spec: mujoco.MjSpec, renderer: Renderer, quality: Quality, size: tuple[int, int]
) -> None:
    """Set what the model must say about a renderer's pictures before it is compiled."""
    room = filament_canvas if renderer == "filament" else opengl_canvas
    room.prepare(spec, quality, size)


@contextlib.contextmanager
def open_canvas(
    model: mujoco.MjModel, renderer: Renderer, size: tuple[int, int], quality: Quality
) -> Iterator[Canvas]:
    """Open a canvas for a model that ``prepare`` was applied to; one at a time in a process.

    Raises:
        RenderError: The renderer does not work here, or has too little memory.
    """
    if renderer == "filament":
        drawing: Canvas = open_filament(model, size, quality)
    else:
        drawing = opengl_canvas.OpenGLCanvas(model, size, quality)
    try:
        yield drawing
    finally:
        drawing.close()
