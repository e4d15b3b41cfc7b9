"""Which lines of a program were run, and lengths that are called of another tool."""

import pytest

from twin.nc.canonical import Axes
from twin.nc.control.settings import ControlSettings, ToolData
from twin.nc.dialects import dialect_named
from twin.nc.interpreter import Interpretation
from twin.nc.line_kernel.kernel import run_lines
from twin.nc.text.source import source_from_text

SETTINGS = ControlSettings(
    axes=Axes(("X", "Y", "Z"), ("linear", "linear", "linear")),
    tools={1: ToolData(5.0, 60.0), 2: ToolData(3.0, 50.0)},
)


def interpreted(text: str, dialect: str, kernel=None) -> Interpretation:
    source = source_from_text(text)
    run = Interpretation(source, dialect_named(dialect), SETTINGS, kernel=lambda _lines: kernel)
    for _ in run.chunks():
        pass
    return run


@pytest.mark.parametrize("kernel", [None, run_lines], ids=["python", "kernel"])
@pytest.mark.parametrize(
    ("text", "dialect", "never"),
    [
        ("G90 G0 X1.\nG1 X2. F100.\nX3.\nX4.\nX5.\nX6.\nM30\n", "fanuc", []),
        ("G90 G0 X1.\nGOTO 9\nG1 X2. F100.\nG4 X1.\n(X5.)\nN9 X3.\nM30\n", "fanuc", [3]),
        ("G90 G0 X1.\nX1.\nM30\n", "fanuc", []),
        ("G90 G0 X1.\n/X2.\nM30\n", "fanuc", []),
        ("G90 G0 X1\no1 if [0]\nX2\no1 endif\nX3\nM2\n", "linuxcnc", [3]),
        ("G90 G0 X1\nM30\nG10 L2 P1 X5\nG0 X2\n", "linuxcnc", [4]),
    ],
)
def test_lines_that_were_never_come_to_are_known_exactly(text, dialect, never, kernel):
    assert interpreted(text, dialect, kernel).coverage.never_run() == never


def test_motion_behind_the_end_is_found_unless_a_subprogram_begins_there():
    ended = interpreted("G90 G0 X1.\nM30\nX2.\n", "fanuc")
    assert (ended.coverage.ends_at, ended.coverage.motion_behind_end()) == (2, 3)
    assert interpreted("G90 G0 X1.\nM30\nO9\nX2.\nM99\n", "fanuc").coverage.motion_behind_end() == 0


@pytest.mark.parametrize(
    ("text", "dialect", "call"),
    [
        ("T1 M6\nG43 H2 Z5.\nM30\n", "fanuc", {2: (2, 1)}),
        ("T2 M6 G43 H2\nM30\n", "fanuc", {1: (2, 2)}),
        ("T2 M6\n#1=1\nG43 H#1 Z5.\nM30\n", "fanuc", {3: (1, 2)}),
        ("T1 M6\nG43 H0\nM30\n", "fanuc", {}),
        ("T2 M6\nG43\nM2\n", "linuxcnc", {2: (2, 2)}),
    ],
)
def test_a_length_call_knows_the_tool_in_the_spindle(text, dialect, call):
    assert interpreted(text, dialect).lengths.calls == call
