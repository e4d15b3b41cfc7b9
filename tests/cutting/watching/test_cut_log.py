"""What was cut by line: against a plain dictionary, and in bounded memory."""

import dataclasses
import math
import pickle
import random

import numpy as np
import pytest

from twin.cutting.watching.cut_log import LINES_REPORTED, BlockCut, CutLog
from twin.cutting.watching.events import EventLog, Stretches
from twin.nc.canonical import FloatArray


def chunk(chance: random.Random, lines: list[int]) -> tuple[Stretches, FloatArray, FloatArray]:
    """Stretches of some lines, some of them in the air, with their widths and forces."""
    count = len(lines)
    values = np.array([[chance.uniform(0.1, 9.0) for _ in range(5)] for _ in range(count)])
    removed = values[:, 0] * (values[:, 4] > 2.0)
    points = np.cumsum(np.vstack([np.zeros((1, 3)), values[:, :3]]), axis=0)
    stretches = Stretches(
        points, np.linspace(0.0, 0.01 * (count - 1), count), np.array(lines), np.zeros(count, np.bool_), removed,
        values[:, 1], np.zeros(count), np.zeros(count), np.zeros((count, 3)),
    )  # fmt: skip
    return stretches, values[:, 2], values[:, 3]


def note(
    cut_log: CutLog, stretches: Stretches, width: FloatArray, force: FloatArray | None
) -> None:
    """Enter stretches, each with its width and force."""
    cut_log.add(stretches)
    cuts = stretches.removed > 0.0
    cut_log.add_means(stretches.line[cuts], width[cuts], None if force is None else force[cuts])


def enter(book: dict[int, BlockCut], stretches: Stretches, width: FloatArray, force: FloatArray):
    """Enter stretch by stretch what the cut log enters at once."""
    for i in np.flatnonzero(stretches.removed > 0):
        block = book.setdefault(int(stretches.line[i]), BlockCut())
        block.removed_mm3 += stretches.removed[i]
        block.path_mm += math.dist(stretches.points[i], stretches.points[i + 1])
        block.depth_mm = max(block.depth_mm, stretches.depth[i])
        block.width_mm = max(block.width_mm, width[i])
        block.force_n = max(block.force_n or 0.0, force[i])


def test_every_line_of_a_program_that_comes_round_again() -> None:
    chance = random.Random(1)  # noqa: S311 (no cryptography)
    cut_log, book = CutLog(remembered=50), {}
    for start in range(0, 300, 7):
        entries = chunk(chance, sorted((start + k // 3) % 90 for k in range(30)))
        note(cut_log, *entries)
        enter(book, *entries)
    assert cut_log.forgotten == 0
    assert list(cut_log.blocks) == sorted(book)
    for line, block in cut_log.blocks.items():
        assert dataclasses.astuple(block) == pytest.approx(dataclasses.astuple(book[line]))


def test_of_very_many_lines_the_foremost_are_told_of() -> None:
    chance = random.Random(2)  # noqa: S311 (the same)
    cut_log, book = CutLog(remembered=2000), {}
    for start in range(0, 20_000, 40):
        entries = chunk(chance, [start + k // 2 for k in range(80)])
        note(cut_log, *entries)
        enter(book, *entries)
    told = cut_log.blocks
    assert len(told) == LINES_REPORTED
    assert cut_log.forgotten > 10_000
    assert len(cut_log._kept) <= 4000
    most = sorted(book, key=lambda line: -book[line].removed_mm3)[: LINES_REPORTED // 2]
    hardest = sorted(book, key=lambda line: -(book[line].force_n or 0.0))[: LINES_REPORTED // 2]
    assert {*most, *hardest} <= told.keys()
    for line in told:
        assert told[line].removed_mm3 == pytest.approx(book[line].removed_mm3)


def test_the_line_that_is_being_cut_is_not_let_go_of() -> None:
    chance = random.Random(3)  # noqa: S311 (the same)
    cut_log, book = CutLog(remembered=20), {}
    for start in range(1, 500, 10):
        entries = chunk(chance, [*range(start, start + 10), 0, 0])
        entries[0].removed[-2:] = 1e-6 * start
        note(cut_log, *entries)
        enter(book, *entries)
    cut_log._tidy()
    assert cut_log.forgotten > 0
    (row,) = np.flatnonzero(cut_log._kept.line == 0)
    assert cut_log._kept.removed[row] == pytest.approx(book[0].removed_mm3)


def test_without_a_force_none_is_told() -> None:
    stretches, width, _ = chunk(random.Random(4), [5] * 9)  # noqa: S311 (the same)
    cut_log = CutLog()
    note(cut_log, stretches, width, None)
    assert cut_log.blocks[5].force_n is None


def test_of_very_many_gouges_the_deepest_are_told_of_in_order() -> None:
    chance = random.Random(5)  # noqa: S311 (the same)
    log, depths = EventLog(most=20), []
    stretches, _, _ = chunk(chance, list(range(300)))
    for line in range(300):
        depths.append(chance.uniform(0.1, 5.0))
        log.note(("flute", line), "flute", stretches, line, depths[-1])
    events = log.events()
    assert [event.line for event in events] == sorted(np.argsort(depths)[-20:].tolist())
    assert log.forgotten > 200


def test_what_comes_in_many_small_chunks_is_put_together() -> None:
    chance = random.Random(3)  # noqa: S311 (the same)
    cut_log = CutLog()
    for _ in range(1000):
        note(cut_log, *chunk(chance, [7, 8]))
    size = len(pickle.dumps(cut_log))
    for _ in range(1000):
        note(cut_log, *chunk(chance, [7, 8]))
    assert len(pickle.dumps(cut_log)) < 1.5 * size
