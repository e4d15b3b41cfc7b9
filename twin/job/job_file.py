"""The job file: which program, on which machine, with which stock, tools and tolerances."""

from pathlib import Path
from typing import Annotated, Literal

import pydantic
from pydantic import Field

from twin.files.stl import stl_extent
from twin.files.toml import Table
from twin.job.builder import Coordinate, MachineFunctions, Positive, ToolChangeTable, Triple
from twin.job.fixture import FixtureTable
from twin.job.tolerance import BaselineTable, ToleranceTable

DEFAULT_MACHINE = "mill4"


class StockTable(Table):
    """The blank: ``box``, ``cylinder``, ``tube``, or the shape of an ``stl`` file."""

    shape: Literal["box", "cylinder", "tube", "stl"]
    """Each shape has its own measures: size; diameter and height; these and bore; file."""
    size: tuple[Positive, Positive, Positive] | None = None
    """Box: along X, Y, Z [mm]."""
    diameter: Positive | None = None
    """Cylinder and tube [mm]."""
    height: Positive | None = None
    """Cylinder and tube [mm]."""
    bore: Positive | None = None
    """Tube: diameter of its hole [mm]."""
    axis: Literal["X", "Y", "Z"] | None = None
    """Cylinder and tube: along which axis of the program it lies, such as a bar in the chuck of a rotary table A; none:
    Z, upright."""
    file: str | None = None
    """STL: its file [mm], relative to the job file."""
    position: Triple = (0.0, 0.0, 0.0)
    """Centre of the top face in program coordinates [mm]; of the box around an STL, or a cylinder that lies."""
    relief: Positive | None = None
    """How deep parallels or a post below it leave room for drills and cutters that go through its lower face
    [mm]; none: they reach up to it."""
    cell: Positive | None = None
    """Grid of the height map [mm]; none: a tenth of the smallest tool's radius, or a fortieth of the
    stock's shorter side where that is less, 0.1 at the finest."""
    material: str | None = None
    """What it is made of, for the cutting force and its weight; none: no force is computed."""
    specific_force: Positive | None = None
    """Its own kc1.1: force on a chip 1 mm wide and 1 mm thick [N/mm²]; with ``exponent``."""
    exponent: Annotated[float, Field(ge=0, lt=1)] | None = None
    """Its own mc: how the specific force falls with the chip's thickness."""
    density: Positive | None = None
    """For its weight, which the axes below it move [g/cm³]; none: its material's, and without one it
    weighs nothing."""

    @pydantic.model_validator(mode="after")
    def _dimensions_fit_shape(self) -> "StockTable":
        given = {name for name in _DIMENSIONS if getattr(self, name) is not None}
        needed = _SHAPES[self.shape]
        if given != set(needed):
            raise ValueError(f"shape '{self.shape}' needs {' and '.join(needed)} and nothing else")
        if (self.specific_force is None) != (self.exponent is None):
            raise ValueError("specific_force and exponent are given together")
        if self.bore is not None and self.diameter is not None and self.bore >= self.diameter:
            raise ValueError("the bore of a tube must be smaller than its diameter")
        if self.axis is not None and self.diameter is None:
            raise ValueError("axis is for shapes 'cylinder' and 'tube'")
        return self

    @property
    def direction(self) -> int:
        """Along which axis its height counts: 0, 1, 2 for X, Y, Z."""
        return "XYZ".index(self.axis or "Z")

    @property
    def lies(self) -> bool:
        """Whether it is a cylinder or a tube that does not stand on its end."""
        return self.axis in ("X", "Y")

    @property
    def on_post(self) -> bool:
        """Whether a post carries it where it does not lie on the table; else two parallels."""
        return self.shape != "box" and not self.lies

    @property
    def extent(self) -> tuple[float, float, float]:
        """Size of the box around the blank [mm].

        Raises:
            ConfigError: The STL file cannot be read.
        """
        if self.size is not None:
            return self.size
        if self.file is not None:
            return stl_extent(Path(self.file))
        assert self.diameter is not None
        assert self.height is not None
        along = [self.diameter] * 3
        along[self.direction] = self.height
        return (along[0], along[1], along[2])


_DIMENSIONS = ("size", "diameter", "height", "bore", "file")
_SHAPES = {
    "box": ("size",),
    "cylinder": ("diameter", "height"),
    "tube": ("diameter", "height", "bore"),
    "stl": ("file",),
}


_POINT_ANGLES = {"drill": 118.0, "chamfer": 90.0}
"""Included angles of points where the job names none [deg]; a drill's after DIN 1412, form A."""

_TEETH_OVER_CENTRE = 3
"""End mills with so many teeth at most are slot drills, which have an edge over the centre (DIN 327)."""

_USUAL_HELIX = 30.0
"""Helix angle of end mills where the job names none [deg]: DIN 1836, type N."""


class ToolTable(Table):
    """One tool of the job."""

    number: Annotated[int, Field(ge=0)]
    """By which the program calls it."""
    name: str = ""
    """By which a program may call it instead, such as ``T="MILL_10"``."""
    kind: Literal["flat", "ball", "bull", "drill", "chamfer"] = "flat"
    """Shape of its end: flat, round, flat with a round corner, or a point."""
    diameter: Positive = 10.0
    """Of the cutting edge [mm]."""
    length: Positive = 60.0
    """From the spindle nose to the tip, holder included [mm]."""
    flute: Positive = 25.0
    """Length of the cutting part [mm]."""
    corner: Positive | None = None
    """Bull-nose: radius of the corner [mm]."""
    radius_offset: Annotated[float, Field(ge=0)] | None = None
    """What the control's tool table holds as its radius [mm]; none: half the diameter. 0 where the program's contours
    are the path of the tool's centre already and the table has only the wear (posts: "wear" compensation)."""
    angle: Annotated[float, Field(gt=0, lt=180)] | None = None
    """Drill and chamfer: included angle of the point [deg]; none: 118 and 90."""
    tip: Annotated[float, Field(ge=0)] = 0.0
    """Chamfer: diameter of the flat at the tip [mm]."""
    shank: Positive | None = None
    """Diameter above the flutes [mm]; none: that of the cutting edge."""
    free_length: Positive | None = None
    """From the holder to the tip [mm]; none: the flutes and three eighths of the rest."""
    holder: Positive = 32.0
    """Diameter of the holder's nut [mm]."""
    teeth: Annotated[int, Field(ge=1)] = 2
    """Cutting edges, for the cutting force."""
    helix: Annotated[float, Field(ge=0, le=60)] | None = None
    """Helix angle of the edges, for the cutting force [deg]; none: 30, of drills and chamfer cutters 0."""
    speed: Positive | None = None
    """Spindle speed for the cutting force [1/min]; none: no force is computed."""
    hand: Literal["right", "left"] = "right"
    """Direction of rotation in which it cuts, seen from the spindle: ``right`` clockwise (M3)."""
    center_cutting: bool | None = None
    """Whether an end mill cuts over its centre, so that it may plunge; none: with two or three teeth it
    does, as slot drills after DIN 327 do; with more it is not known."""
    made_of: Literal["carbide", "hss"] = "carbide"
    """Cemented carbide or high-speed steel: how far it bends, and where it breaks."""
    force_limit: Positive | None = None
    """Level force that breaks it [N]; none: from its diameter, lengths and what it is made of."""
    torque_limit: Positive | None = None
    """Torque that twists it off [N m]; none: from its diameter and what it is made of."""
    thrust_limit: Positive | None = None
    """Force along its axis under which it breaks [N]; none: at which it buckles."""
    chip_limit: Positive | None = None
    """Chip that breaks an edge [mm]; none: a twentieth of the diameter."""
    speed_limit: Positive | None = None
    """Speed beyond which it flies apart [1/min]; none: not watched."""

    @pydantic.model_validator(mode="after")
    def _shape_is_whole(self) -> "ToolTable":
        if (self.corner is not None) != (self.kind == "bull"):
            raise ValueError("kind 'bull', and no other, needs corner = its radius")
        if self.corner is not None and 2 * self.corner > self.diameter:
            raise ValueError("the corner of a bull-nose cutter is at most half its diameter")
        if self.angle is not None and self.kind not in ("drill", "chamfer"):
            raise ValueError("angle belongs to the kinds 'drill' and 'chamfer'")
        if self.tip and (self.kind != "chamfer" or self.tip >= self.diameter):
            raise ValueError("tip belongs to the kind 'chamfer' and is smaller than its diameter")
        if self.free_length is not None and self.free_length > self.length:
            raise ValueError("free_length is at most the length")
        return self

    @property
    def table_radius(self) -> float:
        """Its radius in the control's tool table [mm]."""
        return self.diameter / 2.0 if self.radius_offset is None else self.radius_offset

    @property
    def point_angle(self) -> float | None:
        """Included angle of a conical end [deg]; None: the end is flat or round."""
        return self.angle or _POINT_ANGLES.get(self.kind)

    @property
    def helix_angle(self) -> float:
        """Helix angle of the edges [deg]."""
        if self.helix is not None:
            return self.helix
        return 0.0 if self.kind in _POINT_ANGLES else _USUAL_HELIX

    @property
    def plunges(self) -> bool:
        """Whether it is known to cut where it is driven straight down."""
        if self.kind in ("drill", "ball") or self.center_cutting is not None:
            return self.center_cutting is not False
        return self.kind != "chamfer" and self.teeth <= _TEETH_OVER_CENTRE

    @property
    def below_holder(self) -> float:
        """From the holder to the tip [mm]."""
        if self.free_length is not None:
            return self.free_length
        flute = min(self.flute, 0.8 * self.length)
        return flute + 0.375 * (self.length - flute)


class NominalTable(Table):
    """The part as it shall be, which no cutter may reach into."""

    file: str
    """STL in program coordinates [mm], relative to the job file; the highest surface counts."""
    gouge_um: Positive = 100.0
    """How far into its surface, floors and walls, the tool may cut [µm]."""
    standing_um: Positive | None = None
    """How far beyond its surface material may be left at the end [µm]; not judged by default, since a program
    may be one of several that make the part."""
    gouge: Literal["fail", "alarm"] = "fail"
    """What a deeper cut is: a tolerance that is not kept, or an alarm that stops the machine."""


class VideoTable(Table):
    """How the run is filmed."""

    cameras: tuple[str, ...] = ("overview",)
    """Named cameras, shown one after the other."""
    layout: Literal["sequence", "split"] = "sequence"
    """``split``: all cameras at once, side by side."""
    display: bool = True
    """Whether program, axes, feed and error are shown over the picture."""
    seconds: Positive = 12.0
    """Length of the video; the run is sped up or slowed down to fit [s]."""
    speed: Positive | None = None
    """Times faster than real time, instead of a length."""
    quality: Literal["draft", "final"] = "draft"
    """``final`` has shadows, smooth edges and a finer stock, and takes several times as long."""
    renderer: Literal["opengl", "filament"] = "opengl"
    """``filament`` is physically based: it needs a Vulkan driver and takes longer."""
    fps: Annotated[int, Field(ge=1, le=60)] = 25
    """Frames per second."""
    size: tuple[Annotated[int, Field(ge=64, le=1920)], Annotated[int, Field(ge=64, le=1080)]] = (
        1280,
        720,
    )
    """Width and height of a frame [pixels]."""


class JobFile(Table):
    """A job file; every key but ``program`` has a default.

    ``extends = "other.toml"`` takes what the job does not say from another file, and a ``twin.toml``
    in its folder or above it is taken so without being named.
    """

    program: str
    """NC program, relative to the job file."""
    dialect: str | None = None
    """One of ``twin dialects``; none: recognised from the program."""
    machine: str = DEFAULT_MACHINE
    """A shipped machine's name, or a path relative to the job file."""
    axes: dict[Annotated[str, Field(pattern="^[A-Z]$")], str] = Field(default_factory=dict)
    """Words of axes that the machine lacks: ``A = "C"``, the axis of the machine that A stands for, or
    ``A = "ignored at 0"``, allowed while it stays 0."""
    default_feed: Positive | None = None
    """Feed where the program sets none [mm/min]; none: the machine's."""
    default_rotary_feed: Positive | None = None
    """Feed of moves of rotary axes alone where the program sets none [deg/min]; none: the machine's."""
    part_zero: dict[str, Coordinate] = Field(default_factory=dict)
    """Program zero in machine coordinates, by axis [mm or deg]; an axis left out: on the table's
    centre line, at the height of the stock's top face, other axes at 0."""
    written_zero: dict[str, Coordinate] = Field(default_factory=dict)
    """What the program itself writes into the control's table for the work offset that lies at part zero (G10 L2,
    #5221, $P_UIFR), by axis, in coordinates of the machine that it was written for [mm or deg]; none: in this one's."""
    start: dict[str, Coordinate] = Field(default_factory=dict)
    """Where the axes are when the program starts, program coordinates [mm or deg]."""
    stock: StockTable | None = None
    nominal: NominalTable | None = None
    tools: tuple[ToolTable, ...] = (ToolTable(number=1),)
    """The first is in the spindle at the start."""
    tool_change: ToolChangeTable = ToolChangeTable()
    """Height to which Z goes by itself before a tool change; overrides the machine's."""
    fixtures: tuple[FixtureTable, ...] = ()
    """What holds the part, in addition to what the machine file puts on its table."""
    cutting_load: bool = False
    """The cutting force pushes the axes; the stock's material and a spindle speed must be known. With
    ``cutting_force = "teeth"`` it does so without this key."""
    cutting_force: Literal["teeth", "mean", "none"] = "teeth"
    """Of a stock whose material is known: ``teeth``, the force of every tooth acts while it is cut, the tool
    bends and may break; ``mean``, the mean force is reported, and with ``cutting_load`` computed ahead, but it
    bends and breaks no tool: contour errors come out several times too small where a tool deflects, and the
    part does not show it; ``none``, the mean force is only reported. The page of ``twin/coupling`` has one
    job by both methods."""
    offsets: dict[str, dict[str, Coordinate]] = Field(default_factory=dict)
    """Work offsets by name (``G54``), each by axis, from part zero [mm or deg]."""
    offset_rows: dict[Annotated[int, Field(ge=1)], Annotated[int, Field(ge=0)]] = Field(
        default_factory=dict
    )
    """``fanuc``, ``haas``: rows of the offset memory that hold the length and the radius of a tool of another number:
    ``31 = 1`` lets D31 and H31 be tool 1's."""
    variables: dict[str, float] = Field(default_factory=dict)
    """Values of variables that the program reads but does not set, by their name in it."""
    m_functions: MachineFunctions = Field(default_factory=dict)
    """M codes of the machine's builder that the program holds, in addition to the machine file's:
    ``M10 = "clamp the table"``, with a time ``M22 = { meaning = "pallet", dwell = 4.0 }``."""
    block_skip: bool | tuple[Annotated[int, Field(ge=1, le=9)], ...] = False
    """Blocks that begin with a slash are left out; ``[1, 3]``: those with ``/``, ``/1`` and ``/3``."""
    decimal_point: Literal["calculator", "increments"] | None = None
    """``fanuc``, ``haas``: ``X10`` is 10 mm ("calculator"), or 0.010 mm ("increments"); missing: as
    the machine file says, else as the control does when it comes from its maker."""
    rollover: Literal["shorter", "sign"] | None = None
    """``fanuc``: absolute targets of rotary axes are those of a turn, reached by the shorter path, or in the direction of
    their sign; missing: as the machine file says, else as they are written."""
    units: Literal["mm", "inch"] | None = None
    """In which units the program begins where it names none; missing: as the machine file says, else mm."""
    step_limit: Annotated[int, Field(gt=0)] = 20_000
    """Blocks that may be run again through jumps and loops before the program counts as endless."""
    expect: Annotated[str, Field(pattern="^[a-z0-9_-]+$")] | None = None
    """Code of the alarm, tolerance or diagnostic that the job is to end with; ``twin check`` then
    passes it, and fails it where it ends otherwise."""
    tolerance: ToleranceTable = ToleranceTable()
    baseline: BaselineTable = BaselineTable()
    video: VideoTable = VideoTable()

    @pydantic.model_validator(mode="after")
    def _nominal_needs_stock(self) -> "JobFile":
        if self.nominal is not None and self.stock is None:
            raise ValueError("a nominal part needs a [stock] that it is cut from")
        return self

    @pydantic.model_validator(mode="after")
    def _load_needs_force(self) -> "JobFile":
        if self.cutting_load and self.cutting_force == "none":
            raise ValueError('cutting_load needs a force: cutting_force "mean" or "teeth"')
        return self

    @pydantic.model_validator(mode="after")
    def _rows_are_of_tools(self) -> "JobFile":
        numbers = {0, *(tool.number for tool in self.tools)}
        for row, number in self.offset_rows.items():
            if "tools" in self.model_fields_set and number not in numbers:
                raise ValueError(f"offset_rows.{row}: no tool of the job has the number {number}")
        return self

    @pydantic.field_validator("tools")
    @classmethod
    def _tools_distinct(cls, tools: tuple[ToolTable, ...]) -> tuple[ToolTable, ...]:
        numbers = [tool.number for tool in tools]
        if not tools or len(set(numbers)) != len(numbers):
            raise ValueError("tools must be at least one, each with its own number")
        return tools
