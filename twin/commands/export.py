"""``twin export``: a recording as CSV, a machine as a unit for co-simulation."""

from pathlib import Path

import typer

from twin.errors import ExitCode, UsageError
from twin.extras import require_extra
from twin.recording.export import export_csv
from twin.recording.reader import open_recording


def export_and_print(recording: Path, out: Path | None, *, every: int = 1) -> ExitCode:
    """Write a recording as CSV.

    Args:
        recording: ``recording.h5``.
        out: The file to be; by default beside the recording, with the suffix ``.csv``.
        every: Write one of so many samples.

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
