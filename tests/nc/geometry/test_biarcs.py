"""Spirals as arcs, held against the formula of the spiral."""

import itertools
import math

from hypothesis import given, settings
from hypothesis import strategies as st

from twin.nc.geometry import curves
from twin.nc.geometry.arcs import distance
from twin.nc.geometry.biarcs import SPIRAL_ERROR, spiral


@settings(max_examples=60, derandomize=True, deadline=None)
@given(
    near=st.floats(0.5, 200.0),
    ratio=st.floats(0.2, 5.0),
    sweep=st.floats(1.0, 720.0),
    clockwise=st.booleans(),
    begins=st.floats(0.0, 360.0),
)
def test_the_arcs_of_a_spiral_join_and_keep_to_it(
    near: float, ratio: float, sweep: float, clockwise: bool, begins: float
) -> None:
    center, sense = (3.0, -4.0), -1.0 if clockwise else 1.0

    def on_spiral(share: float) -> tuple[float, float]:
        radius = near * (1.0 + share * (ratio - 1.0))
        angle = math.radians(begins + sense * sweep * share)
        return (center[0] + radius * math.cos(angle), center[1] + radius * math.sin(angle))

    start, end = on_spiral(0.0), on_spiral(1.0)
    pieces = spiral(start, end, center, sense * sweep)
    assert distance(pieces[0][1], start) < 1e-9
    assert distance(pieces[-1][2], end) < 1e-9
    for before, behind in itertools.pairwise(pieces):
        assert distance(before[2], behind[1]) < 1e-9
        assert abs(curves.turn_from(before, behind)) < 1e-4
    angle, where = 0.0, start
    for piece in pieces:
        for tenth in range(1, 11):
            point = curves.point_at(piece, tenth / 10.0)
            ax, ay = where[0] - center[0], where[1] - center[1]
            bx, by = point[0] - center[0], point[1] - center[1]
            angle += math.degrees(math.atan2(ax * by - ay * bx, ax * bx + ay * by))
            expected = near * (1.0 + sense * angle / sweep * (ratio - 1.0))
            assert abs(distance(point, center) - expected) < 2.0 * SPIRAL_ERROR
            where = point
    assert math.isclose(angle, sense * sweep, rel_tol=1e-9)


def test_an_arc_of_one_radius_stays_one() -> None:
    assert spiral((1.0, 0.0), (0.0, 1.0), (0.0, 0.0), 90.0) == [
        curves.arc((1.0, 0.0), (0.0, 1.0), (0.0, 0.0), 90.0)
    ]
