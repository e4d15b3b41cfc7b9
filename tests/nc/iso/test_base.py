"""A jog as a block: the same move on every control, whatever its F counts."""

import pytest

from tests.nc.running import run
from twin.nc.dialects import DIALECTS, dialect_named
from twin.nc.iso.base import jog_block

WITHOUT_C = ("grbl",)
"""It moves X, Y and Z alone."""


@pytest.mark.parametrize(
    ("dialect", "axis", "distance"),
    [
        (dialect, axis, distance)
        for dialect in DIALECTS
        for axis, distance in (("X", -12.3456), ("C", 90.0))
        if not (axis == "C" and dialect in WITHOUT_C)
    ],
)
def test_jog_goes_by_its_distance_at_its_feed(dialect: str, axis: str, distance: float) -> None:
    block = jog_block(dialect_named(dialect), axis, distance, 600.0)
    outcome = run(f"{block}\nM2" if dialect == "linuxcnc" else block, dialect)
    assert outcome.error is None
    assert len(outcome.moves) == 1
    delta = outcome.delta(0)
    assert delta.pop(axis) == pytest.approx(distance, abs=1e-9)
    assert set(delta.values()) == {0.0}
    assert outcome.moves.feed[0] == pytest.approx(600.0, rel=1e-6)


def test_codesys_counts_its_f_per_second() -> None:
    assert jog_block(dialect_named("codesys"), "X", 1.0, 600.0).endswith("X1. F10.")
