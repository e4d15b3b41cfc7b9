"""Cutting and filming: moves cut per second, frames drawn per second, and what is not drawing."""

import statistics
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from benches.row import REPEATS, Row, median_cpu_seconds

from twin.cutting.heights.height_map import blank
from twin.cutting.heights.sweeping import sweep_lines
from twin.cutting.tools import profile
from twin.cutting.tridexel import engagement
from twin.cutting.tridexel.blanks import box
from twin.cutting.tridexel.solids.moving_solid import Poses
from twin.cutting.tridexel.solids.solids import cutting_edge
from twin.files.shipped import resource_root
from twin.job.job_file import StockTable, ToolTable, VideoTable
from twin.nc.canonical import FloatArray
from twin.recording.reader import open_recording
from twin.render.film import film
from twin.render.scene.stage import RenderScene
from twin.run.preparing.preparation import prepare
from twin.run.progress import no_progress
from twin.run.replay import scene_of
from twin.run.run import Run

FREECAD = "FreeCAD height map, published"
PUBLISHED = {0.1: 44e3, 0.2: 146e3}
"""Moves cut per second by FreeCAD's simulator by cell [mm], as published: moves of 0.1 mm, a tool
of 6 mm. It was not run here: PyPI has no FreeCAD."""

MOVE_MM = 0.1
PLATE = StockTable(shape="box", size=(60.0, 60.0, 10.0))
TOOL = ToolTable(number=1, diameter=6.0)
FRAMES = {"draft": 100, "final": 10}
"""Of a film by its quality."""
DEMO = Path("gallery", "fagor8070", "medallion.toml")


def rows() -> Iterator[Row]:
    """Cutting at two cells, then a film of the demo's scene."""
    for cell, published in PUBLISHED.items():
        yield Row(
            package="picture",
            task=f"cut moves of {MOVE_MM} mm, 6 mm tool, cell {cell} mm",
            figure=moves_per_second(cell),
            unit="moves/s",
            peer=FREECAD,
            peer_figure=published,
        )
    for tilt, size in ((0.0, 60.0), (0.0, 200.0), (20.0, 60.0), (20.0, 200.0)):
        yield Row(
            package="picture",
            task=f"cut from any side: moves of {MOVE_MM} mm, 6 mm ball at {tilt:g} degrees, cell 0.2 mm, part of {size:g} mm",
            figure=tri_dexel_moves_per_second(0.2, tilt, size),
            unit="moves/s",
        )
    with tempfile.TemporaryDirectory() as folder:
        run = Run(prepare(resource_root("programs") / DEMO))
        run.execute(Path(folder), no_progress)
        with open_recording(Path(folder) / "recording.h5") as recording:
            scene = scene_of(recording, run.preparation, run.dry_run.summary)
            yield from _film(scene, run.preparation.job.file.video, Path(folder) / "film.mp4")


def _spiral() -> FloatArray:
    """An Archimedean spiral in steps of ``MOVE_MM``, a third of the tool apart, shape (n, 3) [mm]."""
    pitch = TOOL.diameter / 3
    turns = 12.0
    length = np.pi * turns**2 * pitch
    share = np.sqrt(np.linspace(0.0, 1.0, round(length / MOVE_MM)))
    angle, radius = 2 * np.pi * turns * share, turns * pitch * share
    return np.stack(
        [radius * np.cos(angle), radius * np.sin(angle), np.full_like(angle, -2.0)], axis=1
    )


def moves_per_second(cell: float) -> float:
    """Moves of a spiral pocket that are cut per second."""
    points, edge = _spiral(), profile(TOOL)
    part = blank(PLATE, np.zeros(3), cell)

    def cut() -> None:
        part.heights[:] = part.top
        sweep_lines(part, points, edge)

    return (len(points) - 1) / median_cpu_seconds(cut)


def tri_dexel_moves_per_second(cell: float, tilt: float, size: float = 60.0) -> float:
    """Moves of a ball per second, on waves in rows a millimetre apart, its axis turning about Z.

    Args:
        cell: Between the lines of the stock [mm].
        tilt: Of the axis off Z [deg].
        size: Of the block along X and Y, of which the same is cut [mm].
    """
    edge = profile(TOOL.model_copy(update={"kind": "ball"}))
    x = np.arange(-27.0, 27.0, MOVE_MM)
    middle = np.concatenate(
        [
            np.stack(np.broadcast_arrays(x[:: 1 - 2 * (n % 2)], y, 1.5 + 0.5 * np.sin(x / 5.0)), 1)
            for n, y in enumerate(np.arange(-20.0, 20.0))
        ]
    )
    turn, off = np.arange(len(middle)) / 300.0, np.deg2rad(tilt)
    upright = np.full(len(turn), np.cos(off))
    axis = np.stack([np.sin(off) * np.cos(turn), np.sin(off) * np.sin(turn), upright], 1)
    poses = Poses(middle - edge.radius * axis, axis)
    half = 0.5 * size
    whole = box(np.array([-half, -half, -10.0]), np.array([half, half, 0.0]), cell)

    def cut() -> None:
        engagement.cut(whole.copy(), poses, cutting_edge(edge, TOOL.flute), 1)

    return (len(middle) - 1) / median_cpu_seconds(cut)


def _film(scene: RenderScene, video: VideoTable, out: Path) -> Iterator[Row]:
    """Frames per second at 720p behind the first one, and processor time of a frame."""
    for quality, frames in FRAMES.items():
        asked = {"size": (1280, 720), "seconds": frames / video.fps, "quality": quality}
        rates: list[float] = []
        costs: list[float] = []
        for _ in range(REPEATS):
            marks: list[tuple[float, float]] = []
            film(
                scene,
                video=video.model_copy(update=asked),
                out=out,
                progress=lambda *_, marks=marks: marks.append(
                    (time.perf_counter(), time.process_time())
                ),
            )
            passed, spent = np.subtract(marks[-1], marks[0]) / (frames - 1)
            rates.append(1.0 / passed)
            costs.append(1e3 * spent)
        task = f"film the demo's part, 1280 x 720, {quality}"
        yield Row("picture", task, statistics.median(rates), "frames/s")
        yield Row("picture", f"{task}: processor time", statistics.median(costs), "ms a frame")
