"""What the compiled loop over plain blocks is given, changes and fills, as tuples of columns."""

from collections.abc import Iterable
from typing import NamedTuple, TypeAlias, cast

import numpy as np
import numpy.typing as npt

from twin.compilation.compilable import compilable
from twin.nc.canonical import FloatArray, IntArray
from twin.nc.geometry.frame import SHIFTS
from twin.nc.path.drilling_cycle import VALUES
from twin.nc.path.rows import Rows, copy, copy_rows

(
    INTERPOLATION,
    INCREMENTAL,
    CENTER_ABSOLUTE,
    UNIT,
    CORNER,
    FEED_MODE,
    PLANE,
    CYCLE,
    TO_REFERENCE,
    NOTHING,
    CORNER_TOLERANCE,
    SQUARE_CORNERS,
    INDIRECT_LEADS,
    CORRECT_CENTER,
    FREE_PLANE,
) = range(15)
"""Places in the modal state, as ``control.modal`` has them; ``NOTHING`` takes what codes without effect
set; from ``FREE_PLANE`` on stand the directions of a plane that lies not along the axes."""
OF_PLAIN_BLOCKS = NOTHING + 1
"""The places before this one are those that plain blocks set and heed."""
ACTIVE = FREE_PLANE + 9
"""Behind them stands the G code in force in each group; NaN: none."""
(
    PROGRAMMED_FEED,
    SPINDLE,
    SELECTED,
    IN_SPINDLE,
    OFFSET_ON,
    POLAR_ABSCISSA,
    POLAR_ORDINATE,
    POLAR_RADIUS,
    POLAR_ANGLE,
    SCALE,
    ROTATION,
    ROTATION_ABSCISSA,
    ROTATION_ORDINATE,
    TURNED,
    RADIUS_GIVEN,
    SPINDLE_TURNS,
    ACCELERATION,
    DECELERATION,
    RAPID_FEED,
) = range(19)
SIGNS = 19
CYCLE_STATE = 22
CYCLE_WORDS = CYCLE_STATE + VALUES
MATRIX = CYCLE_WORDS + VALUES
REGISTERS = MATRIX + 9
"""Places in the registers: F; S; the tool that comes next and the one that is in use; whether it has
its offset; the polar origin, the last R and Q; the scale; angle and centre of the rotation in the
plane; whether the frame's matrix is not the identity; the tool's radius that the program gave; whether
M3 or M4 is in force; acceleration and deceleration that the program sets; the feed that it gives to
rapids; the signs of X, Y and Z, -1 where they are mirrored; what the drilling cycle in force remembers, as
``drilling_cycle`` counts it, and the same of the words of the block; the matrix, row by row. Those of a
dialect's own stand behind them. NaN: none."""
Cells: TypeAlias = "memoryview[float]"
"""A column as Python reads and writes it one by one, without a NumPy object for each value."""
BAILOUT = -3
"""An instruction or a move is left to the interpreter tier; neither ``UNSUPPORTED`` nor ``NO_ROOM``."""
MOST_EVENTS = 16
"""Events of a block."""

NO_MOTION, RAPID_LINE, FEED_LINE, ARC, DRILLING = range(5)
"""Kinds of modes of motion; ``NO_MOTION`` are those without a compiled form."""

MOST_WORDS = 32
"""Words of a plain block; longer ones are read by the interpreter tier."""
CODES = 1000
"""G and M codes are below this number."""
EARLY, LATE = range(2)
"""When functions are reported: before the move of their block, or behind it."""


class BlockTables(NamedTuple):
    """What plain blocks mean in a dialect, on a machine.

    Attributes:
        field: Which place of the modal state each G code sets, shape (``CODES``,); ``UNSUPPORTED``
            for codes that do more.
        value: To what it sets it, shape (``CODES``,).
        group: Its modal group, shape (``CODES``,).
        cycle: Which drilling cycle each G code begins, 0 where it ends one, ``UNSUPPORTED`` where it
            does neither, shape (``CODES``,).
        cycles: What is peculiar to each, as ``drilling_cycle.Cycle`` has it, and behind that which of its
            values a word with each token kind gives, ``UNSUPPORTED`` for none, shape
            (i, 8 + token_kinds).
        function: Whether each M code is reported ``EARLY``, before its block's move, or ``LATE``,
            shape (``CODES``,); ``UNSUPPORTED`` for codes that do more than that.
        kind: Kind of each mode of motion, as interpolation or cycle, shape (i,).
        clockwise: Of arcs, shape (i,).
        bounds: How badly the centre of an arc may fit, as ``arcs.Bounds`` has it, shape (i, 4).
        signed_radius: A negative radius asks for the larger arc, else it is not plain, shape (i,).
        fits_radius: A centre found by its radius is fitted like a given one, shape (i,).
    """

    field: IntArray
    value: FloatArray
    group: IntArray
    cycle: IntArray
    cycles: FloatArray
    function: IntArray
    kind: IntArray
    clockwise: npt.NDArray[np.bool_]
    bounds: FloatArray
    signed_radius: npt.NDArray[np.bool_]
    fits_radius: npt.NDArray[np.bool_]


class Constants(NamedTuple):
    """What stays as it is during a run.

    Attributes:
        default_feed: Where none is programmed [mm/min].
        default_rotary_feed: Where none is programmed and only rotary axes move [deg/min].
        feed_may_lack: A feed move without a programmed feed was warned of already.
        own_rapid_feed: Feed per second of rapids that the program paces, 0 where they follow F;
            NaN: ``RAPID_FEED`` counts.
        linear: Which axes are linear, shape (k,).
        planes: Columns of abscissa, ordinate and normal of each plane, shape (3, 3).
        directions: Their directions, shape (3, 3, 3).
        tools: Numbers of the tools that the job lists, shape (t,).
        longer: How much longer each is than the first, and at last any other, shape (t + 1,) [mm].
        radii: Of each, and at last of any other, NaN where there is none, shape (t + 1,) [mm].
        over: Room for where the hole lies, shape (k,).
        room: Room for the way there, shape (3, k).
        hole: Room for what the cycle remembers, for the block's words, for what happens at a hole,
            and for its heights and seconds, shape (4, a).
    """

    default_feed: float
    default_rotary_feed: float
    feed_may_lack: bool
    own_rapid_feed: float
    linear: npt.NDArray[np.bool_]
    planes: IntArray
    directions: FloatArray
    tools: FloatArray
    longer: FloatArray
    radii: FloatArray
    over: FloatArray
    room: FloatArray
    hole: FloatArray


class State(NamedTuple):
    """What both tiers remember of a control; the arrays are written to.

    Attributes:
        modal: What is in force, shape (``ACTIVE`` + g,).
        programmed: Programmed position, shape (k,) [mm or deg].
        part: Part position, shape (k,) [mm or deg].
        event_count: Events that were reported, shape (1,).
        registers: Shape (``REGISTERS`` + those of the dialect's own,).
        shifts: In the order of ``frame.SHIFTS``, shape (s, k) [mm or deg].
        total: Their sum, from programmed to part coordinates, shape (k,) [mm or deg].
        target: The coordinates that a block gives to the place where it stands, shape (k,).
    """

    modal: FloatArray
    programmed: FloatArray
    part: FloatArray
    event_count: IntArray
    registers: FloatArray
    shifts: FloatArray
    total: FloatArray
    target: FloatArray


def new_state(start: list[float], modal: FloatArray, own: Iterable[float] = ()) -> State:
    """The state of a control that has run nothing.

    Args:
        start: Where it stands, shape (k,) [mm or deg].
        modal: What is in force.
        own: What the registers of its dialect's own begin with.
    """
    registers = np.append(np.full(REGISTERS, np.nan), tuple(own))
    registers[SCALE] = registers[SIGNS:CYCLE_STATE] = 1.0
    nothing = [POLAR_ABSCISSA, POLAR_ORDINATE, TURNED, RADIUS_GIVEN, SPINDLE_TURNS]
    registers[OFFSET_ON], registers[nothing] = 1.0, 0.0
    registers[MATRIX:REGISTERS] = np.identity(3).ravel()
    axes = len(start)
    return State(
        modal=modal,
        programmed=np.array(start),
        part=np.array(start),
        event_count=np.zeros(1, np.int64),
        registers=registers,
        shifts=np.zeros((len(SHIFTS), axes)),
        total=np.zeros(axes),
        target=np.zeros(axes),
    )


def cells(column: FloatArray) -> Cells:
    """A column, one by one."""
    return cast("Cells", column.data)


class Machine(NamedTuple):
    """What blocks run on.

    Attributes:
        tables: What words mean.
        constants: What stays.
        state: What changes with moves.
        rows: Room for moves and events.
    """

    tables: BlockTables
    constants: Constants
    state: State
    rows: Rows


@compilable
def copy_state(source: State, target: State) -> None:
    """Copy every column of a state."""
    copy(source.modal, target.modal)
    copy(source.programmed, target.programmed)
    copy(source.part, target.part)
    copy(source.registers, target.registers)
    copy(source.total, target.total)
    copy_rows(source.shifts, target.shifts)
    target.event_count[0] = source.event_count[0]
