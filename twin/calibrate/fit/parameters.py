"""What an axis's drive and its log are made of: the parameters that a fit may move."""

import dataclasses
import math

from twin.machine.description.machine_file import AxisTable


@dataclasses.dataclass(frozen=True, slots=True)
class AxisParameters:
    """One axis, in the units of the machine file; those of the log come last."""

    kv: float
    damping_ratio: float
    mass: float
    viscous_friction: float
    dry_friction: float
    constant_force: float
    velocity_feedforward: float
    acceleration_feedforward: float
    reset_time_s: float
    loop_delay_s: float
    velocity_filter_s: float
    command_filter_s: float
    current_scale: float
    current_at_rest: float
    delay: float = 0.0
    """Of the logged actual position behind the axis [s]; of the log, not of the machine."""
    force_delay: float = 0.0
    """Of the logged force or current behind the drive [s]."""
    measuring_filter: float = 0.0
    """Time constant of the filter in front of the logged actual position [s]."""


@dataclasses.dataclass(frozen=True, slots=True)
class Coordinate:
    """How a fit moves one parameter.

    Attributes:
        step: By which a derivative is taken, in the coordinate.
        logarithmic: Moved by its logarithm: it is positive, and errors are shares.
        reciprocal: Moved by one over it, and 0 as 0: a time whose rate counts, 0 being none.
    """

    unit: str
    step: float
    low: float
    high: float
    logarithmic: bool = False
    reciprocal: bool = False

    def inside(self, value: float) -> float:
        """The coordinate of a value."""
        if self.reciprocal:
            return 1.0 / value if value > 0.0 else 0.0
        return math.log(value) if self.logarithmic else value

    def outside(self, coordinate: float) -> float:
        """The value of a coordinate."""
        if self.reciprocal:
            return 1.0 / coordinate if coordinate > _SLOWEST_RATE else 0.0
        return math.exp(min(max(coordinate, -700.0), 700.0)) if self.logarithmic else coordinate

    @property
    def bounds(self) -> tuple[float, float]:
        """Lowest and highest coordinate."""
        if self.reciprocal:
            return 0.0, 1.0 / self.low
        return self.inside(self.low), self.inside(self.high)


_ANY = float("inf")
_SLOWEST_RATE = 1e-3
"""A rate below this is none [1/s]."""


def coordinates(kind: str, force_scale: float) -> dict[str, Coordinate]:
    """How each parameter of an axis is moved.

    Args:
        kind: ``linear`` or ``rotary``.
        force_scale: A force that matters to the axis [N or N m].
    """
    linear = kind == "linear"
    force = "N" if linear else "N m"
    nudge = 1e-3 * force_scale
    return {
        "kv": Coordinate(
            "(m/min)/mm" if linear else "(1000 deg/min)/deg", 1e-4, 1e-3, 1e3, logarithmic=True
        ),
        "damping_ratio": Coordinate("", 1e-4, 0.05, 50.0, logarithmic=True),
        "mass": Coordinate("kg" if linear else "kg m²", 1e-4, 1e-9, 1e9, logarithmic=True),
        "viscous_friction": Coordinate(f"{force} s/{'mm' if linear else 'deg'}", nudge * 1e-3,
                                       0.0, _ANY),
        "dry_friction": Coordinate(force, nudge, 0.0, _ANY),
        "constant_force": Coordinate(force, nudge, -_ANY, _ANY),
        "velocity_feedforward": Coordinate("", 1e-4, 0.0, 1.0),
        "acceleration_feedforward": Coordinate("", 1e-3, 0.0, 1.0),
        "reset_time_s": Coordinate("s", 0.05, 1e-3, 1e3, reciprocal=True),
        "loop_delay_s": Coordinate("s", 1e-5, 0.0, 0.02),
        "velocity_filter_s": Coordinate("s", 1e-5, 0.0, 0.02),
        "command_filter_s": Coordinate("s", 1e-5, 0.0, 0.1),
        "current_scale": Coordinate(f"{force}/A", 1e-4, 1e-9, 1e9, logarithmic=True),
        "current_at_rest": Coordinate("A", 1e-4, -_ANY, _ANY),
        "delay": Coordinate("s", 1e-6, -0.05, 0.2),
        "force_delay": Coordinate("s", 1e-6, -0.05, 0.2),
        "measuring_filter": Coordinate("s", 1e-5, 0.0, 0.1),
    }  # fmt: skip


def of_base(axis: AxisTable, mass: float) -> AxisParameters:
    """The base's own parameters.

    Args:
        mass: What its motor feels [kg or kg m²].
    """
    return AxisParameters(
        kv=axis.kv,
        damping_ratio=axis.damping_ratio,
        mass=mass,
        viscous_friction=axis.viscous_friction,
        dry_friction=axis.dry_friction,
        constant_force=axis.constant_force,
        velocity_feedforward=axis.velocity_feedforward,
        acceleration_feedforward=axis.acceleration_feedforward,
        reset_time_s=axis.reset_time_s,
        loop_delay_s=axis.loop_delay_s,
        velocity_filter_s=axis.velocity_filter_s,
        command_filter_s=axis.command_filter_s,
        current_scale=axis.current_scale or 1.0,
        current_at_rest=axis.current_at_rest,
    )
