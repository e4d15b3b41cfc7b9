"""What only the Fagor CNC 8070 remembers from block to block."""

import dataclasses
import math
from typing import NamedTuple

from twin.nc.bytecode.registers import (
    OFFSET_ON,
    POLAR_ABSCISSA,
    POLAR_ANGLE,
    POLAR_ORDINATE,
    POLAR_RADIUS,
    ROTATION,
    ROTATION_ABSCISSA,
    ROTATION_ORDINATE,
    SCALE,
    SIGNS,
)
from twin.nc.control.constructs import Structure
from twin.nc.control.control import Control
from twin.nc.geometry.arcs import Point
from twin.nc.geometry.matrices import Matrix
from twin.nc.geometry.planes import Vector
from twin.nc.text.blocks import Statement

OFFSETS_BY_NUMBER = 20
"""Work offsets that G159 and the table can name; the first six are G54 to G59."""

ModalCall = tuple[str, dict[str, float], Statement]


class PartFrame(NamedTuple):
    """The frame that #MCS has put aside.

    Attributes:
        shifts: Of every kind, shape (s, k) [mm or deg].
        matrix: Mirror, scale and rotation.
    """

    shifts: list[list[float]]
    matrix: Matrix


@dataclasses.dataclass(slots=True)
class FagorMemory:
    """Polar coordinates, subroutines, mirror, scale and rotation.

    Attributes:
        origin: Polar origin in the working plane, from part zero [mm].
        radius: R of the last polar move while it still holds, or None [mm].
        angle: Its Q, or None [deg].
        temporary: G31: this block's polar origin is the arc's centre.
        circle_radius: G263 or R1 in force, or None [mm].
        blend: I of the last G36 or G39 [mm]; 0: none yet.
        subroutines: First line of each local subroutine by name, from 0.
        library: First line of each global subroutine, from 0.
        headings: Lines of all headings, from 0, in order.
        main: Line of the program's heading, from 0, or None.
        structure: Which $ keywords belong together; None before it was asked for.
        modal_call: #MCALL in force.
        signs: -1 for each of X, Y and Z that is mirrored, else 1.
        scale: General scale factor.
        offset_on: D1 is in force, not D0.
        rotation: Angle [deg] and centre [mm] of a rotation in the plane, or None.
        part_frame: What #MCS has put aside while machine coordinates are in force, or None.
        offsets: Work offsets that the program has written, by name and axis, as those of the job.
    """

    origin: Point = (0.0, 0.0)
    radius: float | None = None
    angle: float | None = None
    temporary: bool = False
    circle_radius: float | None = None
    blend: float = 0.0
    subroutines: dict[str, int] = dataclasses.field(default_factory=dict)
    library: dict[str, int] = dataclasses.field(default_factory=dict)
    headings: list[int] = dataclasses.field(default_factory=list)
    main: int | None = None
    structure: Structure | None = None
    modal_call: ModalCall | None = None
    signs: Vector = (1.0, 1.0, 1.0)
    scale: float = 1.0
    offset_on: bool = True
    rotation: tuple[float, Point] | None = None
    part_frame: PartFrame | None = None
    offsets: dict[str, dict[str, float]] = dataclasses.field(default_factory=dict)


def memory_of(control: Control) -> FagorMemory:
    """The dialect's memory."""
    assert isinstance(control.memory, FagorMemory)
    return control.memory


def acts_on_plain_blocks(control: Control) -> bool:
    """A radius in force, a modal call, machine coordinates or module axes: plain blocks heed them."""
    memory = memory_of(control)
    return (
        memory.temporary
        or memory.modal_call is not None
        or memory.circle_radius is not None
        or memory.part_frame is not None
        or control.settings.module_rotary
    )


def registers(control: Control) -> dict[int, float]:
    """What the compiled tier is given of it; no polar origin while G53 is in force (E1530)."""
    memory = memory_of(control)
    abscissa, ordinate = memory.origin
    angle, center = (math.nan, (0.0, 0.0)) if memory.rotation is None else memory.rotation
    return {
        OFFSET_ON: float(memory.offset_on),
        POLAR_ABSCISSA: math.nan if control.active.get("offset") == 53 else abscissa,
        POLAR_ORDINATE: ordinate,
        POLAR_RADIUS: math.nan if memory.radius is None else memory.radius,
        POLAR_ANGLE: math.nan if memory.angle is None else memory.angle,
        **{SIGNS + axis: sign for axis, sign in enumerate(memory.signs)},
        SCALE: memory.scale,
        ROTATION: angle,
        ROTATION_ABSCISSA: center[0],
        ROTATION_ORDINATE: center[1],
    }


def take_registers(control: Control, values: list[float]) -> None:
    """Take it back."""
    memory = memory_of(control)
    memory.offset_on = values[OFFSET_ON] != 0.0
    if not math.isnan(values[POLAR_ABSCISSA]):
        memory.origin = (values[POLAR_ABSCISSA], values[POLAR_ORDINATE])
    radius, angle = values[POLAR_RADIUS], values[POLAR_ANGLE]
    memory.radius = None if math.isnan(radius) else radius
    memory.angle = None if math.isnan(angle) else angle
    memory.signs = (values[SIGNS], values[SIGNS + 1], values[SIGNS + 2])
    memory.scale = values[SCALE]
    center = (values[ROTATION_ABSCISSA], values[ROTATION_ORDINATE])
    memory.rotation = None if math.isnan(values[ROTATION]) else (values[ROTATION], center)


def offset_name(number: int) -> str:
    """How the job calls a work offset by its number, from 1."""
    return f"G{53 + number}" if number <= 6 else f"G159={number}"
