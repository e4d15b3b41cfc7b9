"""Canonical moves for the tests, written down by their geometry."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from twin.nc.canonical import Axes, FloatArray, Motion, Moves, Shape

AXES = Axes(("X", "Y", "Z", "C"), ("linear", "linear", "linear", "rotary"))
UP = np.array([0.0, 0.0, 1.0])

Row = dict[str, Any]


def line(start: FloatArray, end: FloatArray, *, motion: Motion = Motion.FEED) -> Row:
    """A straight move from one position (X Y Z C) to another."""
    nothing = np.full(3, np.nan)
    length = float(np.linalg.norm(end[:3] - start[:3]))
    return {
        "shape": Shape.LINE, "start": start, "end": end, "length": length or abs(end[3] - start[3]),
        "center": nothing, "normal": nothing, "radius": np.nan, "sweep": 0.0, "motion": motion,
    }  # fmt: skip


def arc(
    start: FloatArray, center: FloatArray, normal: FloatArray, sweep: float, *,
    lead: float = 0.0, turn: float = 0.0,
) -> Row:  # fmt: skip
    """An arc by its opening angle [deg], rising by ``lead`` [mm] while C turns [deg]."""
    radius = start[:3] - center
    angle = np.deg2rad(sweep)
    turned = np.cos(angle) * radius + np.sin(angle) * np.cross(normal, radius)
    end = np.append(center + turned + lead * normal, start[3] + turn)
    size = float(np.linalg.norm(radius))
    return {
        "shape": Shape.ARC, "start": start, "end": end, "length": np.hypot(size * angle, lead),
        "center": center, "normal": normal, "radius": size, "sweep": sweep, "motion": Motion.FEED,
    }  # fmt: skip


def moves_of(*rows: Mapping[str, Any], first_line: int = 1) -> Moves:
    """Moves over X Y Z C, one source line each."""
    count = len(rows)

    def column(name: str) -> FloatArray:
        return np.array([row[name] for row in rows], np.float64)

    line_numbers = np.arange(first_line, first_line + count)
    return Moves(
        axes=AXES,
        motion=column("motion").astype(np.uint8),
        shape=column("shape").astype(np.uint8),
        line=line_numbers,
        block=10 * line_numbers,
        start=column("start"),
        end=column("end"),
        display=column("end"),
        feed=np.full(count, 1000.0),
        feed_unit=np.zeros(count, np.uint8),
        length=column("length"),
        center=column("center"),
        normal=column("normal"),
        radius=column("radius"),
        sweep=column("sweep"),
        corner=np.zeros(count, np.uint8),
        corner_tolerance=np.full(count, np.nan),
        acceleration=np.full(count, np.nan),
        deceleration=np.full(count, np.nan),
    )
