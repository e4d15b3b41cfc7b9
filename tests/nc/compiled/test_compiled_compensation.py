"""Radius compensation compiled against the control's own, bit for bit."""

import dataclasses
import math
from random import Random

import pytest

from tests.nc.compiled.contour_programs import program, switched
from tests.nc.compiled.test_both_tiers import ALWAYS, CALCULATOR, assert_same, general_blocks, seen
from twin.nc.canonical import Function
from twin.nc.dialects import DIALECTS
from twin.nc.text.source import source_from_text

JOB = dataclasses.replace(CALCULATOR, step_limit=2000)


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
    """A block for the interpreter tier stands behind events and a move along the normal."""
    contour = "X0 Y0\nX10\nX20\nX30\nX40\nX50\nX60\nM8\nZ1\nM9\nG9 X70 Y10\nX80\nG40 X90 Y0\nM30"
    text = f"G90 G1 F100 X-20 Y-20\nG41 D1\n{contour}"
    result = assert_same(source_from_text(text), "gost", JOB)
    words = [(before, event.word) for before, event in result.events if isinstance(event, Function)]
    (on, _), (off, _), *_ = words
    assert off == on + 1
    assert seen(source_from_text(text), "gost", JOB, ALWAYS).error is None


@pytest.mark.parametrize("dialect", DIALECTS)
def test_both_ways_agree_on_contours_that_are_switched(dialect: str) -> None:
    ran = moves = 0
    for seed in range(150):
        text = switched(dialect, Random(seed))  # noqa: S311 (programs need no cryptography)
        result = assert_same(source_from_text(text), dialect, JOB)
        ran += result.error is None
        moves += len(result.moves)
    assert ran > 10
    assert moves > 1000


ENDS = {"at once": "G40 X-20 Y-20", "later": "M8\nZ1\nG40\nZ2\nM9\nX-20 Y-9"}


@pytest.mark.parametrize("leads", ["G136", "G137", "G138"])
@pytest.mark.parametrize("end", ENDS.values(), ids=ENDS)
def test_a_contour_in_a_loop_never_leaves_the_compiled_run(
    leads: str, end: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    contour = f"G41\nX0 Y-5\nY30\nX[40+P1*0.001]\nY0\nX-5\n{end}"
    text = (
        f"{leads}\nP1=0\nG90 G1 F100 X-20 Y-20\n$WHILE P1<300\nP1=P1+1\n{contour}\n$ENDWHILE\nM30"
    )
    job = dataclasses.replace(JOB, step_limit=100_000)
    assert assert_same(source_from_text(text), "fagor8070", job).error is None
    assert general_blocks(text, "fagor8070", job, monkeypatch) < 10


@pytest.mark.parametrize("radius", [" D2", " D(#i*0.001+1)", ""])
def test_a_contour_with_a_radius_of_its_own_never_leaves_it_either(
    radius: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    contour = f"G41{radius}\nX0 Y-5\nY30\nX(40+#i*0.001)\nY0\nX-5\nG40 X-20 Y-20"
    head = "LET #i := 0\nG90 G1 F100 X-20 Y-20\nG42 D3\nX-25\nG40 X-20\nN10 #i := #i + 1"
    text = f"{head}\n{contour}\nN20 G20 L10 K(#i < 300)\nM30"
    job = dataclasses.replace(JOB, step_limit=100_000)
    result = assert_same(source_from_text(text), "codesys", job)
    assert result.error is None
    assert len(result.moves) > 2000
    assert general_blocks(text, "codesys", job, monkeypatch) < 10


def test_an_error_in_a_later_pass_is_told_where_it_stands() -> None:
    """The slot becomes narrower than the tool; what was made before stays."""
    contour = "G42\nX0 Y0\nX10\nY[8-P1]\nX0\nG40 X-20 Y-20"
    text = f"P1=0\nG90 G1 F100 X-20 Y-20\n$WHILE P1<9\nP1=P1+1\n{contour}\n$ENDWHILE\nM30"
    result = assert_same(source_from_text(text), "fagor8070", JOB)
    assert result.error is not None
    assert result.error.code == "compensation-gouge"


@pytest.mark.parametrize("block", ["T2 M6", "D0", "G17", "G54", "S500 M3 M8", "/M9", "M3 M5"])
def test_what_stands_within_a_contour_means_the_same(block: str) -> None:
    contour = f"G41\nX0 Y-5\nY30\n{block}\nX40\nY0\nX-5\nG40 X-20 Y-20"
    text = f"P1=0\nG90 G1 F100 X-20 Y-20\n$WHILE P1<50\nP1=P1+1\n{contour}\n$ENDWHILE\nM30"
    for skip in (True, False):
        assert_same(source_from_text(text), "fagor8070", dataclasses.replace(JOB, block_skip=skip))


@pytest.mark.parametrize("plane", ["G17", "G18", "G19"])
def test_a_plane_behind_g41_means_the_same_where_the_compiled_run_has_begun_it(plane: str) -> None:
    text = f"G1 F100 X-20 Y-20 Z-20\nG41 D2\n{plane}\nX0 Y0 Z0\nX20\nZ20 Y20\nG40\nX0 Y0 Z0\n"
    result = assert_same(source_from_text(text), "codesys", JOB)
    assert len(result.moves) > 3
