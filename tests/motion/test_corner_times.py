"""Continuous motion beside exact stops: never slower, on random programs and on those that ship; and less with more tolerance."""

import dataclasses
import itertools

import numpy as np
import pytest
from motion_programs import Program, mill
from random_programs import KINDS, UNEVEN_KINDS, random_machine, random_program

from twin.files.shipped import machine_file, resource_root
from twin.machine.load import read_machine
from twin.motion.limits import MotionLimits
from twin.motion.planner import plan_phases
from twin.nc.canonical import Chunk, Corner, FloatArray
from twin.run.preparing.preparation import prepare

PROGRAMS = resource_root("programs")
JOBS = sorted(path for path in PROGRAMS.rglob("*.toml") if "alarms" not in path.parts)
TOLERANCES = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0)
SLACK = 1.0 + 1e-9
BATCH = 50


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


@pytest.mark.thorough
@pytest.mark.parametrize("first", range(0, 1000, BATCH))
def test_continuous_motion_is_never_slower_than_stops(first: int) -> None:
    for seed in range(first, first + BATCH):
        kinds = KINDS if seed % 2 else UNEVEN_KINDS
        times = []
        for corner in (Corner.CONTINUOUS, Corner.EXACT_STOP):
            rng = np.random.default_rng(seed)
            machine = random_machine(rng)
            program = random_program(rng, corner, kinds=kinds)
            times.append(seconds(program.chunks(), machine, program.start))
        assert times[0] <= times[1] * SLACK, seed


@pytest.mark.thorough
@pytest.mark.parametrize("job", JOBS, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_a_shipped_program_is_never_slower_for_it(job) -> None:
    preparation = prepare(job)
    chunks = list(preparation.interpretation().chunks())
    first = next(chunk.moves.start[0] for chunk in chunks if len(chunk.moves))
    limits = preparation.machine.motion_limits
    continuous, stops = (
        seconds(with_corner(chunks, corner), limits, first)
        for corner in (Corner.CONTINUOUS, Corner.EXACT_STOP)
    )
    assert continuous <= stops * SLACK


def test_more_tolerance_never_costs_time() -> None:
    square = Program()
    square.corner = Corner.CONTINUOUS
    for x, y in ((50.0, 0.0), (50.0, 50.0), (0.0, 50.0), (0.0, 0.0)):
        square.line(x, y, 0.0, 0.0, feed=3000.0)
    times = [
        seconds(square.chunks(), mill(corner_tolerance=wide), square.start) for wide in TOLERANCES
    ]
    assert all(after <= before * SLACK for before, after in itertools.pairwise(times))


def chord_program(rng: np.random.Generator, corner: Corner) -> Program:
    """Chords of a curve as CAM writes them, nearly straight to rough, at one feed or many."""
    program = Program()
    program.corner = corner
    feed = float(np.exp(rng.uniform(np.log(300.0), np.log(10000.0))))
    step, angle = float(rng.choice([0.02, 0.05, 0.1, 0.3, 1.0])), 0.0
    rough, radius = np.exp(rng.uniform(np.log([1e-4, 1.0]), np.log([0.3, 300.0])))
    changes = rng.random() < 0.3
    for _ in range(int(rng.integers(20, 300))):
        angle += step / radius + rng.normal() * rough
        if changes and rng.random() < 0.1:
            feed *= float(rng.uniform(0.5, 2.0))
        along = np.array([np.cos(angle), np.sin(angle), 0.0, 0.0])
        program.line(*(program.position + step * along), feed=feed)
    return program


def knee_machine(rng: np.random.Generator) -> MotionLimits:
    """The shipped mill's limits, or a machine of any temper, that passes knees."""
    if rng.random() < 0.5:
        return read_machine(machine_file("mill4")).motion_limits
    return dataclasses.replace(
        random_machine(rng),
        junction_velocity_step=np.exp(rng.uniform(-3.0, 2.0, 4)),
        junction_acceleration_step=np.exp(rng.uniform(3.0, 7.0, 4)),
    )


def never_slower(first: int, last: int) -> None:
    """Continuous, exact path, exact stop: each takes no less time than the one before it."""
    for seed in range(first, last):
        times = []
        for corner in (Corner.CONTINUOUS, Corner.EXACT_PATH, Corner.EXACT_STOP):
            rng = np.random.default_rng(seed)
            machine, kinds = knee_machine(rng), (*KINDS, *UNEVEN_KINDS)
            most = 300 if seed % 8 == 7 else 40
            program = (
                chord_program(rng, corner)
                if seed % 4 == 0
                else random_program(rng, corner, most, kinds)
            )
            times.append(seconds(program.chunks(), machine, program.start))
        assert times[0] <= times[1] * SLACK, seed
        assert times[1] <= times[2] * SLACK, seed


def long_chain(rng: np.random.Generator, corner: Corner) -> Program:
    """Chords without a stop, more than are cut together, whose roughness changes on the way, now and then with arcs."""
    program = Program()
    program.corner = corner
    feed = float(np.exp(rng.uniform(np.log(1000.0), np.log(15000.0))))
    step, angle = float(rng.choice([0.007, 0.02, 0.05, 0.2])), 0.0
    rough, radius = np.exp(rng.uniform(np.log([1e-4, 2.0]), np.log([0.1, 300.0])))
    changes, arcs = rng.random(2) < [0.5, 0.3]
    for number in range(int(rng.integers(4500, 10000))):
        rougher = 10.0 if changes and number // 1500 % 2 else 1.0
        angle += step / radius * np.sin(number * step / 5.0) + rng.normal() * rough * rougher
        along = np.array([np.cos(angle), np.sin(angle), 0.0, 0.0])
        here = program.position
        if arcs and number % 400 == 399:
            center = (here[0] - 5.0 * along[1], here[1] + 5.0 * along[0], 0.0)
            program.arc(center, (0.0, 0.0, 1.0), 30.0, feed=feed)
            angle += np.deg2rad(30.0)
        else:
            program.line(*np.round(here + step * along, 4), feed=feed)
    return program


def long_chain_is_no_slower(seed: int) -> None:
    """Continuous beside exact path."""
    times = []
    for corner in (Corner.CONTINUOUS, Corner.EXACT_PATH):
        rng = np.random.default_rng(seed)
        machine, program = knee_machine(rng), long_chain(rng, corner)
        times.append(seconds(program.chunks(3000, 4000), machine, program.start))
    # Where chords are joined to segments depends on how they are counted.
    assert times[0] <= times[1] * (1.0 + 1e-6), seed


@pytest.mark.seconds("chains of thousands of blocks are planned in both ways")
@pytest.mark.parametrize("seed", [101, 102])
def test_long_chains_are_no_slower_for_being_continuous(seed: int) -> None:
    long_chain_is_no_slower(seed)


@pytest.mark.thorough
def test_many_long_chains_are_no_slower_for_being_continuous() -> None:
    for seed in range(12):
        long_chain_is_no_slower(seed)


def arc_chain(rng: np.random.Generator, corner: Corner, blocks: tuple[int, int]) -> Program:
    """Arcs with knees between them and no stop, in a wave or anyhow, lines among them now and then."""
    program = Program()
    program.corner = corner
    kind = ("wave", "arcs", "arcs and lines")[rng.integers(3)]
    size, feed = np.exp(rng.uniform(np.log([0.3, 300.0]), np.log([10.0, 30000.0]))).tolist()
    for number in range(int(rng.integers(blocks[0], blocks[1]))):
        here = program.position
        if kind == "arcs and lines" and rng.random() < 0.3:
            program.line(*(here + np.append(rng.normal(size=3) * size, 0.0)), feed=feed)
            continue
        aside = np.array([size, 0.0]) if kind == "wave" else rng.normal(size=2) * size
        sweep = 180.0 if kind == "wave" else float(rng.uniform(20.0, 400.0))
        sense = (-1.0) ** number if kind == "wave" else rng.choice([-1.0, 1.0])
        center = (here[0] + aside[0], here[1] + aside[1], here[2])
        program.arc(center, (0.0, 0.0, 1.0), sweep * sense, feed=feed)
    return program


def arc_chains_are_no_slower(first: int, last: int, blocks: tuple[int, int]) -> None:
    """Continuous, exact path, exact stop, however many blocks there are between two stops."""
    for seed in range(first, last):
        times = []
        for corner in (Corner.CONTINUOUS, Corner.EXACT_PATH, Corner.EXACT_STOP):
            rng = np.random.default_rng(seed)
            machine, program = knee_machine(rng), arc_chain(rng, corner, blocks)
            times.append(seconds(program.chunks(), machine, program.start))
        assert times[0] <= times[1] * SLACK, seed
        assert times[1] <= times[2] * SLACK, seed


@pytest.mark.seconds("chains of hundreds of arcs are planned in three ways")
def test_a_chain_of_arcs_is_no_slower_for_a_freer_way() -> None:
    arc_chains_are_no_slower(0, 2, (520, 530))


@pytest.mark.thorough
@pytest.mark.parametrize(("last", "blocks"), [(104, (600, 1500)), (101, (2500, 3000))])
def test_chains_of_arcs_of_any_length_are_no_slower_for_a_freer_way(
    last: int, blocks: tuple[int, int]
) -> None:
    """The longer ones go on over the blocks that are cut together."""
    arc_chains_are_no_slower(100, last, blocks)


@pytest.mark.seconds("40 programs are planned in three ways")
def test_each_freer_way_through_corners_is_no_slower() -> None:
    never_slower(7000, 7040)


@pytest.mark.thorough
@pytest.mark.parametrize("first", range(0, 1000, BATCH))
def test_each_freer_way_is_no_slower_in_many_programs(first: int) -> None:
    never_slower(first, first + BATCH)
