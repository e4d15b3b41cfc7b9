"""How fast the planner plans.

What its times are worth is held in ``tests/motion``, against Ruckig, TOPP-RA and a time-optimal plan.
"""

import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from benches.row import Row, median_cpu_seconds

from twin.motion.limits import MotionLimits
from twin.motion.planner import plan_phases
from twin.nc.canonical import Chunk
from twin.run.preparing.preparation import Preparation, prepare

CAMOTICS_LINES, CAMOTICS_ARCS = 78e3, 2.5e3
"""What its planner was once measured at, on short lines and on arcs [blocks/s]: it is not run here."""


def prepared(folder: Path, text: str) -> Preparation:
    """A program on mill4, in the dialect of the Fagor 8070."""
    path = folder / "program.nc"
    path.write_text(text, encoding="utf-8")
    return prepare(path, dialect="fagor8070", machine="mill4")


def cycle_s(chunks: list[Chunk], limits: MotionLimits) -> float:
    """Time of a program that starts at zero."""
    return list(plan_phases(chunks, limits, start=np.zeros(4)))[-1].end_time


def rows() -> Iterator[Row]:
    """Blocks a second, as the planner plans them."""
    with tempfile.TemporaryDirectory() as name:
        yield from _rates(Path(name))


def _rates(folder: Path) -> Iterator[Row]:
    for task, text, peer in (
        ("short lines, exact path", _surface(40_000, "G50"), CAMOTICS_LINES),
        ("short lines, continuous", _surface(40_000, "G05"), CAMOTICS_LINES),
        ("half circles, exact path", _half_circles(2_000, "G50"), CAMOTICS_ARCS),
        ("half circles, continuous", _half_circles(2_000, "G05"), CAMOTICS_ARCS),
        ("half circles at F300, exact path", _half_circles(2_000, "G50", 300), CAMOTICS_ARCS),
        ("helices with C, exact path", _helices(2_000), CAMOTICS_ARCS),
    ):
        preparation = prepared(folder, text)
        chunks = list(preparation.interpretation().chunks())
        limits = preparation.machine.motion_limits
        blocks = sum(len(chunk.moves) for chunk in chunks)
        seconds = median_cpu_seconds(lambda c=chunks, m=limits: cycle_s(c, m), repeats=3)
        yield Row("motion", task, blocks / seconds, "blocks/s", "CAMotics, stated", peer)


def _surface(count: int, mode: str) -> str:
    """Rows of 50 mm over a wavy surface in chords of 0.05 mm, as CAM writes them."""
    way = np.arange(1, count + 1) * 0.05
    x = np.abs(way % 100.0 - 50.0) - 50.0
    y = np.floor(way / 50.0) * 0.3
    z = 3.0 * np.sin(x / 4.0) + 2.0 * np.cos(y / 3.0) - 2.0
    lines = [f"G01 X{a:.4f} Y{b:.4f} Z{c:.4f}" for a, b, c in zip(x, y, z, strict=True)]
    return "\n".join([f"G90 G17 {mode} F3000", *lines]) + "\n"


def _half_circles(count: int, mode: str, feed: int = 3000) -> str:
    """A wave of half circles of 1 mm, to and fro over 200 mm."""
    lines: list[str] = []
    for number in range(count):
        turn, step = divmod(number, 100)
        x = 2 * (step + 1) if turn % 2 == 0 else 200 - 2 * (step + 1)
        lines.append(f"G0{2 + number % 2} X{x} Y0 I{1 if turn % 2 == 0 else -1} J0")
    return "\n".join([f"G90 G17 {mode} F{feed}", *lines]) + "\n"


def _helices(count: int) -> str:
    """Full turns of 10 mm, up and down by 1 mm, with the table going 30 degrees to and fro."""
    lines = [f"G03 X0 Y0 Z{number % 2} I5 J0 C{30 * (number % 2)}" for number in range(count)]
    return "\n".join(["G90 G17 G50 F3000", *lines]) + "\n"
