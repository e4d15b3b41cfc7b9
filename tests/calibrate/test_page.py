"""The page says the answer, shows every log, and needs no other file."""

import dataclasses
import re

import numpy as np
import pytest
from machine_logs import logged, mill, strokes, with_axis, without_force

from twin.calibrate.calibrate import calibrate
from twin.calibrate.report.page import calibration_page
from twin.calibrate.result import verdict_sentence


@pytest.fixture(scope="module")
def page() -> str:
    log = without_force(logged(mill(), strokes(3.0)))
    result = calibrate(mill(), [log], [log])
    text = calibration_page(result)
    sentence = verdict_sentence("X", result.axes["X"], result.logs)
    assert sentence.startswith("X: predicts the lag of a log that it has not seen to ")
    assert sentence in text
    return text


@pytest.mark.seconds("a log is fitted and its page made")
def test_it_shows_overlays_what_is_left_spectrum_and_correlations(page: str) -> None:
    # Two logs with lag, rest, spectrum and whiteness each, the correlations, the Bode plot.
    assert page.count("<svg") == 2 * 4 + 2
    assert len(page.encode()) < 300_000
    for word in (
        "hold-out",
        "damping_ratio",
        "mass",
        "What they do not tell",
        "phase margin",
        "Structures that competed",
    ):
        assert word in page


def test_it_needs_no_other_file(page: str) -> None:
    assert not re.search(r"<(script|link|img|iframe)\b", page)
    assert not re.search(r"url\((?!#)", page)


@pytest.mark.seconds("a log is fitted and its page made")
def test_a_force_that_is_left_unexplained_is_no_green_page() -> None:
    log = logged(mill(), strokes(2.0))
    axis = log.axes["X"]
    random = np.random.default_rng(1)
    force = axis.more["force"]
    noise = 3.0 * float(np.std(force)) * random.standard_normal(len(force))
    wrong = dataclasses.replace(axis, more={"force": force + noise})
    result = calibrate(mill(), [with_axis(log, wrong)])
    page = calibration_page(result)
    assert 'class="verdict fail"' in page
    assert "More than half of the logged force is left unexplained" in page
