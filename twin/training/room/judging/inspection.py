"""What the score sheet shows: how the tool was in the part at an alarm, and the part that was handed in."""

import dataclasses
import io
import math
from typing import NamedTuple

import numpy as np
from PIL import Image, ImageDraw

from twin.job.job_file import ToolTable
from twin.nc.canonical import FloatArray
from twin.training.room.observed import Observed, RoomAlarm

FINEST = 240
"""Cells along a side of the kept stock, at most."""
WIDTH, SECTION_HEIGHT = 480, 150
"""Of the picture [pixels]; the section lies below the view from above."""
_STEEL, _CUT, _TOOL, _PAPER = (176, 187, 197), (84, 131, 166), (214, 50, 47), (255, 255, 255)


@dataclasses.dataclass(frozen=True)
class AlarmMoment:
    """An alarm with what there was to see.

    Attributes:
        text: The block that ran, as it is written; empty: none did.
        tip: Where the tool was in the part's frame, shape (3,) [mm].
        heights: Of the stock, every few cells, shape (ny, nx) [mm]; empty: there was none.
        origin: X and Y of the first cell [mm].
        cell: Side of a kept cell [mm].
        ends: Underside and top of the blank [mm].
    """

    alarm: RoomAlarm
    text: str
    tip: FloatArray
    tool: ToolTable
    heights: FloatArray
    origin: tuple[float, float]
    cell: float
    ends: tuple[float, float]

    def picture(self) -> bytes | None:
        """The part from above with the tool, and the section along X through it, as PNG."""
        if not self.heights.size:
            return None
        rows, columns = self.heights.shape
        scale = WIDTH / columns
        height = max(1, round(rows * scale))
        low, high = self.ends
        shade = np.clip((self.heights - low) / max(high - low, 1e-9), 0.0, 1.0)[..., None]
        uncut = (self.heights >= high - 1e-6)[..., None]
        colour = np.where(uncut, _STEEL, np.array(_CUT) * (0.35 + 0.65 * shade))
        top = Image.fromarray(colour.astype(np.uint8)[::-1]).resize((WIDTH, height))
        picture = Image.new("RGB", (WIDTH, height + SECTION_HEIGHT + 8), _PAPER)
        picture.paste(top, (0, 0))
        draw = ImageDraw.Draw(picture)
        x = (self.tip[0] - self.origin[0]) / self.cell * scale
        y = height - (self.tip[1] - self.origin[1]) / self.cell * scale
        radius = 0.5 * self.tool.diameter / self.cell * scale
        draw.ellipse((x - radius, y - radius, x + radius, y + radius), outline=_TOOL, width=3)
        self._draw_section(draw, height + 8, (x, radius), scale / self.cell)
        stream = io.BytesIO()
        picture.save(stream, "PNG")
        return stream.getvalue()

    def _draw_section(
        self, draw: ImageDraw.ImageDraw, top: int, tool: tuple[float, float], scale: float
    ) -> None:
        """The section along X at the tool's Y, to scale, cut off above and below."""
        rows, columns = self.heights.shape
        row = round((float(self.tip[1]) - self.origin[1]) / self.cell)
        x, radius = tool
        middle, base = top + SECTION_HEIGHT // 2, top + SECTION_HEIGHT - 1

        def level(z: float) -> float:
            return float(np.clip(middle - (z - self.ends[1]) * scale, top, base))

        if 0 <= row < rows:
            width = WIDTH / columns
            for column, z in enumerate(self.heights[row]):
                if z > self.ends[0]:
                    box = (column * width, level(float(z)), (column + 1) * width, base)
                    draw.rectangle(box, fill=_STEEL)
        tip = level(float(self.tip[2]))
        draw.rectangle((x - radius, top, x + radius, tip), outline=_TOOL, width=3)


def moment_of(room: Observed, alarm: RoomAlarm) -> AlarmMoment:
    """How the tool is in the part, in so few cells that it costs the machine nothing."""
    setup, lines = room.setup, room.program.lines
    running = room.slot.run is not None and room.slot.running == "program"
    text = lines[alarm.line - 1].strip() if running and 0 < alarm.line <= len(lines) else ""
    tool = setup.tables.tool
    if setup.work is None:
        return AlarmMoment(
            alarm, text, setup.tip, tool, np.zeros((0, 0)), (0.0, 0.0), 1.0, (0.0, 0.0)
        )
    heights, origin, cell = setup.work.view_from_above()
    every = max(1, -(-max(heights.shape) // FINEST))
    kept = heights[::every, ::every].copy()
    return AlarmMoment(alarm, text, setup.tip, tool, kept, origin, cell * every, setup.work.ends)


class MeasuredPlace(NamedTuple):
    """A place of the part, measured.

    Attributes:
        x: Program coordinates at C0 [mm].
        y: The same along Y [mm].
        wanted: Height that the scene asks for [mm].
        found: Height of the part [mm]; None: there is no part.
        good: Whether both agree within the scene's tolerance.
    """

    x: float
    y: float
    wanted: float
    found: float | None
    good: bool


class PartInspection(NamedTuple):
    """A part that was handed in.

    Attributes:
        moment: How it looks, with the tool as it stood then.
        removed: Material that was cut off [mm³]; None: there was no blank.
        wanted_removed: Least and most that the scene asks for [mm³]; None: it does not ask.
    """

    moment: AlarmMoment
    places: tuple[MeasuredPlace, ...] = ()
    removed: float | None = None
    wanted_removed: tuple[float, float] | None = None


def part_is_right(room: Observed) -> bool:
    """Whether the part on the table is the one that the scene asks for."""
    part, work = room.scene.file.part, room.setup.work
    if part is None:
        return True
    if work is None or not part.removed_mm3[0] <= work.removed <= part.removed_mm3[1]:
        return False
    return all(place.good for place in measured_places(room))


def measured_places(room: Observed) -> tuple[MeasuredPlace, ...]:
    """Measure the part on the table where the scene asks for it."""
    part, work = room.scene.file.part, room.setup.work
    if part is None or work is None:
        return ()
    found = []
    for x, y, wanted in part.points:
        height = work.measured(x, y, wanted)
        good = abs(height - wanted) <= part.tolerance
        found.append(MeasuredPlace(x, y, wanted, height if math.isfinite(height) else None, good))
    return tuple(found)


def inspect_part(room: Observed, moment: AlarmMoment) -> PartInspection:
    """Measure what is handed in."""
    part, work = room.scene.file.part, room.setup.work
    if part is None or work is None:
        return PartInspection(moment)
    return PartInspection(moment, measured_places(room), work.removed, part.removed_mm3)
