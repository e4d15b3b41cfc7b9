"""Units that a column may be in, and what they come to in the shop's units."""

from twin.errors import UsageError
from twin.units import DEGREE, SECONDS_PER_MINUTE, AxisKind

_MM_PER_INCH = 25.4
_DEGREES_PER_TURN = 360.0
_LENGTHS = {"mm": 1.0, "m": 1e3, "cm": 10.0, "um": 1e-3, "µm": 1e-3, "in": _MM_PER_INCH}
_ANGLES = {"deg": 1.0, "°": 1.0, "rad": 1.0 / DEGREE, "mdeg": 1e-3, "turn": _DEGREES_PER_TURN}
_TIMES = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9}
_FORCES = {"N": 1.0, "kN": 1e3}
_TORQUES = {"N m": 1.0, "Nm": 1.0}
_CURRENTS = {"A": 1.0, "mA": 1e-3, "V": 1.0, "%": 1.0, "N m": 1.0, "Nm": 1.0}
"""Force of unknown scale: current, or whatever the drive shows for it."""


def _per_time(units: dict[str, float], power: int) -> dict[str, float]:
    suffixes = {1: {"/s": 1.0, "/min": 1.0 / SECONDS_PER_MINUTE}, 2: {"/s²": 1.0, "/s2": 1.0}}
    return {
        unit + suffix: value * factor
        for unit, value in units.items()
        for suffix, factor in suffixes[power].items()
    }


_BY_QUANTITY: dict[str, dict[AxisKind, dict[str, float]]] = {
    "position": {"linear": _LENGTHS, "rotary": _ANGLES},
    "velocity": {
        "linear": _per_time(_LENGTHS, 1),
        "rotary": _per_time(_ANGLES, 1) | {"rpm": _DEGREES_PER_TURN / SECONDS_PER_MINUTE},
    },
    "acceleration": {"linear": _per_time(_LENGTHS, 2), "rotary": _per_time(_ANGLES, 2)},
    "force": {"linear": _FORCES, "rotary": _TORQUES},
    "current": {"linear": _CURRENTS, "rotary": _CURRENTS},
}
UNITS = {
    unit for kinds in _BY_QUANTITY.values() for units in kinds.values() for unit in units
} | set(_TIMES)
"""Every unit that is known."""


def time_factor(unit: str, where: str) -> float:
    """Seconds per unit of time.

    Raises:
        UsageError: The unit is none of time.
    """
    if unit not in _TIMES:
        raise UsageError(f"{where}: no unit of time '{unit}': known are {', '.join(_TIMES)}")
    return _TIMES[unit]


def factor(quantity: str, kind: AxisKind, unit: str, where: str) -> float:
    """What one of a unit is in mm or degrees, seconds, newtons or newton metres.

    Args:
        quantity: ``position``, ``velocity``, ``acceleration``, ``force`` or ``current``.

    Raises:
        UsageError: No such unit of that quantity for that kind of axis.
    """
    known = _BY_QUANTITY[quantity][kind]
    if unit not in known:
        other: AxisKind = "rotary" if kind == "linear" else "linear"
        why = f" (it is one of a {other} axis)" if unit in _BY_QUANTITY[quantity][other] else ""
        raise UsageError(
            f"{where}: '{unit}' is no unit of {quantity} for a {kind} axis{why}; known are "
            f"{', '.join(known)}"
        )
    return known[unit]


def kind_of(unit: str) -> AxisKind:
    """Whether a unit of position belongs to a linear or a rotary axis."""
    return "rotary" if unit in _ANGLES else "linear"
