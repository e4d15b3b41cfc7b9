"""The times of tools against the samples that each is in the spindle for."""

import numpy as np
import pytest

from tests.compare.runs import samples, setpoints
from tests.compare.test_trace import MOVES
from twin.job.job_file import ToolTable
from twin.run.observers import ToolTimes
from twin.toolpath.tool_plan import ToolPlan

TOOLS = tuple(ToolTable(number=number, diameter=2.0 * number) for number in (3, 1))


def test_every_sample_counts_for_the_tool_in_the_spindle() -> None:
    asked = setpoints(MOVES, per_move=100)
    run = samples(asked, asked.position)
    times = ToolTimes(ToolPlan(TOOLS, (0, 1)), 0.001)
    times.add(run[:150])
    times.add(run[150:])
    found = times.result(None)
    first = int((np.maximum(asked.move, 0) < 1).sum())
    assert [use.tool.number for use in found] == [3, 1]
    assert [use.time_s for use in found] == pytest.approx([first * 1e-3, (len(run) - first) * 1e-3])
    assert [use.removed_mm3 for use in found] == [None, None]
    assert found[0].as_json()["diameter_mm"] == 6.0
