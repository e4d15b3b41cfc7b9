"""``result.json``: the verdict and every figure behind it, in the form that users script against."""

import dataclasses
import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from twin.compare.figures import ArcFigures, AxisTracking, BlockFigures, Figures
from twin.compare.verdict import PRINTED_DIGITS, Verdict
from twin.files.atomic import write_text
from twin.job.tolerance import ToleranceTable
from twin.recording.alarms import Alarm
from twin.units import AxisKind

SCHEMA = 1
BLOCKS_KEPT = 1000
"""``blocks`` holds so many blocks at most, those with the greatest contour errors."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class RunSummary:
    """What the result says in addition to the figures; the caller knows it.

    Attributes:
        duration_s: Machine time of the program, without the settling after it [s].
        wall_s: How long the whole run took [s].
        stages: Seconds by stage: ``interpret_s``, ``plan_s``, ``simulate_s``, ``compare_s``,
            ``cut_s``, ``render_s``; a stage that was left out is 0. The machine is planned and stepped beside the others:
            ``simulate_s`` is how long they waited for it.
        cut: The content of the key ``cut``, or None when nothing was cut.
        commanded: Final setpoint by axis, part coordinates [mm or deg].
        simulated: Final joint position by axis, part coordinates [mm or deg].
        near_miss: The content of the key ``near_miss``, or None when all kept their distance.
        scope: The content of the key ``scope``: what the verdict looked at.
        tools: The rows of the key ``tools``: what each tool is, its time, what it took off.
    """

    program: str
    dialect: str
    machine: str
    duration_s: float
    wall_s: float
    stages: Mapping[str, float]
    cut: Mapping[str, Any] | None
    commanded: Mapping[str, float]
    simulated: Mapping[str, float]
    near_miss: Mapping[str, Any] | None = None
    scope: Mapping[str, Any] | None = None
    tools: Sequence[Mapping[str, Any]] = ()


STAGES = ("interpret_s", "plan_s", "simulate_s", "compare_s", "cut_s", "render_s")


def result(
    summary: RunSummary,
    figures: Figures,
    tolerance: ToleranceTable,
    verdict: Verdict,
    alarms: Sequence[Alarm] = (),
) -> dict[str, Any]:
    """Put the result of a run together, ready for JSON.

    Returns:
        The content of ``result.json``; numbers that do not exist are None.
    """
    contour = figures.contour
    content = {
        "schema": SCHEMA,
        "program": summary.program,
        "dialect": summary.dialect,
        "machine": summary.machine,
        "verdict": verdict.outcome,
        "scope": None if summary.scope is None else dict(summary.scope),
        "reasons": [dataclasses.asdict(reason) for reason in verdict.reasons],
        "checks": [dataclasses.asdict(c) | {"holds": c.holds} for c in verdict.checks],
        "duration_s": summary.duration_s,
        "samples": figures.samples,
        "wall_s": summary.wall_s,
        "real_time_factor": summary.duration_s / summary.wall_s if summary.wall_s > 0 else None,
        "stages": {name: summary.stages.get(name, 0.0) for name in STAGES},
        "tracking_um": _tracking(figures, "linear"),
        "tracking_mdeg": _tracking(figures, "rotary"),
        "contour_um": dataclasses.asdict(contour),
        "contour_shares_um": dict(figures.shares),
        **({} if figures.direction is None else {"direction_mdeg": _axis(figures.direction)}),
        "features_um": {
            name: dataclasses.asdict(feature) for name, feature in figures.features.items()
        },
        "corners": dataclasses.asdict(figures.corners),
        "blocks": _worst_blocks(figures.blocks),
        "blocks_forgotten": figures.blocks.forgotten,
        "arcs": [_arc(arc) for arc in figures.arcs],
        "bidirectional_arcs": [dataclasses.asdict(pair) for pair in figures.bidirectional],
        "tolerance": tolerance.model_dump(exclude_none=True),
        "alarms": [
            {"code": a.code, "line": a.line, "time_s": a.time_s, "message": a.message}
            for a in alarms
        ],
        "near_miss": None if summary.near_miss is None else dict(summary.near_miss),
        "cut": None if summary.cut is None else dict(summary.cut),
        "tools": [dict(tool) for tool in summary.tools],
        "final": {"commanded": dict(summary.commanded), "simulated": dict(summary.simulated)},
    }
    return _rounded(content)


def write_result(path: Path, content: Mapping[str, Any]) -> None:
    """Write ``result.json``, complete or not at all."""
    write_text(path, json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n")


def _tracking(figures: Figures, kind: AxisKind) -> dict[str, dict[str, float]]:
    return {name: _axis(axis) for name, axis in figures.tracking.items() if axis.kind == kind}


def _axis(axis: AxisTracking) -> dict[str, float]:
    return {
        "max": axis.max,
        "rms": axis.rms,
        "p99": axis.p99,
        "worst_line": axis.line,
        "worst_time_s": axis.time_s,
    }


def _worst_blocks(blocks: BlockFigures) -> list[dict[str, Any]]:
    """The blocks with the greatest contour errors, in program order."""
    rows = np.sort(np.argsort(-blocks.max_um, kind="stable")[:BLOCKS_KEPT])
    return [
        {
            "line": int(blocks.line[row]),
            "motion": "rapid" if blocks.rapid[row] else "feed",
            "shape": "arc" if blocks.arc[row] else "line",
            "max": float(blocks.max_um[row]),
            "rms": float(blocks.rms_um[row]),
            "p99": float(blocks.p99_um[row]),
            "time_s": float(blocks.time_s[row]),
        }
        for row in rows
    ]


def _arc(arc: ArcFigures) -> dict[str, float]:
    return {
        "line": arc.line,
        "time_s": arc.time_s,
        "radius_mm": arc.radius_mm,
        "sweep_deg": arc.sweep_deg,
        "circular_deviation_um": arc.circular_deviation_um,
        "radial_deviation_um": arc.radial_deviation_um,
        "radial_max_um": arc.radial_max_um,
        "radial_min_um": arc.radial_min_um,
    }


def _rounded(value: Any) -> Any:
    if isinstance(value, float):
        return round(value, PRINTED_DIGITS) if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {key: _rounded(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_rounded(item) for item in value]
    return value
