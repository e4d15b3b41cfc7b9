"""Axes that go evenly over several moves (G71, G70 of CODESYS): one slope over the path."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.nc.running import bad, good
from twin.nc.path import synchronous_axes

POINTS = st.lists(st.tuples(st.integers(-50, 50), st.integers(-50, 50)), min_size=2, max_size=8)


@settings(max_examples=40, derandomize=True, deadline=None)
@given(points=POINTS, named=st.integers(0, 7), turn=st.floats(-720.0, 720.0))
def test_the_slope_is_the_same_everywhere(
    points: list[tuple[int, int]], named: int, turn: float
) -> None:
    blocks = [f"N{n} G1 X{x} Y{y}" for n, (x, y) in enumerate(points, 20)]
    blocks[named % len(blocks)] += f" C{turn:.4f}"
    text = "N5 F10 N10 G71 L6 " + " ".join(blocks) + " N99 G70 L6 N100 G1 Z5"
    outcome = good(text, "codesys")
    moves = outcome.moves[:-1]
    turned = moves.end[:, 3] - moves.start[:, 3]
    length = moves.length.sum()
    if length:
        np.testing.assert_allclose(turned, float(f"{turn:.4f}") * moves.length / length, atol=1e-9)
    assert outcome.display["C"] == pytest.approx(outcome.position["C"])


def test_a_helix_counts_with_its_rise_and_events_keep_their_place() -> None:
    text = (
        "N10 G71 L6 N20 G1 X30 C90 F10 N30 M10 N40 G3 X30 Y0 Z40 I-10 T360 N50 G1 X0 N60 G70 N70 X9"
    )
    outcome = good(text, "codesys")
    moves = outcome.moves
    assert [event.before for event in outcome.events] == [1]
    ends = np.cumsum(moves.length[:3]) / moves.length[:3].sum() * 90.0
    np.testing.assert_allclose(moves.end[:3, 3], ends, atol=1e-9)
    assert moves.end[3, 3] == 90.0


def test_a_program_may_end_before_the_axis_arrives() -> None:
    assert good("N10 G71 L6 N20 G1 X10 C40 F5 N30 X20", "codesys").moves.end[:, 3].tolist() == [
        20.0,
        40.0,
    ]


def test_too_many_moves_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(synchronous_axes, "MOST_MOVES", 3)
    error = bad("N1 G71 L6 F5 " + " ".join(f"N{n} G1 X{n}" for n in range(2, 9)), "codesys")
    assert error.code == "even-axis"


def test_an_axis_that_the_machine_lacks_is_named() -> None:
    assert "no axis A" in str(bad("N10 G71 L4", "codesys"))
