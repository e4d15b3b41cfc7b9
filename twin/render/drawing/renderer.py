"""Which renderer draws: MuJoCo's OpenGL one, or the physically based Filament."""

import contextlib
from collections.abc import Iterator
from typing import Literal

import mujoco

from twin.render.drawing import filament_canvas, opengl_canvas
from twin.render.drawing.canvas import Canvas, Quality
from twin.render.drawing.filament import open_filament

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
