"""Scene files: a story, a machine with its faults, a program, and tasks that are checked.

A scene is one TOML file in a folder of its own or of several; what it names lies in that folder.
"""

import dataclasses
from pathlib import Path
from typing import Annotated, Any, Literal

import pydantic
from pydantic import Field

from twin.errors import ConfigError, UsageError
from twin.files.toml import Table, read_toml
from twin.job.job_file import JobFile
from twin.job.load import Job
from twin.run.preparing.preparation import Preparation, prepare_job
from twin.training.scene.confinement import Confinement, leaves_folder
from twin.training.scene.tasks import TaskTable
from twin.training.scene.vocabulary import Language, Text
from twin.training.scene.work_holding import with_work_holding

FaultKind = Literal["friction", "backlash", "dull_drive", "lost_offset", "alarm"]

FAULT_DEFAULTS: dict[FaultKind, tuple[float, str, str]] = {
    "friction": (1500.0, "N", "N m"),
    "backlash": (0.05, "mm", "deg"),
    "dull_drive": (0.4, "", ""),
    "lost_offset": (2.0, "mm", "deg"),
    "alarm": (0.0, "", ""),
}
"""What a fault is offered with: its value, and its unit for a linear and for a rotary axis."""


class FaultTable(Table):
    """One fault.

    ``friction``: dry friction of the axis [N or N m]. ``backlash``: play of the axis [mm or deg].
    ``dull_drive``: the share that is left of the axis's loop gain. ``lost_offset``: the part zero
    of the axis jumps by so much [mm or deg]. ``alarm``: the control stops for no reason.
    """

    kind: FaultKind
    """What is broken."""
    axis: Annotated[str, Field(max_length=8)] = ""
    """The axis that has it; an alarm has none."""
    value: Annotated[float, Field(ge=-1e6, le=1e6)] = 0.0
    """How much, in the unit of its kind."""

    @pydantic.model_validator(mode="after")
    def _fits(self) -> "FaultTable":
        if (self.kind == "alarm") == bool(self.axis):
            raise ValueError("an alarm has no axis, every other fault names one")
        if self.kind in ("friction", "backlash") and self.value < 0.0:
            raise ValueError(f"{self.kind} is 0 or more")
        if self.kind == "dull_drive" and not 0.05 <= self.value <= 1.0:
            raise ValueError("dull_drive leaves a share of 0.05 to 1 of the gain")
        return self


Mode = Literal["auto", "single", "jog", "mdi"]
"""Automatic, single block, manual jog, manual data input."""

MODES: tuple[Mode, ...] = ("auto", "single", "jog", "mdi")

FEED_OVERRIDES = (0, 120)
"""Ends of the feed override dial [%]."""
RAPID_OVERRIDES = (0, 100)
"""Ends of the rapid override dial [%]."""
SPINDLE_OVERRIDES = (50, 120)
"""Ends of the spindle override dial [%]."""

_SHIPPED = Path(__file__).resolve().parent.parent / "scenes"


class StartTable(Table):
    """How the machine and its control are found."""

    mode: Mode = "auto"
    """Automatic, single block, jog, or a line typed in."""
    position: dict[str, float] = Field(default_factory=dict)
    """Where the axes are, machine coordinates [mm or deg]; none: as the job's start says."""
    zero_error: dict[str, float] = Field(default_factory=dict)
    """How far the control's part zero is off the part's true one [mm or deg]."""
    tool_length_error: float = 0.0
    """How much longer the tool table has the tool in the spindle than it is [mm]."""
    spindle: bool = False
    """Whether the spindle turns already."""
    speed: Annotated[float, Field(gt=0)] | None = None
    """Commanded speed [1/min]; none: not set."""
    feed_override: Annotated[int, Field(ge=FEED_OVERRIDES[0], le=FEED_OVERRIDES[1])] = 100
    """Of programmed feeds [%]."""
    rapid_override: Annotated[int, Field(ge=RAPID_OVERRIDES[0], le=RAPID_OVERRIDES[1])] = 100
    """Of rapids [%]."""
    alarm: str = ""
    """An alarm that is active when the scene begins: ``hard-limit`` for an axis on its switch."""


class PictureTable(Table):
    """How the machine is shown."""

    camera: str = "table"
    """Named camera that the view begins with."""
    columns: Annotated[int, Field(ge=4, le=96)] = 40
    """Columns of the drawn stock along its longer side; the cutting itself is as fine as ever."""


class PartTable(Table):
    """What the finished part is known by: a program that ends has finished it only then."""

    removed_mm3: tuple[float, float] = (0.0, 1e12)
    """Least and most that has been cut off [mm³]."""
    points: tuple[tuple[float, float, float], ...] = ()
    """Where the part's surface lies: X, Y and Z in program coordinates at C0 [mm]."""
    tolerance: Annotated[float, Field(gt=0)] = 0.1
    """Of the points [mm]."""


class LessonTable(Table):
    """What the score sheet says about the scene's trap to somebody who fell into it."""

    cause: Text
    """What went wrong, and at which block."""
    consequence: Text
    """What it does to part, tool or machine."""
    right: Text
    """What would have been right."""

    @property
    def texts(self) -> tuple[Text, Text, Text]:
        """All of it, in this order."""
        return self.cause, self.consequence, self.right


class StepTable(Table):
    """A step of a scripted operator: a command, or something to wait for."""

    do: str | None = None
    """A command; its arguments stand in ``give``."""
    give: dict[str, Any] = Field(default_factory=dict)
    """Arguments of the command, such as ``{ axis = "X", direction = 1, step = 10.0 }``."""
    wait: Literal["rest", "alarm", "moving", "line", "end", "seconds", "contact"] | None = None
    """``rest``: the axes stand; ``end``: the program has ended; ``line``: that line runs;
    ``contact``: the feeler lamp is lit."""
    value: float = 0.0
    """The line, or the seconds."""

    @pydantic.model_validator(mode="after")
    def _one_of_both(self) -> "StepTable":
        if (self.do is None) == (self.wait is None):
            raise ValueError("a step has either do or wait")
        return self

    def command(self) -> dict[str, Any]:
        """The command as plain data."""
        return {"do": self.do, **self.give}


class SceneFile(Table):
    """A scene file."""

    schema_: Literal[1] = Field(alias="schema")
    """Version of this form."""
    title: Text
    """What the list of scenes and the page call it."""
    story: Text
    """What the operator reads first."""
    language: Language = "en"
    """Language of labels, messages and texts, unless ``--language`` names another."""
    job: JobFile
    """Program, machine, the part's true zero, stock and tools; as in a job file."""
    start: StartTable = StartTable()
    faults: tuple[FaultTable, ...] = ()
    """What is broken from the start."""
    tasks: Annotated[tuple[TaskTable, ...], Field(min_length=1)]
    part: PartTable | None = None
    """The part by which the condition ``finished`` is judged; none: the program's end is enough."""
    lesson: LessonTable | None = None
    """Shown on the score sheet of a scene that was handed in with less than all points."""
    hints: tuple[Text, ...] = ()
    """Given one after the other when the operator asks for one."""
    hint_cost: Annotated[int, Field(ge=0)] = 1
    """Points that a hint costs."""
    time_limit_s: Annotated[float, Field(gt=0)] = 1800.0
    """Machine time from the first touch after which the scene is judged [s]."""
    picture: PictureTable = PictureTable()
    guide: bool = False
    """Whether the page shows first-time users what to press; for scenes where that gives nothing away."""
    solution: tuple[StepTable, ...] = ()
    """A scripted operator who reaches full points."""
    mistake: tuple[StepTable, ...] = ()
    """A scripted operator who falls into the trap."""
    mistake_fails: tuple[int, ...] = ()
    """Numbers of the tasks that the mistake fails."""

    @pydantic.field_validator("job")
    @classmethod
    def _stay_in_folder(cls, job: JobFile) -> JobFile:
        named = [job.program, job.machine, (job.stock and job.stock.file) or ""]
        for name in named:
            if leaves_folder(name):
                raise ValueError(f"'{name}' leaves the scene's folder")
        return job


@dataclasses.dataclass(frozen=True)
class Scene:
    """A scene that was read.

    Attributes:
        cells_across: Cells of the live stock along its shorter side, at least; 0: as the job says.
    """

    name: str
    file: SceneFile
    preparation: Preparation
    cells_across: int = 0

    @property
    def points(self) -> int:
        """What all its tasks are worth."""
        return sum(task.points for task in self.file.tasks)


def scene_names() -> tuple[str, ...]:
    """Names of the shipped scenes, sorted."""
    return tuple(sorted(path.stem for path in _SHIPPED.glob("*.toml")))


def scene_path(name: str) -> Path:
    """Find a scene by its shipped name or its file.

    Raises:
        UsageError: There is none; the message lists the shipped ones.
    """
    if name in scene_names():
        return _SHIPPED / f"{name}.toml"
    path = Path(name)
    if path.suffix == ".toml" and path.is_file():
        return path
    raise UsageError(
        f"no scene '{name}': shipped scenes are {', '.join(scene_names())}; "
        "or give the path of a scene.toml"
    )


def read_scene(path: Path) -> Scene:
    """Read a scene with all that it names.

    Raises:
        ConfigError: The scene, or what it names, is wrong.
    """
    file = read_toml(path, SceneFile)
    folder = path.resolve().parent
    Confinement(path).require(file.job)
    if not (folder / file.job.program).is_file():
        raise ConfigError(f"{path}: no NC program '{file.job.program}' beside it")
    scene = Scene(path.stem, file, with_work_holding(prepare_job(Job(folder, file.job))))
    axes = scene.preparation.machine.axes.names
    named = [*file.start.position, *file.start.zero_error, *(f.axis for f in file.faults if f.axis)]
    for task in file.tasks:
        named += task.axes_named()
    for axis in named:
        if axis not in axes:
            raise ConfigError(f"{path}: no axis '{axis}': the machine has {', '.join(axes)}")
    return scene


_WITHOUT_END_S = 1e9
"""Time limit of a room without a lesson [s]."""


def scene_of_job(name: str, preparation: Preparation) -> Scene:
    """A room without a lesson: the machine of a job, for programs that come from elsewhere."""
    file = SceneFile(
        schema=1,
        title={"en": name},
        story={"en": "Programs come from a sender."},
        job=preparation.job.file,
        start=StartTable(mode="mdi"),
        tasks=(TaskTable(text={"en": "Run a program to its end."}, finished=True),),
        time_limit_s=_WITHOUT_END_S,
    )
    return Scene(name, file, preparation)
