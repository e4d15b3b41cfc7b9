"""A ball-bar's log: how far the tool is off a circle, over the angle (ISO 230-4, as a QC20-W exports it)."""

import enum
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
import pydantic
from pydantic import Field

from twin.errors import UsageError
from twin.files.toml import Table, checked, load_toml
from twin.logs.column_map import ColumnTable
from twin.logs.machine_log import channel_of, read_raw_log
from twin.logs.units import factor
from twin.nc.canonical import FloatArray

Positive = Annotated[float, Field(gt=0)]


class CircleSense(enum.IntEnum):
    """Sense of a circle, seen along the normal of its plane."""

    COUNTER_CLOCKWISE = 1
    CLOCKWISE = -1


_LEAST_TURN = 180.0
"""An arc below this many degrees does not tell a circle's shape from where its centre is."""
_LEAST_SAMPLES = 100
_FARTHEST = 0.02
"""Share of the radius beyond which a deviation is none."""


class BallBarTable(Table):
    """``[ball_bar]`` of a map: the circle, and the columns of either direction or of both."""

    plane: Literal["XY", "ZX", "YZ"]
    """The first axis is the one along which the angle is 0."""
    radius: Positive
    """Commanded [mm]."""
    feed: Positive
    """Along the circle [mm/min]."""
    angle: ColumnTable
    """Counter-clockwise from the first axis, in either direction of motion."""
    counter_clockwise: ColumnTable | None = None
    """Distance outward from the commanded circle, of the counter-clockwise turn."""
    clockwise: ColumnTable | None = None
    """That distance of the clockwise turn."""

    @pydantic.model_validator(mode="after")
    def _has_a_direction(self) -> "BallBarTable":
        if self.counter_clockwise is None and self.clockwise is None:
            raise ValueError("needs 'counter_clockwise' or 'clockwise', or both")
        return self


class BallBarLog(NamedTuple):
    """A ball-bar's log.

    Attributes:
        plane: The two axes, in the order in which positive turns go.
        radius: Commanded [mm].
        speed: Along the circle [mm/s].
        angle: Counter-clockwise from the first axis, shape (n,) [rad].
        turns: Distance outward from the circle by direction, shape (n,) each [mm].
    """

    name: str
    plane: str
    radius: float
    speed: float
    angle: FloatArray
    turns: Mapping[CircleSense, FloatArray]


def read_ball_bar(path: Path, columns: Path | None) -> BallBarLog:
    """Read a ball-bar's log.

    Args:
        path: The log: a table with a column of angles and one or two of deviations.

    Raises:
        UsageError: There is no map, the log cannot be read, or it is no turn of a ball-bar.
        ConfigError: The map is wrong.
    """
    data: dict[str, Any] = {} if columns is None else load_toml(columns)
    if not isinstance(data.get("ball_bar"), dict):
        raise UsageError(
            f"{path}: a ball-bar's log needs a map, --columns MAP.toml, with a table such as\n[ball_bar]\n"
            'plane = "XY"\nradius = 150.0    # mm\nfeed = 1000.0    # mm/min\n'
            'angle = { column = "angle", unit = "deg" }\n'
            'counter_clockwise = { column = "ccw", unit = "um" }\n'
            'clockwise = { column = "cw", unit = "um" }'
        )
    where = f"{columns}: ball_bar"
    table = checked(data["ball_bar"], BallBarTable, where)
    raw = read_raw_log(path)

    def numbers(role: str, column: ColumnTable, *, angle: bool = False) -> FloatArray:
        scale = factor("position", "rotary" if angle else "linear", column.unit, f"{where}.{role}")
        channel = channel_of(raw, where, role, column)
        return (channel.numbers(path) * column.scale + column.offset) * scale

    angle = np.deg2rad(numbers("angle", table.angle, angle=True))
    roles = {CircleSense.COUNTER_CLOCKWISE: "counter_clockwise", CircleSense.CLOCKWISE: "clockwise"}
    turns = {
        sense: numbers(role, column)
        for sense, role in roles.items()
        if (column := getattr(table, role)) is not None
    }
    log = BallBarLog(str(path), table.plane, table.radius, table.feed / 60.0, angle, turns)
    _refuse_what_is_no_turn(log)
    return log


def _refuse_what_is_no_turn(log: BallBarLog) -> None:
    if not np.isfinite([log.angle, *log.turns.values()]).all():
        raise UsageError(f"{log.name}: holds what is not a finite number")
    seen = len(np.unique(np.floor(np.rad2deg(log.angle) % 360.0)))
    if len(log.angle) < _LEAST_SAMPLES or seen < _LEAST_TURN / 2.0:
        raise UsageError(
            f"{log.name}: {len(log.angle)} samples within {seen} degrees; a turn of "
            f"{_LEAST_TURN:g} degrees or more in {_LEAST_SAMPLES} samples is needed"
        )
    farthest = max(float(np.abs(turn).max()) for turn in log.turns.values())
    if farthest > _FARTHEST * log.radius:
        raise UsageError(
            f"{log.name}: is {farthest:.4g} mm off a circle of {log.radius:g} mm: deviations are "
            "counted from the circle, and their unit is the map's"
        )
