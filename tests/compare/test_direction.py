"""The error of the tool's direction, on machines whose axes tilt the part."""

import numpy as np
import pytest

from tests.compare.runs import samples
from tests.five_axes import FIRST_LENGTH, TRUNNION_AXES, on_machine, settings, trunnion
from tests.nc.running import run
from twin.compare.comparison import Comparison
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Moves, Shape
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


@pytest.mark.parametrize(("axis", "mdeg"), [("A", 50.0), ("X", 0.0)])
def test_the_angle_is_that_of_the_axis_that_tilts(axis: str, mdeg: float) -> None:
    moves = _curves()
    asked = _setpoints(moves)
    joints = asked.position.copy()
    joints[:, TRUNNION_AXES.index(axis)] += 0.05
    comparison = Comparison(TRUNNION_AXES, FRAME, SETUP.zero)
    comparison.expect(moves)
    comparison.add(samples(asked, joints))
    direction = comparison.result().direction
    assert direction is not None
    assert direction.max == pytest.approx(mdeg, abs=1e-6)
    assert direction.rms == pytest.approx(mdeg, abs=1e-6)


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
