"""What only the Fagor CNC 8070 remembers from block to block."""

import dataclasses

from twin.nc.arcs import Point
from twin.nc.blocks import Statement
from twin.nc.control import Control
from twin.nc.dialects.fagor8070.structure import Structure

ModalCall = tuple[str, dict[str, float], Statement]


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
        mirrored: Columns of the mirrored axes.
        scale: General scale factor.
        offset_on: D1 is in force, not D0.
        rotation: Angle [deg] and centre [mm] of a rotation in the plane, or None.
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
    mirrored: frozenset[int] = frozenset()
    scale: float = 1.0
    offset_on: bool = True
    rotation: tuple[float, Point] | None = None


def memory_of(control: Control) -> FagorMemory:
    """The dialect's memory."""
    assert isinstance(control.memory, FagorMemory)
    return control.memory


def acts_on_plain_blocks(control: Control) -> bool:
    """Polar values, a radius in force, a modal call or module axes: plain blocks heed them."""
    memory = memory_of(control)
    return (
        memory.temporary
        or memory.modal_call is not None
        or not (memory.radius is memory.angle is memory.circle_radius is None)
        or control.settings.module_rotary
    )
