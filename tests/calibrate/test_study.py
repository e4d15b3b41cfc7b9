"""A sample of the study of synthetic machines; scripts/calibration_study.py runs all 200."""

import numpy as np

from scripts.calibration_study import covered, draw, fit, unnamed


def test_intervals_cover_the_truth_and_what_is_hidden_is_named() -> None:
    random = np.random.default_rng(5)
    hits: list[bool] = []
    for _ in range(4):
        drawn = draw(random)
        found = fit(drawn)
        assert not unnamed(drawn, found)
        hits += covered(drawn, found).values()
    assert len(hits) > 15
    assert np.mean(hits) >= 0.85
