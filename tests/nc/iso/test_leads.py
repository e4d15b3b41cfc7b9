"""Leads to contours: Klartext and SINUMERIK say the same way, and an arc touches the contour."""

import math

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given, settings

from tests.examples import examples
from tests.nc.dialects.test_pockets import TOOLS
from tests.nc.running import good
from twin.nc.canonical import FloatArray, Moves

SIDES = {"RL": ("G41", 1.0), "RR": ("G42", -1.0)}


def klartext(kind: str, words: str, side: str, ends: FloatArray) -> Moves:
    (x, y), (u, v) = ends
    text = f"L X-80 Y-70 FMAX\nAPPR {kind} X{x:+.6f} Y{y:+.6f} {words} {side} F300\nL X{u:+.6f} Y{v:+.6f}"
    begin = "BEGIN PGM P MM\nTOOL CALL 1 Z S1000\nL Z-2 R0 FMAX\n"
    return good(f"{begin}{text}\nDEP LT LEN3\nEND PGM P MM", "heidenhain", tools=TOOLS).moves


def sinumerik(code: str, side: str, ends: FloatArray) -> Moves:
    (x, y), (u, v) = ends
    text = f"G54 G0 Z-2 F300\nX-80 Y-70\n{side} G1 {code} X{x:.6f} Y{y:.6f}\nX{u:.6f} Y{v:.6f}\nG40 G148 DISR=3\nM30"
    return good(text, "sinumerik", tools=TOOLS).moves


@pytest.mark.seconds("a property of the ways to contours in two languages")
@settings(max_examples=examples(40), deadline=None)
@given(
    side=st.sampled_from(sorted(SIDES)),
    shape=st.sampled_from([("CCA90", "G247"), ("CCA180", "G347")]),
    radius=st.floats(1.0, 20.0),
    ends=st.lists(st.floats(-50.0, 50.0), min_size=4, max_size=4),
)
def test_an_arc_touches_the_contour_beside_its_begin(
    side: str, shape: tuple[str, str], radius: float, ends: list[float]
) -> None:
    points = np.array(ends).reshape(2, 2).round(6)
    way = points[1] - points[0]
    if np.hypot(*way) < 20.0:
        return
    radius = round(radius, 6)
    code, sense = SIDES[side]
    made = klartext("CT", f"{shape[0]} R{radius}", side, points)
    arc = int(np.flatnonzero(made.sweep)[0])
    along = way / np.hypot(*way)
    aside = np.array([-along[1], along[0]]) * sense
    np.testing.assert_allclose(made.end[arc, :2], points[0] + 5.0 * aside, atol=1e-5)
    spoke = made.end[arc, :2] - made.center[arc, :2]
    assert abs(spoke @ along) < 1e-4 * radius
    assert math.hypot(*spoke) == pytest.approx(radius, abs=1e-5)
    assert np.sign(made.sweep[arc]) == sense
    same = sinumerik(f"{shape[1]} DISR={radius}", code, points)
    other = int(np.flatnonzero(same.sweep)[0])
    np.testing.assert_allclose(same.start[other], made.start[arc], atol=1e-5)
    np.testing.assert_allclose(same.end[other:-1], made.end[arc:-1], atol=1e-5)


def test_a_contour_that_begins_where_the_tool_stands_keeps_its_first_element() -> None:
    text = 'G54 T1 M6 F500\nG0 X0 Y0 Z10\nCYCLE72("AA:BB",20,0,2,-3,0,0,0,300,100,1,41,2,5,500,2,5)\nGOTOF FIN'
    moves = good(f"{text}\nAA: G1 X0 Y0\nX20\nBB: Y20\nFIN: M30", "sinumerik", tools=TOOLS).moves
    low = moves[(moves.end[:, 2] == -3.0) & (moves.start[:, 2] == -3.0)]
    np.testing.assert_allclose(low.end[:, :2], [(0, 5), (15, 5), (15, 20), (10, 25)], atol=1e-9)
