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

# --- variables

LOAD = 3
"""Put the variable with the slot ``operand`` on the stack."""
LOAD_NUMBERED = 4
"""Put the variable with the number on the stack in its place."""
DEFINED = 5
"""Put on the stack whether the variable with the slot ``operand`` has a value."""
STORE = 6
"""Give the variable with the slot ``operand`` the topmost value."""
STORE_DECLARED = 7
"""Store the topmost value in the slot ``operand``, if that variable has a value of its own already."""
STORE_NUMBERED = 8
"""Store the topmost value in the variable whose number lies below it."""

# --- words and moves

WORD = 9
"""The topmost value becomes a word of the token kind ``operand``."""
WORD_CONSTANT = 10
"""``immediate`` becomes a word of the token kind ``operand``."""
RUN = 11
"""Execute the block's words."""
RUN_REPEATEDLY = 12
"""Execute the block's words as often as the topmost value says, at most ``immediate`` times."""
RUN_CODES = 13
"""Execute the block's words so far, and drop them except N."""
RUN_POLAR = 14
"""Execute the block's words, on a straight line to where R (``operand`` 1), Q (2) or both (3) lead,
whose values are the topmost."""

# --- the registers' snapshot, radius compensation, codes

SNAPSHOT = 15
"""What follows changes more than variables: keep a snapshot of the registers."""
COMPENSATE = 16
"""Radius compensation begins, of the topmost value, left (``operand`` 1) or right (-1)."""
END_COMPENSATION = 17
"""Radius compensation ends."""
ACTIVATE = 18
"""The G code ``operand`` becomes active."""
NO_PECKS = 19
"""No drilling cycle with pecks may be in force."""

# --- values on the stack: from here on both tiers run instructions alike

CONSTANT = 20
"""Put ``immediate`` on the stack."""
NEGATE = 21
"""Change the sign."""
UNARY = 22
"""Replace the topmost value by the function ``operand`` of it."""
BINARY = 23
"""Replace the two topmost values by the operator ``operand`` between them."""
TERNARY = 24
"""Replace the three topmost values by the function ``operand`` of them."""
DROP = 25
"""Take the topmost value off the stack."""

# --- jumps

JUMP = 26
"""Jump to the location ``operand``."""
JUMP_IF = 27
"""Jump to the location ``operand`` if the topmost value is not 0."""
JUMP_UNLESS = 28
"""Jump to the location ``operand`` if the topmost value is 0."""
JUMP_CASE = 29
"""Jump to the location ``operand`` if the topmost value equals the one below, which stays."""

# --- counted loops

BEGIN_FOR = 30
"""First, last and step become whether first lies beyond last, and first."""
STEP_FOR = 31
"""First, last, step and value become whether the next value is in reach, and that value."""
COUNT_DOWN = 32
"""Put on the stack whether the counter with the slot ``operand``, which begins at ``immediate``,
is not 0 yet, and take 1 from it; at 0 it is forgotten."""

# --- calls

CHECK_CALL = 33
"""At most ``operand`` parts may call each other."""
OWN_VARIABLES = 34
"""The part that is called next has local variables of its own."""
RESTORE_CODES = 35
"""The end of the part that is called next restores the codes that are active now."""
CALL = 36
"""Run the part that begins at the location ``operand``."""
RANGE = 37
"""The range that is repeated next ends at the location ``operand``."""
REPEAT = 38
"""Run the range, or the part that a word ends, which begins at the location ``operand`` as often as the
topmost value says."""
CHECK_RETURN = 39
"""There must be a part that can be returned from."""
RETURN = 40
"""Go back behind the call."""

# --- registers

REGISTER = 41
"""Put the register ``operand`` on the stack."""
SET_REGISTER = 42
"""The topmost value becomes the register ``operand``."""
EMPTY_REGISTER = 43
"""The register ``operand`` has no value from here on."""
TO_MILLIMETRES = 44
"""Convert the topmost value, a length, from the active unit."""
CHECK = 45
"""The topmost value, which stays, must be as the check ``operand`` says, one of those below, of
``immediate``; else the interpreter tier must run the block, which says what is wrong."""

AT_LEAST, AT_MOST, WHOLE, SIGN, PRESENT, ABSENT, LISTED_TOOL, UNCOMPENSATED = range(8)
"""Checks: not below ``immediate``; not above it; a whole number from 0 to it; -1 or 1; any value, or
none (NaN); the number of a tool that the job lists; or, of no value, radius compensation is not in force."""

# --- events

FUNCTION = 46
"""Report the M function ``operand``, a start of the spindle together with its speed."""
REPORT = 47
"""Report an event of the kind ``operand`` with the topmost value."""

# --- tools and coordinates

TOOL_RADIUS = 48
"""Put the radius of the tool in use on the stack, NaN where there is no tool."""
COORDINATE = 49
"""Put the abscissa (``operand`` 0) or ordinate (1) of the present position on the stack."""
TOOL_LENGTH = 50
"""Shift Z by the length of the tool in use, if its offset applies."""
SHIFT = 51
"""The topmost values, one for each axis, are the shift ``operand``."""
REFRAME = 52
"""The shifts have changed."""
BEGIN_TARGET = 53
"""Begin to set new coordinates for the present position: until set, each axis keeps its own."""
TARGET = 54
"""The topmost value is the new coordinate of the axis ``operand``."""
SET_POSITION = 55
"""The new coordinates hold from here on, by the shift ``operand``."""
TRANSFORM = 56
"""Mirror, scale and rotation have changed."""
PLANE = 57
"""The plane ``operand``, 0 to 2, becomes active, with part zero as polar origin."""
