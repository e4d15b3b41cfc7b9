"""TOPP-RA's bound of the time along a chain of moves, which knows no jerk limit."""

import itertools
from typing import Any

import numpy as np
import toppra
import toppra.algorithm
import toppra.constraint
from motion_programs import Program, mill

from twin.motion.limits import MotionLimits
from twin.nc.canonical import Corner, FloatArray
from twin.toolpath.geometry import geometry


class ChainOfMoves(toppra.interpolator.AbstractGeometricPath):
    """A program's path by its length, as TOPP-RA wants it."""

    def __init__(self, program: Program) -> None:
        self.moves = program.moves
        self.shapes = geometry(self.moves)
        self.place = np.append(0.0, np.cumsum(self.moves.length))

    def __call__(self, path_positions: Any, order: int = 0) -> FloatArray:
        s = np.atleast_1d(np.asarray(path_positions, np.float64))
        row = np.clip(np.searchsorted(self.place, s, "right") - 1, 0, len(self.moves) - 1)
        u = np.clip((s - self.place[row]) / self.moves.length[row], 0.0, 1.0)
        if order == 0:
            values = self.shapes.position(row, u)
        else:
            values = self.shapes.derivative(row, u, order)
            values = values / self.moves.length[row][:, None] ** order
        return values[:, :3] if np.ndim(path_positions) else values[0, :3]

    @property
    def dof(self) -> int:
        return 3

    @property
    def path_interval(self) -> FloatArray:
        return self.place[[0, -1]]

    @property
    def waypoints(self) -> None:
        return None


def bound(program: Program, machine: MotionLimits, feed: float) -> float:
    """TOPP-RA's time for the path with the same velocities, accelerations and feed [s]."""
    path = ChainOfMoves(program)
    velocity = np.minimum(machine.velocity[:3], np.inf)
    limits = [
        toppra.constraint.JointVelocityConstraint(np.stack([-velocity, velocity], axis=1)),
        toppra.constraint.JointAccelerationConstraint(
            np.stack([-machine.acceleration[:3], machine.acceleration[:3]], axis=1)
        ),
    ]
    grid = np.unique(
        np.concatenate([np.linspace(a, b, 120) for a, b in itertools.pairwise(path.place)])
    )
    solver = toppra.algorithm.TOPPRA(limits, path, gridpoints=grid, solver_wrapper="seidel")
    speed = solver.compute_parameterization(0, 0)[1]
    assert speed is not None
    # The feed is one more ceiling on the speed; below it TOPP-RA's profile stays as it is only
    # where it never gets there, so the feed must not bind in these programs.
    assert speed.max() <= feed
    mean = 0.5 * (speed[1:] + speed[:-1])
    return float(np.sum(np.diff(grid) / mean))


def fast_machine(jerk: float) -> MotionLimits:
    """A machine that its axes' accelerations bound, and a jerk."""
    return mill(
        velocity=np.full(4, 2000.0), acceleration=np.array([3000.0, 2500.0, 2000.0, 4000.0]),
        jerk=np.full(4, jerk), path_acceleration=np.inf, path_jerk=np.inf,
        junction_velocity_step=1e-6, junction_acceleration_step=1e9,
    )  # fmt: skip


def slot(feed: float, radius: float, straight: float) -> Program:
    program = Program()
    program.corner = Corner.EXACT_PATH
    program.line(straight, 0.0, 0.0, 0.0, feed=feed)
    program.arc((straight, radius, 0.0), (0.0, 0.0, 1.0), 180.0, feed=feed)
    program.line(0.0, 2.0 * radius, 0.0, 0.0, feed=feed)
    program.arc((0.0, radius, 0.0), (0.0, 0.0, 1.0), 180.0, feed=feed)
    return program


def wave(feed: float) -> Program:
    """Tangent arcs of changing radius and sense."""
    program = Program()
    program.corner = Corner.EXACT_PATH
    for i, radius in enumerate([5.0, 12.0, 3.0, 30.0, 8.0]):
        side = (-1.0) ** i
        x, y, _, _ = program.position
        program.arc((x + radius, y, 0.0), (0.0, 0.0, 1.0), -180.0 * side, feed=feed)
    return program
