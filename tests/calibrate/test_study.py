"""A sample of the study of synthetic machines; ``python -m tests.calibrate.study`` runs all 200."""

import numpy as np
import pytest

from tests.calibrate.study import covered, draw, extras_of, fit, unnamed

pytestmark = pytest.mark.bench


def test_intervals_cover_the_truth_and_what_is_hidden_is_named() -> None:
    random = np.random.default_rng(5)
    hits: list[bool] = []
    while len(hits) < 15:
        drawn = draw(random)
        if len(extras_of(drawn)) > 1:
            continue
        found = fit(drawn)
        assert not unnamed(drawn, found)
        hits += covered(drawn, found).values()
    assert np.mean(hits) >= 0.85
