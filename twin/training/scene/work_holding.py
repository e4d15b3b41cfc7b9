"""What holds the raw part of a scene: a vise under a block, a chuck with three jaws under a round one.

They are fixtures like those that a job file names: they are drawn, and whatever of the tool's side meets them is a
collision. A scene whose job or machine file clamps something itself has nothing added.
"""

import dataclasses
import math
from collections.abc import Iterator

from twin.job.fixture import FixtureTable
from twin.machine.description.config import Blank, MachineConfig
from twin.run.preparing.preparation import Preparation

GRIP_SHARE, GRIP_MM = 0.3, (2.0, 8.0)
"""How much of the part's height the jaws grip: a share of it, within so much [mm]."""
PARALLELS_MM = 12.0
"""What lifts the part off a vise's bed or a chuck's face [mm]."""
JAW_SHARE, JAW_WIDTH_MM = 0.75, (30.0, 160.0)
"""Width of a vise's jaws: a share of the part's length along X, within so much [mm]."""
JAW_THICKNESS_MM, JAW_DIAMETER_MM = 18.0, 20.0
"""Of a vise's jaws, and of a chuck's, which are round [mm]."""
CHUCK_JAWS = 3
_Z = 2
STEEL_G_MM3 = 7.85e-3
"""[g/mm³]"""


def with_work_holding(preparation: Preparation) -> Preparation:
    """The job of a scene with what holds its raw part.

    Raises:
        ConfigError: The machine or the stock is wrong.
    """
    job, machine = preparation.job, preparation.machine
    stock = job.file.stock
    if stock is None or stock.shape == "stl" or machine.file.fixtures:
        return preparation
    if machine.part_frame.table_about(_Z) is None:
        return preparation
    blank = preparation.layout.blank
    assert blank is not None
    if blank.direction != _Z:
        return preparation  # A bar that lies is held by its ends, on machines that have something for that.
    holding = {"fixtures": tuple(_chuck(blank) if blank.round else _vise(blank))}
    return dataclasses.replace(
        preparation,
        job=job.with_file(job.file.model_copy(update=holding)),
        machine=MachineConfig(machine.path, machine.file.model_copy(update=holding)),
    )


def _vise(blank: Blank) -> Iterator[FixtureTable]:
    """A bed along Y, with the jaw that is behind the part and the one that is screwed against it."""
    (length, width, _), (x, y, _) = blank.size, blank.center
    across = _within(JAW_SHARE * length, JAW_WIDTH_MM)
    foot, top = _heights(blank)
    if foot:
        yield _box("vise bed", (across, width + 4.0 * JAW_THICKNESS_MM, foot), (x, y, 0.0))
    jaw = (across, JAW_THICKNESS_MM, top - foot)
    away = (width + JAW_THICKNESS_MM) / 2.0
    yield _box("fixed jaw", jaw, (x, y + away, foot))
    yield _box("moving jaw", jaw, (x, y - away, foot))


def _chuck(blank: Blank) -> Iterator[FixtureTable]:
    """A round body with three jaws about the part."""
    (diameter, _, _), (x, y, _) = blank.size, blank.center
    foot, top = _heights(blank)
    if foot:
        yield _cylinder("chuck", diameter + 2.0 * JAW_DIAMETER_MM, foot, (x, y, 0.0))
    away = (diameter + JAW_DIAMETER_MM) / 2.0
    for number in range(CHUCK_JAWS):
        turn = 2.0 * math.pi * number / CHUCK_JAWS
        place = x + away * math.cos(turn), y + away * math.sin(turn), foot
        yield _cylinder(f"chuck jaw {number + 1}", JAW_DIAMETER_MM, top - foot, place)


def _heights(blank: Blank) -> tuple[float, float]:
    """Heights over the table of a bed or chuck's face, 0 where there is no room for one, and of the jaws' upper ends [mm]."""
    height, middle = blank.size[2], blank.center[2]
    gap = middle - height / 2.0
    return max(gap - PARALLELS_MM, 0.0), gap + _within(GRIP_SHARE * height, GRIP_MM)


def _within(value: float, ends: tuple[float, float]) -> float:
    return min(max(value, ends[0]), ends[1])


def _box(
    name: str, size: tuple[float, float, float], place: tuple[float, float, float]
) -> FixtureTable:
    mass = STEEL_G_MM3 * math.prod(size) / 1000.0
    return FixtureTable(name=name, size=size, position=place, mass=mass)


def _cylinder(
    name: str, diameter: float, height: float, place: tuple[float, float, float]
) -> FixtureTable:
    mass = STEEL_G_MM3 * math.pi / 4.0 * diameter**2 * height / 1000.0
    return FixtureTable(name=name, diameter=diameter, height=height, position=place, mass=mass)
