"""How the axes of a machine move and carry each other, after ``AxisMotion`` of MTConnect Part 2."""

import dataclasses
from collections.abc import Collection
from typing import Literal

from twin.kinematics import Kinematics
from twin.nc.canonical import Axes, FloatArray

_DIGITS = 6
"""Decimals of directions and places; more is rounding of the model's own turns."""


@dataclasses.dataclass(frozen=True, slots=True)
class AxisMotion:
    """What a positive position of an axis does to the part of the machine that it moves.

    Attributes:
        parent: Name of the axis that carries this one; empty: the frame does.
        axis: Unit vector along or about which it moves, in machine coordinates, shape (3,).
        origin: A point on the axis of what turns, with all axes at zero, from the spindle nose there, shape (3,)
            [mm]; None of what slides.
    """

    type: Literal["PRISMATIC", "REVOLUTE", "CONTINUOUS"]
    parent: str
    axis: tuple[float, ...]
    origin: tuple[float, ...] | None


def motions_of(axes: Axes, chain: Kinematics, endless: Collection[str]) -> dict[str, AxisMotion]:
    """The motion of every axis by its name.

    A joint that carries the part moves against the coordinates that count it (ISO 841), so its direction is
    turned round: what is given is how the machine's own part moves.

    Args:
        chain: The machine's joints, from the tool over the frame to the part, with all axes at zero.
        endless: Names of the axes that turn without end.
    """
    found, names = {}, [axes.names[column] for column in chain.column]
    count = len(names)
    for joint, name in enumerate(names):
        on_tool = bool(chain.on_tool[joint])
        carrier = joint + 1 if on_tool else joint - 1
        carried = 0 <= carrier < count and bool(chain.on_tool[carrier]) is on_tool
        kind = ("CONTINUOUS" if name in endless else "REVOLUTE") if chain.rotary[joint] else None
        found[name] = AxisMotion(
            kind or "PRISMATIC",
            names[carrier] if carried else "",
            _plain(chain.axis[joint] if on_tool else -chain.axis[joint]),
            _plain(chain.anchor[joint]) if kind else None,
        )
    return found


def _plain(vector: FloatArray) -> tuple[float, ...]:
    """A vector without negative zeros."""
    return tuple(round(float(value), _DIGITS) + 0.0 for value in vector)
