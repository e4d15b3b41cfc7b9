"""What only the Fagor CNC 8070 remembers from block to block."""

import dataclasses
import functools
import math
from typing import NamedTuple

from twin.nc.control.constructs import Structure
from twin.nc.control.control import Control
from twin.nc.geometry.arcs import Point
from twin.nc.geometry.frame import chained
from twin.nc.geometry.matrices import IDENTITY, Matrix
from twin.nc.geometry.planes import Vector
from twin.nc.iso.machine_coordinates import SuspendedFrame
from twin.nc.text.blocks import Statement

OFFSETS_BY_NUMBER = 20
"""Work offsets that G159 and the table can name; the first six are G54 to G59."""

ModalCall = tuple[str, dict[str, float], Statement]


class SpatialSystem(NamedTuple):
    """A coordinate system of #CS or #ACS.

    Attributes:
        directions: Of its axes, as columns.
        origin: [mm].
        solution: Of the rotary axes: 1 FIRST, -1 SECOND, 0 neither is asked for.
    """

    directions: Matrix
    origin: Vector
    solution: float = 0.0


KINDS = ("#ACS", "#CS")
"""Of coordinate systems, in the order in which they act."""


@dataclasses.dataclass(slots=True)
class FagorMemory:
    """Subroutines, offsets, tool, polar coordinates and transformations.

    Attributes:
        temporary: G31: this block's polar origin is the arc's centre.
        circle_radius: G263 or R1 in force, or None [mm].
        blend: I of the last G36 or G39 [mm]; 0: none yet.
        subroutines: First line of each local subroutine by name, from 0.
        library: First line of each global subroutine, from 0.
        headings: Lines of all headings, from 0, in order.
        main: Line of the program's heading, from 0, or None.
        structure: Which $ keywords belong together; None before it was asked for.
        part_frame: What #MCS has put aside while machine coordinates are in force, or None.
        offset_on: The tool in the spindle has its offset.
        polar_origin: In the working plane, from part zero [mm].
        polar_radius: R as programmed last [mm]; NaN: computed from where the tool is.
        polar_angle: Q as programmed last, likewise [deg].
        signs: Of X, Y and Z, -1 where they are mirrored.
        scale: Of all three.
        rotation: Its angle in the working plane [deg]; NaN: none.
        rotation_center: [mm].
        offsets: Work offsets that the program has written, by name and axis, as those of the job.
        systems: Coordinate systems that are stored, by kind and number; the one stored last is at the end.
        active: Those in force, by kind, in the order of their activation.
        orients: #TOOL ORI: the next motion block sets the tool perpendicular to the plane.
        led: The tip was led before that block.
    """

    temporary: bool = False
    circle_radius: float | None = None
    blend: float = 0.0
    subroutines: dict[str, int] = dataclasses.field(default_factory=dict)
    library: dict[str, int] = dataclasses.field(default_factory=dict)
    headings: list[int] = dataclasses.field(default_factory=list)
    main: int | None = None
    structure: Structure | None = None
    modal_call: ModalCall | None = None
    part_frame: SuspendedFrame | None = None
    offset_on: bool = True
    polar_origin: Point = (0.0, 0.0)
    polar_radius: float = math.nan
    polar_angle: float = math.nan
    signs: list[float] = dataclasses.field(default_factory=lambda: [1.0, 1.0, 1.0])
    scale: float = 1.0
    rotation: float = math.nan
    rotation_center: Point = (0.0, 0.0)
    offsets: dict[str, dict[str, float]] = dataclasses.field(default_factory=dict)
    systems: dict[str, dict[int, SpatialSystem]] = dataclasses.field(
        default_factory=lambda: {kind: {} for kind in KINDS}
    )
    active: dict[str, list[SpatialSystem]] = dataclasses.field(
        default_factory=lambda: {kind: [] for kind in KINDS}
    )
    orients: bool = False
    led: bool = False

    def combined(self, *kinds: str) -> tuple[Matrix, Vector]:
        """Directions of the axes, as columns, and origin of all systems of some kinds in force."""
        systems = [system[:2] for kind in kinds for system in self.active[kind]]
        return functools.reduce(chained, systems, (IDENTITY, (0.0, 0.0, 0.0)))

    @property
    def is_tilted(self) -> bool:
        """Whether a coordinate system is in force."""
        return any(self.active.values())


def memory_of(control: Control) -> FagorMemory:
    """The dialect's memory."""
    assert isinstance(control.memory, FagorMemory)
    return control.memory


def acts_on_lines(control: Control) -> bool:
    """A radius, a modal call, machine coordinates, systems in space or module axes, polar values that Cartesian moves end."""
    memory = memory_of(control)
    return (
        memory.temporary
        or memory.modal_call is not None
        or memory.circle_radius is not None
        or memory.part_frame is not None
        or memory.is_tilted
        or memory.orients
        or not math.isnan(memory.polar_radius)
        or control.settings.module_rotary
    )


def offset_name(number: int) -> str:
    """How the job calls a work offset by its number, from 1."""
    return f"G{53 + number}" if number <= 6 else f"G159={number}"
