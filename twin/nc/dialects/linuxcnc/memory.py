"""What only LinuxCNC remembers from block to block."""

import dataclasses

from twin.nc.control.constructs import Structure
from twin.nc.control.control import Control
from twin.nc.control.modal import Modal

ControlPoint = tuple[float, float, float]
"""X, Y [mm] and weight of a control point of a NURBS."""
SYSTEMS = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3")
"""Coordinate systems in the order of their numbers, from 1."""


@dataclasses.dataclass(slots=True)
class CoordinateSystem:
    """One coordinate system.

    Attributes:
        origin: Its zero in part coordinates, shape (k,) [mm or deg].
        rotation: About Z [deg].
    """

    origin: list[float]
    rotation: float = 0.0


@dataclasses.dataclass(slots=True)
class SavedState:
    """What M70 and M73 put aside.

    Attributes:
        feed: F as it was written, or None.
        spindle: S, or None [1/min].
        preset_on: Whether G92 or G52 shifted.
    """

    modal: Modal
    feed: float | None
    spindle: float | None
    preset_on: bool


@dataclasses.dataclass(slots=True)
class LinuxcncMemory:
    """Coordinate systems, tool offset, subroutines, values that the program can read.

    Attributes:
        systems: Coordinate systems by number, from 1, as far as they are known.
        system: Number of the one in force.
        preset: Of G92 and G52, shape (k,) [mm or deg].
        kept_preset: What G92.3 puts back, shape (k,).
        tool_offset: Of G43, shape (k,) [mm or deg]; None: G49.
        offset_unit: Unit in force when it came into force [mm].
        homes: Positions of G28 and G30 in machine coordinates, shape (2, k).
        structure: Which O-words belong together; None before it was asked for.
        labels: Lines, from 0, of the O-words that have been run, by scope and name.
        saved: What M70 and M73 have put aside, by how deep the call is, and whether its end puts it back.
        subroutines: Lines, from 0, of the definitions of subroutines by name, in the order of the text.
        garbled: Lines, from 0, within a condition, a loop or a subroutine that begin as one with an O-word
            and are none, or hold an open comment.
        called: Names of those that have been called.
        returned: Value of the last subroutine, and whether it gave one.
        functions: M functions in force by what they switch.
        cycle: Number of the canned cycle whose words hold; 0: none do.
        back_boring: I, J and K of G87 [mm].
        compensation: Radius compensation in force, as ``compensation`` has it, or None.
        leading_out: It has ended, and no straight move has led out yet.
        spline_end: P and Q of the last G5 [mm]; None where another move came since.
        control_points: Of the NURBS that is being given.
        control_line: Line of its last point, from 1.
        prepared: T has prepared a tool: it stays so for the next M6.
        probe: Where the last probe ended, shape (k,) [unit of the program then, or deg].
        converted_feed: F as it was written, where the unit has changed since; else None.
        percent_ended: A second % has ended it.
    """

    systems: dict[int, CoordinateSystem] = dataclasses.field(default_factory=dict)
    system: int = 1
    preset: list[float] = dataclasses.field(default_factory=list)
    kept_preset: list[float] = dataclasses.field(default_factory=list)
    preset_on: bool = False
    tool_offset: list[float] | None = None
    offset_unit: float = 1.0
    homes: list[list[float]] = dataclasses.field(default_factory=list)
    structure: Structure | None = None
    labels: dict[str, int] = dataclasses.field(default_factory=dict)
    saved: dict[int, tuple[SavedState, bool]] = dataclasses.field(default_factory=dict)
    subroutines: dict[str, list[int]] = dataclasses.field(default_factory=dict)
    garbled: list[int] = dataclasses.field(default_factory=list)
    called: set[str] = dataclasses.field(default_factory=set)
    returned: tuple[float, bool] = (0.0, False)
    functions: dict[str, float] = dataclasses.field(default_factory=dict)
    cycle: int = 0
    back_boring: tuple[float, ...] = (0.0, 0.0, 0.0)
    compensation: object = None
    leading_out: bool = False
    spline_end: tuple[float, float] | None = None
    control_points: list[ControlPoint] = dataclasses.field(default_factory=list)
    control_line: int = 0
    spline_order: int = 3
    prepared: bool = False
    probe: list[float] = dataclasses.field(default_factory=list)
    converted_feed: float | None = None
    percent: bool = False
    percent_ended: bool = False


def memory_of(control: Control) -> LinuxcncMemory:
    """The dialect's memory."""
    assert isinstance(control.memory, LinuxcncMemory)
    return control.memory


def written_feed(control: Control) -> float | None:
    """F as it was written: a change of the unit leaves its number as it is (``rs274``)."""
    return memory_of(control).converted_feed or control.motion.feed
