import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from twin.compare.figures import (
    ArcFigures,
    AxisTracking,
    BlockFigures,
    ContourFigures,
    CornerFigures,
    Figures,
)
from twin.compare.result import RunSummary, result, write_result
from twin.compare.verdict import PRINTED_DIGITS, Check, judge
from twin.errors import ExitCode
from twin.job.tolerance import BlocksToleranceTable, ToleranceTable
from twin.recording.alarms import Alarm
from twin.run.judging.outcome import LOAD_FIGURES

ALARM = Alarm("soft-limit", 7, 1.5, "X", "X leaves its travel")


def figures(contour: float = 12.0, lag: float = 150.0, turn: float = 30.0) -> Figures:
    return Figures(
        samples=1000,
        duration_s=2.5,
        tracking={
            "X": AxisTracking("linear", lag, 80.0, 3, 0.4),
            "C": AxisTracking("rotary", turn, 10.0, 4, 0.6),
        },
        contour=ContourFigures(max=contour, rms=4.0, p99=11.0, worst_line=9, worst_time_s=1.25),
        arcs=(ArcFigures(5, 0.2, 25.0, -360.0, 3.0, 1.0, -2.0, np.zeros((0, 2))),),
        worst=(),
        blocks=BlockFigures(
            line=np.array([2, 5, 9]),
            rapid=np.array([True, False, False]),
            arc=np.array([False, True, False]),
            samples=np.array([10, 20, 30]),
            max_um=np.array([0.9, 0.5, 1.0]) * contour,
            rms_um=np.array([4.0, 4.0, 4.0]),
            p99_um=np.array([5.0, 5.0, 5.0]),
            time_s=np.array([0.1, 0.7, 1.25]),
        ),
        corners=CornerFigures(count=3, rounding_um=6.0, line=8, time_s=1.1),
        direction=AxisTracking("rotary", 45.0, 20.0, 7, 1.2),
    )


def test_within_tolerance_passes_and_the_limit_itself_is_within():
    for limit in (12.0, 20.0):
        verdict = judge(figures(), ToleranceTable(contour_um=limit))
        assert (verdict.outcome, verdict.reasons) == ("pass", ())
        assert verdict.exit_code is ExitCode.OK


POSITIVE = st.floats(1e-3, 1e6).map(lambda value: float(f"{value:.9g}"))
EVERY_LIMIT = {
    "contour_um": 12.0, "rapid_contour_um": 10.8, "corner_um": 6.0, "following_um": 150.0,
    "following_mdeg": 30.0, "direction_mdeg": 45.0, "circular_deviation_um": 3.0, "cycle_time_s": 2.5,
}  # fmt: skip


@pytest.mark.parametrize("key", EVERY_LIMIT)
@pytest.mark.parametrize(
    ("more", "outcome"), [(0.0, "pass"), (4e-7, "pass"), (-4e-7, "pass"), (-2e-6, "fail")]
)
def test_a_value_that_is_printed_as_its_limit_holds(key: str, more: float, outcome: str):
    """Of every figure: a value and its limit are compared as ``result.json`` has them."""
    value = EVERY_LIMIT[key]
    wide = {"contour_um": 1e3} | {key: value + more}
    verdict = judge(figures(), ToleranceTable.model_validate(wide), cycle_time_s=2.5)
    assert key in {check.what for check in verdict.checks}
    assert verdict.outcome == outcome


def test_no_tolerance_is_without_its_limit_above():
    assert {*EVERY_LIMIT, *LOAD_FIGURES, "blocks"} == set(ToleranceTable.model_fields)


@given(limit=POSITIVE, steps=st.integers(-30, 30), scale=st.sampled_from([1e-7, 1e-6, 1e-3, 0.04]))
def test_the_message_shows_on_which_side_of_its_limit_a_value_is(
    limit: float, steps: int, scale: float
) -> None:
    check = Check("force_n", "cutting force", limit + steps * scale, limit, "N", 0, 0.0)
    printed, _, shown = check.message.removeprefix("cutting force ").partition(" N ")
    relation, _, allowed = shown.partition(" force_n = ")
    assert float(allowed) == limit
    # Both are rounded to what is printed: a difference below that is none.
    assert (relation == "is within") == check.holds
    if check.holds:
        assert float(printed) <= max(limit, round(limit, PRINTED_DIGITS))
    else:
        assert float(printed) > limit


def test_a_contour_error_fails_with_value_limit_line_and_time():
    verdict = judge(figures(), ToleranceTable(contour_um=11.9))
    assert (verdict.outcome, verdict.exit_code) == ("fail", ExitCode.FAILED)
    (reason,) = verdict.reasons
    assert (reason.what, reason.line, reason.time_s) == ("contour_um", 9, 1.25)
    assert str(reason) == "line 9, 1.250 s: contour error 12.0 µm exceeds contour_um = 11.9"


def ranges(*parts: tuple[int, int, float]) -> tuple[BlocksToleranceTable, ...]:
    return tuple(BlocksToleranceTable(lines=(a, b), contour_um=um) for a, b, um in parts)


@pytest.mark.parametrize(
    ("tolerance", "told"),
    [
        ({"contour_um": 12, "rapid_contour_um": 10}, [("rapid_contour_um", 2)]),
        ({"contour_um": 10.7, "rapid_contour_um": 50}, [("contour_um", 9)]),
        ({"contour_um": 10.7, "blocks": ranges((9, 9, 13))}, [("contour_um", 2)]),
        ({"contour_um": 12, "blocks": ranges((4, 6, 5))}, [("blocks[0].contour_um", 5)]),
        ({"contour_um": 12, "blocks": ranges((1, 9, 5), (1, 9, 50))}, []),
        (
            {"contour_um": 5, "blocks": ranges((5, 9, 11), (9, 9, 11.5))},
            [("contour_um", 2), ("blocks[1].contour_um", 9)],
        ),
        ({"corner_um": 5.9}, [("corner_um", 8)]),
        ({"corner_um": 6}, []),
        ({"circular_deviation_um": 2.9}, [("circular_deviation_um", 5)]),
        ({"circular_deviation_um": 3}, []),
        ({"direction_mdeg": 44}, [("direction_mdeg", 7)]),
        ({"direction_mdeg": 45}, []),
        ({"cycle_time_s": 2.4}, [("cycle_time_s", 0)]),
        ({"cycle_time_s": 2.5}, []),
    ],
)
def test_each_tolerance_gives_its_worst_place(tolerance: dict, told: list[tuple[str, int]]):
    verdict = judge(figures(), ToleranceTable(**tolerance))
    assert [(reason.what, reason.line) for reason in verdict.reasons] == told


def test_the_cycle_time_may_leave_the_settling_out():
    tolerance = ToleranceTable(cycle_time_s=2.4)
    assert judge(figures(), tolerance, cycle_time_s=2.3).outcome == "pass"


def test_a_range_that_ends_before_it_begins_is_refused():
    with pytest.raises(ValueError, match="first, last"):
        BlocksToleranceTable(lines=(9, 2), contour_um=1.0)


def test_following_error_is_judged_by_the_kind_of_axis_when_asked_for():
    assert judge(figures(), ToleranceTable()).outcome == "pass"
    verdict = judge(figures(), ToleranceTable(following_um=100.0, following_mdeg=20.0))
    assert [(r.what, r.line) for r in verdict.reasons] == [
        ("following_um", 3),
        ("following_mdeg", 4),
    ]
    assert judge(figures(), ToleranceTable(following_um=150.0)).outcome == "pass"


def test_an_alarm_outweighs_a_tolerance_and_is_told_first():
    verdict = judge(figures(), ToleranceTable(contour_um=1.0), [ALARM])
    assert (verdict.outcome, verdict.exit_code) == ("alarm", ExitCode.ALARM)
    assert [reason.what for reason in verdict.reasons] == ["soft-limit", "contour_um"]


def summary() -> RunSummary:
    return RunSummary(
        program="ring.nc", dialect="gost", machine="mill4", duration_s=2.5, wall_s=0.5,
        stages={"interpret_s": 0.1, "simulate_s": 0.3}, cut={"removed_mm3": 10.0},
        commanded={"X": 1.0}, simulated={"X": float("nan")},
    )  # fmt: skip


def test_the_result_has_every_key_of_the_contract(tmp_path: Path):
    tolerance = ToleranceTable(contour_um=20.0)
    verdict = judge(figures(), tolerance, [ALARM])
    write_result(
        tmp_path / "result.json", result(summary(), figures(), tolerance, verdict, [ALARM])
    )
    content = json.loads((tmp_path / "result.json").read_text(encoding="utf-8"))
    assert content["schema"] == 1
    assert content["verdict"] == "alarm"
    assert content["real_time_factor"] == 5.0
    assert set(content["stages"]) == {
        "interpret_s", "plan_s", "simulate_s", "compare_s", "cut_s", "render_s",
    }  # fmt: skip
    assert content["tracking_um"]["X"]["max"] == 150.0
    assert content["tracking_mdeg"]["C"]["rms"] == 10.0
    assert content["contour_um"] == {
        "max": 12.0, "rms": 4.0, "p99": 11.0, "worst_line": 9, "worst_time_s": 1.25,
    }  # fmt: skip
    (arc,) = content["arcs"]
    assert (arc["line"], arc["radius_mm"], arc["circular_deviation_um"]) == (5, 25.0, 3.0)
    assert arc["radial_deviation_um"] == -2.0
    assert content["tolerance"]["contour_um"] == 20.0
    told = {"code": "soft-limit", "line": 7, "time_s": 1.5, "message": "X leaves its travel"}
    assert content["alarms"] == [told]
    assert content["cut"] == {"removed_mm3": 10.0}
    assert content["final"] == {"commanded": {"X": 1.0}, "simulated": {"X": None}}
    for key in ("program", "dialect", "machine", "duration_s", "samples", "wall_s"):
        assert key in content


def test_a_result_that_cannot_be_written_leaves_nothing(tmp_path: Path):
    with pytest.raises(ValueError, match="JSON"):
        write_result(tmp_path / "result.json", {"value": float("nan")})
    assert list(tmp_path.iterdir()) == []
