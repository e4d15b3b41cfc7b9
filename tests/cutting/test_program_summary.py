"""What a program says beside its moves, read off real programs."""

import numpy as np
import pytest

from tests.five_axes import FIRST_LENGTH, TRUNNION_AXES, on_machine, settings, trunnion
from twin.cutting.program_summary import PlacedPart, ProgramSummary, SummaryBuilder
from twin.cutting.tools import EMPTY_SPINDLE, default_cell
from twin.errors import ConfigError
from twin.job.job_file import JobFile, StockTable, ToolTable
from twin.nc.canonical import Axes, concatenate
from twin.nc.control.settings import ControlSettings, ToolData
from twin.nc.dialects import dialect_named
from twin.nc.functions import SpindleState
from twin.nc.interpreter import Interpretation
from twin.nc.text.source import source_from_text
from twin.toolpath.geometry import geometry
from twin.toolpath.part_frame import PartFrame

AXES = Axes(("X", "Y", "Z", "C"), ("linear", "linear", "linear", "rotary"))
TOOLS = (ToolTable(number=1), ToolTable(number=4, diameter=6.0, length=75.0, speed=500.0))
JOB = JobFile(program="p.nc", tools=TOOLS, stock=StockTable(shape="box", size=(9.0, 9.0, 9.0)))


def summary(
    text: str, job: JobFile = JOB, dialect: str = "gost", spindle: SpindleState | None = None
) -> ProgramSummary:
    settings = ControlSettings(
        axes=AXES,
        periodic=frozenset("C"),
        tools={tool.number: ToolData(tool.diameter / 2, tool.length) for tool in job.tools},
    )
    builder = SummaryBuilder(job, spindle)
    for chunk in Interpretation(source_from_text(text), dialect_named(dialect), settings).chunks():
        builder.add(chunk)
    return builder.summary()


@pytest.mark.parametrize("dialect", ["gost", "mefi", "fagor8070"])
def test_tools_change_between_moves(dialect: str) -> None:
    found = summary("G0 X1\nG1 X2 F100\nT4\nG1 X3\nM6\nG1 X4\nT1 M6\nG0 X5\nM30\n", dialect=dialect)
    numbers = [found.tools.at(move).number for move in range(-1, 5)]
    assert numbers == [1, 1, 1, 1, 4, 1]
    assert found.tools.length_difference(found.tools.at(3)) == 15.0
    assert [(move, line, tool.number) for move, line, tool in found.tools.changes] == [
        (3, 5, 4), (4, 7, 1),
    ]  # fmt: skip
    assert found.is_rapid(np.array([-1, 0, 1, 2, 3, 4, 5])).tolist() == [
        False, True, False, False, False, True, False,
    ]  # fmt: skip


def test_tool_0_leaves_the_spindle_empty() -> None:
    found = summary("T4 M6\nG1 X2 F100\nT0 M6\nG0 X5\nM30\n", dialect="fagor8070")
    lengths = [found.tools.at(move).length for move in range(2)]
    assert lengths == [75.0, EMPTY_SPINDLE.length]
    stock = StockTable(shape="box", size=(90.0, 90.0, 9.0))
    assert default_cell(found.tools.tools, stock) == default_cell(TOOLS, stock)


def test_the_spindle_as_the_program_speaks_of_it() -> None:
    found = summary(
        "G0 X1\nS900 M3\nG1 X2 F100\nS1200\nG1 X3\nM5\nG0 X4\nM4\nG1 X5\nT4 M6\nG1 X6\nM30\n"
    )
    assert [found.spindle.at(move) for move in range(6)] == [0, 900, 1200, 0, -1200, 0]
    assert [found.tools.at(move).speed for move in range(6)] == [None, 900, 1200, None, 1200, None]


@pytest.mark.parametrize("change", ["T4 M6", "T1 M6", "M6", "T9 M6"])
def test_the_spindle_stands_behind_every_change_of_tool_until_it_is_started(change: str) -> None:
    any_tool = JobFile(program="p.nc", stock=JOB.stock)
    found = summary(f"S900 M3\nG1 X2 F100\n{change}\nG1 X3\nM4\nG1 X4\nM30\n", any_tool)
    assert [found.spindle.at(move) for move in range(3)] == [900, 0, -900]


def test_a_program_that_never_speaks_of_the_spindle_has_the_jobs_speed() -> None:
    found = summary("G0 X1\nT4 M6\nG1 X2 F100\nM30\n")
    assert [found.tools.at(move).speed for move in range(2)] == [None, 500.0]


def test_what_the_screen_adds_is_noted_where_it_changes() -> None:
    found = summary("G0 C0\nG102 C360\nG1 C721 F1200\nG1 C10\nG1 C20\nM30\n")
    assert [found.shown(move, np.zeros(4))[3] for move in range(3)] == [0.0, -720.0, -720.0]
    assert summary("G1 X1 F100\nM30\n").screen is None


def test_an_unlisted_tool_is_refused_where_something_is_cut() -> None:
    program = "G0 X1\nT9 M6\nG1 X2 F100\nM30\n"
    with pytest.raises(ConfigError, match=r"line 2 .* tool 9, but the job lists 1, 4"):
        summary(program)
    air = JOB.model_copy(update={"stock": None})
    assert summary(program, air).tools.at(5).number == 1
    any_tool = JobFile(program="p.nc", stock=JOB.stock)
    assert summary(program, any_tool).tools.at(5).number == 1


def test_an_empty_program_has_notes_too() -> None:
    found = summary("M30\n")
    assert found.tools.at(0).number == 1
    assert found.is_rapid(np.array([-1, 0])).tolist() == [False, False]


def test_the_end_of_a_silent_program_is_no_word_about_the_spindle() -> None:
    found = summary("T4 M6\nG1 X2 F100\nG1 X3\nM30\n")
    assert [found.spindle.at(move) for move in range(2)] == [None, None]
    assert [found.tools.at(move).speed for move in range(2)] == [500.0, 500.0]


def test_a_speed_behind_m3_turns_the_spindle() -> None:
    found = summary("M3\nS4000\nG1 X2 F100\nM4\nG1 X3\nM5\nS500\nG1 X4\nM30\n")
    assert [found.spindle.at(move) for move in range(3)] == [4000, -4000, 0]


def test_a_start_without_s_stands_where_the_control_has_a_word_for_it_and_the_job_says_nothing():
    found = summary("M3\nG1 X1 F100\nT4 M6\nM3\nG1 X2\nM30\n", spindle=SpindleState(has_word=True))
    assert [found.spindle.at(move) for move in range(2)] == [0, 500]
    found = summary("M3\nG1 X1 F100\nS9000\nG1 X2\nM30\n", spindle=SpindleState(fastest=8000.0))
    assert [found.spindle.at(move) for move in range(2)] == [None, 8000]


LED = """G54 G90 G0 X0 Y0 Z30 A0 C0
T2 M6
G43.4 H2
G1 X10 Y5 Z20 A20 C30 F500
G1 X30 Y-5 Z12 A-35 C80
G2 X10 Y-5 I-10 J0
G1 C40
X12 Y8 Z15
G3 X12 Y8 I-4 J0
G68 X3 Y2 R25
G1 X20 Y8 Z14 A10
X0 Y0
G69
G49
G0 Z80
G68.2 X5 Y6 Z7 I20 J30 K-10
G53.1
G1 X10 Y4 Z3 F300
G2 X10 Y4 I-6 J2
G1 G41 D2 X20 Y9
X30 Y9
X40 Y-20
G40 X60 Y-30
G69
M30
"""


@pytest.mark.seconds("every code of five axes, and its planning tables")
def test_the_screen_shows_programmed_coordinates_all_along_a_led_or_tilted_move() -> None:
    setup = on_machine(trunnion())
    frame = PartFrame(None, (0.0, 0.0), chain=setup.chain).at(setup.zero, FIRST_LENGTH)
    tools = tuple(ToolTable(number=n, length=FIRST_LENGTH + 15.0 * (n - 1)) for n in (1, 2))
    builder = SummaryBuilder(
        JobFile(program="p.nc", tools=tools), part=PlacedPart(frame, setup.zero)
    )
    source, dialect = source_from_text(LED), dialect_named("fanuc")
    chunks = list(Interpretation(source, dialect, settings(setup)).chunks())
    for chunk in chunks:
        builder.add(chunk)
    found, moves = builder.summary(), concatenate([each.moves for each in chunks], TRUNNION_AXES)
    path, shares = geometry(moves), np.linspace(0.0, 1.0, 5)
    for row in range(len(moves)):
        axes = path.position(np.full(len(shares), row), shares)
        shown = np.array([found.shown(row, each) for each in axes])
        np.testing.assert_allclose(shown[-1], moves.display[row], atol=1e-7)
        steps = np.linalg.norm(np.diff(shown[:, :3], axis=0), axis=1)
        assert np.ptp(steps) < 1e-7
        if moves.sweep[row] == 0.0:
            straight = shown[0] + shares[:, None] * (shown[-1] - shown[0])
            np.testing.assert_allclose(shown[:, :3], straight[:, :3], atol=1e-7)
