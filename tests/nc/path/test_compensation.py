"""Radius compensation: leads, necks, and the tool's distance from the contour."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.nc.dialects.test_same_part import sampled
from tests.nc.running import Outcome, bad, good
from twin.nc.canonical import FloatArray
from twin.nc.control.settings import ToolData

RADIUS = 3.0
TOOLS = {1: ToolData(RADIUS, 60.0)}


def away_from(path: FloatArray, contour: FloatArray) -> FloatArray:
    return np.linalg.norm(path[:, None, :2] - contour[None, :, :2], axis=2).min(axis=1)


@pytest.mark.seconds("every polygon is offset and measured")
@settings(max_examples=40, derandomize=True, deadline=None)
@given(
    corners=st.integers(3, 9),
    size=st.floats(20.0, 60.0),
    turned=st.integers(0, 359),
    clockwise=st.booleans(),
    outside=st.booleans(),
)
def test_the_tool_keeps_its_distance_from_any_polygon(
    corners: int, size: float, turned: int, clockwise: bool, outside: bool
) -> None:
    """Regular polygons of any size, inside and outside, from the middle of a side."""
    sign = -1.0 if clockwise else 1.0
    vertices = [
        (
            size * math.cos(math.radians(turned + sign * 360.0 * k / corners)),
            size * math.sin(math.radians(turned + sign * 360.0 * k / corners)),
        )
        for k in range(corners + 1)
    ]
    (ax, ay), (bx, by) = vertices[0], vertices[1]
    middle = ((ax + bx) / 2.0, (ay + by) / 2.0)
    code = "G41" if clockwise == outside else "G42"
    far = 2.0 if outside else 0.2
    start = f"G0 X{middle[0] * far:.6f} Y{middle[1] * far:.6f}\nF100"
    contour = [f"G1 X{middle[0]:.6f} Y{middle[1]:.6f}"]
    contour += [f"X{x:.6f} Y{y:.6f}" for x, y in [*vertices[1:], middle]]
    back = f"G40 X{middle[0] * far:.6f} Y{middle[1] * far:.6f}"
    apothem = size * math.cos(math.pi / corners)
    text = "\n".join([start, code, *contour, back])
    if not outside and apothem < 1.2 * RADIUS / 0.8:
        return
    outcome = good(text, "gost", tools=TOOLS)
    plain = good("\n".join([start, *contour]), "gost").moves[2:]
    path = sampled(outcome.moves[2:-1])
    away = away_from(path, sampled(plain))
    assert away.min() > RADIUS - 1e-5
    assert away.max() < RADIUS + 0.25  # the contour's samples lie up to 2 mm apart
    assert outcome.codes == []


def u_shape(neck: float) -> str:
    """A chamber behind a neck that is narrower than the chamber."""
    return (
        f"G0 X0 Y30\nG41 D1 G1 X{-neck / 2} Y20 F100\nY0\nX-20\nY-30\nX20\nY0\nX{neck / 2}\nY20\n"
        "G40 X0 Y30"
    )


def test_a_neck_that_is_wide_enough_is_passed() -> None:
    moves = good(u_shape(8.0), "gost", tools=TOOLS).moves
    assert moves.end[-1, :2].tolist() == [0.0, 30.0]


def test_a_neck_narrower_than_the_tool_is_refused() -> None:
    error = bad(u_shape(5.0), "gost", tools=TOOLS)
    assert error.code == "compensation-gouge"
    assert "that of line 3" in error.message or "that of line 2" in error.message


def test_a_contour_that_crosses_itself_may_be_compensated() -> None:
    text = "G0 X-10 Y5\nG41 D1 G1 X0 Y0 F100\nX40 Y40\nX60\nY0\nX40\nX0 Y40\nX-20\nG40 X-30 Y30"
    assert good(text, "gost", tools=TOOLS).moves.end[-1, 0] == -30.0


def lead_codes(outcome: Outcome) -> list[str]:
    return [code for code in outcome.codes if code == "compensation-lead"]


def test_a_lead_from_the_wrong_side_is_warned_of() -> None:
    text = "G0 X{x} Y20\nG41 D1 G1 X0 Y0 F100\nY40\nX-20 Y60\nG40 X-40 Y60"
    right = good(text.format(x=10), "gost", tools=TOOLS)
    left = good(text.format(x=-10), "gost", tools=TOOLS)
    assert len(lead_codes(right)) == 1
    assert right.warnings[0].line == 2
    assert lead_codes(left) == []


@settings(max_examples=40, derandomize=True, deadline=None)
@given(angle=st.integers(0, 355), far=st.floats(10.0, 60.0))
def test_indirect_leads_never_cut_the_first_point(angle: int, far: float) -> None:
    """Unless they come from ahead or the other side: no way leads around there."""
    x, y = far * math.cos(math.radians(angle)), far * math.sin(math.radians(angle))
    text = f"G136\nG00 X{x:.6f} Y{y:.6f}\nG41 G01 X0 Y0 F100\nY40\nX60\nG40 X100 Y80\nM30"
    outcome = good(text, "fagor8070", tools=TOOLS)
    moves = outcome.moves[1:]
    lead = moves[moves.line == 3]
    path = sampled(lead)[:, :2]
    free = np.linalg.norm(path, axis=1).min() > RADIUS - 1e-6
    assert free or (outcome.codes == ["compensation-lead"] and 0 < angle <= 90)
    np.testing.assert_allclose(moves.start[moves.line == 4][0, :2], [-RADIUS, 0.0], atol=1e-9)


def test_a_vertical_move_beside_the_contour_stays_there() -> None:
    text = "G0 X-10 Y-10\nG41 D1 G1 X0 Y0 F100\nY30\nZ-2\nX30\nG40 Y50"
    moves = good(text, "gost", tools=TOOLS).moves
    np.testing.assert_array_equal(moves.start[1:], moves.end[:-1])
    assert moves.end[:, 2].tolist() == [0.0, 0.0, 0.0, -2.0, -2.0, -2.0, -2.0]


@pytest.mark.parametrize(
    ("code", "radius", "lost"),
    [("G41", 45.0, math.degrees(math.asin(5.0 / 45.0))), ("G42", 55.0, 0.0)],
)
def test_a_helix_of_half_turns_keeps_them(code: str, radius: float, lost: float) -> None:
    """Inside, it begins where the parallel of the line before meets it."""
    text = (
        f"G00 X-10 Y-10\n{code} G01 X0 Y0 F100\nX50\nG03 X-50 Y0 I-50 Z45 K10\nG01 Y-30\n"
        "G40 Y-50\nM30"
    )
    moves = good(text, "fagor8070", tools={1: ToolData(5.0, 60.0)}).moves
    helix = moves[moves.line == 4]
    assert helix.sweep[0] == pytest.approx(4.5 * 360.0 - lost)
    np.testing.assert_allclose(helix.end[0, :3], [-radius, 0.0, 45.0], atol=1e-9)


@pytest.mark.parametrize("code", ["G41", "G42"])
def test_a_full_circle_changes_its_radius(code: str) -> None:
    text = f"G0 X10 Y-5\n{code} D1 G1 X20 Y0 F100\nG3 X20 Y0 I-20\nG40 G1 X10 Y5"
    outcome = good(text, "gost", tools=TOOLS)
    wanted = 17.0 if code == "G41" else 23.0
    assert outcome.moves.radius[2] == pytest.approx(wanted)
    assert outcome.moves.sweep[2] == pytest.approx(360.0)


def test_any_number_of_plunges_waits_for_the_end_of_an_element() -> None:
    """Forty moves along the tool's axis, with a function behind each, more than there is room for at first."""
    plunges = "\n".join(f"Z{-number}\nM8" for number in range(1, 41))
    text = f"F100\nG41\nG1 X20 Y0\nX40\n{plunges}\nX60\nG40\nX80 Y20\n"
    outcome = good(text, "gost", tools=TOOLS)
    heights = outcome.moves.end[:, 2].tolist()
    assert heights == [0.0, 0.0, *(-float(number) for number in range(1, 41)), -40.0, -40.0]
    assert [event.before for event in outcome.events] == list(range(3, 43))


@settings(max_examples=20, derandomize=True, deadline=None)
@given(turn=st.floats(5.0, 175.0), left=st.booleans(), first_side=st.booleans())
def test_sides_change_where_the_extended_parallels_cross(
    turn: float, left: bool, first_side: bool
) -> None:
    """Two lines of 200 mm that turn by an angle: the parallels cross ``r cot(turn / 2)`` from the corner along one
    of them, square to it by the radius."""
    sign = 1.0 if left else -1.0
    x, y = math.cos(math.radians(turn)), sign * math.sin(math.radians(turn))
    one, other = ("G41", "G42") if first_side else ("G42", "G41")
    text = (
        f"G0 X-220.\n{one} D1 G1 X-200. Y0. F100.\nX0.\n{other} X{200.0 * x:.9f} Y{200.0 * y:.9f}\n"
        f"X{300.0 * x:.9f} Y{300.0 * y:.9f}\nG40 X{400.0 * x:.9f} Y{400.0 * y:.9f}\nM30\n"
    )
    moves = good(text, "fanuc", tools=TOOLS).moves
    crossing = moves.end[moves.line == 3][-1, :2]
    far = RADIUS / math.tan(math.radians(turn / 2.0))
    side = RADIUS if first_side else -RADIUS
    along = far if left == first_side else -far
    np.testing.assert_allclose(crossing, [along, side], atol=1e-6)
    behind = moves.end[moves.line == 4][-1, :2]
    np.testing.assert_allclose(behind @ [-y, x], -side, atol=1e-6)


@pytest.mark.parametrize("sense", ["G2", "G3"])
def test_the_radius_changes_evenly_with_the_angle_of_an_arc(sense: str) -> None:
    """Half a circle of 40 mm about X0 Y0, the tool 3 mm beside its start and 1 mm beside its end."""
    way = 1.0 if sense == "G3" else -1.0
    text = (
        f"#13002=1.\nG0 X40. Y{-60.0 * way}\nG41 D1 G1 Y{-20.0 * way} F100.\nY0.\n"
        f"D2 {sense} X-40. I-40. J0.\nG1 Y{-40.0 * way}\nG40 Y{-60.0 * way}\nM30\n"
    )
    moves = good(text, "fanuc", tools=TOOLS).moves
    path = sampled(moves[moves.line == 5])[:, :2]
    radius = np.linalg.norm(path, axis=1)
    angle = np.abs(np.degrees(np.arctan2(path[:, 1], path[:, 0])))
    side = -way
    np.testing.assert_allclose(radius, 40.0 + side * (3.0 - 2.0 * angle / 180.0), atol=1e-3)
