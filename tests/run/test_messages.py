"""Near misses as they are reported."""

from pathlib import Path

import pytest

from twin.machine.watching.clearance import TOUCH
from twin.nc.text.source import read_source
from twin.recording.alarms import NearMiss
from twin.run.messages import near_miss_diagnostic


@pytest.mark.parametrize(
    ("clearance", "told"),
    [
        (0.0, "the holder touches the jaw: there is no room between them"),
        (TOUCH, "the holder touches the jaw: there is no room between them"),
        (0.05, "the holder passes the jaw with 0.05 mm to spare"),
    ],
)
def test_what_lies_on_each_other_does_not_pass(tmp_path: Path, clearance: float, told: str) -> None:
    program = tmp_path / "program.nc"
    program.write_text("G0 X1\n", encoding="utf-8")
    miss = NearMiss(clearance, 1, 2.0, ("holder", "jaw"))
    assert told in str(near_miss_diagnostic(miss, read_source(program)))
