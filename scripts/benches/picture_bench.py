"""Cutting and filming: moves cut per second, frames drawn per second, and what is not drawing."""

import statistics
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from benches.row import REPEATS, Row, median_cpu_seconds

from twin.cutting.cut import Cutter
from twin.cutting.height_map import blank
from twin.cutting.sweeping import sweep_lines
from twin.cutting.tools import profile
from twin.files.shipped import resource_root
from twin.job.job_file import StockTable, ToolTable, VideoTable
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray
from twin.recording.reader import Samples, open_recording
from twin.render.film import film
from twin.render.scene.stage import Scene
from twin.run.preparation import prepare
from twin.run.progress import no_progress
from twin.run.replay import scene_of
from twin.run.run import Run
from twin.toolpath.part_frame import PartFrame

FREECAD = "FreeCAD height map, published"
PUBLISHED = {0.1: 44e3, 0.2: 146e3}
"""Moves cut per second by FreeCAD's simulator by cell [mm], as published: moves of 0.1 mm, a tool
of 6 mm. It was not run here: PyPI has no FreeCAD."""

MOVE_MM = 0.1
PLATE = StockTable(shape="box", size=(60.0, 60.0, 10.0))
TOOL = ToolTable(number=1, diameter=6.0)
FRAME = PartFrame(rotary=3, center=(0.0, 0.0))
FRAMES = {"draft": 100, "final": 10}
"""Of a film by its quality."""
DEMO = Path("gallery", "fagor8070", "medallion.toml")
RING_CELLS = (0.8, 0.4, 0.2, 0.1)


def rows() -> Iterator[Row]:
    """Cutting at two cells, a ring against its formula, then a film of the demo's scene."""
    for cell, published in PUBLISHED.items():
        yield Row(
            package="picture",
            task=f"cut moves of {MOVE_MM} mm, 6 mm tool, cell {cell} mm",
            figure=moves_per_second(cell),
            unit="moves/s",
            peer=FREECAD,
            peer_figure=published,
        )
        yield Row(
            package="picture",
            task=f"the same on straight passes, cell {cell} mm",
            figure=straight_moves_per_second(cell),
            unit="moves/s",
            peer=FREECAD,
            peer_figure=published,
        )
    for cell in RING_CELLS:
        yield Row("picture", f"ring cut by C at X100, cell {cell} mm: volume off", ring(cell), "%")
    with tempfile.TemporaryDirectory() as folder:
        run = Run(prepare(resource_root("programs") / DEMO))
        dry_run = run.dry_run()
        run.execute(dry_run, Path(folder), no_progress)
        with open_recording(Path(folder) / "recording.h5") as recording:
            scene = scene_of(recording, run.preparation, dry_run.summary)
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
        sweep_lines(part, points, edge, cores=1)

    return (len(points) - 1) / median_cpu_seconds(cut)


def _samples(position: FloatArray) -> Samples:
    """Samples at 1 ms of axes that stand where they were told to."""
    still, column, line = np.zeros_like(position), np.zeros(len(position)), np.ones(len(position))
    number = line.astype(np.int64)
    time: FloatArray = 1e-3 * np.arange(len(position), dtype=np.float64)
    setpoint = Setpoints(time, number, number - 1, column, position, still, still)
    return Samples(setpoint, position, still, still)


def straight_moves_per_second(cell: float) -> float:
    """Moves of straight passes, to and fro, that a cutter takes per second: it joins them."""
    x = np.arange(-27.0, 27.0, MOVE_MM)
    passes = [
        np.stack(np.broadcast_arrays(x[:: 1 - 2 * (number % 2)], y, -2.0, 0.0), axis=1)
        for number, y in enumerate(np.arange(-27.0, 27.0, TOOL.diameter / 3))
    ]
    samples = _samples(np.concatenate(passes))
    feed = np.zeros(len(samples), np.bool_)

    def cut() -> None:
        Cutter(PLATE.model_copy(update={"cell": cell}), TOOL, FRAME, np.zeros(4)).add(samples, feed)

    return len(samples) / median_cpu_seconds(cut)


def ring(cell: float) -> float:
    """How far the volume of a groove cut by turning C alone is off 2 pi R width depth [%]."""
    depth, radius = 2.0, 100.0
    stock = StockTable(shape="cylinder", diameter=240.0, height=20.0, cell=cell)
    cutter = Cutter(stock, TOOL, FRAME, np.zeros(4))
    position = np.tile([radius, 0.0, -depth, 0.0], (20_000, 1))
    position[:, 3] = np.linspace(0.0, 360.0, len(position))
    cutter.add(_samples(position), np.zeros(len(position), np.bool_))
    exact = 2 * np.pi * radius * TOOL.diameter * depth
    return 100.0 * abs(cutter.result().removed_mm3 / exact - 1.0)


def _film(scene: Scene, video: VideoTable, out: Path) -> Iterator[Row]:
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
