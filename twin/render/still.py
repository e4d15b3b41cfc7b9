"""Stills of a recorded run."""

import dataclasses
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from PIL import Image

from twin.errors import RenderError
from twin.files.atomic import complete_or_absent
from twin.recording.reader import Recording
from twin.render.drawing.canvas import Pixels, quality_named
from twin.render.drawing.renderer import Renderer
from twin.render.frames import deal
from twin.render.gauge import Gauge
from twin.render.scene.scene import RenderScene
from twin.render.scene.stage import stage


@dataclasses.dataclass(frozen=True, slots=True)
class Shot:
    """One still.

    Attributes:
        out: The picture (PNG), complete or not at all.
        end: How many samples of the recording lie behind it; see ``moment``.
        line: Source line that is shown as the running one; 0: that of the last sample.
    """

    out: Path
    end: int
    line: int = 0


def stills(
    scene: RenderScene,
    shots: Sequence[Shot],
    *,
    cameras: Sequence[str] = ("overview",),
    size: tuple[int, int] = (1280, 720),
    quality: str = "final",
    renderer: Renderer = "opengl",
    display: bool = True,
) -> None:
    """Draw moments of a recorded run in one pass over it.

    Args:
        shots: The moments, in any order.
        cameras: Names of the cameras; several are shown side by side.
        size: Width and height [px].
        quality: ``draft`` or ``final``.
        renderer: ``opengl`` or ``filament``.
        display: Whether the head-up display is on the pictures.

    Raises:
        RenderError: There is no such camera, no renderer, or a file cannot be written.
        ConfigError: The stock is too large for its grid.
    """
    scene.require(cameras)
    shots = sorted(shots, key=lambda shot: shot.end)
    gauge = Gauge(scene)
    panels = gauge.display(size, None) if display else None
    with stage(scene, size, quality_named(quality).for_still, renderer=renderer) as play:
        waiting = iter(shots)
        for samples, due in deal(scene.recording, np.array([shot.end for shot in shots])):
            play.advance(samples)
            gauge.add(samples)
            if not due:
                continue
            shot = next(waiting)
            pixels = play.picture(*cameras)
            if panels is not None:
                reading = gauge.reading(play.warning)
                reading = dataclasses.replace(reading, line=shot.line or reading.line)
                pixels = panels.draw(pixels, reading)
            save(pixels, shot.out)


def save(pixels: Pixels, out: Path) -> None:
    """Write a picture as PNG, complete or not at all.

    Raises:
        RenderError: The file cannot be written.
    """
    try:
        with complete_or_absent(out) as temporary:
            Image.fromarray(np.ascontiguousarray(pixels)).save(temporary, "PNG", optimize=True)
    except OSError as error:
        raise RenderError(f"{out}: cannot be written: {error.strerror}") from error


def moment(recording: Recording, *, time_s: float | None = None, line: int | None = None) -> int:
    """How many samples lie behind a moment of a recording.

    Args:
        recording: Of n samples.
        time_s: The moment [s].
        line: The end of this source line's first run. Neither: the end of the recording.

    Raises:
        RenderError: There is no such moment.
    """
    period = recording.header.period_s
    if line is not None:
        here = recording.column("line") == line
        if not here.any():
            raise RenderError(f"line {line} of the program moved nothing")
        first = int(np.argmax(here))
        rest = ~here[first:]
        return first + (int(np.argmax(rest)) if rest.any() else len(rest))
    if time_s is None:
        return len(recording)
    last = (len(recording) - 1) * period
    if not 0.0 <= time_s <= last + period:
        raise RenderError(f"the recording has no moment {time_s:g} s: it ends at {last:g} s")
    return min(len(recording), int(time_s / period) + 1)
