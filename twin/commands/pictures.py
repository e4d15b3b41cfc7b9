"""The film and the still of a run."""

from pathlib import Path

import numpy as np

from twin.chain import Run
from twin.progress import Progress
from twin.recording import open_recording

STILL_NAME = "still.png"


def film_run(run: Run, folder: Path, progress: Progress) -> None:
    """Film a run that was recorded, and draw its end as a still.

    Args:
        run: The run, with its contour errors kept.
        folder: Where ``recording.h5`` lies and the pictures go.
        progress: Told how far the film is.

    Raises:
        RenderError: Pictures cannot be made here.
    """
    from twin.render.film import film, still

    job = run.preparation.job.file
    with open_recording(folder / "recording.h5") as recording:
        shared = {
            "spec": run.spec,
            "machine": run.preparation.machine,
            "stock": job.stock,
            "tool": job.tools[0],
            "source": run.preparation.source.lines,
            "rapid_moves": run.rapid_moves,
            "contour_um": np.concatenate(run.contour_um),
        }
        film(
            recording,
            video=job.video,
            out=folder / "video.mp4",
            progress=lambda done, frames: progress("film", done / frames),
            **shared,
        )
        still(recording, camera=job.video.cameras[0], out=folder / STILL_NAME, **shared)
