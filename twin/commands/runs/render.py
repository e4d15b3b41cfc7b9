"""``twin render``: films, stills, the part in colours, from a recording or a job."""

import dataclasses
import json
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import pydantic
import typer

from twin.commands.runs.pictures import FILM_STEM
from twin.commands.runs.run import run_and_print
from twin.compilation.announcement import announce_compilation
from twin.cutting.material import Material
from twin.cutting.measuring.inspection import Inspection
from twin.cutting.recut import COMMANDED, inspect_recorded, recut
from twin.errors import ExitCode, UsageError
from twin.files.atomic import write_text
from twin.job.job_file import VideoTable
from twin.render.encoder import FORMATS
from twin.render.film import film
from twin.render.inspection_still import inspection_still
from twin.render.scene.scene import RenderScene
from twin.render.still import Shot, moment, stills
from twin.run.progress import shown_progress
from twin.run.replay import event_time, open_scene
from twin.run.run_folder import INSPECTION_FILES, program_stem, without_verdict

RECORDING_SUFFIX = ".h5"
_FIGURES, _PICTURE, _PART = INSPECTION_FILES


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Wanted:
    """What to make of a recording.

    Attributes:
        video: Keys of the job's ``[video]`` table to change; None leaves one as it is.
        form: Of the film: ``mp4``, ``gif`` or ``webp``.
        film: Whether to film although something else is asked for.
        times: Moments for stills [s].
        lines: Source lines at whose end to draw stills.
        events: Names of events to draw stills of.
        glb: Whether to write the part in colours.
        inspect: STL of the nominal part, or ``commanded``; None: nothing is measured.
        tolerance_um: What the part is held to [µm]; None: the job's contour tolerance, and the
            exit code does not say whether it holds.
    """

    video: dict[str, Any] = dataclasses.field(default_factory=dict)
    form: str = "mp4"
    film: bool = False
    times: tuple[float, ...] = ()
    lines: tuple[int, ...] = ()
    events: tuple[str, ...] = ()
    glb: bool = False
    inspect: str | None = None
    tolerance_um: float | None = None

    @property
    def makes_film(self) -> bool:
        """Whether a film is wanted: where nothing else is, too."""
        return self.film or not (
            self.times or self.lines or self.events or self.glb or self.inspect
        )


def render_and_print(
    path: Path, out: Path | None, wanted: Wanted, *, dialect: str | None, machine: str | None
) -> ExitCode:
    """Make pictures of a recording, or of a job that is run first.

    Args:
        path: ``recording.h5``, an NC program or a job file.
        out: Folder for the pictures; beside the recording by default, ``out/<program>`` for a job.

    Raises:
        TwinError: Something is missing or wrong; see each error's exit code.
    """
    if f".{wanted.form}" not in FORMATS:
        known = ", ".join(suffix[1:] for suffix in FORMATS)
        raise UsageError(f"--format '{wanted.form}': films are written as {known}")
    announce_compilation()
    code = ExitCode.OK
    recording, folder = path, out or path.parent
    if path.suffix != RECORDING_SUFFIX:
        folder = out or Path("out") / program_stem(path)
        code = run_and_print(
            path, folder, dialect=dialect, machine=machine, video=False, strict=False
        )
        recording = folder / "recording.h5"
        if not recording.is_file():
            return code
    elif dialect is not None:
        raise UsageError("--dialect is for programs and jobs: a recording holds its own")
    earlier = without_verdict(folder, INSPECTION_FILES) if wanted.inspect else nullcontext()
    with earlier, open_scene(recording, machine=machine) as (scene, preparation):
        made = _Maker(scene, folder, wanted, preparation.job.file.video)
        within = made.make(preparation.job.file.tolerance.contour_um)
    return code or (ExitCode.OK if within else ExitCode.FAILED)


class _Maker:
    """Makes what is wanted of one scene and says so."""

    def __init__(self, scene: RenderScene, folder: Path, wanted: Wanted, video: VideoTable) -> None:
        self._scene, self._folder, self._wanted = scene, folder, wanted
        self._video = _changed(video, wanted.video)

    def make(self, default_tolerance_um: float) -> bool:
        """Make it all; returns whether a tolerance that was asked for holds."""
        scene, folder, wanted = self._scene, self._folder, self._wanted
        scene.require(self._video.cameras)
        shots = self._shots()
        found = None
        if wanted.inspect is not None:
            found = self._measure(wanted.inspect, wanted.tolerance_um or default_tolerance_um)
        if wanted.glb and found is None:
            self._write(folder / _PART, lambda out: self._part().write_glb(out))
        if shots:
            stills(
                scene,
                shots,
                cameras=self._video.cameras
                if self._video.layout == "split"
                else self._video.cameras[:1],
                size=self._video.size,
                quality=self._video.quality,
                renderer=self._video.renderer,
                display=self._video.display,
            )
            for shot in shots:
                typer.echo(str(shot.out))
        if wanted.makes_film:
            self._write(folder / f"{FILM_STEM}.{wanted.form}", self._film)
        return found is None or wanted.tolerance_um is None or found.holds

    def _film(self, out: Path) -> None:
        with shown_progress() as progress:
            film(
                self._scene,
                video=self._video,
                out=out,
                progress=lambda done, frames: progress("film", done / frames),
            )

    def _shots(self) -> list[Shot]:
        recording, wanted = self._scene.recording, self._wanted
        named = [
            *((f"{time:g}s", moment(recording, time_s=time)) for time in wanted.times),
            *((f"line-{line}", moment(recording, line=line)) for line in wanted.lines),
            *(
                (event, moment(recording, time_s=event_time(self._scene, event)))
                for event in wanted.events
            ),
        ]
        return [Shot(self._folder / f"still-{name}.png", end) for name, end in dict(named).items()]

    def _part(self) -> Material:
        if self._scene.stock is None:
            raise UsageError("the job has no [stock]: there is no part to write or to measure")
        return recut(self._scene.recording, self._scene.summary, self._scene.stock).material

    def _measure(self, nominal: str, tolerance_um: float) -> Inspection:
        scene = self._scene
        if scene.stock is None:
            raise UsageError("the job has no [stock]: there is no part to write or to measure")
        if nominal != COMMANDED and not Path(nominal).is_file():
            raise UsageError(f"--inspect {nominal}: give '{COMMANDED}' or an STL file")
        part = inspect_recorded(
            scene.recording,
            scene.summary,
            scene.stock,
            COMMANDED if nominal == COMMANDED else Path(nominal),
            tolerance_um,
        )
        found = part.found
        figures = found.as_json()
        self._write(
            self._folder / _FIGURES,
            lambda out: write_text(out, json.dumps(figures, indent=2) + "\n"),
        )
        if self._wanted.glb:
            self._write(self._folder / _PART, part.write_glb)
        self._write(
            self._folder / _PICTURE,
            lambda out: inspection_still(
                scene,
                part,
                out=out,
                size=self._video.size,
                quality=self._video.quality,
                renderer=self._video.renderer,
            ),
        )
        typer.echo(found.summary)
        return found

    def _write(self, out: Path, make: Callable[[Path], object]) -> None:
        make(out)
        typer.echo(str(out))


def _changed(video: VideoTable, changes: dict[str, Any]) -> VideoTable:
    """The job's video table with what the command line says."""
    given = {name: value for name, value in changes.items() if value is not None}
    if "seconds" in given:
        given.setdefault("speed", None)
    try:
        return VideoTable.model_validate({**video.model_dump(), **given})
    except pydantic.ValidationError as error:
        lines = [f"--{detail['loc'][0]}: {detail['msg']}" for detail in error.errors()]
        raise UsageError("; ".join(lines)) from error
