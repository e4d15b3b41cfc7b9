"""Chips that fly off the tool while it cuts: one sees where and how much."""

import dataclasses

import numpy as np

from twin.nc.canonical import FloatArray

MOST = 60
RATE_OF_MOST = 300.0
"""Material removed per second from which on no more chips are drawn [mm³/s]."""
SIZE_SHARE = 0.11
"""Length of the largest chip, as a share of the tool's diameter."""
LONGEST_M = 2.5e-3
"""No chip is longer [m]."""
FLIGHT_S = 0.05
"""How long a chip is seen [s]."""
SPEED = (0.2, 0.9)
"""Slowest and fastest chip [m/s]."""
RISE = (0.15, 0.8)
"""Least and greatest rise of their paths over the level ones."""
GRAVITY = 9.81
"""[m/s²]."""
RGBA = (0.86, 0.84, 0.80, 1.0)
_FORM = (1.0, 0.45, 0.16)
"""Half axes of a chip, as shares of its length."""


@dataclasses.dataclass(frozen=True, slots=True)
class Chips:
    """Where n chips are in one picture.

    Attributes:
        position: In the world, shape (n, 3) [m].
        rotation: Shape (n, 3, 3).
        half_size: Half of their lengths, shape (n, 3) [m].
    """

    position: FloatArray
    rotation: FloatArray
    half_size: FloatArray


def chips(tip: FloatArray, diameter: float, rate: float, seed: int) -> Chips:
    """Chips around a cutting tool.

    They are thrown off its edge in all directions and fall; each picture shows new ones, because a
    film is mostly faster than they are.

    Args:
        tip: The tool's tip in the world, shape (3,) [m].
        diameter: Of the tool [m].
        rate: Material removed per second [mm³/s]; 0: there are no chips.
        seed: The same gives the same chips.
    """
    count = int(np.ceil(MOST * np.sqrt(min(rate / RATE_OF_MOST, 1.0)))) if rate > 0 else 0
    random = np.random.default_rng(seed)
    turn = random.uniform(0.0, 2 * np.pi, count)
    out = np.stack([np.cos(turn), np.sin(turn), np.zeros(count)], axis=1)
    velocity = random.uniform(*SPEED, count)[:, None] * (
        out + random.uniform(*RISE, count)[:, None] * [0.0, 0.0, 1.0]
    )
    time = random.uniform(0.0, FLIGHT_S, count)[:, None]
    fall = 0.5 * GRAVITY * time**2 * [0.0, 0.0, 1.0]
    length = min(SIZE_SHARE * diameter, LONGEST_M) * random.uniform(0.4, 1.0, count)
    return Chips(
        tip + 0.5 * diameter * out + velocity * time - fall,
        np.linalg.qr(random.standard_normal((count, 3, 3)))[0],
        length[:, None] * np.array(_FORM),
    )
