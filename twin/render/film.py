"""Films of a recorded run."""

from collections.abc import Callable, Iterator
from pathlib import Path

from twin.errors import RenderError
from twin.job.job_file import VideoTable
from twin.nc.canonical import IntArray
from twin.recording.reader import Recording
from twin.render.drawing.canvas import Pixels, quality_named
from twin.render.encoder import video_writer
from twin.render.frames import deal, frame_ends
from twin.render.gauge import Gauge
from twin.render.hud import HudValues
from twin.render.scene.scene import RenderScene
from twin.render.scene.stage import ScenePlayer, stage

Progress = Callable[[int, int], None]
"""Called with the number of frames that are drawn, and the number of all."""

MOST_FRAMES = 100_000
"""A film of more frames is refused: an hour at 25 frames a second is 90,000."""


def film(
    scene: RenderScene, *, video: VideoTable, out: Path, progress: Progress | None = None
) -> Path:
    """Film a recorded run as MP4, GIF or WebP: one camera after the other, or all side by side.

    Args:
        scene: What is to be seen; the simulated joints move, and the stock is cut as it goes on.
        video: Cameras, length, quality, frame rate and size; odd sizes are made even.
        out: The film, complete or not at all; ``.mp4``, ``.gif`` or ``.webp``.

    Returns:
        ``out``.

    Raises:
        RenderError: There is nothing to film, no such camera, no renderer, no encoder, or the file
            cannot be written.
        ConfigError: The stock is too large for its grid.
    """
    recording = scene.recording
    scene.require(video.cameras)
    quality = quality_named(video.quality)
    size = (video.size[0] // 2 * 2, video.size[1] // 2 * 2)
    duration = len(recording) * recording.header.period_s
    seconds = video.seconds if video.speed is None else duration / video.speed
    frames = max(1, round(seconds * video.fps))
    if frames > MOST_FRAMES:
        raise RenderError(
            f"a film of {seconds:.0f} s at {video.fps} frames a second would have {frames} frames; "
            f"{MOST_FRAMES} are the most: raise video.speed or lower video.seconds"
        )
    ends = frame_ends(len(recording), frames)
    gauge = Gauge(scene)
    display = gauge.display(size, duration * video.fps / frames)
    with (
        stage(scene, size, quality, renderer=video.renderer) as play,
        video_writer(out, size, video.fps) as writer,
    ):
        for done, (pixels, reading) in enumerate(_frames(play, gauge, video, recording, ends), 1):
            if video.display:
                writer.write(lambda pixels=pixels, reading=reading: display.draw(pixels, reading))
            else:
                writer.write(lambda pixels=pixels: pixels)
            if progress is not None:
                progress(done, frames)
    return out


def _frames(
    play: ScenePlayer, gauge: Gauge, video: VideoTable, recording: Recording, ends: IntArray
) -> Iterator[tuple[Pixels, HudValues]]:
    """Draw a film's frames, with what there is to read off; each is drawn while the next one is cut.

    Args:
        ends: How many samples lie behind each frame.
    """
    begun: tuple[Callable[[], Pixels], HudValues] | None = None
    number = 0
    for samples, due in deal(recording, ends):
        play.advance(samples)
        gauge.add(samples)
        if not due:
            continue
        play.refresh()
        if begun is not None:
            yield begun[0](), begun[1]
        cameras = video.cameras
        if video.layout == "sequence":
            cameras = (cameras[number * len(cameras) // len(ends)],)
        begun = play.begin_picture(*cameras), gauge.reading(play.warning)
        number += 1
    if begun is not None:
        yield begun[0](), begun[1]
