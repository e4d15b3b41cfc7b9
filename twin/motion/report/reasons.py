"""What bounds the velocity of pieces and of their borders, in words."""

import dataclasses

import numpy as np

from twin.motion.blocks.border_kernels import STEP_NOISE
from twin.motion.limits import MotionLimits
from twin.motion.pieces.bound_kernels import bound_derivatives
from twin.motion.pieces.limit_kernels import CENTRIPETAL_SHARE, CURVE_JERK_SHARE
from twin.motion.pieces.pieces import Pieces
from twin.motion.profile.backward_pass_kernels import SLOWEST
from twin.nc.canonical import FloatArray, IntArray

FEED = "programmed feed"
STOP = "stop at a block's end"
SHORT = "block too short to speed up"
BESIDE = "curve next to a slower place"

NEAR = 1e-6
"""Share by which two bounds may differ and count as the same."""

CLEARLY = 1e-3
"""Share by which a velocity must stay below all its bounds for something else to bound it."""


@dataclasses.dataclass(frozen=True, slots=True)
class Reasons:
    """What bounds n pieces, in words.

    Attributes:
        entry: What bounds the velocity at the border before each; empty: nothing but the piece.
    """

    velocity: list[str]
    entry: list[str]
    acceleration: list[str]
    jerk: list[str]


def reasons(pieces: Pieces, limits: MotionLimits, names: tuple[str, ...]) -> Reasons:
    """Name the strictest bound of each piece, by the rules of ``twin.motion.pieces.pieces``."""
    bounds, curvature, _ = bound_derivatives(
        pieces.geometry.table.curves(), pieces.geometry.row, pieces.begin,
        pieces.fraction_per_length, pieces.length, pieces.rounding,
    )  # fmt: skip
    first, second, third = bounds[:, 0], bounds[:, 1], bounds[:, 2]
    along_rotary = np.all(first[:, :3] == 0.0, axis=1)
    path_acceleration = np.where(
        along_rotary, limits.rotary_path_acceleration, limits.path_acceleration
    )
    path_jerk = np.where(along_rotary, limits.rotary_path_jerk, limits.path_jerk)
    # Curves that go round long use more.
    used = third * pieces.velocity[:, None] ** 3 / limits.jerk
    share_of_jerk = np.maximum(CURVE_JERK_SHARE, used.max(axis=1))
    with np.errstate(divide="ignore", over="ignore"):
        fastest = {
            FEED: pieces.feed,
            "path acceleration in a curve": np.sqrt(path_acceleration / curvature),
        }
        hardest = {"path acceleration": path_acceleration}
        smoothest = {"path jerk": path_jerk}
        for axis, name in enumerate(names):
            fastest[f"velocity of {name}"] = limits.velocity[axis] / first[:, axis]
            share = CENTRIPETAL_SHARE * limits.acceleration[axis]
            fastest[f"acceleration of {name} in a curve"] = np.sqrt(share / second[:, axis])
            jerk = share_of_jerk * limits.jerk[axis]
            fastest[f"jerk of {name} in a curve"] = np.cbrt(jerk / third[:, axis])
            hardest[f"acceleration of {name}"] = limits.acceleration[axis] / first[:, axis]
            smoothest[f"jerk of {name}"] = limits.jerk[axis] / first[:, axis]
    names_of_bounds, bound = _least(fastest)
    # What ``lower_to_reachable`` takes away.
    beside = pieces.velocity < bound * (1.0 - CLEARLY)
    return Reasons(
        velocity=[
            BESIDE if row else name for name, row in zip(names_of_bounds, beside, strict=True)
        ],
        entry=_entries(pieces, limits, names),
        acceleration=_least(hardest)[0],
        jerk=_least(smoothest)[0],
    )


def _least(bounds: dict[str, FloatArray]) -> tuple[list[str], FloatArray]:
    """The name of the least bound of each row, of equals the one named first; and the bound."""
    names = list(bounds)
    values = np.stack(list(bounds.values()))
    least = values.min(axis=0)
    return [names[row] for row in np.argmax(values <= least * (1.0 + NEAR), axis=0)], least


def _entries(pieces: Pieces, limits: MotionLimits, names: tuple[str, ...]) -> list[str]:
    out = [""] * len(pieces)
    bounded = np.flatnonzero(np.isfinite(pieces.entry))
    steps = _steps(pieces, bounded)
    for row, tangent, turn in zip(bounded, *steps, strict=True):
        if pieces.entry[row] < SLOWEST or row == 0:
            out[row] = STOP
            continue
        by_tangent = _allowed(limits.junction_velocity_step, tangent)
        by_turn = np.sqrt(_allowed(limits.junction_acceleration_step, turn))
        kind, bound = "velocity", by_tangent
        if by_turn.min() < by_tangent.min():
            kind, bound = "acceleration", by_turn
        out[row] = f"junction step of the {kind} of {names[int(np.argmin(bound))]}"
    return out


def _allowed(largest: FloatArray | float, step: FloatArray) -> FloatArray:
    """By how much each axis's step may be multiplied; infinite where it is rounding, shape (k,)."""
    out = np.full_like(step, np.inf)
    np.divide(np.broadcast_to(largest, step.shape), step, out=out, where=step >= STEP_NOISE)
    return out


def _steps(pieces: Pieces, rows: IntArray) -> tuple[FloatArray, FloatArray]:
    """Steps of dq/dx and d²q/dx² at the borders before rows, shape (m, k) each."""
    before = np.maximum(rows - 1, 0)
    shape, scale = pieces.geometry.whole(), pieces.fraction_per_length
    end = pieces.begin[before] + pieces.length[before] * scale[before]

    def step(order: int) -> FloatArray:
        here = shape.derivative(rows, pieces.begin[rows], order) * scale[rows, None] ** order
        there = shape.derivative(before, end, order) * scale[before, None] ** order
        return np.abs(here - there)

    return step(1), step(2)
