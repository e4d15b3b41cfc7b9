"""What an instruction does, by its opcode; ``operand`` and ``immediate`` are its other columns.

Values wait on a stack. A block begins with ``BLOCK`` and ends with ``NEXT``; before its first instruction
that cannot be undone it has met all that could stop it. Opcodes of one kind follow each other: their
range says which function runs them.
"""

BLOCK = 0
"""A block begins; ``operand``: row of the line's next block, 0 for none."""
NEXT = 1
"""The block ends."""
TRAP = 2
"""The interpreter tier must run this block."""

# --- values on the stack

CONSTANT = 3
"""Put ``immediate`` on the stack."""
LOAD = 4
"""Put the variable with the slot ``operand`` on the stack."""
LOAD_NUMBERED = 5
"""Put the variable with the number on the stack in its place."""
DEFINED = 6
"""Put on the stack whether the variable with the slot ``operand`` has a value."""
NEGATE = 7
"""Change the sign."""
UNARY = 8
"""Replace the topmost value by the function ``operand`` of it."""
BINARY = 9
"""Replace the two topmost values by the operator ``operand`` between them."""
TERNARY = 10
"""Replace the three topmost values by the function ``operand`` of them."""
DROP = 11
"""Take the topmost value off the stack."""

# --- variables

STORE = 12
"""Give the variable with the slot ``operand`` the topmost value."""
STORE_DECLARED = 13
"""Store the topmost value in the slot ``operand``, if that variable has a value of its own already."""
STORE_NUMBERED = 14
"""Store the topmost value in the variable whose number lies below it."""

# --- words and moves

WORD = 15
"""The topmost value becomes a word of the token kind ``operand``."""
WORD_CONSTANT = 16
"""``immediate`` becomes a word of the token kind ``operand``."""
RUN = 17
"""Execute the block's words."""
RUN_REPEATEDLY = 18
"""Execute the block's words as often as the topmost value says, at most ``immediate`` times."""
RUN_CODES = 19
"""Execute the block's words so far, and drop them except N."""
RUN_POLAR = 20
"""Execute the block's words, on a straight line to where R (``operand`` 1), Q (2) or both (3) lead,
whose values are the topmost."""

# --- the registers' snapshot, radius compensation

SNAPSHOT = 21
"""What follows changes more than variables: keep a snapshot of the registers."""
COMPENSATE = 22
"""Radius compensation begins, of the topmost value, left (``operand`` 1) or right (-1)."""
END_COMPENSATION = 23
"""Radius compensation ends."""

# --- jumps

JUMP = 24
"""Jump to the location ``operand``."""
JUMP_IF = 25
"""Jump to the location ``operand`` if the topmost value is not 0."""
JUMP_UNLESS = 26
"""Jump to the location ``operand`` if the topmost value is 0."""
JUMP_CASE = 27
"""Jump to the location ``operand`` if the topmost value equals the one below, which stays."""

# --- counted loops

BEGIN_FOR = 28
"""First, last and step become whether first lies beyond last, and first."""
STEP_FOR = 29
"""First, last, step and value become whether the next value is in reach, and that value."""
COUNT_DOWN = 30
"""Put on the stack whether the counter with the slot ``operand``, which begins at ``immediate``,
is not 0 yet, and take 1 from it; at 0 it is forgotten."""

# --- calls

CHECK_CALL = 31
"""At most ``operand`` parts may call each other."""
OWN_VARIABLES = 32
"""The part that is called next has local variables of its own."""
RESTORE_CODES = 33
"""The end of the part that is called next restores the codes that are active now."""
CALL = 34
"""Run the part that begins at the location ``operand``."""
RANGE = 35
"""The range that is repeated next ends at the location ``operand``."""
REPEAT = 36
"""Run the range, or the part that a word ends, which begins at the location ``operand`` as often as the
topmost value says."""
CHECK_RETURN = 37
"""There must be a part that can be returned from."""
RETURN = 38
"""Go back behind the call."""

# --- codes and events

ACTIVATE = 39
"""The G code ``operand`` becomes active."""
FUNCTION = 40
"""Report the M function ``operand``, a start of the spindle together with its speed."""
SPEED = 41
"""The spindle's speed is the topmost value; ``operand`` 1: report it."""
TOOL = 42
"""The topmost value is the number of the tool to prepare; ``operand`` 1: it must be one of the job's."""
AUXILIARY = 43
"""Report H with the topmost value."""
DWELL = 44
"""Wait as many seconds as the topmost value."""

# --- tools

CHANGE_TOOL = 45
"""The tool that was prepared last becomes the tool in use."""
OFFSET_ON = 46
"""``operand`` 1: tool offsets apply; 0: they do not."""
TOOL_LENGTH = 47
"""Shift Z by the length of the tool in use, if its offset applies."""
TOOL_RADIUS = 48
"""Put the radius of the tool in use on the stack; ``operand`` 1: 0 where it has no offset."""
PROGRAMMED_RADIUS = 49
"""The topmost value is the radius that the program gives the tool; ``operand`` 0: put on the
stack what it gave last."""

# --- shifts of coordinates

SHIFT = 50
"""The topmost values, one for each axis, are the shift ``operand``."""
REFRAME = 51
"""The shifts have changed."""
BEGIN_TARGET = 52
"""Begin to set new coordinates for the present position: until set, each axis keeps its own."""
TARGET = 53
"""The topmost value is the new coordinate of the axis ``operand``."""
SET_POSITION = 54
"""The new coordinates hold from here on, by the shift ``operand``."""
TO_MILLIMETRES = 55
"""Convert the topmost value from the active unit, as one of the axis ``operand``."""

# --- plane and polar coordinates

PLANE = 56
"""The plane ``operand`` becomes active: 0 to 2."""
POLAR_ORIGIN = 57
"""``operand`` 2: the two topmost values are the polar origin; 0: the present position is."""
FORGET_POLAR = 58
"""The last R and Q are no longer modal."""

# --- drilling cycles

NO_PECKS = 59
"""No drilling cycle with pecks may be in force."""
CYCLE_WORD = 60
"""The topmost value is that of the drilling cycle's word for ``operand``."""

# --- mirror, scale, rotation

MIRROR = 61
"""The topmost value, -1 or 1, is the sign of the axis ``operand``."""
SCALE = 62
"""The topmost value is the scale."""
ROTATE = 63
"""The topmost values are angle, abscissa and ordinate of the rotation, which must be the only one."""
END_ROTATION = 64
"""The rotation ends."""
TRANSFORM = 65
"""Mirror, scale and rotation have changed."""
