"""The cutter against jaws and clamps, by the geometry of both."""

import math

import numpy as np
import pytest

from tests.cutting.conftest import Motion
from twin.cutting.fixtures import FixtureGuard
from twin.cutting.tools import ToolPlan
from twin.job.fixture import FixtureTable
from twin.job.job_file import ToolTable
from twin.toolpath.part_frame import PartFrame

TOOL = ToolTable(number=1, diameter=10.0)
TABLE = -300.0
JAW = FixtureTable(name="jaw", size=(80.0, 20.0, 30.0), position=(0.0, 50.0, 0.0))
CLAMP = FixtureTable(name="clamp", diameter=16.0, height=45.0, position=(-60.0, 0.0, 0.0))


def guard(turn_zero: float = 0.0, tools: ToolPlan | None = None) -> FixtureGuard:
    frame = PartFrame(rotary=3, center=(7.0, -4.0), turn_zero=turn_zero)
    return FixtureGuard((JAW, CLAMP), tools or ToolPlan((TOOL,)), frame, TABLE)


def towards_jaw(z: float, c: float = 0.0) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    """The tool goes along machine +Y, a hundredth of a millimetre a sample."""
    y = np.arange(0.0, 60.0, 0.01)
    return np.stack([0 * y + 7.0, y - 4.0, 0 * y + TABLE + z, 0 * y + c], axis=1)


def test_the_jaw_is_met_where_its_side_is(samples: Motion) -> None:
    found = guard().look(samples(towards_jaw(20.0), line=9))
    assert found is not None
    sample, event, name = found
    assert (name, event.line, event.what) == ("jaw", 9, "fixture")
    assert 0.01 * sample == pytest.approx(40.0 - 5.0, abs=2.5)
    assert event.depth_mm == pytest.approx(10.0, abs=0.01)


@pytest.mark.parametrize("z", [30.0, 31.0])
def test_above_the_jaw_nothing_is_met(samples: Motion, z: float) -> None:
    assert guard().look(samples(towards_jaw(z))) is None


def test_fixtures_turn_with_the_table(samples: Motion) -> None:
    assert guard().look(samples(towards_jaw(20.0, c=-90.0))) is None
    for c in (90.0, -270.0):
        found = guard().look(samples(towards_jaw(20.0, c)))
        assert found is not None
        assert found[2] == "clamp", "the tool is over the part's -X"
        assert 0.01 * found[0] == pytest.approx(60.0 - 8.0 - 5.0, abs=2.5)
    angle = np.linspace(0.0, 360.0, 4000)
    turning = np.stack([0 * angle + 67.0, 0 * angle - 4.0, 0 * angle + TABLE + 40.0, angle], 1)
    found = guard().look(samples(turning))
    assert found is not None
    assert found[2] == "clamp"
    half = math.degrees(2 * math.asin((8.0 + 5.0) / 2 / 60.0))
    assert angle[found[0]] == pytest.approx(180.0 - half, abs=2.5)


def test_fixtures_count_from_the_table_at_zero(samples: Motion) -> None:
    """Where part zero is turned, the jaw still stands at machine +Y with the table at 0."""
    straight, turned = guard(), guard(turn_zero=35.0)
    for c in (0.0, 20.0):
        motion = samples(towards_jaw(20.0, c))
        first, second = straight.look(motion), turned.look(motion)
        assert first is not None
        assert second is not None
        assert first[0] == pytest.approx(second[0], abs=250)


def test_a_longer_tool_reaches_deeper(samples: Motion) -> None:
    long = ToolTable(number=2, diameter=10.0, length=75.0)
    plan = ToolPlan((TOOL, long), (0, 0))
    assert guard(tools=plan).look(samples(towards_jaw(40.0))) is not None
    assert guard().look(samples(towards_jaw(40.0))) is None
