"""Radius compensation compiled against the control's own, bit for bit."""

import dataclasses
import math
from random import Random

import pytest

from tests.nc.nc_contours import program
from tests.nc.nc_running import WITH_TABLES
from tests.nc.test_nc_plain import ALWAYS, assert_same, seen
from twin.nc.canonical import Function
from twin.nc.dialects import DIALECTS
from twin.nc.source import source_from_text

JOB = dataclasses.replace(WITH_TABLES, step_limit=2000)


@pytest.mark.parametrize("dialect", DIALECTS)
def test_both_ways_agree_on_contours(dialect: str) -> None:
    ran = moves = 0
    for seed in range(120):
        text = program(dialect, Random(seed))  # noqa: S311 (programs need no cryptography)
        result = assert_same(source_from_text(text), dialect, JOB)
        ran += result.error is None
        moves += len(result.moves)
    assert 10 < ran < 120
    assert moves > 1000


def test_a_long_contour_goes_through_many_chunks() -> None:
    lines = ["G90 G1 F1000 X-50 Y-50", "G41 D1 X0 Y0"]
    x = y = 0.0
    for number in range(9000):
        heading = 0.4 * math.sin(number * 0.05)
        x, y = x + 5.0 * math.cos(heading), y + 5.0 * math.sin(heading)
        lines.append(f"G1 X{x:.3f} Y{y:.3f}" + (" M8" if number % 50 == 0 else ""))
        if number % 70 == 0:
            lines.append("Z1\nS500\nZ2")
    result = assert_same(source_from_text("\n".join([*lines, "G40 Y-90", "M30"])), "gost", JOB)
    assert result.error is None
    assert len(result.moves) > 9000


def test_what_waits_when_a_run_ends_comes_at_the_end_of_the_held_move() -> None:
    """A block for the general way stands behind events and a move along the normal."""
    contour = "X0 Y0\nX10\nX20\nX30\nX40\nX50\nX60\nM8\nZ1\nM9\nG9 X70 Y10\nX80\nG40 X90 Y0\nM30"
    text = f"G90 G1 F100 X-20 Y-20\nG41 D1\n{contour}"
    result = assert_same(source_from_text(text), "gost", JOB)
    words = [(before, event.word) for before, event in result.events if isinstance(event, Function)]
    (on, _), (off, _), *_ = words
    assert off == on + 1
    assert seen(source_from_text(text), "gost", JOB, ALWAYS).error is None
