"""What a program says beside its moves, read off real programs."""

import numpy as np
import pytest

from twin.cutting.program_summary import ProgramSummary, SummaryBuilder
from twin.cutting.tools import EMPTY_SPINDLE, default_cell
from twin.errors import ConfigError
from twin.job.job_file import JobFile, StockTable, ToolTable
from twin.nc.canonical import Axes
from twin.nc.control.settings import ControlSettings, ToolData
from twin.nc.dialects import dialect_named
from twin.nc.functions import SpindleState
from twin.nc.interpreter import Interpretation
from twin.nc.text.source import source_from_text

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
    assert found.tools.longer(found.tools.at(3)) == 15.0
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
    assert found.shown is not None
    assert [found.shown.at(move)[3] for move in range(3)] == [0.0, -720.0, -720.0]
    assert summary("G1 X1 F100\nM30\n").shown is None


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
