import dataclasses
from pathlib import Path

import numpy as np
import pytest

from tests.compare.paths import UP, arc, line, moves_of
from twin.compare.baseline import RunFigures, compare_baseline, write_baseline
from twin.compare.verdict import Reason
from twin.errors import UsageError
from twin.job import BaselineTable
from twin.nc.canonical import Moves

CORNER = np.array([50.0, 0, 0, 0])
ROWS = [
    line(np.zeros(4), CORNER),
    arc(CORNER, np.array([50.0, 20.0, 0]), UP, 360.0),
    line(CORNER, np.array([50.0, -30.0, -5.0, 90.0])),
]
MOVES = moves_of(*ROWS)
FIGURES = RunFigures(cycle_time_s=20.0, contour_um=5.0)


@pytest.fixture
def stored(tmp_path: Path) -> Path:
    write_baseline(tmp_path / "part.baseline", FIGURES, [MOVES])
    return tmp_path / "part.baseline"


def reasons(stored: Path, moves: Moves, figures: RunFigures = FIGURES) -> list[Reason]:
    return compare_baseline(stored, figures, [moves], BaselineTable())


def test_the_same_run_holds_however_it_is_chunked(stored: Path):
    assert reasons(stored, MOVES) == []
    assert compare_baseline(stored, FIGURES, [MOVES[:1], MOVES[1:]], BaselineTable()) == []


def test_the_file_is_text_with_a_line_a_move(stored: Path):
    lines = stored.read_text(encoding="utf-8").splitlines()
    assert lines[:4] == [
        "twin baseline 1", "cycle_time_s 20.000000", "contour_um 5.000", "axes X Y Z C",
    ]  # fmt: skip
    assert lines[4] == "1 | feed line | 0 0 0 0 | 50 0 0 0"
    assert lines[5] == "2 | feed arc | 50 0 0 0 | 50 0 0 0 | 50 20 0 0 0 1 360"
    assert len(lines) == 7


def changed(column: str, row: int, value: object) -> Moves:
    values = getattr(MOVES, column).copy()
    values[row] = value
    return dataclasses.replace(MOVES, **{column: values})


@pytest.mark.parametrize(
    ("moves", "line_number", "told"),
    [
        (changed("end", 2, [50.02, -30, -5, 90]), 3, "ends at X50.02, baseline X50"),
        (changed("end", 2, [50, 30, -5, 90]), 3, "ends at Y30, baseline Y-30"),
        (changed("end", 2, [50, -30, -5, 90.002]), 3, "ends at C90.002, baseline C90"),
        (changed("sweep", 1, -360.0), 2, "arc of -360 degrees, baseline 360"),
        (changed("sweep", 1, 720.0), 2, "arc of 720 degrees, baseline 360"),
        (changed("center", 1, [30.0, 0, 0]), 2, "arc about (30 0 0), baseline (50 20 0)"),
        (changed("motion", 0, 0), 1, "rapid line, baseline feed line"),
        (MOVES[:2], 0, "ends before what was line 3"),
        (moves_of(*ROWS, ROWS[0]), 4, "does not have"),
    ],
)
def test_the_first_block_that_differs_is_named(
    stored: Path, moves: Moves, line_number: int, told: str
):
    (reason,) = reasons(stored, moves)
    assert (reason.what, reason.line) == ("baseline-path", line_number)
    assert told in reason.message


def test_a_normal_and_a_sweep_turned_over_together_are_the_same_arc(stored: Path):
    turned = dataclasses.replace(changed("sweep", 1, -360.0), normal=-MOVES.normal)
    assert reasons(stored, turned) == []


def test_less_than_the_tolerance_is_no_difference(stored: Path):
    assert reasons(stored, changed("end", 2, [50.0009, -30, -5, 90])) == []


def test_time_and_error_are_held_too(stored: Path):
    (slow,) = reasons(stored, MOVES, RunFigures(20.3, 5.0))
    assert (slow.what, "20.300 s, baseline 20.000 s" in slow.message) == (
        "baseline-cycle-time",
        True,
    )
    (worse,) = reasons(stored, MOVES, RunFigures(20.1, 6.5))
    assert worse.what == "baseline-contour"
    assert reasons(stored, MOVES, RunFigures(20.1, 1.0)) == []


def test_a_missing_baseline_is_told_with_what_to_do(tmp_path: Path):
    (reason,) = reasons(tmp_path / "none.baseline", MOVES)
    assert "--update-baseline" in reason.message


@pytest.mark.parametrize(
    "text",
    ["", "else\n", "twin baseline 1\ncycle_time_s x\ncontour_um 1\n", "twin baseline 1\naxes X\n",
     "twin baseline 1\ncycle_time_s 1\ncontour_um 1\naxes X Y Z C\nbroken\n"],
)  # fmt: skip
def test_what_is_no_baseline_is_refused(tmp_path: Path, text: str):
    (tmp_path / "x.baseline").write_text(text, encoding="utf-8")
    with pytest.raises(UsageError, match="is not a baseline"):
        reasons(tmp_path / "x.baseline", MOVES)


def test_a_program_without_moves_has_a_baseline(tmp_path: Path):
    write_baseline(tmp_path / "x.baseline", FIGURES, [])
    assert compare_baseline(tmp_path / "x.baseline", FIGURES, [], BaselineTable()) == []
