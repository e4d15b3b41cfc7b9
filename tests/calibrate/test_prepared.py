"""A long log is judged in parts, which leave nothing out and change nothing."""

import pytest
from machine_logs import logged, mill, strokes

from twin.calibrate import prepared as preparing
from twin.calibrate.figures import figures_of
from twin.calibrate.fit.parameters import of_base
from twin.calibrate.prepared import prepared


@pytest.mark.seconds("a machine is simulated for two seconds")
def test_a_long_stretch_is_judged_in_parts_as_it_is_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    machine = mill()
    item = prepared(logged(machine, strokes(2.0)), "fit")
    assert list(item.parts("X")) == list(item.rows("X")) == [(0, 2000)]
    # Another gain, so that something is left.
    parameters = of_base(machine.axis("X").model_copy(update={"kv": 6.0}), 1041.0)
    whole = figures_of(item, "X", parameters)
    monkeypatch.setattr(preparing, "_MOST_AT_ONCE", 700)
    parts = list(item.parts("X"))
    assert parts == [(0, 666), (666, 1333), (1333, 2000)]
    cut = figures_of(item, "X", parameters)
    assert whole.share > 0.05
    assert cut.share == pytest.approx(whole.share, rel=0.05)
    assert len(whole.course.time) - 2 * 101 <= len(cut.course.time) <= len(whole.course.time)
