"""Blocks are worked on in groups, which nobody must see in the plan."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from motion_programs import Program, mill, run

from twin.motion.blocks.blocks import BlocksOfChunks, WithNeighbours
from twin.motion.pieces import pieces
from twin.nc.canonical import Corner


def helices(count: int, turns: float, corner: Corner) -> Program:
    """Helices with a line and some rounded corners between them."""
    program = Program()
    program.corner, program.corner_tolerance = corner, 0.02
    for number in range(count):
        x, y, z = program.position[:3]
        program.arc((x + 4.0, y, z), (0.0, 0.0, 1.0), 360.0 * turns, advance=1.0, feed=9000.0)
        program.line(x + 1.0, y + number % 3, z + 1.0, 0.0, feed=6000.0)
    return program


@settings(derandomize=True, max_examples=60, deadline=None)
@given(
    turns=st.lists(st.floats(0.1, 9.0), min_size=1, max_size=12),
    batch=st.integers(1, 9),
    context=st.integers(1, 5),
    most=st.floats(0.5, 60.0),
)
def test_every_block_is_worked_on_once(
    turns: list[float], batch: int, context: int, most: float
) -> None:
    program = Program()
    for each in turns:
        program.arc((4.0, 0.0, 0.0), (0.0, 0.0, 1.0), 360.0 * each, advance=1.0)
    worked: list[int] = []
    ends: list[bool] = []
    blocks = BlocksOfChunks(program.chunks(3, 5), program.start)
    for group in WithNeighbours(blocks, batch, context, most):
        move, angle = group.blocks.move, np.abs(group.blocks.geometry.angle)
        own = slice(group.first, group.last)
        worked += move[own].tolist()
        assert np.all(np.diff(move) == 1)
        assert group.first <= context
        assert angle[own][:-1].sum() <= most
        assert angle[group.last : -1].sum() <= most
        ends.append(group.to_the_end)
        assert not group.to_the_end or move[-1] == len(turns) - 1
    assert ends[-1]
    assert worked == list(range(len(turns)))


@pytest.mark.parametrize("corner", [Corner.EXACT_STOP, Corner.CONTINUOUS])
def test_small_groups_give_the_same_setpoints(
    corner: Corner, monkeypatch: pytest.MonkeyPatch
) -> None:
    program = helices(12, 3.0, corner)
    whole = run(program, mill(), period_s=0.02)
    monkeypatch.setattr(pieces, "MAX_ANGLE", 40.0 * math.pi)
    grouped = run(program, mill(), period_s=0.02)
    assert np.array_equal(whole.position, grouped.position)
