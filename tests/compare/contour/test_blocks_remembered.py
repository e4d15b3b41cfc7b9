"""The worst blocks are the same whether all are remembered or few."""

import dataclasses
import itertools

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.compare.paths import line, moves_of
from twin.compare.contour.blocks import BlockCollector
from twin.compare.figures import BlockFigures
from twin.nc.canonical import Motion

REMEMBERED = 7
REPORTED = 5
RANGES = ((10, 14), (13, 20))
LINES = 60


def figures(
    place: np.ndarray, error: np.ndarray, rows: int, remembered: int
) -> tuple[BlockFigures, int]:
    """What a collector finds, and the most rows that it held."""
    corners = [np.array([x, 0.0, 0.0, 0.0]) for x in range(LINES + 1)]
    kinds = [Motion.RAPID if index % 5 == 0 else Motion.FEED for index in range(LINES)]
    pairs = zip(itertools.pairwise(corners), kinds, strict=True)
    moves = moves_of(*(line(a, b, motion=kind) for (a, b), kind in pairs))
    time = np.float64(0.001) * np.arange(len(place))
    collector, most = BlockCollector(RANGES, remembered), 0
    for first in range(0, len(place), rows):
        here = slice(first, first + rows)
        found = collector.add(
            moves, place[here], moves.line[place[here]], error[here].copy(), time[here]
        )
        assert (collector.columns.block[found] == np.unique(collector.columns.block[found])).all()
        most = max(most, len(collector.columns.block))
    return collector.figures(), most


@settings(max_examples=60, derandomize=True, deadline=None)
@given(
    st.lists(st.tuples(st.integers(0, LINES - 1), st.integers(1, 6)), min_size=1, max_size=200),
    st.integers(1, 40),
    st.integers(0, 2**31),
)
def test_few_blocks_remembered_are_the_worst_of_all(
    stays: list[tuple[int, int]], rows: int, seed: int
):
    place = np.repeat([move for move, _ in stays], [count for _, count in stays])
    error = 10.0 ** np.random.default_rng(seed).uniform(-2, 4, len(place))
    every, _ = figures(place, error, rows, LINES)
    few, _ = figures(place, error, rows, REMEMBERED)
    assert every.forgotten == 0
    assert few.forgotten >= max(0, len(every) - len(few))
    worst = np.argsort(-every.max_um)[:REPORTED]
    kept = np.argsort(-few.max_um)[:REPORTED]
    for name in ("line", "rapid", "max_um", "time_s"):
        assert getattr(few, name)[kept].tolist() == getattr(every, name)[worst].tolist()
    whole, _ = figures(place, error, len(place), REMEMBERED)
    np.testing.assert_equal(dataclasses.asdict(few), dataclasses.asdict(whole))
    for first, last in RANGES:
        assert _greatest(few, first, last) == _greatest(every, first, last)
    assert _greatest_of(few, few.rapid) == _greatest_of(every, every.rapid)


def test_blocks_passed_once_keep_all_their_figures_and_bound_the_memory():
    place = np.repeat(np.arange(LINES), 4)
    error = np.random.default_rng(7).uniform(0.1, 9.0, len(place))
    every, _ = figures(place, error, 10, LINES)
    few, most = figures(place, error, 10, REMEMBERED)
    assert most <= 3 * REMEMBERED
    assert few.forgotten == LINES - len(few)
    rows = np.searchsorted(every.line, few.line)
    for name in ("samples", "rms_um", "p99_um", "arc"):
        assert getattr(few, name).tolist() == getattr(every, name)[rows].tolist()


def _greatest(found: BlockFigures, first: int, last: int) -> float:
    return _greatest_of(found, (found.line >= first) & (found.line <= last))


def _greatest_of(found: BlockFigures, which: np.ndarray) -> float:
    return float(found.max_um[which].max(initial=0.0))
