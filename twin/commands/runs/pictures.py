"""The film and the stills of a run."""

from pathlib import Path

from twin.recording.reader import open_recording
from twin.run.progress import Progress
from twin.run.results import ALARM_STILL_NAME, STILL_NAME
from twin.run.run import Run

FILM_STEM = "video"
ALARM_CAMERAS = ("tool", "overview")
"""What the moment of a contact is seen from: those of these that the machine has, side by side. The frame and
the far side of the table are not near the tool."""
_ALARM_SIZE = (1280, 480)
"""Of both views together [px]."""
ALARMS_OF_CONTACT = ("collision", "rapid-into-stock", "spindle-off", "gouge")
"""Alarms of two things that meet, which a picture shows."""


def film_run(run: Run, folder: Path, progress: Progress) -> None:
    """Film a run that was recorded, and draw its end as a still.

    Args:
        folder: Where ``recording.h5`` lies and the pictures go.

    Raises:
        RenderError: Pictures cannot be made here.
    """
    from twin.render.film import film
    from twin.render.still import Shot, stills
    from twin.run.replay import scene_of

    video = run.preparation.job.file.video
    with open_recording(folder / "recording.h5") as recording:
        scene = scene_of(recording, run.preparation, run.dry_run.summary)
        film(
            scene,
            video=video,
            out=folder / f"{FILM_STEM}.mp4",
            progress=lambda done, frames: progress("film", done / frames),
        )
        shot = Shot(folder / STILL_NAME, len(recording))
        stills(
            scene,
            [shot],
            cameras=video.cameras[:1],
            quality=video.quality,
            renderer=video.renderer,
        )


def draw_contact(run: Run, folder: Path, line: int) -> None:
    """Draw a collision, which is the end of its recording, from near and from afar.

    Args:
        folder: Where ``recording.h5`` lies and the picture goes.
        line: Of the alarm; the last sample may be of a later one.

    Raises:
        RenderError: Pictures cannot be made here.
    """
    from twin.render.still import Shot, stills
    from twin.run.replay import scene_of

    with open_recording(folder / "recording.h5") as recording:
        scene = scene_of(recording, run.preparation, run.dry_run.summary)
        cameras = [name for name in ALARM_CAMERAS if name in scene.camera_names()]
        shot = Shot(folder / ALARM_STILL_NAME, len(recording), line)
        stills(scene, [shot], cameras=cameras, size=_ALARM_SIZE, quality="draft")
