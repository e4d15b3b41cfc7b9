import numpy as np
import pytest

from tests.compare.paths import AXES, line, moves_of
from tests.compare.runs import FRAME, PART_ZERO, samples, setpoints
from twin.compare import trace as module
from twin.compare.trace import Trace, line_changes

MOVES = moves_of(
    line(np.zeros(4), np.array([10.0, 0, 0, 0])),
    line(np.array([10.0, 0, 0, 0]), np.array([10.0, 5, 0, 90.0])),
)


def traced(per_move: int, rows: int, error: np.ndarray) -> Trace:
    asked = setpoints(MOVES, per_move=per_move)
    run = samples(asked, asked.position - np.array([0.001, 0, 0, 0.002]))
    trace = Trace(AXES, FRAME, PART_ZERO)
    for first in range(0, len(asked), rows):
        here = slice(first, first + rows)
        chunk = samples(asked[here], run.joint_position[here])
        trace.add(chunk, error[here])
    return trace


def test_a_short_run_is_kept_whole():
    error = np.linspace(0, 1, 101)
    trace = traced(50, 30, error)
    assert trace.time == pytest.approx(0.001 * np.arange(101))
    assert trace.error_um == pytest.approx(error)
    assert trace.position[0] == pytest.approx([-0.001, 0, 0, -0.002])
    assert trace.lag == pytest.approx(np.tile([0.001, 0, 0, 0.002], (101, 1)))
    # The table turns counter-clockwise under a positive C, the tool around the part with it.
    assert trace.tool[50] == pytest.approx([9.999, 0, 0], abs=0.002)
    assert [number for _, number in line_changes(trace)] == [1, 2]


@pytest.mark.parametrize("rows", [7, 100, 4000])
def test_a_long_run_is_thinned_and_keeps_its_peaks(monkeypatch: pytest.MonkeyPatch, rows: int):
    monkeypatch.setattr(module, "POINTS", 50)
    rng = np.random.default_rng(1)
    error = rng.random(6001)
    error[1234], error[6000] = 9.0, 8.0
    trace = traced(3000, rows, error)
    assert 50 <= len(trace.time) <= 102
    assert np.all(np.diff(trace.time) >= 0)
    assert trace.error_um.max() == 9.0
    assert trace.time[trace.error_um.argmax()] == pytest.approx(1.234)
    assert trace.time[-1] == pytest.approx(6.0)


def test_nothing_gives_an_empty_trace():
    trace = Trace(AXES, FRAME, PART_ZERO)
    assert len(trace.time) == len(trace.line) == 0
    assert trace.position.shape == (0, 4)
    assert list(line_changes(trace)) == []
