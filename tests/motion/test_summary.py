from pathlib import Path

import numpy as np
import pytest
from motion_programs import AXES, Program, duration, mill, run

from twin.motion.summary import Cause, draw, summarize
from twin.nc.canonical import Corner


def test_time_by_move_adds_up_to_the_cycle_time() -> None:
    program = Program().line(50.0, 0.0, 0.0, 0.0, feed=6000.0).dwell(0.25)
    program.corner = Corner.EXACT_PATH
    for i in range(20):
        program.line(50.0, 0.1 * (i + 1), 0.0, 0.0, feed=6000.0)
    program.arc((40.0, 2.0, 0.0), (0.0, 0.0, 1.0), 270.0, feed=3000.0)
    summary = summarize(program.chunks(), mill(), start=program.start)
    assert summary.total == pytest.approx(duration(program, mill()), rel=1e-9)
    assert list(summary.move) == [0, 0, *range(1, 22)]
    assert summary.seconds[1, Cause.DWELL] == 0.25
    assert np.all(summary.lost() > -1e-9)
    # 50 mm at 100 mm/s: 0.1 s up, 0.1 s down, the rest at the feed (v 100, a 2000, j 40000).
    assert summary.seconds[0, Cause.SPEEDING_UP] == pytest.approx(0.05, abs=0.06)
    assert summary.seconds[0].sum() == pytest.approx(0.6)
    assert summary.ideal[0] == pytest.approx(0.5)
    assert sum(summary.by_cause().values()) == pytest.approx(summary.total)


def test_program_without_moves_takes_no_time() -> None:
    summary = summarize(Program().chunks(), mill(), start=np.zeros(4))
    assert summary.total == 0.0
    assert len(summary.move) == 0


@pytest.mark.parametrize("suffix", ["svg", "png"])
def test_drawing_is_written(tmp_path: Path, suffix: str) -> None:
    program = Program().line(50.0, 0.0, 0.0, 90.0, feed=6000.0)
    picture = tmp_path / f"plan.{suffix}"
    draw(run(program, mill()), AXES, picture)
    assert picture.stat().st_size > 1000
    if suffix == "svg":
        assert "path speed [mm/min]" in picture.read_text(
            encoding="utf-8"
        ) or "<svg" in picture.read_text(encoding="utf-8")
