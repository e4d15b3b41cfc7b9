"""``twin export``: a recording as CSV."""

from pathlib import Path

import typer

from twin.errors import ExitCode, UsageError
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
