"""Rotary axes that point the tool in a direction."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.five_axes import TRAVEL, head_and_table, trunnion
from twin.kinematics import Kinematics, tool_direction
from twin.nc.path.tool_center.orientation import rotary_axes_for

_CHAINS = st.sampled_from((trunnion(), head_and_table()))


@settings(max_examples=40)
@given(_CHAINS, st.floats(-119.0, 119.0), st.floats(-500.0, 500.0), st.floats(-90.0, 90.0))
def test_what_some_angles_point_at_is_found(
    chain: Kinematics, tilt: float, turn: float, now: float
) -> None:
    direction = tool_direction(chain, np.array([[0.0, 0.0, 0.0, tilt, turn]]))[0]
    here = np.array([1.0, 2.0, 3.0, 0.0, now])
    found = rotary_axes_for(chain, direction, here, TRAVEL)
    assert np.linalg.norm(tool_direction(chain, found[None])[0] - direction) < 1e-9
    assert np.all(found[:3] == here[:3])
    assert TRAVEL[3, 0] - 1e-6 <= found[3] <= TRAVEL[3, 1] + 1e-6
    assert abs(found[4] - now) <= 180.0 + 1e-6


@pytest.mark.parametrize("tilt", [1e-10, 1.2e-7, 1e-6, 1e-3])
def test_next_to_the_axis_of_the_table_the_tilt_is_found(tilt: float) -> None:
    direction = tool_direction(trunnion(), np.array([[0.0, 0.0, 0.0, tilt, 20.0]]))[0]
    found = rotary_axes_for(trunnion(), direction, np.zeros(5), TRAVEL)
    assert np.linalg.norm(tool_direction(trunnion(), found[None])[0] - direction) < 2e-11


def test_an_axis_that_changes_nothing_stays() -> None:
    here = np.array([0.0, 0.0, 0.0, 0.0, 33.0])
    assert rotary_axes_for(trunnion(), np.array([0.0, 0.0, 1.0]), here, TRAVEL)[4] == 33.0


def test_the_sign_of_the_axis_next_to_the_tool_is_kept() -> None:
    direction = np.array([0.0, np.sin(np.pi / 6), np.cos(np.pi / 6)])
    here = np.zeros(5)
    for sense in (1.0, -1.0):
        found = rotary_axes_for(trunnion(), direction, here, TRAVEL, sense)
        assert found[3] == pytest.approx(30.0 * sense)


def test_what_the_travel_leaves_out_is_not_taken() -> None:
    travel = TRAVEL.copy()
    travel[3] = (-5.0, 120.0)
    direction = np.array([0.0, np.sin(np.pi / 6), np.cos(np.pi / 6)])
    assert rotary_axes_for(trunnion(), direction, np.zeros(5), travel)[3] == pytest.approx(30.0)
    travel[3] = (-5.0, 20.0)
    with pytest.raises(ValueError, match="do not point the tool"):
        rotary_axes_for(trunnion(), direction, np.zeros(5), travel)
