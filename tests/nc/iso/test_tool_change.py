"""The height that Z rises to by itself before a tool changes."""

import dataclasses

import pytest

from tests.nc.running import SETTINGS, run
from twin.cutting.watching.events import CutEvent
from twin.job.job_file import ToolTable
from twin.nc.control.settings import ToolData
from twin.nc.functions import TOOL_CHANGE
from twin.run.machining import stock_alarm

JOB = dataclasses.replace(
    SETTINGS,
    tools={1: ToolData(5.0, 60.0), 2: ToolData(3.0, 95.0)},
    offsets={"G54": {}},
    machine_zero={"X": 0.0, "Y": 0.0, "Z": 300.0, "C": 0.0},
)
CHANGE = "G0 X10. Y5. Z20.\nT2 M6\nG0 X30.\nM30\n"
DIALECTS = ("fanuc", "haas", "linuxcnc", "fagor8070", "gost", "mefi")


@pytest.mark.parametrize("dialect", DIALECTS)
def test_a_height_of_the_machine_is_gone_to_before_the_change(dialect: str) -> None:
    made = run(CHANGE, dialect, JOB, tool_change_height=-50.0)
    assert made.error is None, made.error
    heights = [made.end(row)["Z"] for row in range(len(made.moves))]
    assert heights == [20.0, 250.0, 250.0]  # machine zero lies at Z300 of the part
    (change,) = [event for event in made.events if getattr(event, "word", "") == TOOL_CHANGE]
    assert change.before == 2


@pytest.mark.parametrize(("dialect", "rises"), [(name, name == "haas") for name in DIALECTS])
def test_a_haas_alone_rises_to_machine_zero_by_itself(dialect: str, rises: bool) -> None:
    made = run(CHANGE, dialect, JOB)
    assert len(made.moves) == 2 + rises
    assert made.position["Z"] == (300.0 if rises else 20.0)


def test_what_is_higher_already_stays() -> None:
    made = run(CHANGE.replace("Z20.", "Z280."), "fanuc", JOB, tool_change_height=-50.0)
    assert [made.end(row)["Z"] for row in range(len(made.moves))] == [280.0, 280.0]


def test_a_height_that_is_written_down_asks_for_part_zero() -> None:
    assert run(CHANGE, "haas", JOB, machine_zero=None).error is None
    made = run(CHANGE, "fanuc", JOB, machine_zero=None, tool_change_height=-50.0)
    assert made.error is not None
    assert made.error.code == "no-machine-zero"
    assert not made.moves.line.tolist().count(2)


def test_the_alarm_says_how_long_the_tools_are_and_what_to_write() -> None:
    event = CutEvent(7, 1.0, 12.0, (0.0, 0.0, -12.0), "arrival")
    tools = [ToolTable(number=number, length=length) for number, length in ((1, 60.0), (2, 95.0))]
    message = stock_alarm(event, tools[1], tools[0]).message
    assert "tool 2, 95 mm long, comes into the spindle 12.00 mm deep in the part" in message
    assert "where tool 1 of 60 mm was" in message
    assert "[tool_change] height = 0" in message


@pytest.mark.parametrize(
    ("dialect", "block"),
    [
        ("fanuc", "G53 Z-10."),
        ("haas", "G53 Z-10."),
        ("linuxcnc", "G53 G0 Z-10."),
        ("sinumerik", "SUPA Z-10"),
        ("fagor8070", "#MCS ON\nG0 Z-10\n#MCS OFF"),
        ("heidenhain", "L Z-10 FMAX M91"),
    ],
)
def test_moves_from_machine_zero_are_shown_in_the_programs_coordinates(
    dialect: str, block: str
) -> None:
    """As the screen's absolute position goes on doing: machine zero lies at Z300 of the part."""
    first = "L X+10 Y+5 FMAX" if dialect == "heidenhain" else "G0 X10. Y5."
    made = run(f"{first}\n{block}\nM30\n", dialect, JOB)
    assert made.error is None, made.error
    shown = dict(zip(made.moves.axes.names, made.moves.display[-1].tolist(), strict=True))
    assert (shown["X"], shown["Y"], shown["Z"]) == (10.0, 5.0, 290.0)
