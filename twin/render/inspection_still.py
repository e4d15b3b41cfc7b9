"""The machined part, coloured by how far it is from what it should be."""

from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from twin.cutting.heights.colours import deviation_colours
from twin.cutting.heights.height_map import HeightMap
from twin.cutting.measuring.inspection import Inspection
from twin.cutting.measuring.measured_part import MeasuredPart
from twin.render.drawing.canvas import quality_named
from twin.render.drawing.renderer import Renderer
from twin.render.hud import INK, MUTED, PAPER, font, lay_over
from twin.render.scene.cameras import PART
from twin.render.scene.scene import RenderScene
from twin.render.scene.stage import stage
from twin.render.still import save


def inspection_still(
    scene: RenderScene,
    part: MeasuredPart,
    *,
    out: Path,
    camera: str = PART,
    size: tuple[int, int] = (1280, 720),
    quality: str = "final",
    renderer: Renderer = "opengl",
) -> None:
    """Draw the part at the end of a run, coloured by what measuring it found.

    Args:
        part: The measured part of that stock; the tolerance has the last colours.
        out: The picture (PNG), complete or not at all.
        size: Width and height [px].
        quality: ``draft`` or ``final``.
        renderer: ``opengl`` or ``filament``.

    Raises:
        RenderError: There is no such camera, no renderer, or the file cannot be written.
        ConfigError: The stock is wrong.
    """
    scene.require((camera,))
    found, paint = part.found, part.deviations
    if isinstance(part.nominal, HeightMap):
        colours = deviation_colours(found.deviation_mm, part.scale_mm)
        paint = np.dstack([colours, 255 * found.measured.astype(np.uint8)])
    cost = quality_named(quality).for_still
    with stage(scene, size, cost, renderer=renderer, paint=paint, trail=False) as play:
        for samples in scene.recording.chunks():
            play.advance(samples)
        play.clear_view()
        pixels = play.picture(camera).copy()
    margin = max(1, round(18 * size[1] / 720))
    lay_over(pixels, _legend(found, size[1] / 720), margin, margin)
    save(pixels, out)


def _legend(found: Inspection, scale: float) -> Image.Image:
    """Colour scale and figures."""
    figures = found.as_json()
    tolerance = f"{found.tolerance_um:g}"
    lines = [("measured share", f"{100 * figures['measured_share']:.1f} %")]
    if "max_um" in figures:
        lines += [
            ("left standing", f"{figures['max_um']:+.1f} µm"),
            ("too deep", f"{figures['min_um']:+.1f} µm"),
            ("mean", f"{figures['mean_um']:+.2f} µm"),
            ("walls known to", f"{figures['bound_um']:.0f} µm"),
            (f"within ±{tolerance} µm", f"{100 * figures['within_share']:.2f} %"),
        ]
    pixels = [max(1, round(scale * value)) for value in (14, 270, 24, 16)]
    padding, width, row, bar = pixels
    panel = Image.new("RGBA", (width, 2 * padding + bar + row * (len(lines) + 1)), (0, 0, 0, 0))
    draw = ImageDraw.Draw(panel)
    draw.rounded_rectangle((0, 0, panel.width - 1, panel.height - 1), 8, fill=PAPER)
    across = np.linspace(-1.0, 1.0, width - 2 * padding)
    colours = np.repeat(deviation_colours(across, 1.0)[None], bar, axis=0)
    panel.paste(Image.fromarray(colours), (padding, padding))
    small = font("DejaVuSans", max(1, round(14 * scale)))
    middle = padding + bar + row // 2
    for place, text, anchor in (
        (padding, f"-{tolerance}", "lm"),
        (width // 2, "0", "mm"),
        (width - padding, f"+{tolerance} µm", "rm"),
    ):
        draw.text((place, middle), text, font=small, fill=MUTED, anchor=anchor)
    for name, text in lines:
        middle += row
        draw.text((padding, middle), name, font=small, fill=MUTED, anchor="lm")
        draw.text((width - padding, middle), text, font=small, fill=INK, anchor="rm")
    return panel
