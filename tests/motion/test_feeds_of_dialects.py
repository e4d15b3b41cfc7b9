"""What a dialect's feed and acceleration words come to in time: from text to planned motion."""

import math
from pathlib import Path

import numpy as np
import pytest
from motion_programs import mill

from twin.columns import join
from twin.motion.planner import plan, plan_phases
from twin.motion.setpoints.setpoints import Setpoints
from twin.run.dry_run.dry_run import interpreted
from twin.run.preparing.preparation import Preparation, prepare

NIMBLE = mill(
    velocity=np.full(4, 1e4), acceleration=np.full(4, 1e7), jerk=np.full(4, 1e13),
    path_acceleration=math.inf, path_jerk=math.inf,
)  # fmt: skip
"""Gets to any feed within a few microseconds."""


def prepared(folder: Path, text: str, dialect: str) -> Preparation:
    path = folder / "program.nc"
    path.write_text(text, encoding="utf-8")
    return prepare(path, dialect=dialect, machine="mill4")


def seconds(folder: Path, text: str, dialect: str) -> float:
    program = interpreted(prepared(folder, text, dialect))
    return list(plan_phases(program.chunks(), NIMBLE, start=program.start))[-1].end_time


@pytest.mark.parametrize(
    ("dialect", "text", "expected"),
    [
        # A mixed block: the feed is that of X Y Z, and C follows in the same time.
        ("fagor8070", "G90 G01 X30 Y40 C180 F3000", 1.0),
        ("gost", "G90 G01 X30 Y40 C180 F3000", 1.0),
        ("mefi", "G90 G01 X30 Y40 C180 F3000", 1.0),
        ("codesys", "N10 G01 X30 Y40 C180 F50", 1.0),
        # C alone: degrees per minute, in CODESYS per second.
        ("fagor8070", "G90 G01 C180 F5400", 2.0),
        ("gost", "G90 G01 C180 F5400", 2.0),
        ("mefi", "G90 G01 C180 F5400", 2.0),
        ("codesys", "N10 G01 C180 F90", 2.0),
        # Inverse time: F is the block's seconds, whatever moves.
        ("fagor8070", "G93 G01 X30 Y40 C180 F2", 2.0),
        ("fagor8070", "G93 G01 C180 F3", 3.0),
        # Per revolution: 0.2 mm at 600 1/min are 2 mm/s.
        ("fagor8070", "G95 S600 M03 F0.2\nG01 X10", 5.0),
        ("gost", "G95 S600 M03 F0.2\nG01 X10", 5.0),
    ],
)  # fmt: skip
def test_feed_counts_what_the_dialect_says(
    dialect: str, text: str, expected: float, tmp_path: Path
) -> None:
    assert seconds(tmp_path, f"{text}\n", dialect) == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize(("raising", "lowering"), [(400.0, 40.0), (40.0, 400.0), (200.0, 200.0)])
def test_codesys_speeds_up_by_one_word_and_brakes_by_the_other(
    raising: float, lowering: float, tmp_path: Path
) -> None:
    preparation = prepared(tmp_path, f"N10 G01 X60 F50 E{raising} E-{lowering}\n", "codesys")
    setpoints = _setpoints(preparation)
    gain = np.diff(setpoints.velocity[:, 0]) / 0.001
    assert gain.max() == pytest.approx(raising, rel=1e-3)
    assert gain.min() == pytest.approx(-lowering, rel=1e-3)
    # 60 mm at 50 mm/s, and half of each ramp's time again.
    expected = 60.0 / 50.0 + 0.5 * 50.0 / raising + 0.5 * 50.0 / lowering
    assert setpoints.time[-1] == pytest.approx(expected, abs=2e-3)


def _setpoints(preparation: Preparation) -> Setpoints:
    program, zero = interpreted(preparation), np.zeros(4)
    return join(
        list(plan(program.chunks(), NIMBLE, period_s=0.001, part_zero=zero, start=program.start))
    )
