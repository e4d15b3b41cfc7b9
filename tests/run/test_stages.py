import time

import pytest

from twin.run.progress import StageClock


def test_inner_stages_do_not_count_for_outer_ones(monkeypatch: pytest.MonkeyPatch):
    now = iter(range(100))
    monkeypatch.setattr(time, "perf_counter", lambda: float(next(now)))
    clock = StageClock()
    with clock.stage("outer"), clock.stage("inner"):
        pass
    assert clock.seconds == {"outer": 2.0, "inner": 1.0}


def test_watching_passes_items_on():
    clock = StageClock()
    assert list(clock.watch("count", iter(range(4)))) == [0, 1, 2, 3]
    assert set(clock.seconds) == {"count"}


def test_an_error_leaves_the_clock_usable():
    clock = StageClock()

    def fail() -> None:
        with clock.stage("bad"):
            raise ValueError("broken")

    with pytest.raises(ValueError, match="broken"):
        fail()
    with clock.stage("good"):
        pass
    assert set(clock.seconds) == {"bad", "good"}
