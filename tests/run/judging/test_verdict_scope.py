"""Attempts to get a green light that is a lie: each ends with an alarm, a failed check or a warning at its line."""

from collections.abc import Mapping
from pathlib import Path
from textwrap import dedent
from types import MappingProxyType

import pytest

from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.run.judging.outcome import Outcome
from twin.run.preparing.preparation import prepare
from twin.run.progress import no_progress
from twin.run.run import Run

JOB = """
program = "p.nc"
dialect = "{dialect}"
{top}
[start]
Z = {start}
[stock]
shape = "box"
size = [40.0, 40.0, 10.0]
cell = {cell}
{stock}
[[tools]]
number = 1
diameter = 8.0
flute = 20.0
{tool}
[[tools]]
number = 2
diameter = 6.0
kind = "drill"
length = 62.0
flute = 20.0
{more}
"""
HEAD = "G90 G17 T1 M6\nG43 H1\nS3000 M3\n"
CUT = "G0 X-30. Y0.\nG0 Z-2.\nG1 X30. F600.\nG0 Z20.\n"


def run(
    folder: Path,
    program: str,
    parts: Mapping[str, str] = MappingProxyType({}),
    *,
    strict: bool = False,
) -> Outcome:
    """Run a program on a small block."""
    usual = {
        "top": "",
        "stock": "",
        "tool": "",
        "more": "",
        "start": "20.0",
        "dialect": "fanuc",
        "cell": "0.5",
    }
    keys = {**usual, **parts}
    (folder / "p.nc").write_text(dedent(program))
    (folder / "p.toml").write_text(JOB.format(**keys))
    chain = Run(prepare(folder / "p.toml", strict=strict))
    return chain.execute(None, no_progress)


def codes(outcome: Outcome) -> dict[str, int]:
    """Codes of warnings and reasons, with their lines."""
    warned = {found.code: found.line for found in outcome.warnings}
    return warned | {reason.what: reason.line for reason in outcome.verdict.reasons}


def test_an_ordinary_cut_draws_nothing(tmp_path: Path) -> None:
    outcome = run(tmp_path, HEAD + CUT + "M30\n")
    assert not codes(outcome)
    assert outcome.verdict.outcome == "pass"
    assert outcome.scope.removed_mm3 == pytest.approx(8.0 * 40.0 * 2.0, rel=0.05)
    assert outcome.scope.tools_unused == (2,)


def test_what_a_table_throws_off_far_from_its_axis_is_no_tolerance_too_wide(tmp_path: Path) -> None:
    """3 mm along X, Y and Z, and 2 degrees of C over half a metre and more."""
    outcome = run(tmp_path, HEAD + CUT + "M30\n", {"more": "[tolerance]\ncontour_um = 20e3"})
    assert not codes(outcome)


SLIPS: dict[str, tuple[str, dict[str, str], str, int]] = {
    "cut in the air": (HEAD + "G1 Z5. F600.\nG1 X9.\nM30\n", {}, "nothing-cut", 4),
    "spindle stopped in the slot": (
        HEAD + "G0 X-30. Y0.\nG0 Z-2.\nG1 X0. F600.\nM5\nG0 Z20.\nM30\n", {}, "stops-in-cut", 7,
    ),
    "end in the slot": (
        HEAD + "G0 X-30. Y0.\nG0 Z-2.\nG1 X0. F600.\nM30\n", {}, "ends-in-cut", 7,
    ),
    "drill milled with": (
        HEAD + "T2 M6\nG43 H2\nS2000 M3\nG0 X0. Y0.\nG0 Z2.\nG1 Z-4. F100.\nG1 X9. F50.\nG0 Z20.\nM30\n", {},
        "drill-sideways", 10,
    ),
    "four teeth straight down": (
        HEAD + "G0 X0. Y0.\nG0 Z2.\nG1 Z-4. F100.\nG0 Z20.\nM30\n", {"tool": "teeth = 4"}, "blunt-plunge", 6,
    ),
    "backwards": (
        HEAD.replace("M3", "M4") + CUT + "M30\n", {}, "counter-clockwise", 3,
    ),
    "spindle never started": (
        "G90 G17 T2 M6\nG43 H2\nG0 X0. Y0.\nG0 Z2.\nG1 Z-4. F100.\nG0 Z20.\nM30\n", {},
        "spindle-never-started", 1,
    ),
    "H of the drill": (
        HEAD.replace("H1", "H2") + CUT + "M30\n", {}, "length-of-other-tool", 2,
    ),
    "no G43": (
        HEAD.replace("G43 H1", "G40") + CUT + "M30\n", {}, "length-never-called", 1,
    ),
    "end above the contour": (
        HEAD + CUT + "M30\nG0 Z-4.\nG1 X-30. F600.\nG0 Z20.\n", {}, "ends-before-motion", 8,
    ),
    "lines that are gone": (
        HEAD + CUT + "M30\n",
        {"more": "[[tolerance.blocks]]\nlines = [3, 900]\ncontour_um = 50.0"}, "tolerance-lines", 8,
    ),
    "a tolerance of a kilometre": (
        HEAD + CUT + "M30\n", {"more": "[tolerance]\ncontour_um = 1e9"}, "tolerance-too-wide", 1,
    ),
    "a rapid's tolerance of a metre": (
        HEAD + CUT + "M30\n", {"more": "[tolerance]\nrapid_contour_um = 1e6"}, "tolerance-too-wide", 1,
    ),
    "a line's tolerance of a metre": (
        HEAD + CUT + "M30\n", {"more": "[[tolerance.blocks]]\nlines = [6, 6]\ncontour_um = 1e6"},
        "tolerance-too-wide", 1,
    ),
    "a table's tolerance of a turn": (
        HEAD + CUT + "G1 C5. F600.\nM30\n", {"more": "[tolerance]\nfollowing_mdeg = 360e3"}, "tolerance-too-wide", 1,
    ),
    "lines without motion": (
        HEAD + CUT + "M30\n",
        {"more": "[[tolerance.blocks]]\nlines = [100, 900]\ncontour_um = 50.0"},
        "blocks[0].contour_um", 0,
    ),
    "arcs asked for, none there": (
        HEAD + CUT + "M30\n", {"more": "[tolerance]\ncircular_deviation_um = 5.0"},
        "circular_deviation_um", 0,
    ),
    "corners asked for, none there": (
        HEAD + "G1 Z-2. F600.\nM30\n", {"more": "[tolerance]\ncorner_um = 5.0"}, "corner_um", 0,
    ),
    "rapids asked for, none there": (
        HEAD + "G1 Z-2. F600.\nG1 Z20.\nM30\n", {"more": "[tolerance]\nrapid_contour_um = 5.0"},
        "rapid_contour_um", 0,
    ),
    "nothing moves": ("G90\nM30\n", {}, "nothing-moves", 0),
    "100 mm a tooth": (
        "G90 G17 T1 M6\nG43 H1\nS30 M3\n" + CUT.replace("F600.", "F6000.") + "M30\n", {},
        "feed-per-tooth", 6,
    ),
    "too fast for the tool": (
        HEAD + CUT + "M30\n", {"tool": "speed_limit = 2000.0"}, "tool-broken", 3,
    ),
    "too fast later": (
        HEAD + CUT + "S9000\nM30\n", {"tool": "speed_limit = 4000.0"}, "tool-broken", 8,
    ),
    "force limit without a material": (
        HEAD + CUT + "M30\n", {"tool": "force_limit = 5.0"}, "limit-not-judged", 6,
    ),
    "the program waits in the slot": (
        HEAD + "G0 X-30. Y0.\nG0 Z-2.\nG1 X0. F600.\nM00\nG1 X30.\nG0 Z20.\nM30\n", {}, "stops-in-cut", 7,
    ),
    "a tap that is an end mill": (
        HEAD + "G0 X0. Y0.\nG84 Z-4. R2. F500.\nG80\nG0 Z20.\nM30\n", {}, "cutter-in-cycle", 5,
    ),
    "a drill that is an end mill": (
        HEAD + "G0 X0. Y0.\nG83 Z-4. R2. Q1. F100.\nG80\nG0 Z20.\nM30\n", {}, "cutter-in-cycle", 5,
    ),
    "rapids between the middles of cells": (
        HEAD + "T2 M6\nG43 H2\nG0 X5. Y5.\nG0 Z-3.\nG0 Z20.\nM30\n",
        {"stock": "", "cell": "5.0"}, "coarse-cell", 6,
    ),
    "only rapids": (HEAD + "G0 X5.\nG0 Z5.\nM30\n", {}, "nothing-cut", 3),
    "begin in the block": (
        HEAD + "G1 X9. F600.\nG0 Z20.\nM30\n", {"start": "-4.0"}, "starts-in-stock", 4,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", SLIPS)
def test_slip_is_told_at_its_line(name: str, tmp_path: Path) -> None:
    program, parts, code, line = SLIPS[name]
    found = codes(run(tmp_path, program, parts))
    assert found.get(code) == line, found


@pytest.mark.parametrize(
    "cycle", ["G82 Z-4. R2. P100 F100.", "G85 Z-4. R2. F100."], ids=["counterbore", "reamer"]
)
def test_cycles_that_are_no_drills_take_end_mills(cycle: str, tmp_path: Path) -> None:
    program = HEAD + f"G0 X0. Y0.\n{cycle}\nG80\nG0 Z20.\nM30\n"
    assert codes(run(tmp_path, program)) == {}


def test_a_cut_on_a_side_that_is_thinner_than_a_cell_is_one(tmp_path: Path) -> None:
    """No cell's middle is reached, and volume and force show it: the blank is 40 mm wide."""
    program = HEAD + "G0 X-30. Y23.9\nG0 Z-3.\nG1 X30. F480.\nG0 Z20.\nM30\n"
    outcome = run(tmp_path, program, {"stock": 'material = "C45"'})
    assert outcome.scope.removed_mm3 == pytest.approx(40.0 * 0.1 * 3.0, rel=0.01)
    assert codes(outcome) == {}


def test_strict_makes_them_failures(tmp_path: Path) -> None:
    program, parts, code, line = SLIPS["end in the slot"]
    outcome = run(tmp_path, program, parts, strict=True)
    assert outcome.verdict.outcome == "fail"
    assert (code, line) in [(reason.what, reason.line) for reason in outcome.verdict.reasons]
    program, parts, code, line = SLIPS["no G43"]
    with pytest.raises(ProgramError, match=code):
        run(tmp_path, program, parts, strict=True)


def test_an_alarm_judges_nothing_that_never_ran(tmp_path: Path) -> None:
    """Corners, arcs and rapids behind it are not there, and a tolerance on them is no failure."""
    behind = (
        "".join(f"G1 X{20 - k}. Y{k % 2}. F600.\n" for k in range(37))
        + "G2 I5. J0.\nG0 Z20.\nM30\n"
    )
    asked = "[tolerance]\ncontour_um = 50.0\ncorner_um = 100.0\ncircular_deviation_um = 5.0"
    stop = "G0 X-30. Y0.\nG0 Z-2.\nG0 X30.\n"
    outcome = run(tmp_path, HEAD + stop + behind, {"more": asked})
    assert codes(outcome) == {"rapid-into-stock": 6}
    assert outcome.verdict.outcome == "alarm"
    assert outcome.figures.corners.line <= 5
    assert outcome.figures.corners.count <= 2
    assert outcome.figures.arcs == ()
    assert max(outcome.figures.blocks.line) <= 6
    assert any(each.what == "all behind line 6" for each in outcome.scope.not_watched)
