import dataclasses
import itertools
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.compare.paths import AXES, UP, arc, line, moves_of
from twin.compare.baseline import MOST_LISTED, compare_baseline, write_baseline
from twin.compare.baseline_text import RunFigures
from twin.compare.verdict import Reason
from twin.errors import UsageError
from twin.job.tolerance import BaselineTable
from twin.nc.canonical import Axes, Chunk, Dwell, Function, Moves
from twin.nc.text.diagnostics.diagnostics import Diagnostic, ProgramError

CORNER = np.array([50.0, 0, 0, 0])
ROWS = [
    line(np.zeros(4), CORNER),
    arc(CORNER, np.array([50.0, 20.0, 0]), UP, 360.0),
    line(CORNER, np.array([50.0, -30.0, -5.0, 90.0])),
]
MOVES = moves_of(*ROWS)
EVENTS = (Function(0, 1, "M3", {"S": 3000.0}), Dwell(1, 2, 0.5), Function(3, 3, "M30", {}))
PROGRAM = Chunk(MOVES, EVENTS)
FIGURES = RunFigures(cycle_time_s=20.0, contour_um=5.0)


@pytest.fixture
def stored(tmp_path: Path) -> Path:
    write_baseline(tmp_path / "part.baseline", FIGURES, AXES, [PROGRAM])
    return tmp_path / "part.baseline"


def reasons(
    stored: Path, moves: Moves, figures: RunFigures | None = FIGURES, *, events: tuple = EVENTS
) -> list[Reason]:
    program = [Chunk(moves, events)]
    return compare_baseline(stored, figures, AXES, program, BaselineTable())


def test_the_same_run_holds_however_it_is_chunked(stored: Path):
    assert reasons(stored, MOVES) == []
    later = tuple(dataclasses.replace(event, before=event.before - 1) for event in EVENTS[1:])
    chunks = [Chunk(MOVES[:1], EVENTS[:1]), Chunk(MOVES[1:], later)]
    assert compare_baseline(stored, FIGURES, AXES, chunks, BaselineTable()) == []


def test_the_file_is_text_with_a_line_an_entry_and_no_word_twice(stored: Path):
    assert stored.read_text(encoding="utf-8").splitlines() == [
        "twin baseline 5",
        "cycle_time_s 20.000000",
        "contour_um 5.000",
        "axes X Y Z C",
        "M3 S3000",
        "start X0 Y0 Z0 C0",
        "corner exact-stop",
        "acceleration machine",
        "feed X50 F1000",
        "dwell 0.5",
        "arc center 50 20 0 normal 0 0 1 sweep 360",
        "feed Y-30 Z-5 C90",
        "M30",
    ]


def test_positions_are_told_as_the_control_shows_them(stored: Path):
    """A tool 35 mm longer than the first: what the program calls Z-5 is Z30 for the axes."""
    higher = [50.0, -30.0, 30.0, 90.0]
    moves = changed("end", 2, higher)
    moves.display[2] = [50.0, -30.0, -5.0, 90.0]
    (found,) = reasons(stored, moves)
    assert found.message == "ends at Z-5, baseline Z-40"


def test_lines_that_move_in_the_program_change_nothing(stored: Path, tmp_path: Path):
    moved = dataclasses.replace(MOVES, line=MOVES.line + 7, block=MOVES.block + 70)
    assert reasons(stored, moved) == []
    write_baseline(tmp_path / "moved", FIGURES, AXES, [Chunk(moved, EVENTS)])
    assert (tmp_path / "moved").read_bytes() == stored.read_bytes()


def changed(column: str, row: int, value: object) -> Moves:
    values = getattr(MOVES, column).copy()
    values[row] = value
    display = values.copy() if column == "end" else MOVES.display
    return dataclasses.replace(MOVES, **{column: values, "display": display})


@pytest.mark.parametrize(
    ("moves", "line_number", "told"),
    [
        (changed("end", 2, [50.02, -30, -5, 90]), 3, "ends at X50.02, baseline X50"),
        (changed("end", 2, [50, 30, -5, 90]), 3, "ends at Y30, baseline Y-30"),
        (changed("end", 2, [50, -30, -5, 90.002]), 3, "ends at C90.002, baseline C90"),
        (changed("sweep", 1, -360.0), 2, "clockwise by 360 degrees, baseline counter-clockwise"),
        (changed("sweep", 1, 720.0), 2, "by 720 degrees, baseline counter-clockwise by 360"),
        (changed("center", 1, [30.0, 0, 0]), 2, "arc about (30 0 0), baseline (50 20 0)"),
        (changed("normal", 1, [0.0, 1.0, 0.0]), 2, "in the plane ZX, baseline XY"),
        (changed("motion", 0, 0), 1, "rapid X50, baseline feed X50"),
    ],
)
def test_the_first_block_that_differs_is_named(
    stored: Path, moves: Moves, line_number: int, told: str
):
    (reason,) = reasons(stored, moves)
    assert (reason.what, reason.line) == ("baseline-path", line_number)
    assert told in reason.message


def test_a_move_more_or_less_is_told_with_what_there_was(stored: Path):
    fewer, end = reasons(stored, MOVES[:2], events=EVENTS[:2])
    assert (fewer.what, fewer.line) == ("baseline-path", 2)
    assert fewer.message == "lost here: feed Y-30 Z-5 C90"
    assert (end.what, end.message) == ("baseline-function", "lost here: M30")
    (more,) = reasons(stored, moves_of(*ROWS, ROWS[0]), events=(*EVENTS[:2],))
    assert (more.what, more.line) == ("baseline-function", 4)
    assert more.message.endswith(", baseline M30")


def test_a_lost_block_in_the_middle_is_one_difference_and_not_all_that_follow(tmp_path: Path):
    places = [np.array([float(at), 0, 0, 0]) for at in range(40)]
    rows = [line(a, b) for a, b in itertools.pairwise(places)]
    write_baseline(tmp_path / "long", FIGURES, AXES, [Chunk(moves_of(*rows))])
    shorter = Chunk(moves_of(*rows[:10], *rows[13:]))
    found = compare_baseline(tmp_path / "long", FIGURES, AXES, [shorter], BaselineTable())
    assert [reason.message for reason in found] == [f"lost here: feed X{x}" for x in (11, 12, 13)]
    assert [reason.line for reason in found] == [11] * len(found)


def test_all_blocks_that_differ_are_listed_with_an_end(stored: Path, tmp_path: Path):
    ends = MOVES.end.copy()
    ends[0, 0], ends[2, 1] = 50.5, -31.0
    found = reasons(stored, dataclasses.replace(MOVES, end=ends, display=ends))
    assert [(reason.line, reason.message) for reason in found] == [
        (1, "ends at X50.5, baseline X50"),
        (3, "ends at Y-31, baseline Y-30"),
    ]
    places = [np.array([float(at), 0, 0, 0]) for at in range(200)]
    rows = [line(a, b) for a, b in itertools.pairwise(places)]
    write_baseline(tmp_path / "long", FIGURES, AXES, [Chunk(moves_of(*rows))])
    slow = dataclasses.replace(moves_of(*rows), feed=np.full(len(rows), 17.0))
    many = compare_baseline(tmp_path / "long", FIGURES, AXES, [Chunk(slow)], BaselineTable())
    assert len(many) == MOST_LISTED + 1
    assert many[-1].message == f"{len(rows) - MOST_LISTED} more differences of blocks"


@pytest.mark.parametrize(
    ("column", "value", "what", "told"),
    [
        ("corner", 2, "baseline-corner", "corner continuous, baseline exact-stop"),
        (
            "acceleration",
            500.0,
            "baseline-acceleration",
            "acceleration 500 machine, baseline machine",
        ),
    ],
)
def test_how_a_block_is_driven_is_held_too(
    stored: Path, column: str, value: float, what: str, told: str
):
    (found,) = reasons(stored, changed(column, 1, value))
    assert (found.what, found.line, found.message) == (what, 2, told)


def test_the_job_and_the_cut_are_held_too(tmp_path: Path):
    path = tmp_path / "part.baseline"
    cut = {"removed_mm3": 1000.0, "tool.1": 600.0, "tool.2": 400.0, "gouges_count": 0.0}
    stored = dataclasses.replace(FIGURES, cut=cut)
    job = {"tools.1.diameter": "8.0", "stock.size": "[60.0, 60.0, 20.0]"}
    write_baseline(path, stored, AXES, [PROGRAM], job)
    assert compare_baseline(path, stored, AXES, [PROGRAM], BaselineTable(), job) == []
    other = {"tools.1.diameter": "6.0", "offsets.G54.X": "1.0"}
    now = {"removed_mm3": 1000.0, "tool.1": 590.0, "tool.3": 410.0, "gouges_count": 1.0}
    now = dataclasses.replace(FIGURES, cut=now)
    found = compare_baseline(path, now, AXES, [PROGRAM], BaselineTable(), other)
    assert [(reason.what, reason.message) for reason in found] == [
        ("baseline-job", "offsets.G54.X is 1.0, baseline not set"),
        ("baseline-job", "stock.size is not set, baseline [60.0, 60.0, 20.0]"),
        ("baseline-job", "tools.1.diameter is 6.0, baseline 8.0"),
        ("baseline-cut", "cut: gouges 1, baseline 0"),
        ("baseline-cut", "cut: tool 1 removes 590 mm³, baseline 600"),
        ("baseline-cut", "cut: tool 2 removes 0 mm³, baseline 400"),
        ("baseline-cut", "cut: tool 3 removes 410 mm³, baseline 0"),
    ]


def test_functions_dwells_and_feeds_are_held_too(stored: Path):
    (slow,) = reasons(stored, MOVES, events=(Function(0, 1, "M3", {"S": 300.0}), *EVENTS[1:]))
    assert (slow.what, slow.message) == ("baseline-function", "M3 S300, baseline M3 S3000")
    (off,) = reasons(stored, MOVES, events=EVENTS[1:])
    assert (off.what, off.line) == ("baseline-function", 1)
    (long,) = reasons(stored, MOVES, events=(EVENTS[0], Dwell(1, 2, 5.0), EVENTS[2]))
    assert (long.what, long.message) == ("baseline-path", "dwell 5 s, baseline 0.5 s")
    feed = MOVES.feed.copy()
    feed[1] = 1002.0
    (fast,) = reasons(stored, dataclasses.replace(MOVES, feed=feed))
    assert (fast.what, fast.line) == ("baseline-feed", 2)
    assert "feed 1002, baseline 1000" in fast.message
    feed[1] = 1000.5
    assert reasons(stored, dataclasses.replace(MOVES, feed=feed)) == []


def broken_program(moves: Moves, line: int) -> Iterator[Chunk]:
    yield Chunk(moves, EVENTS[:1])
    raise ProgramError(Diagnostic("error", "unknown-word", "no word", "a.nc", line, 1))


def test_a_program_that_no_longer_interprets_is_told_with_what_was_there(stored: Path):
    """The dwell that follows the first move is the first thing that is missing."""
    program = broken_program(MOVES[:1], 2)
    (broken,) = compare_baseline(stored, None, AXES, program, BaselineTable())
    assert (broken.what, broken.line) == ("baseline-path", 2)
    assert broken.message == "no longer interprets, baseline dwell 0.5"
    program = broken_program(changed("end", 0, [51.0, 0, 0, 0])[:1], 2)
    earlier, broken = compare_baseline(stored, None, AXES, program, BaselineTable())
    assert (earlier.line, earlier.message) == (1, "ends at X51, baseline X50")
    assert broken.line == 2


def test_another_machine_is_no_traceback(stored: Path):
    axes = Axes(("X", "Y", "Z"), ("linear",) * 3)
    (other,) = compare_baseline(stored, FIGURES, axes, [], BaselineTable())
    assert other.message == "axes X Y Z, baseline X Y Z C"


@settings(max_examples=examples(25), derandomize=True, deadline=None)
@given(st.integers(0, 2**31), st.integers(1, 12))
def test_what_is_stored_is_what_comes_back(seed: int, count: int):
    random = np.random.default_rng(seed)
    position, rows = random.uniform(-200, 200, 4), []
    for _ in range(count):
        end = np.where(random.random(4) < 0.5, position, random.uniform(-200, 200, 4))
        row = line(position, end)
        if random.random() < 0.4:
            normal = np.eye(3)[random.integers(3)]
            row = arc(position, position[:3] + 9.0 * np.roll(normal, 1), normal, 200.0, lead=1.0)
        rows.append(row)
        position = row["end"]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "x.baseline"
        write_baseline(file, FIGURES, AXES, [Chunk(moves_of(*rows))])
        assert reasons(file, moves_of(*rows), events=()) == []
        index = int(random.integers(count))
        rows[index] = rows[index] | {"end": rows[index]["end"] + np.array([0, 0.0011, 0, 0])}
        (found,) = reasons(file, moves_of(*rows), events=())
        assert (found.what, found.line) == ("baseline-path", index + 1)


def test_a_normal_and_a_sweep_turned_over_together_are_the_same_arc(stored: Path):
    turned = dataclasses.replace(changed("sweep", 1, -360.0), normal=-MOVES.normal)
    assert reasons(stored, turned) == []


def test_less_than_the_tolerance_is_no_difference(stored: Path):
    assert reasons(stored, changed("end", 2, [50.0009, -30, -5, 90])) == []


def test_time_and_error_are_held_too(stored: Path):
    assert reasons(stored, MOVES, None) == []
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
    ["", "else\n", "twin baseline 2\ncycle_time_s x\ncontour_um 1\n", "twin baseline 2\naxes X\n",
     "twin baseline 1\ncycle_time_s 1\ncontour_um 1\naxes X Y Z C\n",
     *(f"twin baseline 2\ncycle_time_s 1\ncontour_um 1\naxes X Y Z C\n{line}\n"
       for line in ("feed Q5", "feed X5,5", "arc center 1 2", "dwell", "dwell x", "feed X"))],
)  # fmt: skip
def test_what_is_no_baseline_is_refused(tmp_path: Path, text: str):
    (tmp_path / "x.baseline").write_text(text, encoding="utf-8")
    with pytest.raises(UsageError, match="is not a baseline"):
        reasons(tmp_path / "x.baseline", MOVES)


def test_a_program_without_moves_has_a_baseline(tmp_path: Path):
    write_baseline(tmp_path / "x.baseline", FIGURES, AXES, [])
    assert compare_baseline(tmp_path / "x.baseline", FIGURES, AXES, [], BaselineTable()) == []
