"""Curves: what the comparison follows is the line or arc of the tip, between where the axes have it."""

import numpy as np
import pytest

from tests.five_axes import FIRST_LENGTH, on_machine, settings, trunnion
from tests.nc.running import run
from twin.nc.canonical import Shape
from twin.toolpath.nearest import ends_of, path_columns
from twin.toolpath.part_frame import PartFrame
from twin.toolpath.place_kernels import PathKind

PROGRAMS = {
    "a line": ("G1 X40. Y-10. Z3. A30. C90. F500.", PathKind.LINE),
    "a circle": ("G3 X0 Y0 I-12. J5. A20. C360. F500.", PathKind.CIRCLE),
}


@pytest.mark.parametrize(("block", "kind"), PROGRAMS.values(), ids=PROGRAMS)
@pytest.mark.parametrize("length_difference", [0.0, 15.0])
def test_the_path_in_the_part_is_the_programmed_one(
    block: str, kind: int, length_difference: float
) -> None:
    setup = on_machine(trunnion())
    tool = 2 if length_difference else 1
    text = f"O1\nT{tool} M6\nG43.4 H{tool}\nG0 X0 Y0 Z0\n{block}\nM30\n"
    outcome = run(text, "fanuc", settings(setup))
    assert outcome.error is None, outcome.error
    moves = outcome.moves[outcome.moves.shape == Shape.CURVE]
    frame = PartFrame(None, (0.0, 0.0), chain=trunnion()).at(setup.zero, FIRST_LENGTH)
    path = path_columns(moves, frame, setup.zero, np.full(len(moves), length_difference))
    assert set(path.kind.tolist()) == {kind}
    ends = ends_of(path)
    tips = frame.position(moves.end + setup.zero, length_difference)
    assert np.abs(ends.point - tips).max() < 1e-9
    # Consecutive parts go on where, and in the direction in which, the one before has ended.
    assert np.abs(path.origin[1:] + path.first[1:] - ends.point[:-1]).max() < 1e-9
    assert np.abs(ends.leaving[:-1] - ends.arriving[1:]).max() < 1e-9
    if kind == PathKind.CIRCLE:
        middle = frame.program_zero(setup.zero) + np.array((-12.0, 5.0, 0.0))
        assert np.abs(path.origin - middle).max() < 1e-9
