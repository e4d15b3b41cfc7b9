"""Contour error by feature: straight blocks and arcs apart."""

import numpy as np

from twin.compare.figures import FeatureFigures
from twin.compare.statistics import Distribution
from twin.nc.canonical import FloatArray, IntArray, Moves, Shape

FEATURES = {"line": Shape.LINE, "arc": Shape.ARC}


class FeatureCollector:
    """Collects the contour error of the samples nearest to each kind of block."""

    def __init__(self) -> None:
        self._errors = {name: Distribution() for name in FEATURES}
        self._worst: dict[str, tuple[int, float]] = dict.fromkeys(FEATURES, (0, 0.0))

    def add(self, moves: Moves, place: IntArray, error: FloatArray, time: FloatArray) -> None:
        """Take in a chunk of n samples: nearest move, contour error [µm], time [s]."""
        for name, shape in FEATURES.items():
            rows = np.flatnonzero(moves.shape[place] == shape)
            if not len(rows):
                continue
            worst = int(rows[error[rows].argmax()])
            first = self._errors[name].count == 0
            if first or error[worst] > self._errors[name].greatest:
                self._worst[name] = int(moves.line[place[worst]]), float(time[worst])
            self._errors[name].add(error[rows])

    def figures(self) -> dict[str, FeatureFigures]:
        """The figures of the features that occurred."""
        return {
            name: FeatureFigures(
                errors.greatest, errors.rms, errors.percentile(99.0), *self._worst[name]
            )
            for name, errors in self._errors.items()
            if errors.count
        }
