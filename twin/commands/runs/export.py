"""``twin export``: a recording as CSV, a machine as a unit for co-simulation."""

from pathlib import Path

import numpy as np
import typer

from twin.errors import ExitCode, UsageError
from twin.extras import require_extra
from twin.files.atomic import complete_or_absent
from twin.nc.canonical import Axes
from twin.recording.reader import Recording, open_recording
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


def export_and_print(recording: Path, out: Path | None, *, every: int = 1) -> ExitCode:
    """Write a recording as CSV.

    Args:
        recording: ``recording.h5``.
        out: The file to be; by default beside the recording, with the suffix ``.csv``.

    Raises:
        RecordingError: The recording cannot be read.
        UsageError: ``every`` is below 1, or the output would overwrite the recording.
    """
    if every < 1:
        raise UsageError(f"--every must be 1 or more, not {every}")
    path = out or recording.with_suffix(".csv")
    if path.resolve() == recording.resolve():
        raise UsageError(f"{path}: would overwrite the recording; give another file by --out")
    with open_recording(recording) as opened:
        rows = export_csv(opened, path, every=every)
    typer.echo(f"{rows} rows in {path}")
    return ExitCode.OK


def export_unit(machine: str, out: Path | None) -> ExitCode:
    """Write a machine as a unit for co-simulation (FMI 3).

    Args:
        machine: A shipped machine's name, or its file.
        out: The file to be; by default the machine's name in the working folder.

    Raises:
        UsageError: The extra is missing, there is no such machine, or the file cannot be written.
        ConfigError: The machine is wrong.
    """
    require_extra("fmu", "twin export --fmu")
    from twin.fmu.build import build_unit

    path = out or Path(f"{Path(machine).stem}.fmu")
    try:
        build_unit(machine, path)
    except OSError as error:
        raise UsageError(f"{path}: cannot be written: {error.strerror}") from error
    typer.echo(f"{path}: FMI 3, co-simulation; steps of one servo period")
    return ExitCode.OK
