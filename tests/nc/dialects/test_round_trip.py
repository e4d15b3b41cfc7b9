"""Moves that are printed in a dialect read back as the same moves."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.nc.running import good
from twin.nc.canonical import Shape

coordinates = st.integers(-200_000, 200_000).map(lambda value: value / 1000.0)
turns = st.integers(-720_000, 720_000).map(lambda value: value / 1000.0)
lines = st.tuples(st.sampled_from(["G0", "G1"]), coordinates, coordinates, coordinates, turns)
arcs = st.tuples(
    st.sampled_from(["G2", "G3"]),
    coordinates.filter(lambda value: abs(value) > 1.0),
    coordinates,
    st.integers(1, 1079),
    coordinates,
)
Blocks = list[tuple[str, float, float, float, float]]
blocks = st.lists(st.one_of(lines, arcs), min_size=1, max_size=12)
STYLES = {
    "gost": ("{g} {rest}", 60.0),
    "mefi": ('{g} {rest} "text', 60.0),
    "codesys": ("N{n} {g} {rest}", 1.0),
    "fagor8070": ("N{n} {rest} {g} ; text", 60.0),
}


@pytest.mark.parametrize("dialect", STYLES)
@settings(max_examples=60, derandomize=True, deadline=None)
@given(program=blocks)
def test_printed_moves_read_back(dialect: str, program: Blocks) -> None:
    style, feed_scale = STYLES[dialect]
    here = np.zeros(4)
    text, wanted = [f"G1 F{10.0 * feed_scale:g}"], []
    for number, (code, first, second, third, fourth) in enumerate(program):
        if code in ("G0", "G1"):
            there = np.array([first, second, third, fourth])
            words = f"X{first} Y{second} Z{third} C{fourth}"
            sweep = 0.0
        else:
            sweep = -(third % 359 + 1.0) if code == "G2" else third % 359 + 1.0
            arm, angle = -np.array([first, second]), math.radians(sweep)
            turned = np.array([
                arm[0] * math.cos(angle) - arm[1] * math.sin(angle),
                arm[0] * math.sin(angle) + arm[1] * math.cos(angle),
            ])  # fmt: skip
            end = here[:2] - arm + turned
            there = np.array([*np.round(end, 9), fourth, here[3]])
            words = f"X{there[0]:.9f} Y{there[1]:.9f} Z{fourth} I{first} J{second}"
        if sweep != 0.0 or np.any(there != here):
            wanted.append((there, sweep))
        text.append(style.format(g=code, rest=words, n=number))
        here = there
    moves = good("\n".join(text), dialect).moves
    assert len(moves) == len(wanted)
    for row, (end, sweep) in enumerate(wanted):
        np.testing.assert_allclose(moves.end[row], end, atol=1e-9)
        assert moves.sweep[row] == pytest.approx(sweep, abs=1e-4)
        assert (moves.shape[row] == Shape.ARC) == (sweep != 0.0)
