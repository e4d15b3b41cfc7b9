"""The instruction table: what blocks that compute, jump or call do, one small step a row.

Values wait on a stack. A block begins with ``BLOCK`` and ends with ``NEXT``; before its first step
that cannot be undone it has met all that could stop it.
"""

import enum
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from twin.nc.canonical import FloatArray, IntArray
from twin.nc.control.flow import Place

MOST_INSTRUCTIONS = 1 << 19
"""Rows that are kept; a program that needs more is translated anew from there on."""
MOST_STORES = 64
"""Variables that a block may set."""
MOST_ROWS = 200
"""Rows of a block."""
MOST_VALUES = MOST_ROWS
"""Values that wait on the stack: no row adds more than one."""
PART_BITS = 20
"""A place as one number: the line, and in these bits the part."""
LARGEST_PART = (1 << PART_BITS) - 1
UNKNOWN, GENERAL = 0, -1
"""Instead of a line's first row: not translated yet; always run by the general way."""


class Step(enum.IntEnum):
    """What a row does; ``argument`` and ``number`` are its columns."""

    BLOCK = 0
    """A block begins; ``argument``: row of the line's next block, 0 for none."""
    NEXT = 1
    """It ends."""
    LEAVE = 2
    """The general way must run this block."""
    NUMBER = 3
    """Put ``number`` on the stack."""
    LOAD = 4
    """Put the variable with the slot ``argument`` on the stack."""
    LOAD_NUMBERED = 5
    """Put the variable with the number on the stack in its place."""
    LOAD_BELOW = 6
    """As ``LOAD``, below the topmost value."""
    LOAD_NUMBERED_BELOW = 7
    """As ``LOAD_BELOW``, of the variable whose number lies below the topmost value."""
    DEFINED = 8
    """Put on the stack whether the variable with the slot ``argument`` has a value."""
    NEGATE = 9
    """Change the sign."""
    ONE = 10
    """Replace the topmost value by the function ``argument`` of it."""
    TWO = 11
    """Replace the two topmost values by the operator ``argument`` between them."""
    THREE = 12
    """Replace the three topmost values by the function ``argument`` of them."""
    DROP = 13
    """Forget the topmost value."""
    STORE = 14
    """Give the variable with the slot ``argument`` the topmost value."""
    STORE_DECLARED = 15
    """The same where it has a value of its own already."""
    STORE_NUMBERED = 16
    """The same for the variable whose number lies below."""
    WORD = 17
    """The topmost value is that of a word with the role ``argument``."""
    WORD_NUMBER = 18
    """``number`` is."""
    RUN = 19
    """Run the words."""
    RUN_OFTEN = 20
    """Run them as often as the topmost value says, at most ``number`` times."""
    JUMP = 21
    """Go on at the place ``argument``."""
    JUMP_IF = 22
    """The same where the topmost value is not 0."""
    JUMP_UNLESS = 23
    """The same where it is 0."""
    JUMP_CASE = 24
    """The same where it equals the value below, which stays."""
    BEGIN_FOR = 25
    """First, last and step become whether first lies beyond last, and first."""
    STEP_FOR = 26
    """First, last, step and value become whether the next value is in reach, and that value."""
    COUNT_DOWN = 27
    """Put on the stack whether the counter with the slot ``argument``, which begins at ``number``,
    is not 0 yet, and take 1 from it; at 0 it is forgotten."""
    MAY_CALL = 28
    """At most ``argument`` parts may call each other."""
    OWN_VARIABLES = 29
    """The part that is called next has local variables of its own."""
    RESTORING = 30
    """Its end puts back into force what is in force now."""
    CALL = 31
    """Run the part that begins at the place ``argument``."""
    RANGE = 32
    """The range that is repeated next ends at the place ``argument``."""
    REPEAT = 33
    """Run the range that begins at the place ``argument`` as often as the topmost value says."""
    MAY_RETURN = 34
    """There must be a part that can be returned from."""
    RETURN = 35
    """Go back behind the call."""
    KEEP = 36
    """What follows changes more than variables; keep how all was."""
    RUN_CODES = 37
    """Run the words so far, and forget them but for N."""
    RUN_POLAR = 38
    """Run the words, on a straight way to where R (``argument`` 1), Q (2) or both (3) lead, whose
    values are the topmost."""
    IN_FORCE = 39
    """The G code ``argument`` is in force."""
    PLANE = 40
    """The plane ``argument`` is in force: 0 to 2."""
    FUNCTION = 41
    """Report the M function ``argument``."""
    SPINDLE_FUNCTION = 42
    """The same with the spindle's speed."""
    SPEED = 43
    """The spindle's speed is the topmost value; ``argument`` 1: report it."""
    TOOL = 44
    """The tool with the topmost number comes next; ``argument`` 1: it must be one of the job's."""
    AUXILIARY = 45
    """Report H with the topmost value."""
    DWELL = 46
    """Wait as many seconds as the topmost value."""
    CHANGE_TOOL = 47
    """The tool that comes next is used from now on."""
    OFFSET_ON = 48
    """Tools have their offset, or with ``argument`` 0 not."""
    TOOL_LENGTH = 49
    """The tool in use moves Z by its length, where it has its offset."""
    SHIFT = 50
    """The topmost values, one for each axis, are the shift ``argument``."""
    REFRAME = 51
    """The shifts have changed."""
    BEGIN_LABEL = 52
    """The place where the machine stands gets new coordinates: at first those that it has."""
    LABEL = 53
    """The topmost value is that of the axis ``argument``."""
    RELABEL = 54
    """They hold from now on, by the shift ``argument``."""
    POLAR_ORIGIN = 55
    """The two topmost values (``argument`` 2) are the polar origin; 0: it is where the tool stands."""
    TO_MILLIMETRES = 56
    """The topmost value is in the unit in force, of the axis ``argument``."""
    NO_PECKS = 57
    """No drilling cycle with pecks may be in force."""
    FORGET_POLAR = 58
    """The last R and Q hold no longer."""
    TOOL_RADIUS = 59
    """Put the radius of the tool in use on the stack; ``argument`` 1: 0 where it has no offset."""
    COMPENSATE = 60
    """Radius compensation begins, of the topmost value, left (``argument`` 1) or right (-1)."""
    END_COMPENSATION = 61
    """It ends."""
    CYCLE_WORD = 62
    """The topmost value is that of the drilling cycle's word for ``argument``."""
    PROGRAMMED_RADIUS = 63
    """The topmost value is the radius that the program gives the tool; ``argument`` 0: put on the
    stack what it gave last."""
    MIRROR = 64
    """The topmost value, -1 or 1, is the sign of the axis ``argument``."""
    SCALE = 65
    """It is the scale."""
    ROTATE = 66
    """The topmost values are angle, abscissa and ordinate of the rotation, which must be the only one."""
    END_ROTATION = 67
    """It ends."""
    TRANSFORM = 68
    """Mirror, scale and rotation have changed."""


class Table(NamedTuple):
    """The rows, as the kernel reads them.

    Attributes:
        first: First row of each line, ``UNKNOWN`` or ``GENERAL``, shape (lines + 1,).
        step: Shape (n,).
        argument: Shape (n,).
        number: Shape (n,).
        numbered: Slots of the variables that have a number, shape (m,).
    """

    first: npt.NDArray[np.int32]
    step: IntArray
    argument: IntArray
    number: FloatArray
    numbered: IntArray


class Instructions:
    """A table that grows."""

    def __init__(self, lines: int) -> None:
        self._first = np.zeros(lines + 1, np.int32)
        self._translated: list[int] = []
        self._step = np.zeros(256, np.int64)
        self._argument = np.zeros(256, np.int64)
        self._number = np.zeros(256)
        self._step[0] = Step.NEXT
        self._rows = 1
        self.numbered = np.zeros(0, np.int64)

    @property
    def rows(self) -> int:
        """Where the next row goes."""
        return self._rows

    @property
    def table(self) -> Table:
        """The rows as columns."""
        return Table(self._first, self._step, self._argument, self._number, self.numbered)

    def add(self, step: Step, argument: int = 0, number: float = 0.0) -> None:
        """Append a row."""
        row = self._rows
        self._grow(1)
        self._step[row], self._argument[row], self._number[row] = step, argument, number
        self._rows = row + 1

    def add_rows(
        self,
        steps: IntArray,
        arguments: IntArray,
        numbers: FloatArray,
        own: FloatArray,
        at: IntArray,
    ) -> int:
        """Append rows, with other numbers at some of them; the first of them."""
        first, count = self._rows, len(steps)
        self._grow(count)
        rows = slice(first, first + count)
        self._step[rows], self._argument[rows], self._number[rows] = steps, arguments, numbers
        self._number[at + first] = own
        self._rows = first + count
        return first

    def _grow(self, rows: int) -> None:
        while self._rows + rows > len(self._step):
            self._step = np.concatenate([self._step, np.zeros_like(self._step)])
            self._argument = np.concatenate([self._argument, np.zeros_like(self._argument)])
            self._number = np.concatenate([self._number, np.zeros_like(self._number)])

    def lead_here(self, row: int) -> None:
        """The next row is the argument of an earlier one."""
        self._argument[row] = self._rows

    def take_back(self, row: int) -> None:
        """Forget this row and those behind it."""
        self._rows = row

    def number_variables(self, slots: list[int]) -> None:
        """From now on these are the slots of the variables 0, 1, 2, ..."""
        self.numbered = np.array(slots, np.int64)

    def begins(self, line: int, row: int) -> None:
        """The rows of a line, counted from 0, begin here; or ``GENERAL``."""
        self._first[line] = row
        self._translated.append(line)

    def make_room(self) -> None:
        """Forget everything where the table has become too long."""
        if self._rows > MOST_INSTRUCTIONS or len(self._translated) > MOST_INSTRUCTIONS:
            self._first[self._translated] = UNKNOWN
            self._translated = []
            self._rows = 1


def number_of_place(place: Place) -> int:
    """A place as one number, in the order of the program."""
    return place.line << PART_BITS | place.part


def place_of_number(number: int) -> Place:
    """The inverse of ``number_of_place``."""
    return Place(number >> PART_BITS, number & LARGEST_PART)


(
    BLOCK,
    NEXT,
    LEAVE,
    NUMBER,
    LOAD,
    LOAD_NUMBERED,
    LOAD_BELOW,
    LOAD_NUMBERED_BELOW,
    DEFINED,
    NEGATE,
    ONE,
    TWO,
    THREE,
    DROP,
    STORE,
    STORE_DECLARED,
    STORE_NUMBERED,
    WORD,
    WORD_NUMBER,
    RUN,
    RUN_OFTEN,
    JUMP,
    JUMP_IF,
    JUMP_UNLESS,
    JUMP_CASE,
    BEGIN_FOR,
    STEP_FOR,
    COUNT_DOWN,
    MAY_CALL,
    OWN_VARIABLES,
    RESTORING,
    CALL,
    RANGE,
    REPEAT,
    MAY_RETURN,
    RETURN,
    KEEP,
    RUN_CODES,
    RUN_POLAR,
    IN_FORCE,
    PLANE,
    FUNCTION,
    SPINDLE_FUNCTION,
    SPEED,
    TOOL,
    AUXILIARY,
    DWELL,
    CHANGE_TOOL,
    OFFSET_ON,
    TOOL_LENGTH,
    SHIFT,
    REFRAME,
    BEGIN_LABEL,
    LABEL,
    RELABEL,
    POLAR_ORIGIN,
    TO_MILLIMETRES,
    NO_PECKS,
    FORGET_POLAR,
    TOOL_RADIUS,
    COMPENSATE,
    END_COMPENSATION,
    CYCLE_WORD,
    PROGRAMMED_RADIUS,
    MIRROR,
    SCALE,
    ROTATE,
    END_ROTATION,
    TRANSFORM,
) = range(len(Step))
