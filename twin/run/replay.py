"""A recorded run opened again, with the job that it was made with: what pictures are made of."""

import contextlib
from collections.abc import Iterator
from pathlib import Path

from twin.cutting.program_summary import PlacedPart, ProgramSummary, SummaryBuilder
from twin.cutting.recut import recut
from twin.errors import UsageError
from twin.machine.model.model import build_spec
from twin.recording.reader import Recording, RecordingHeader, open_recording
from twin.render.scene.scene import RenderScene
from twin.run.preparing.preparation import Preparation, prepare_recorded

EVENTS = ("end", "worst", "alarm", "rapid", "gouge")
"""Moments that can be asked for by name: the run's end, its greatest contour error, the machine's
first alarm, the first rapid into stock, the first gouge by flutes, shank or holder."""


def summary_of(preparation: Preparation, header: RecordingHeader) -> ProgramSummary:
    """Tools, speeds of the spindle and rapids of the program of a recording.

    Raises:
        ProgramError: The program is wrong.
        ConfigError: It brings a tool that the job does not list.
    """
    part = PlacedPart(header.part_frame, header.part_zero)
    builder = SummaryBuilder(preparation.job.file, preparation.spindle, part)
    for chunk in preparation.interpretation().chunks():
        builder.add(chunk)
    return builder.summary()


def scene_of(
    recording: Recording, preparation: Preparation, summary: ProgramSummary
) -> RenderScene:
    """What is to be seen of a recording of a prepared job."""
    job = preparation.job.file
    return RenderScene(
        recording=recording,
        spec=build_spec(preparation.machine, job.tools[0]),
        machine=preparation.machine,
        summary=summary,
        source=preparation.source.lines,
        stock=job.stock,
        error_scale_um=job.tolerance.contour_um,
    )


@contextlib.contextmanager
def open_scene(
    path: Path, *, machine: str | None = None
) -> Iterator[tuple[RenderScene, Preparation]]:
    """Open a recording with all that its pictures need.

    Args:
        path: ``recording.h5``.
        machine: Overrides the machine that it names.

    Raises:
        RecordingError: The recording cannot be read, or does not hold its job.
        UsageError: Its machine is gone.
    """
    with open_recording(path) as recording:
        preparation = prepare_recorded(recording.header, machine=machine)
        yield (
            scene_of(recording, preparation, summary_of(preparation, recording.header)),
            preparation,
        )


def event_time(scene: RenderScene, event: str) -> float | None:
    """When something happened in a run [s]; None for its end.

    Args:
        event: One of ``EVENTS``.

    Raises:
        UsageError: There is no such event, or it did not happen.
    """
    if event not in EVENTS:
        raise UsageError(f"no event '{event}': there are {', '.join(EVENTS)}")
    recording = scene.recording
    if event == "end":
        return None
    found = None
    if event == "worst":
        error = recording.contour_um(0, len(recording))
        found = None if error is None else float(recording.column("time")[error.argmax()])
    elif event == "alarm":
        found = min((time for time, _ in recording.alarms), default=None)
    elif scene.stock is not None:
        cut = recut(recording, scene.summary, scene.stock).result()
        events = cut.rapid_into_stock if event == "rapid" else cut.gouges
        found = min((each.time_s for each in events), default=None)
    if found is None:
        raise UsageError(f"{recording.path}: the run has no '{event}' to show")
    return found
