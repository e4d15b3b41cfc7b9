"""What only the SINUMERIK remembers from block to block."""

import dataclasses
import enum
import math

from twin.nc.control.constructs import Structure
from twin.nc.control.control import Control
from twin.nc.geometry.arcs import Point
from twin.nc.geometry.matrices import IDENTITY, Matrix
from twin.nc.geometry.planes import Vector
from twin.nc.iso.machine_coordinates import SuspendedFrame
from twin.nc.text.blocks import Statement
from twin.nc.text.expressions.arithmetic import nearest_whole_away


class VariableType(enum.Enum):
    """Types of variables that the twin computes with: what an assignment makes of a value; texts are kept as written."""

    REAL = "REAL"
    INT = "INT"
    BOOL = "BOOL"
    CHAR = "CHAR"
    STRING = "STRING"
    AXIS = "AXIS"

    def converted(self, value: float) -> float:
        """A value as a variable of this type holds it."""
        if self is VariableType.BOOL:
            return 1.0 if value != 0.0 else 0.0
        if self in (VariableType.INT, VariableType.CHAR):
            return nearest_whole_away(value)
        return value


TEXTS = (VariableType.STRING, VariableType.AXIS)
"""Types whose values are texts."""


DEEPEST_CALL = 16
"""Subprograms that may call each other (manual)."""


@dataclasses.dataclass(frozen=True, slots=True)
class Formal:
    """A parameter of a subprogram.

    Attributes:
        is_reference: VAR: it writes the caller's variable.
        is_table: It is a table of the caller's, as large as that is.
        default: Its value where the call gives none.
    """

    name: str
    type: VariableType
    is_reference: bool = False
    is_table: bool = False
    default: float = 0.0


@dataclasses.dataclass(frozen=True, slots=True)
class Subprogram:
    """A subprogram: its lines, from 0, and what its PROC says.

    Attributes:
        lines: Those between its heading and the next.
        first: Where it begins to run.
        restores: SAVE: modal codes and frames are put back when it returns.
    """

    lines: range
    first: int
    formals: tuple[Formal, ...] = ()
    restores: bool = False


@dataclasses.dataclass(slots=True)
class CallFrame:
    """What belongs to one call: types of its variables by name, tables by name, and where its references lead.

    Attributes:
        types: Of the variables that it has defined.
        texts: Values of its variables that hold texts.
        references: Parameters (VAR) by the caller's variable that they write when the call ends.
        programmable: The programmable frame that its end puts back; None: it stays.
    """

    types: dict[str, VariableType] = dataclasses.field(default_factory=dict)
    sizes: dict[str, tuple[int, int]] = dataclasses.field(default_factory=dict)
    texts: dict[str, str] = dataclasses.field(default_factory=dict)
    references: dict[str, str] = dataclasses.field(default_factory=dict)
    programmable: tuple[Matrix, Vector] | None = None
    depth: int = 0


@dataclasses.dataclass(slots=True)
class SinumerikMemory:
    """Frames, pole, tool, subprograms, variables.

    Attributes:
        matrix: Of the programmable frame.
        swivel: Directions of the axes of CYCLE800's plane, as columns, and its origin [mm]; None: there is none.
        vector_turns: A vector is reached in the plane of both directions, or not; None: ORIWKS and ORIMKS say which.
        machine_vectors: ORIMKS: no frame turns a vector.
        uneven: It scales the axes differently.
        translation: Of the programmable frame, before it shifts by a work offset [mm].
        fine: Its fine part (G59), which TRANS ends [mm].
        other_shifts: Programmable shifts of axes that are no X, Y, Z, by column [mm or deg].
        offset: Name of the work offset in force; empty: none was programmed.
        offsets: Work offsets that the program has written ($P_UIFR), by name and axis.
        machine_pending: G500 waits for the place of machine zero, which the job does not say.
        part_frame: What G53, G153 or SUPA have put aside for their block, or None.
        carried: How far the last change of a frame has moved programmed coordinates, which the next
            incremental word of an axis makes up for, shape (k,) [mm or deg].
        pole: In the working plane [mm].
        polar_radius: RP as programmed last [mm]; NaN: computed from where the tool is.
        polar_angle: AP as programmed last, likewise [deg].
        tool_on: The tool in the spindle has its offset D.
        edges: Number of the edge that the program calls of each tool.
        unit: Of lengths, as it was before the block [mm].
        allowance: OFFN [mm].
        sharp_corners: DISC=100: G450 goes to the intersection, too.
        lead_side: Of the contour that the last lead has come to.
        lead_offset: How far beside it the tool's centre goes [mm].
        rounding: RNDM [mm].
        ends_rounding: RNDM=0: it ends behind the next move.
        modal_feed: F that an FB of the block has put aside, or None.
        main: Lines of the main program.
        calls: What belongs to each call, the main program's first.
        structure: Which keywords belong together; None before it was asked for.
        modal_call: MCALL in force: what is called after every block that moves.
        modal_depth: Calls around what it has called and that runs; None: it does not run.
    """

    matrix: Matrix = IDENTITY
    swivel: tuple[Matrix, Vector] | None = None
    vector_turns: bool | None = None
    machine_vectors: bool = False
    uneven: bool = False
    translation: Vector = (0.0, 0.0, 0.0)
    fine: Vector = (0.0, 0.0, 0.0)
    other_shifts: dict[int, float] = dataclasses.field(default_factory=dict)
    offset: str = ""
    offsets: dict[str, dict[str, float]] = dataclasses.field(default_factory=dict)
    machine_pending: bool = False
    part_frame: SuspendedFrame | None = None
    carried: list[float] | None = None
    pole: Point = (0.0, 0.0)
    polar_radius: float = math.nan
    polar_angle: float = math.nan
    tool_on: bool = True
    edges: dict[int, float] = dataclasses.field(default_factory=dict)
    unit: float = 1.0
    allowance: float = 0.0
    sharp_corners: bool = False
    lead_side: float = 0.0
    lead_offset: float = 0.0
    rounding: float = 0.0
    ends_rounding: bool = False
    modal_feed: float | None = None
    subprograms: dict[str, Subprogram] = dataclasses.field(default_factory=dict)
    main: range = range(0)
    calls: list[CallFrame] = dataclasses.field(default_factory=lambda: [CallFrame()])
    structure: Structure | None = None
    modal_call: Statement | None = None
    modal_depth: int | None = None


def memory_of(control: Control) -> SinumerikMemory:
    """The dialect's memory."""
    assert isinstance(control.memory, SinumerikMemory)
    return control.memory


def acts_on_lines(control: Control) -> bool:
    """A call behind each move, inches, roundings, polar values that Cartesian moves end, a frame that changed."""
    memory = memory_of(control)
    return (
        memory.modal_call is not None
        or memory.rounding > 0.0
        or memory.machine_pending
        or memory.carried is not None
        or memory.uneven
        or memory.swivel is not None
        or control.modal.unit != 1.0
        or not math.isnan(memory.polar_radius)
    )
