"""Films and stills of a recorded run."""

from collections.abc import Callable, Sequence
from pathlib import Path

import mujoco
import numpy as np
from PIL import Image

from twin.cutting.outline import BoolArray
from twin.cutting.tools import ToolPlan
from twin.errors import RenderError
from twin.files import complete_or_absent
from twin.job import StockTable, ToolTable, VideoTable
from twin.machine.config import Machine
from twin.nc.canonical import FloatArray
from twin.recording import Recording, Samples
from twin.render.canvas import QUALITIES
from twin.render.encoder import video_writer
from twin.render.hud import Display, Reading
from twin.render.replay import deal, frame_ends
from twin.render.stage import Scene, stage
from twin.units import SECONDS_PER_MINUTE, UM_PER_MM

Progress = Callable[[int, int], None]
"""Told how many frames are drawn, and of how many."""


def film(
    recording: Recording,
    *,
    spec: mujoco.MjSpec,
    machine: Machine,
    stock: StockTable | None,
    tool: ToolTable | ToolPlan,
    source: Sequence[str],
    video: VideoTable,
    out: Path,
    quality: str | None = None,
    rapid_moves: BoolArray | None = None,
    contour_um: FloatArray | None = None,
    error_scale_um: float | None = None,
    alarms: Sequence[tuple[float, str]] = (),
    progress: Progress | None = None,
) -> Path:
    """Film a recorded run as MP4, GIF or WebP: one camera after the other, or all side by side.

    Args:
        recording: What to replay; the simulated joints are shown.
        spec: Machine, tool and named cameras (``twin.machine.model.build_spec``).
        machine: The machine file.
        stock: The blank, which is cut as the film goes on; None for none.
        tool: What is in the spindle, or what is in it when.
        source: Lines of the program.
        video: Cameras, length, frame rate and size; odd sizes are made even.
        out: The film, complete or not at all; ``.mp4``, ``.gif`` or ``.webp``.
        quality: ``draft`` or ``final``; None: what ``video`` says.
        rapid_moves: Whether each move of the program is a rapid; None: none is.
        contour_um: Contour error of every sample, shape (n,) [µm], which colours the trail; None:
            the lag is shown.
        error_scale_um: Error that has the trail's last colour [µm]; None: the greatest.
        alarms: When the machine raised which alarm [s, text]; shown from then on.
        progress: Called after every frame.

    Returns:
        ``out``.

    Raises:
        RenderError: There is nothing to film, no such camera, no OpenGL, no encoder, or the file
            cannot be written.
        ConfigError: The stock is too large for its grid.
    """
    scene = Scene(
        recording=recording,
        spec=spec,
        machine=machine,
        tool=tool,
        stock=stock,
        rapid_moves=rapid_moves,
        error_um=contour_um,
        error_scale_um=error_scale_um,
    )
    quality = quality or video.quality
    _require(scene, video.cameras, quality)
    size = (video.size[0] // 2 * 2, video.size[1] // 2 * 2)
    duration = len(recording) * recording.header.period_s
    seconds = video.seconds if video.speed is None else duration / video.speed
    frames = max(1, round(seconds * video.fps))
    ends = frame_ends(len(recording), frames)
    gauge = Gauge(recording, contour_um, alarms)
    display = gauge.display(source, size, duration * video.fps / frames)
    with stage(scene, size, QUALITIES[quality]) as play, video_writer(out, size, video.fps) as film:
        done = 0
        for samples, due in deal(recording, ends):
            play.advance(samples)
            gauge.add(samples)
            if not due:
                continue
            cameras = video.cameras
            if video.layout == "sequence":
                cameras = (cameras[done * len(cameras) // frames],)
            pixels, reading = play.picture(*cameras), gauge.reading(play.warning)
            film.write(lambda pixels=pixels, reading=reading: display.draw(pixels, reading))
            done += 1
            if progress is not None:
                progress(done, frames)
    return out


def still(
    recording: Recording,
    *,
    spec: mujoco.MjSpec,
    machine: Machine,
    stock: StockTable | None,
    tool: ToolTable | ToolPlan,
    source: Sequence[str],
    out: Path,
    camera: str = "overview",
    size: tuple[int, int] = (1280, 720),
    time_s: float | None = None,
    line: int | None = None,
    quality: str = "final",
    rapid_moves: BoolArray | None = None,
    contour_um: FloatArray | None = None,
    error_scale_um: float | None = None,
    alarms: Sequence[tuple[float, str]] = (),
    display: bool = True,
) -> Path:
    """Draw one moment of a recorded run as a PNG.

    Args:
        recording: As for ``film``, like the other arguments of the same names.
        spec: See ``film``.
        machine: See ``film``.
        stock: See ``film``.
        tool: See ``film``.
        source: See ``film``.
        out: The picture, complete or not at all.
        camera: Name of the camera.
        size: Width and height [px].
        time_s: The moment [s].
        line: The end of this source line's first run, instead of a time. Neither: the end.
        quality: See ``film``.
        rapid_moves: See ``film``.
        contour_um: See ``film``.
        error_scale_um: See ``film``.
        alarms: See ``film``.
        display: Whether the head-up display is on the picture.

    Returns:
        ``out``.

    Raises:
        RenderError: There is no such moment or camera, no OpenGL, or the file cannot be written.
        ConfigError: The stock is too large for its grid.
    """
    scene = Scene(
        recording=recording,
        spec=spec,
        machine=machine,
        tool=tool,
        stock=stock,
        rapid_moves=rapid_moves,
        error_um=contour_um,
        error_scale_um=error_scale_um,
    )
    _require(scene, (camera,), quality)
    end = moment(recording, time_s=time_s, line=line)
    gauge = Gauge(recording, contour_um, alarms)
    with stage(scene, size, QUALITIES[quality]) as play:
        for samples, _ in deal(recording, np.array([end])):
            play.advance(samples)
            gauge.add(samples)
        pixels, reading = play.picture(camera), gauge.reading(play.warning)
    if display:
        pixels = gauge.display(source, size, None).draw(pixels, reading)
    try:
        with complete_or_absent(out) as temporary:
            Image.fromarray(np.ascontiguousarray(pixels)).save(temporary, "PNG", optimize=True)
    except OSError as error:
        raise RenderError(f"{out}: cannot be written: {error.strerror}") from error
    return out


def moment(recording: Recording, *, time_s: float | None = None, line: int | None = None) -> int:
    """How many samples lie behind a moment of a recording.

    Args:
        recording: Of n samples.
        time_s: The moment [s].
        line: The end of this source line's first run. Neither: the end of the recording.

    Raises:
        RenderError: There is no such moment.
    """
    period = recording.header.period_s
    if line is not None:
        here = recording.column("line") == line
        if not here.any():
            raise RenderError(f"line {line} of the program moved nothing")
        first = int(np.argmax(here))
        rest = ~here[first:]
        return first + (int(np.argmax(rest)) if rest.any() else len(rest))
    if time_s is None:
        return len(recording)
    last = (len(recording) - 1) * period
    if not 0.0 <= time_s <= last + period:
        raise RenderError(f"the recording has no moment {time_s:g} s: it ends at {last:g} s")
    return min(len(recording), int(time_s / period) + 1)


def _require(scene: Scene, cameras: Sequence[str], quality: str) -> None:
    if not len(scene.recording):
        raise RenderError("the recording has no samples: there is nothing to show")
    if not cameras:
        raise RenderError(f"no camera is named: the machine has {', '.join(scene.camera_names())}")
    for camera in cameras:
        scene.require_camera(camera)
    if quality not in QUALITIES:
        raise RenderError(f"no quality '{quality}': there are {', '.join(QUALITIES)}")


class Gauge:
    """Reads off a recording what the display shows."""

    def __init__(
        self,
        recording: Recording,
        contour_um: FloatArray | None,
        alarms: Sequence[tuple[float, str]] = (),
    ) -> None:
        """Take what the figures come from.

        Args:
            recording: The run.
            contour_um: Contour error of every sample [µm]; None: the lag is read.
            alarms: When the machine raised which alarm [s, text].
        """
        self._alarms = sorted(alarms)
        self._header = recording.header
        self._contour = contour_um
        self._last: Samples | None = None
        self._count = 0

    def display(self, source: Sequence[str], size: tuple[int, int], speed: float | None) -> Display:
        """A display for this run; a film has a speed, a still has none."""
        program = Path(self._header.program).name
        return Display(
            title=f"{program} · {self._header.machine}",
            source=source,
            axes=self._header.axes,
            size=size,
            speed=speed,
            error_name="lag" if self._contour is None else "contour",
        )

    def add(self, samples: Samples) -> None:
        """Go on by samples that follow the last ones."""
        if len(samples):
            self._last = samples[-1:]
            self._count += len(samples)

    def reading(self, warning: Callable[[int], str]) -> Reading:
        """What there is to read after the last sample.

        Args:
            warning: What to warn of while a program line runs, where there is no alarm.
        """
        assert self._last is not None
        header, last = self._header, self._last
        joints, setpoint = last.joint_position, last.setpoint
        if self._contour is None:
            position = header.part_frame.position
            away = position(joints)[0] - position(setpoint.position)[0]
            error = UM_PER_MM * float(np.linalg.norm(away))
        else:
            error = float(self._contour[self._count - 1])
        velocity = SECONDS_PER_MINUTE * last.joint_velocity[0]
        feed = float(np.linalg.norm(velocity[:3]))
        rotary = header.axes.rotary()
        turning = float(np.linalg.norm(velocity[rotary]))
        only_turns = feed < 1.0 < turning
        line, time = int(setpoint.line[0]), float(setpoint.time[0])
        raised = [text for since, text in self._alarms if since <= time]
        return Reading(
            line=line,
            position=joints[0] - header.part_zero,
            feed=turning if only_turns else feed,
            feed_unit="°/min" if only_turns else "mm/min",
            error_um=error,
            time_s=time,
            alarm=raised[-1] if raised else warning(line),
        )
