"""The greatest of what the tool felt, by line and in all."""

import dataclasses

import numpy as np
import pytest

from tests.cutting.conftest import Motion
from twin.cutting.forces.load_log import FIGURES, LoadLog
from twin.recording.form import Samples, ToolLoad


def loads(samples: Motion, force: list[float], lines: list[int], start: float = 0.0) -> Samples:
    count, size = len(force), np.array(force)
    motion = samples(np.zeros((count, 3)), np.array(lines), start)
    zero = np.zeros(count)
    tool = ToolLoad(
        np.zeros((count, 3)), size, 2.0 * size, 1e-3 * size, size[:, None] * [1e-3, 0.0, 0.0],
        zero, 1e-2 * size, zero > 0.0,
    )  # fmt: skip
    return dataclasses.replace(motion, tool=tool)


def test_every_line_keeps_its_greatest(samples: Motion) -> None:
    log = LoadLog()
    log.add(loads(samples, [0.0, 10.0, 30.0, 20.0], [1, 2, 2, 3]))
    log.add(loads(samples, [25.0, 5.0], [3, 2], start=1.0))
    rows = log.as_json()
    assert [(row["line"], row["force_n"]) for row in rows] == [(2, 30.0), (3, 25.0)]
    assert rows[1]["deflection_um"] == pytest.approx(25.0)
    assert set(rows[0]) == {"line", *FIGURES}
    greatest = log.greatest["power_w"]
    assert (greatest.value, greatest.line, greatest.time_s) == (60.0, 2, pytest.approx(0.002))


def test_of_many_lines_the_foremost_are_kept(samples: Motion) -> None:
    log = LoadLog(remembered=10)
    for line in range(100):
        log.add(loads(samples, [float(line + 1)], [line]))
    assert len(log.as_json()) <= 20
    assert log.as_json()[-1]["force_n"] == 100.0


def test_without_simulated_force_there_is_nothing(samples: Motion) -> None:
    log = LoadLog()
    log.add(samples(np.zeros((5, 3))))
    assert log.as_json() == []
    assert log.greatest == {}
