"""The lines of JSON against the records that they are the text of."""

import json
from pathlib import Path

import pytest

from tests.nc.running import ROOT, SETTINGS, all_records, shipped
from twin.nc.dialects import dialect_named
from twin.nc.interpreter import Interpretation
from twin.nc.jsonl import json_lines, text_lines
from twin.nc.text.diagnostics import ProgramError
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
