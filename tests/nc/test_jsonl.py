"""The lines of JSON against the records that they are the text of."""

import dataclasses
import json
from pathlib import Path

import pytest

from tests.nc.running import ROOT, SETTINGS, all_records, shipped
from twin.nc.control.settings import ToolData
from twin.nc.dialects import dialect_named
from twin.nc.interpreter import Interpretation
from twin.nc.jsonl import json_lines, text_lines
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.nc.text.source import source_from_text

TEXT = "N5 G0 X1 C5\nM3 S5\nN7 G1 X5 Y2 F100\nG2 X15 I5 J0\nG4 P1\nG1 C90\nX1e5\n"


def interpretation(text: str) -> Interpretation:
    return Interpretation(source_from_text(text), dialect_named("gost"), SETTINGS)


@pytest.mark.parametrize("path", sorted((ROOT / "programs" / "fagor8070").glob("*.nc")))
def test_lines_are_the_records_as_json(path: Path) -> None:
    wanted = [json.dumps(each, ensure_ascii=False) for each in all_records(shipped(path))]
    assert list(json_lines(shipped(path))) == wanted


def test_events_rapids_labels_and_errors_keep_their_places() -> None:
    wanted = [json.dumps(each, ensure_ascii=False) for each in all_records(interpretation(TEXT))]
    lines: list[str] = []
    with pytest.raises(ProgramError):
        lines.extend(json_lines(interpretation(TEXT)))
    assert lines == wanted
    assert [json.loads(line)["type"] for line in lines][:3] == ["move", "function", "move"]


def test_text_has_a_line_for_each_record() -> None:
    text = TEXT.replace("X1e5\n", "")
    assert len(list(text_lines(interpretation(text)))) == len(all_records(interpretation(text)))


TWO_TOOLS = dataclasses.replace(
    SETTINGS,
    tools={1: ToolData(5.0, 60.0), 2: ToolData(3.0, 95.0)},
    offsets={"G54": {}, "G55": {"X": 100.0}},
)
DRILLED = {
    "fanuc": "G21 G90 G54\nT2 M6\nG55 G0 X10. Y20.\nG43 H2 Z15.\nG1 Z2. F100.\nM30\n",
    "haas": "G21 G90 G54\nT2 M6\nG55 G0 X10. Y20.\nG43 H2 Z15.\nG1 Z2. F100.\nM30\n",
    "linuxcnc": "G21 G90 G54\nT2 M6\nG55 G0 X10. Y20.\nG43 H2 Z15.\nG1 Z2. F100.\nM30\n",
    "gost": "G90 G54\nT2 M6\nG55 G0 X10 Y20\nG43 Z15\nG1 Z2 F100\nM30\n",
}


@pytest.mark.parametrize("name", DRILLED)
def test_display_is_what_the_program_says_under_an_offset_and_a_length(name: str) -> None:
    """A tool 35 mm longer than the first goes to Z2: the first one's tip would be at Z37, 100 mm beside G54."""
    made = Interpretation(source_from_text(DRILLED[name]), dialect_named(name), TWO_TOOLS)
    moves = [each for each in all_records(made) if each["type"] == "move"]
    assert moves[-1]["end"]["Z"] == pytest.approx(37.0)
    assert moves[-1]["end"]["X"] == pytest.approx(110.0)
    shown = [each["display"] for each in moves if "display" in each]
    assert [(each["X"], each["Y"], each["Z"]) for each in shown[-2:]] == [(10, 20, 15), (10, 20, 2)]
    again = Interpretation(source_from_text(DRILLED[name]), dialect_named(name), TWO_TOOLS)
    assert "X10 Y20 Z2 " in list(text_lines(again))[-3]


def test_moves_under_compensation_say_that_they_are_those_of_the_tool_centre() -> None:
    text = "G21 G90 G54\nG0 X-20. Y0.\nG41 D1 G1 X0. F100.\nY30.\nX30.\nG40 X50.\nM30\n"
    made = Interpretation(source_from_text(text), dialect_named("fanuc"), TWO_TOOLS)
    moves = [each for each in all_records(made) if each["type"] == "move"]
    assert [(each["line"], "tool_center" in each) for each in moves] == [
        (2, False), (3, True), (4, True), (5, True), (6, False),
    ]  # fmt: skip
    assert moves[2]["end"]["X"] == pytest.approx(-5.0)
    again = Interpretation(source_from_text(text), dialect_named("fanuc"), TWO_TOOLS)
    text_of = {line.split()[0]: line for line in text_lines(again)}
    assert text_of["4"].split()[2:4] == ["X-5", "Y35"]
    assert text_of["4"].endswith("tool centre")


def test_moves_beside_a_contour_of_heidenhain_say_so_too() -> None:
    text = "BEGIN PGM P MM\nTOOL CALL 1 Z S1000\nL X-20 Y+0 R0 FMAX\nL X+0 RL F100\nL Y+30\nL X+50 R0\nEND PGM P MM\n"
    made = Interpretation(source_from_text(text), dialect_named("heidenhain"), TWO_TOOLS)
    moves = [each for each in all_records(made) if each["type"] == "move"]
    assert [(each["line"], "tool_center" in each) for each in moves] == [
        (3, False), (4, True), (5, True), (6, False),
    ]  # fmt: skip


def test_what_the_screen_shows_as_the_position_is_not_said_twice() -> None:
    text = "G21 G90 G54\nG0 X-20. Y0.\nG1 Z-5. F100.\nM30\n"
    made = Interpretation(source_from_text(text), dialect_named("fanuc"), TWO_TOOLS)
    assert not any("display" in each for each in all_records(made) if each["type"] == "move")
