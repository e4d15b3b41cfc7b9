"""A recording as CSV, for a spreadsheet or another program."""

from pathlib import Path

import numpy as np

from twin.files.atomic import complete_or_absent
from twin.nc.canonical import Axes
from twin.recording.reader import Recording
from twin.units import AxisKind

_UNITS: dict[AxisKind, tuple[str, str]] = {"linear": ("mm", "N"), "rotary": ("deg", "Nm")}


def csv_header(axes: Axes) -> list[str]:
    """Names of the columns, each with its unit: ``X_setpoint_mm``, ``C_joint_deg_per_s``, ..."""
    columns = ["time_s", "line"]
    for suffix in ("setpoint_{}", "setpoint_{}_per_s", "joint_{}", "joint_{}_per_s"):
        columns += [
            f"{name}_{suffix.format(_UNITS[kind][0])}"
            for name, kind in zip(axes.names, axes.kinds, strict=True)
        ]
    columns += [
        f"{name}_force_{_UNITS[kind][1]}" for name, kind in zip(axes.names, axes.kinds, strict=True)
    ]
    return columns


def export_csv(recording: Recording, path: Path, *, every: int = 1) -> int:
    """Write a recording as CSV, complete or not at all.

    Args:
        recording: The recording.
        path: The file to be.
        every: Write one of so many samples.

    Returns:
        How many rows were written.
    """
    header = csv_header(recording.header.axes)
    formats = ["%.6f", "%d", *["%.9g"] * (len(header) - 2)]
    written, seen = 0, 0
    with complete_or_absent(path) as temporary, temporary.open("w", encoding="utf-8") as file:
        file.write(",".join(header) + "\n")
        for samples in recording.chunks():
            asked = samples.setpoint
            rows = np.column_stack(
                [
                    asked.time, asked.line.astype(np.float64), asked.position, asked.velocity,
                    samples.joint_position, samples.joint_velocity, samples.drive_force,
                ]
            )[-seen % every :: every]  # fmt: skip
            np.savetxt(file, rows, fmt=formats, delimiter=",")
            seen += len(samples)
            written += len(rows)
    return written
