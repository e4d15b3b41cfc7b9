"""The film and the still of a run."""

from pathlib import Path

from twin.recording.reader import open_recording
from twin.run.dry_run import DryRun
from twin.run.progress import Progress
from twin.run.results import STILL_NAME
from twin.run.run import Run

FILM_STEM = "video"


def film_run(run: Run, dry_run: DryRun, folder: Path, progress: Progress) -> None:
    """Film a run that was recorded, and draw its end as a still.

    Args:
        run: The run.
        dry_run: What the first pass over its program found.
        folder: Where ``recording.h5`` lies and the pictures go.
        progress: Told how far the film is.

    Raises:
        RenderError: Pictures cannot be made here.
    """
    from twin.render.film import film
    from twin.render.still import Shot, stills
    from twin.run.replay import scene_of

    video = run.preparation.job.file.video
    with open_recording(folder / "recording.h5") as recording:
        scene = scene_of(recording, run.preparation, dry_run.summary)
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
