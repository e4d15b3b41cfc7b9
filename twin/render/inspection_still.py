"""The machined part, coloured by how far it is from what was commanded."""

from pathlib import Path

import mujoco
import numpy as np
from PIL import Image, ImageDraw

from twin.cutting.colours import deviation_colours
from twin.cutting.cut import Cutter
from twin.cutting.inspection import Inspection, inspect
from twin.cutting.outline import BoolArray
from twin.cutting.tools import ToolPlan
from twin.errors import RenderError
from twin.files import complete_or_absent
from twin.job import StockTable, ToolTable
from twin.machine.config import Machine
from twin.recording import Recording
from twin.render.cameras import PART
from twin.render.canvas import QUALITIES
from twin.render.hud import INK, MUTED, PAPER, font, lay_over
from twin.render.replay import rapid_mask
from twin.render.stage import Scene, stage
from twin.units import UM_PER_MM


def inspection_still(
    recording: Recording,
    *,
    spec: mujoco.MjSpec,
    machine: Machine,
    stock: StockTable,
    tool: ToolTable | ToolPlan,
    tolerance_um: float,
    out: Path,
    camera: str = PART,
    size: tuple[int, int] = (1280, 720),
    quality: str = "final",
    rapid_moves: BoolArray | None = None,
) -> Inspection:
    """Measure the part against the one that the commanded path would cut, and draw it.

    Args:
        recording: The run.
        spec: Machine, tool and named cameras.
        machine: The machine file.
        stock: The blank.
        tool: What is in the spindle, or what is in it when.
        tolerance_um: Deviation that is still good, and that has the last colours [µm].
        out: The picture (PNG), complete or not at all.
        camera: Name of the camera.
        size: Width and height [px].
        quality: ``draft`` or ``final``.
        rapid_moves: Whether each move of the program is a rapid; None: none is.

    Raises:
        RenderError: There is no such camera, no OpenGL, or the file cannot be written.
        ConfigError: The stock is wrong.
    """
    scene = Scene(recording=recording, spec=spec, machine=machine, tool=tool, stock=stock)
    scene.require_camera(camera)
    header = recording.header
    real, ideal = (
        Cutter(stock, tool, header.part_frame, header.part_zero, along=along)
        for along in ("joints", "setpoints")
    )
    for samples in recording.chunks():
        rapid = rapid_mask(samples, rapid_moves)
        real.add(samples, rapid)
        ideal.add(samples, rapid)
    found = inspect(real.map, ideal.map, tolerance_um)
    paint = deviation_colours(found.deviation_mm, tolerance_um / UM_PER_MM)
    with stage(scene, size, QUALITIES[quality], paint=paint) as play:
        for samples in recording.chunks():
            play.advance(samples)
        pixels = play.picture(camera).copy()
    lay_over(pixels, _legend(found, size[1] / 720), 18, 18)
    try:
        with complete_or_absent(out) as temporary:
            Image.fromarray(np.ascontiguousarray(pixels)).save(temporary, "PNG", optimize=True)
    except OSError as error:
        raise RenderError(f"{out}: cannot be written: {error.strerror}") from error
    return found


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
