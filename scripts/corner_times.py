"""Continuous motion beside exact stops: random programs, the shipped ones, and time over tolerance.

Prints a line for each and exits with 1 if continuous motion is slower anywhere, or more tolerance.
"""

import dataclasses
import importlib
import itertools
import math
import sys
from pathlib import Path

import numpy as np

from twin.machine.description.motion_limits import motion_limits
from twin.motion.limits import MotionLimits
from twin.motion.phase_planner import plan_phases
from twin.nc.canonical import Chunk, Corner, FloatArray
from twin.run.preparation import prepare

ROOT = Path(__file__).parents[1]
TOLERANCES = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0)
SLACK = 1.0 + 1e-9


def seconds(chunks: list[Chunk], limits: MotionLimits, start: FloatArray) -> float:
    """Cycle time [s]."""
    ends = [phases.end_time for phases in plan_phases(chunks, limits, start=start)]
    return ends[-1] if ends else 0.0


def with_corner(chunks: list[Chunk], corner: Corner) -> list[Chunk]:
    """A program with every corner that is not a stop passed in one way."""
    out = []
    for chunk in chunks:
        kinds = np.where(chunk.moves.corner == Corner.EXACT_STOP, Corner.EXACT_STOP, corner)
        moves = dataclasses.replace(chunk.moves, corner=kinds.astype(np.uint8))
        out.append(dataclasses.replace(chunk, moves=moves))
    return out


def random_ratios(count: int) -> list[float]:
    """Times of random programs, continuous over stops."""
    sys.path.insert(0, str(ROOT / "tests" / "motion"))
    programs = importlib.import_module("random_programs")
    out = []
    for seed in range(count):
        kinds = programs.KINDS if seed % 2 else programs.UNEVEN_KINDS
        times = []
        for corner in (Corner.CONTINUOUS, Corner.EXACT_STOP):
            rng = np.random.default_rng(seed)
            machine = programs.random_machine(rng)
            program = programs.random_program(rng, corner, kinds=kinds)
            times.append(seconds(program.chunks(), machine, program.start))
        out.append(times[0] / times[1])
    return out


def shipped_ratios() -> dict[str, float]:
    """Times of the shipped programs, continuous over stops."""
    out = {}
    for job in sorted((ROOT / "programs").rglob("*.toml")):
        if "alarms" in job.parts:
            continue
        preparation = prepare(job)
        chunks = list(preparation.interpretation().chunks())
        first = next((chunk.moves.start[0] for chunk in chunks if len(chunk.moves)), None)
        if first is None:
            continue
        limits = motion_limits(preparation.machine)
        times = [
            seconds(with_corner(chunks, corner), limits, first)
            for corner in (Corner.CONTINUOUS, Corner.EXACT_STOP)
        ]
        out[str(job.relative_to(ROOT))] = times[0] / max(times[1], 1e-9)
    return out


def main(count: int) -> int:
    """Measure and print; the exit code."""
    ratios = random_ratios(count)
    print(f"{count} random programs, continuous over stops: mean {np.mean(ratios):.4f},", end=" ")
    print(f"least {min(ratios):.4f}, most {max(ratios):.6f}")
    shipped = shipped_ratios()
    for name, ratio in shipped.items():
        print(f"{name}: {ratio:.4f}")
    programs = importlib.import_module("motion_programs")
    square = programs.Program()
    square.corner = Corner.CONTINUOUS
    for x, y in ((50.0, 0.0), (50.0, 50.0), (0.0, 50.0), (0.0, 0.0)):
        square.line(x, y, 0.0, 0.0, feed=3000.0)
    times = [
        seconds(square.chunks(), programs.mill(corner_tolerance=wide), square.start)
        for wide in TOLERANCES
    ]
    for wide, time in zip(TOLERANCES, times, strict=True):
        print(f"square of 50 mm at {wide} mm: {time:.4f} s")
    falls = all(after <= before * SLACK for before, after in itertools.pairwise(times))
    slowest = max([*ratios, *shipped.values()], default=-math.inf)
    return 0 if falls and slowest <= SLACK else 1


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 1000))
