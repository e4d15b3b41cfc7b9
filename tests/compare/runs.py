"""Runs for the tests: setpoints at constant speed along moves, and joints with known errors."""

import numpy as np

from tests.compare.paths import AXES
from twin.compare.comparison import Comparison
from twin.compare.figures import Figures
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray, Moves, Shape
from twin.recording.reader import Samples
from twin.toolpath.part_frame import PartFrame

FRAME = PartFrame(rotary=3, center=(40.0, -30.0), turn_zero=15.0)
PART_ZERO = np.array([70.0, 20.0, -250.0, 15.0])
PERIOD = 0.001


def positions(moves: Moves, place: FloatArray) -> FloatArray:
    """Machine coordinates at places counted in moves (2.5: the middle of the third)."""
    row = np.clip(place.astype(int), 0, len(moves) - 1)
    u = place - row
    start, end = moves.start[row], moves.end[row]
    points = start + u[:, None] * (end - start)
    arcs = moves.shape[row] == Shape.ARC
    r = start[arcs, :3] - moves.center[row][arcs]
    n = moves.normal[row][arcs]
    angle = np.deg2rad(u[arcs] * moves.sweep[row][arcs])[:, None]
    lead = np.einsum("ij,ij->i", end[arcs, :3] - start[arcs, :3], n)[:, None]
    turned = np.cos(angle) * r + np.sin(angle) * np.cross(n, r)
    points[arcs, :3] = moves.center[row][arcs] + turned + u[arcs, None] * lead * n
    return points + PART_ZERO


def setpoints(moves: Moves, *, per_move: int = 500, wait: int = 0) -> Setpoints:
    """``per_move`` samples for each move, at constant speed, then ``wait`` samples at rest."""
    place = np.arange(per_move * len(moves) + 1) / per_move
    place = np.append(place, np.full(wait, float(len(moves))))
    row = np.minimum(np.ceil(place).astype(int) - 1, len(moves) - 1).clip(0)
    position = positions(moves, place)
    velocity = np.gradient(position, PERIOD, axis=0)
    return Setpoints(
        time=np.float64(PERIOD) * np.arange(len(place)),
        line=moves.line[row],
        move=row,
        fraction=place - row,
        position=position,
        velocity=velocity,
        acceleration=np.gradient(velocity, PERIOD, axis=0),
    )


def samples(setpoint: Setpoints, joint: FloatArray) -> Samples:
    return Samples(setpoint, joint, setpoint.velocity, np.zeros_like(joint))


def late(moves: Moves, setpoint: Setpoints, by: float) -> FloatArray:
    """Joints that stand where the setpoints stood a share of a move earlier."""
    place = np.maximum(setpoint.move + setpoint.fraction - by, 0.0)
    return positions(moves, place)


def compare(
    moves: Moves | list[Moves], setpoint: Setpoints, joint: FloatArray, *, rows: int = 100_000,
    frame: PartFrame = FRAME,
) -> tuple[Figures, FloatArray]:  # fmt: skip
    """The figures of a run and the contour error of every sample [µm]."""
    comparison = Comparison(AXES, frame, PART_ZERO)
    for piece in [moves] if isinstance(moves, Moves) else moves:
        comparison.expect(piece)
    whole = samples(setpoint, joint)
    errors = [
        comparison.add(
            Samples(
                whole.setpoint[here], whole.joint_position[here],
                whole.joint_velocity[here], whole.drive_force[here],
            )
        )
        for here in (slice(i, i + rows) for i in range(0, len(setpoint), rows))
    ]  # fmt: skip
    return comparison.result(), np.concatenate(errors)
