"""The error of the tool's direction, on machines whose axes tilt the part."""

import numpy as np
import pytest

from tests.compare.runs import samples
from tests.five_axes import FIRST_LENGTH, TRUNNION_AXES, on_machine, settings, trunnion
from tests.nc.running import run
from twin.compare.comparison import Comparison
from twin.compare.figures import AxisTracking
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray, Moves, Shape
from twin.nc.path.tool_center import ToolCenter
from twin.toolpath.part_frame import PartFrame

SETUP = on_machine(trunnion())
FRAME = PartFrame(None, (0.0, 0.0), chain=trunnion()).at(SETUP.zero, FIRST_LENGTH)
PER_MOVE = 8


def _curves() -> Moves:
    text = "O1\nG43.4 H1\nG1 X10. F500.\nX40. Y-10. A30. C90.\nM30\n"
    moves = run(text, "fanuc", settings(SETUP)).moves
    return moves[moves.shape == Shape.CURVE]


def _setpoints(moves: Moves) -> Setpoints:
    assert moves.curve is not None
    move = np.repeat(np.arange(len(moves)), PER_MOVE)
    fraction = np.tile(np.arange(1, PER_MOVE + 1) / PER_MOVE, len(moves))
    powers = fraction[:, None, None] ** np.arange(1, 6)
    position = moves.start[move] + np.sum(moves.curve[move] * powers, axis=2) + SETUP.zero
    still = np.zeros_like(position)
    time = np.arange(1, len(move) + 1, dtype=np.float64) * np.float64(0.001)
    return Setpoints(time, moves.line[move], move, fraction, position, still, still)


def _compared(joints: FloatArray) -> AxisTracking:
    moves = _curves()
    comparison = Comparison(TRUNNION_AXES, FRAME, SETUP.zero)
    comparison.expect(moves)
    comparison.add(samples(_setpoints(moves), joints))
    direction = comparison.result().direction
    assert direction is not None
    return direction


@pytest.mark.parametrize(("axis", "mdeg"), [("A", 50.0), ("X", 0.0)])
def test_the_angle_is_that_of_the_axis_that_tilts(axis: str, mdeg: float) -> None:
    """The tip stays where it is, so that its place on the path does."""
    tip, joints = ToolCenter(SETUP, 0.0, [0.0] * 5), _setpoints(_curves()).position
    for row in joints:
        place = tip.tip((row - SETUP.zero).tolist())
        place[TRUNNION_AXES.index("A")] += 0.05 if axis == "A" else 0.0
        row[:] = np.array(tip.axes(place)) + SETUP.zero
    direction = _compared(joints)
    assert direction.max == pytest.approx(mdeg, abs=1e-3)
    assert direction.rms == pytest.approx(mdeg, abs=1e-3)


def test_axes_that_are_late_together_are_in_the_right_direction() -> None:
    joints = _setpoints(_curves()).position
    late = np.concatenate([joints[:1].repeat(5, axis=0), joints[:-5]])
    assert _compared(late).max < 0.2
    assert np.abs(late - joints)[:, 3].max() > 0.05


def test_the_tip_that_follows_exactly_has_no_contour_error() -> None:
    moves = _curves()
    asked = _setpoints(moves)
    comparison = Comparison(TRUNNION_AXES, FRAME, SETUP.zero)
    comparison.expect(moves)
    errors = comparison.add(samples(asked, asked.position))
    assert np.abs(errors).max() < 1e-5


def test_where_nothing_tilts_there_is_no_such_error() -> None:
    level = PartFrame(None, (0.0, 0.0))
    assert Comparison(TRUNNION_AXES, level, SETUP.zero).result().direction is None
