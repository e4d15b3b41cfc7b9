"""However a recorded run is divided into chunks, its comparison comes to the same bits."""

import dataclasses
import itertools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pytest
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from twin.compare.comparison import Comparison
from twin.compare.figures import Figures
from twin.recording.reader import Samples, open_recording
from twin.run.preparing.preparation import prepare
from twin.run.progress import no_progress
from twin.run.run import Run

PROGRAM = """G90 G17 G54 T1
S3000 M3
G0 X0. Y0. Z5.
G1 X10. Y0. F6000.
G2 X10. Y0. I-5. J0.
G1 X0. Y2.
G1 X10. Y3. C20.
G3 X10. Y3. I-5. J0.
G3 X10. Y3. I-5. J0. C60.
G2 X10. Y3. I-5. J0.
G1 X9.95 Y3.02
G1 X9.9 Y3.1
G1 X9.9 Y3.
G1 X10. Y3.
G1 Y5. F90.
G0 X0. Y0. C0.
M30
"""
"""Circles both ways that begin and end at a corner, acute corners, blocks shorter than the error, a table that turns, and a
corner that is left so slowly that the search has let go of all before it."""


class Recorded(NamedTuple):
    """A run that was simulated, with what it is compared with."""

    run: Run
    samples: Samples

    def figures(self, edges: Sequence[int]) -> tuple[Figures, np.ndarray]:
        """What a comparison of its samples in pieces comes to, and the contour error of each."""
        comparison = Comparison(self.run.machine.axes, self.run.part_frame, self.run.part_zero)
        for chunk in self.run.dry_run.program.chunks():
            comparison.expect(chunk.moves)
        pieces = itertools.pairwise([0, *edges, len(self.samples)])
        errors = [comparison.add(self.samples[first:last]) for first, last in pieces]
        return comparison.result(), np.concatenate(errors)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Recorded:
    folder = tmp_path_factory.mktemp("recorded")
    (folder / "corners.nc").write_text(PROGRAM)
    job = 'program = "corners.nc"\ndialect = "haas"\nmachine = "mill4"\n[part_zero]\nZ = -300.0\n'
    (folder / "corners.toml").write_text(job)
    run = Run(prepare(folder / "corners.toml"))
    run.execute(folder, no_progress)
    with open_recording(folder / "recording.h5") as recording:
        (whole,) = recording.chunks()
    return Recorded(run, whole)


@pytest.mark.seconds("simulates a program, and compares it in many divisions")
@settings(max_examples=examples(40), derandomize=True, deadline=None)
@given(st.data())
def test_a_division_into_chunks_changes_no_bit(recorded: Recorded, data: st.DataObject):
    whole, errors = recorded.figures([])
    assert len(whole.arcs) == 3
    assert whole.bidirectional
    assert whole.corners.count > 5
    last = len(errors) - 1
    anywhere = st.lists(st.integers(1, last), unique=True, max_size=80).map(sorted)
    evenly = st.integers(50, 500).map(lambda rows: range(rows, last, rows))
    divided, same = recorded.figures(data.draw(anywhere | evenly))
    np.testing.assert_equal(dataclasses.asdict(divided), dataclasses.asdict(whole))
    assert same.tobytes() == errors.tobytes()
