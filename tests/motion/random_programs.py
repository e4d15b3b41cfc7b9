"""Random programs in great number, by a seed, without a property tester's bookkeeping."""

import math

import numpy as np
from motion_programs import Program

from twin.motion.limits import MotionLimits
from twin.nc.canonical import Corner

KINDS = ("lines", "short lines", "right angles", "lines and arcs", "table")

UNEVEN_KINDS = ("feeds", "short arcs")
"""Programs whose feed changes from move to move, and whose arcs turn by a few degrees."""


def random_machine(rng: np.random.Generator) -> MotionLimits:
    """A machine of any temper."""

    def any_of(low: float, high: float, count: int = 4) -> np.ndarray:
        return np.exp(rng.uniform(math.log(low), math.log(high), count))

    return MotionLimits(
        velocity=any_of(20.0, 1000.0),
        acceleration=any_of(200.0, 20000.0),
        jerk=any_of(2e3, 1e6),
        path_acceleration=float(any_of(200.0, 20000.0, 1)[0]),
        path_jerk=float(any_of(2e3, 1e6, 1)[0]),
        corner_tolerance=float(any_of(1e-3, 1.0, 1)[0]),
        further_corner_tolerance=float(any_of(1e-3, 1.0, 1)[0]),
    )


def random_program(
    rng: np.random.Generator, corner: Corner, most: int = 40, kinds: tuple[str, ...] = KINDS
) -> Program:
    """A program of one of some kinds; the same seed gives the same path for any corner."""
    kind = kinds[rng.integers(len(kinds))]
    size = float(np.exp(rng.uniform(math.log(0.2), math.log(50.0))))
    feed = float(np.exp(rng.uniform(math.log(200.0), math.log(30000.0))))
    program = Program()
    program.corner = corner
    for number in range(int(rng.integers(2, most))):
        here = program.position
        if kind == "feeds" and rng.random() < 0.5:
            feed = float(np.exp(rng.uniform(math.log(50.0), math.log(30000.0))))
        if kind == "right angles":
            step = np.zeros(4)
            step[number % 2] = size * rng.choice([-1.0, 1.0]) * rng.uniform(0.2, 1.0)
            program.line(*(here + step), feed=feed)
        elif kind in ("lines and arcs", "short arcs") and rng.random() < 0.5:
            aside = rng.normal(size=2) * size
            smallest, largest = (20.0, 400.0) if kind == "lines and arcs" else (1.0, 20.0)
            sweep = rng.uniform(smallest, largest) * rng.choice([-1.0, 1.0])
            center = (here[0] + aside[0], here[1] + aside[1], here[2])
            program.arc(center, (0.0, 0.0, 1.0), sweep, feed=feed)
        elif kind == "short lines":
            step = np.append(rng.normal(size=3) * 0.02 * size + [0.05 * size, 0.0, 0.0], 0.0)
            program.line(*(here + step), feed=feed)
        else:
            turn = rng.normal() * 20.0 if kind == "table" else 0.0
            program.line(*(here + np.append(rng.normal(size=3) * size, turn)), feed=feed)
    return program
