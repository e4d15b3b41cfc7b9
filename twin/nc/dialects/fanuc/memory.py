"""What only a Fanuc control remembers from block to block."""

import dataclasses
import re
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from twin.nc.control.constructs import Structure
from twin.nc.control.control import Control
from twin.nc.geometry.arcs import Point
from twin.nc.geometry.matrices import Matrix
from twin.nc.geometry.planes import Vector
from twin.nc.path.compensation.stage import SideChange
from twin.nc.path.feed_rates import FeedMode
from twin.nc.text.blocks import Word
from twin.nc.text.lines import Lines


def letter_patterns(letter: str, rest: bytes) -> tuple[re.Pattern[bytes], ...]:
    """A letter of either case with what follows: two patterns, since each is found much faster alone."""
    return tuple(re.compile(each.encode() + rest) for each in (letter.upper(), letter.lower()))


def holds_any(lines: Lines, patterns: Iterable[re.Pattern[bytes]]) -> bool:
    """Whether one of the patterns is in any line."""
    return any(lines.any_holds(pattern) for pattern in patterns)


MODAL_GROUPS: Mapping[int, str] = {
    1: "motion",
    2: "plane",
    3: "distance",
    5: "feed",
    6: "units",
    7: "compensation",
    8: "length",
    9: "cycle",
    10: "return plane",
    11: "scale",
    12: "modal call",
    13: "spindle",
    14: "offset",
    15: "corner",
    16: "rotation",
    17: "polar",
    22: "mirror",
}
"""Modal groups by the number of the control, in which #4001 and those behind it count them."""


class Variant(NamedTuple):
    """What controls of the family do differently.

    Attributes:
        feed_increments: What F without a point counts, in mm/min and in inch/min.
        seconds_by_point: P of a dwell counts seconds where it has a point.
        repeats_in_p: P of M98 may hold how often the subprogram runs: P21000 is O1000, twice.
        deepest_call: Programs that may call each other.
        own_cycle_words: I, J and K of G73 and G83 are pecks that become less deep, J of G74 and G84 how fast
            a tap comes back.
        counting: Address that says how often a cycle's block drills.
        tool_variables: First and last system variable of each column of the offset memory.
        machine_by_motion: G53 moves by the motion code in force, not always rapidly.
        last_code_counts: A motion code overrules the code of a cycle before it in its block.
        modal_groups: Modal groups by the number in which #4001 and those behind it count them.
        further_offset: Code of the work offsets beyond G59, as the job names them.
        home_without_axes: G28 alone takes every axis home.
        first_alarm: Number of the alarm that #3000=0 would raise.
        common_by_thousands: #10100 is #100, and #10000 to #10999 belong to all programs.
        then_takes_words: Words may follow THEN.
        repeats_motion: L repeats the motion of its block.
        adds_rotation: When controls of this kind add the R of G68 in G91 to the rotation in force.
        reference_cancels_any_length: G28 cancels the tool length whatever axes it names, not with Z alone.
        side_change: How the tool goes over to the other side of a contour.
        transformed_keeps_origin: Neither work offsets nor presets nor moves to reference points are under
            a scale, a mirror or a rotation.
    """

    feed_increments: tuple[float, float] = (1.0, 0.01)
    seconds_by_point: bool = False
    repeats_in_p: bool = True
    deepest_call: int = 10
    own_cycle_words: bool = False
    counting: str = "K"
    machine_by_motion: bool = False
    last_code_counts: bool = True
    transformed_keeps_origin: bool = True
    reference_cancels_any_length: bool = False
    modal_groups: Mapping[int, str] = MODAL_GROUPS
    further_offset: str = "G54.1"
    home_without_axes: bool = False
    first_alarm: int = 3000
    common_by_thousands: bool = False
    then_takes_words: bool = False
    repeats_motion: bool = False
    side_change: SideChange = SideChange.EXTENDED
    adds_rotation: str = "a control with parameter 5400 #0 at 1 adds it"
    tool_variables: tuple[tuple[int, int, str], ...] = (
        (2001, 2200, "length_wear"),
        (2201, 2400, "length"),
        (10001, 10999, "length_wear"),
        (11001, 11999, "length"),
        (12001, 12999, "radius_wear"),
        (13001, 13999, "radius"),
    )


FANUC = Variant()
HAAS = Variant(
    feed_increments=(0.001, 0.0001),
    seconds_by_point=True,
    repeats_in_p=False,
    deepest_call=9,
    own_cycle_words=True,
    counting="L",
    machine_by_motion=True,
    reference_cancels_any_length=True,
    last_code_counts=False,
    side_change=SideChange.ALONG,
    transformed_keeps_origin=False,
    modal_groups={
        **{number: name for number, name in MODAL_GROUPS.items() if number <= 11},
        12: "offset",
        15: "corner",
        16: "rotation",
    },
    further_offset="G154",
    home_without_axes=True,
    first_alarm=1000,
    common_by_thousands=True,
    then_takes_words=True,
    repeats_motion=True,
    adds_rotation="a control with setting 73 ON adds it",
    tool_variables=(
        (2001, 2200, "length"),
        (2201, 2400, "length_wear"),
        (2401, 2600, "radius"),
        (2601, 2800, "radius_wear"),
    ),
)


class ModalCall(NamedTuple):
    """What G66 or G65 asks for.

    Attributes:
        line: First line of the program, from 0.
        values: Its arguments by their variables.
    """

    line: int
    often: int
    values: dict[str, float]
    word: Word


@dataclasses.dataclass(slots=True)
class ToolOffset:
    """A row of the offset memory, with what the program has written into it [mm].

    Attributes:
        length: Geometry of the length; None: that of the job's tool.
        radius: Geometry of the radius; None: that of the job's tool.
        length_wear: Added to the length.
    """

    length: float | None = None
    radius: float | None = None
    length_wear: float = 0.0
    radius_wear: float = 0.0


class PlaneBlock(NamedTuple):
    """What a block says of a tilted plane: X Y Z [mm], I J K [deg, or a vector], and R [deg]."""

    place: Vector
    angles: Vector
    turn: float


@dataclasses.dataclass(slots=True)
class FanucMemory:
    """Programs, offsets, transformations.

    Attributes:
        programs: Line behind the heading of each program by its number or name, from 0.
        headings: Lines of all headings, from 0, in order.
        main: Line of the heading of the program that runs first, or None.
        offsets: Work offsets that the program has written, by name and axis, as those of the job.
        common_offset: The external work offset, by axis [mm or deg].
        offset: Name of the work offset in force.
        tool_offsets: Rows of the offset memory that the program has written, by number.
        length_number: H in force; None: none yet.
        radius_number: D in force; None: none yet.
        intermediate: Where the last G28 or G30 passed, part coordinates by column, for G29.
        length_cancelled: Code that has cancelled the tool length while G43 or G44 stays in force; empty: none.
        overrules_cycles: Some line holds a motion code behind that of a cycle.
        feed_mode: What F counted when it was written.
        feed_lost: F was written for another feed mode and counts no more.
        polar: G16 is in force: plane coordinates are radius and angle.
        polar_center: Its origin, programmed coordinates of the plane [mm].
        polar_radius: Its last radius, or None [mm].
        polar_angle: Its last angle, or None [deg].
        scale: Factors of X, Y and Z, and their centre [mm].
        mirror: Coordinates of the axes of mirror images by column [mm].
        rotation: Angle [deg] and centre [mm] of a rotation in the plane, or None.
        tilt: Directions of a tilted plane's axes, as columns, and its origin [mm], or None.
        plane_form: P of a G68.2 that further blocks go on with, or None.
        plane_blocks: Those so far, by Q.
        cylinder: Column of the rotary axis and radius [mm] of G107, or None.
        loops: Those of the file; None before they were asked for.
        modal_call: G66 in force.
        modal_depth: Programs that were being run for callers when it was called.
        extended_number: P of the last G54.1.
        clocks: What the timers #3001 [ms] and #3002 [h] show.
    """

    variant: Variant = FANUC
    programs: dict[int | str, int] = dataclasses.field(default_factory=dict)
    headings: list[int] = dataclasses.field(default_factory=list)
    main: int | None = None
    offsets: dict[str, dict[str, float]] = dataclasses.field(default_factory=dict)
    common_offset: dict[str, float] = dataclasses.field(default_factory=dict)
    offset: str = "G54"
    tool_offsets: dict[int, ToolOffset] = dataclasses.field(default_factory=dict)
    length_number: int | None = None
    radius_number: int | None = None
    intermediate: dict[int, float] = dataclasses.field(default_factory=dict)
    length_cancelled: str = ""
    overrules_cycles: bool = False
    feed_mode: FeedMode = FeedMode.PER_MINUTE
    feed_lost: bool = False
    polar: bool = False
    polar_center: Point = (0.0, 0.0)
    polar_radius: float | None = None
    polar_angle: float | None = None
    scale: tuple[Vector, Vector] | None = None
    mirror: dict[int, float] = dataclasses.field(default_factory=dict)
    rotation: tuple[float, Point] | None = None
    tilt: tuple[Matrix, Vector] | None = None
    plane_form: int | None = None
    plane_blocks: dict[int, PlaneBlock] = dataclasses.field(default_factory=dict)
    cylinder: tuple[int, float] | None = None
    loops: Structure | None = None
    modal_call: ModalCall | None = None
    modal_depth: int = 0
    extended_number: int = 0
    clocks: dict[int, float] = dataclasses.field(default_factory=dict)


def memory_of(control: Control) -> FanucMemory:
    """The dialect's memory."""
    assert isinstance(control.memory, FanucMemory)
    return control.memory


def acts_on_lines(control: Control) -> bool:
    """Polar coordinates, a scale, a modal call or a cylinder in force, F lost: plain blocks depend on them."""
    memory = memory_of(control)
    if memory.length_cancelled or memory.overrules_cycles or control.settings.rollover is not None:
        return True
    if memory.feed_lost and control.motion.feed is None:
        return True
    remembered = (memory.scale, memory.modal_call, memory.cylinder, memory.tilt)
    return memory.polar or any(each is not None for each in remembered)


def refuse_transformed(control: Control, code: str) -> None:
    """What changes the origin, or leaves it, under a scale, a mirror or a rotation (manual of G51, G51.1, G68)."""
    memory = memory_of(control)
    transformed = memory.scale is not None or memory.mirror or memory.rotation is not None
    if memory.variant.transformed_keeps_origin and transformed:
        message = f"{code} cannot stand while a scale, a mirror or a rotation is in force"
        control.fail("rotation-active", message, hint="end them first: G50, G50.1, G69")
