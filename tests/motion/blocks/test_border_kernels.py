import numpy as np
from hypothesis import given
from motion_programs import SETTINGS, Program, programs

from twin.columns import join
from twin.motion.blocks.blocks import Blocks, BlocksOfChunks, largest_travels
from twin.motion.blocks.border_kernels import (
    STEP_NOISE,
    border_steps,
    border_velocities,
    tolerance_shares,
)
from twin.nc.canonical import Corner, FloatArray


def blocks_of(program: Program) -> Blocks | None:
    parts = [part for part in BlocksOfChunks(program.chunks(), program.start) if len(part)]
    return join(parts) if parts else None


def plain_steps(blocks: Blocks, order: int) -> FloatArray:
    """By the derivatives of the geometry at both sides of each border."""
    rows, count = np.arange(len(blocks)), len(blocks)
    scale = np.divide(1.0, blocks.length, out=np.zeros(count), where=blocks.length > 0.0)[:, None]
    begin, end = (
        blocks.geometry.derivative(rows, np.full(count, u), order) * scale**order
        for u in (0.0, 1.0)
    )
    steps = np.zeros_like(begin)
    steps[1:] = begin[1:] - end[:-1]
    return steps


def found_steps(blocks: Blocks) -> tuple[FloatArray, FloatArray]:
    return border_steps(blocks.geometry.curves(), blocks.length)


@SETTINGS
@given(programs(most=6, corners=tuple(Corner)))
def test_steps_are_those_of_the_geometry(program: Program) -> None:
    blocks = blocks_of(program)
    if blocks is None:
        return
    for order, found in zip((1, 2), found_steps(blocks), strict=True):
        expected = plain_steps(blocks, order)
        size = 1.0 + np.abs(expected).max()
        assert np.abs(found - expected).max() <= 1e-12 * size + STEP_NOISE
        assert not np.any((found != 0.0) & (np.abs(found) < STEP_NOISE))


@SETTINGS
@given(programs(most=6))
def test_shares_and_velocities_are_those_of_the_steps(program: Program) -> None:
    blocks = blocks_of(program)
    if blocks is None:
        return
    tangent_step, curvature_step = found_steps(blocks)
    count = len(blocks)
    per_width, per_square = tolerance_shares(
        tangent_step, curvature_step, np.full(count, 0.02), 0.5
    )
    assert np.allclose(
        per_width,
        np.maximum(
            np.linalg.norm(tangent_step[:, :3], axis=1) / 0.02, np.abs(tangent_step[:, 3]) / 0.5
        ),
    )
    assert np.allclose(per_square, np.linalg.norm(curvature_step[:, :3], axis=1) / 0.02)
    rounded, stops, width = np.arange(count) % 2 == 0, np.zeros(count, np.bool_), np.zeros(count)
    stops[0], width[-1] = True, 0.1
    step, gain = np.array([1.0, 2.0, 3.0, 4.0]), np.array([400.0, 300.0, 200.0, 100.0])
    found = border_velocities(tangent_step, curvature_step, stops, rounded, width, step, gain)
    with np.errstate(divide="ignore"):
        expected = np.minimum(
            (step / np.abs(tangent_step)).min(axis=1),
            np.sqrt((gain / np.abs(curvature_step)).min(axis=1)),
        )
    expected[rounded & np.isfinite(expected)] = 0.0
    expected[width > 0.0] = np.inf
    expected[stops] = 0.0
    assert np.allclose(found, expected)


@SETTINGS
@given(programs(most=6))
def test_travels_are_the_largest(program: Program) -> None:
    moves = program.moves
    rotary = moves.axes.rotary()
    farthest, linear = largest_travels(moves.start, moves.end, rotary)
    travel = np.abs(moves.end - moves.start)
    assert np.array_equal(farthest, travel.max(axis=1, initial=0.0))
    assert np.array_equal(linear, travel[:, ~rotary].max(axis=1, initial=0.0))
