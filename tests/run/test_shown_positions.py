"""The worst places of a run are reported in the coordinates that the control shows."""

from pathlib import Path

import pytest

from twin.run.preparing.preparation import prepare
from twin.run.progress import no_progress
from twin.run.run import Run

PROGRAM = "G21 G90 G54\nT2 M6\nS1000 M3\nG0 X10. Y5.\nG43 H2 Z20.\nG1 Z2. F3000.\nX40.\nY30.\nM30\n"
JOB = """program = "part.nc"
dialect = "fanuc"
[[tools]]
number = 1
length = 60.0
[[tools]]
number = 2
length = 95.0
"""


@pytest.mark.seconds("a program is run")
def test_the_height_of_a_longer_tool_is_that_of_the_program(tmp_path: Path) -> None:
    (tmp_path / "part.nc").write_text(PROGRAM)
    (tmp_path / "part.toml").write_text(JOB)
    run = Run(prepare(tmp_path / "part.toml"))
    outcome = run.execute(None, no_progress)
    flat = [place for place in outcome.figures.worst if place.line in (7, 8)]
    assert flat
    assert [place.position[2] for place in flat] == pytest.approx([2.0] * len(flat), abs=0.2)
    under = outcome.trace.tool[outcome.trace.line == 8]
    assert under[:, 2].min() == pytest.approx(2.0, abs=0.2)
