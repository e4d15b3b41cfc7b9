"""Contour error by feature: at corners, on straight blocks and on arcs."""

import numpy as np

from twin.compare.figures import ContourFigures
from twin.compare.statistics import Distribution
from twin.nc.canonical import BoolArray, FloatArray, IntArray, Moves, Shape

FEATURES = ("line", "arc", "corner")
_CORNER = FEATURES.index("corner")
_SHAPES = {
    Shape.LINE: FEATURES.index("line"),
    Shape.ARC: FEATURES.index("arc"),
    Shape.CURVE: FEATURES.index("line"),
}


class FeatureCollector:
    """Collects the contour error of every sample under the feature that it is nearest to."""

    def __init__(self) -> None:
        self._errors = [Distribution() for _ in FEATURES]
        self._worst = [(0, 0.0) for _ in FEATURES]

    def add(
        self, moves: Moves, place: IntArray, at_corner: BoolArray, error: FloatArray,
        time: FloatArray,
    ) -> None:  # fmt: skip
        """Take in a chunk of n samples.

        Args:
            place: Index in ``moves`` of each sample's nearest place, shape (n,).
            at_corner: Which samples are at a corner rather than on their block, shape (n,).
            error: Contour error, shape (n,) [µm].
            time: Shape (n,) [s].
        """
        codes = np.array([_SHAPES[Shape(shape)] for shape in range(len(_SHAPES))])
        feature = np.where(at_corner, _CORNER, codes[moves.shape[place]])
        for index, errors in enumerate(self._errors):
            rows = np.flatnonzero(feature == index)
            greatest = errors.add(error[rows])
            if greatest is not None:
                row = rows[greatest]
                self._worst[index] = int(moves.line[place[row]]), float(time[row])

    def figures(self) -> dict[str, ContourFigures]:
        """The figures of the features that occurred."""
        return {
            name: ContourFigures(errors.greatest, errors.rms, errors.percentile(99.0), *worst)
            for name, errors, worst in zip(FEATURES, self._errors, self._worst, strict=True)
            if errors.count
        }
