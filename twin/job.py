"""The job file: which program, on which machine, with which stock, tools and tolerances."""

from pathlib import Path
from typing import Annotated, Literal

import pydantic
from pydantic import Field

from twin.errors import ConfigError
from twin.toml_file import Table, read_toml

Positive = Annotated[float, Field(gt=0)]

DEFAULT_MACHINE = "mill4"
DEFAULT_CONTOUR_UM = 20.0
"""Contour tolerance of a job that names none [µm]: what a general mill holds under IT7."""


class StockTable(Table):
    """The blank: ``box`` with size, ``cylinder`` with diameter and height."""

    shape: Literal["box", "cylinder"]
    size: tuple[Positive, Positive, Positive] | None = None
    """Box: along X, Y, Z [mm]."""
    diameter: Positive | None = None
    """Cylinder [mm]."""
    height: Positive | None = None
    """Cylinder [mm]."""
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Centre of the top face in program coordinates [mm]."""
    cell: Positive | None = None
    """Grid of the height map [mm]; none: a tenth of the tool's radius, 0.1 at the finest."""

    @pydantic.model_validator(mode="after")
    def _dimensions_fit_shape(self) -> "StockTable":
        box, round_ = self.size is not None, (self.diameter, self.height)
        if self.shape == "box" and (not box or any(value is not None for value in round_)):
            raise ValueError("shape 'box' needs size = [x, y, z] and nothing else")
        if self.shape == "cylinder" and (box or any(value is None for value in round_)):
            raise ValueError("shape 'cylinder' needs diameter and height and nothing else")
        return self

    @property
    def extent(self) -> tuple[float, float, float]:
        """Size of the box around the blank [mm]."""
        if self.size is not None:
            return self.size
        assert self.diameter is not None
        assert self.height is not None
        return (self.diameter, self.diameter, self.height)


class ToolTable(Table):
    """One tool of the job."""

    number: Annotated[int, Field(ge=0)]
    kind: Literal["flat", "ball"] = "flat"
    diameter: Positive = 10.0
    """Of the cutting edge [mm]."""
    length: Positive = 60.0
    """From the spindle nose to the tip, holder included [mm]."""
    flute: Positive = 25.0
    """Length of the cutting part [mm]."""


class ToleranceTable(Table):
    """What the verdict holds the run to."""

    contour_um: Positive = DEFAULT_CONTOUR_UM
    """Largest distance from the commanded path, seen from the part [µm]."""
    following_um: Positive | None = None
    """Largest following error of a linear axis [µm]; none: not judged."""
    following_mdeg: Positive | None = None
    """Largest following error of a rotary axis [mdeg]; none: not judged."""


class VideoTable(Table):
    """How the run is filmed."""

    cameras: tuple[str, ...] = ("overview",)
    """Named cameras, shown one after the other."""
    seconds: Positive = 12.0
    """Length of the video; the run is sped up or slowed down to fit [s]."""
    fps: Annotated[int, Field(ge=1, le=60)] = 25
    size: tuple[Annotated[int, Field(ge=64, le=1920)], Annotated[int, Field(ge=64, le=1080)]] = (
        1280,
        720,
    )


class JobFile(Table):
    """A job file; every key but ``program`` has a default."""

    program: str
    """NC program, relative to the job file."""
    dialect: str | None = None
    """One of ``twin dialects``; none: told apart by the program's own words."""
    machine: str = DEFAULT_MACHINE
    """A shipped machine's name, or a path relative to the job file."""
    default_feed: Positive | None = None
    """Feed where the program sets none [mm/min]; none: the machine's."""
    default_rotary_feed: Positive | None = None
    """The same for moves of rotary axes alone [deg/min]."""
    part_zero: dict[str, float] = Field(default_factory=dict)
    """Program zero in machine coordinates, by axis [mm or deg]; an axis left out: on the table's
    centre line, at the height of the stock's top face, other axes at 0."""
    start: dict[str, float] = Field(default_factory=dict)
    """Where the axes stand when the program starts, program coordinates [mm or deg]."""
    stock: StockTable | None = None
    tools: tuple[ToolTable, ...] = (ToolTable(number=1),)
    """The first is in the spindle at the start."""
    tolerance: ToleranceTable = ToleranceTable()
    video: VideoTable = VideoTable()

    @pydantic.field_validator("tools")
    @classmethod
    def _tools_distinct(cls, tools: tuple[ToolTable, ...]) -> tuple[ToolTable, ...]:
        numbers = [tool.number for tool in tools]
        if not tools or len(set(numbers)) != len(numbers):
            raise ValueError("tools must be at least one, each with its own number")
        return tools


class Job:
    """A job that was read.

    Attributes:
        folder: What relative paths in it are relative to.
        file: Its checked content.
        program: The NC program.
    """

    def __init__(self, folder: Path, file: JobFile) -> None:
        self.folder = folder
        self.file = file
        self.program = folder / file.program


def read_job(path: Path) -> Job:
    """Read a job file, or make the default job of an NC program.

    An NC program with a job file of the same stem beside it is run by that job.

    Args:
        path: A ``.toml`` job file, or an NC program.

    Raises:
        ConfigError: The job file is wrong, or the program does not exist.
    """
    beside = path.with_suffix(".toml")
    if path.suffix == ".toml":
        job = Job(path.parent, read_toml(path, JobFile))
    elif beside.is_file() and (job := Job(path.parent, read_toml(beside, JobFile))).program == path:
        pass
    else:
        job = Job(path.parent, JobFile(program=path.name))
    if not job.program.is_file():
        raise ConfigError(f"{job.program}: no such NC program")
    return job
