"""From programmed coordinates to the part's, on the columns of the state.

What a shift, a mirror, a scale or a rotation does to coordinates, ``geometry.frame`` says.
"""

from twin.compilation.compilable import compilable, inlined
from twin.nc.bytecode.registers import (
    FREE_PLANE,
    MATRIX,
    PLANE,
    ROTATION,
    ROTATION_ABSCISSA,
    ROTATION_ORDINATE,
    SCALE,
    SIGNS,
    TURNED,
    Constants,
    State,
)
from twin.nc.canonical import FloatArray
from twin.nc.geometry import frame
from twin.nc.geometry.matrices import IDENTITY, Matrix
from twin.nc.geometry.planes import Vector, vector_of

_ROTATION_SHIFT = frame.SHIFTS.index("rotation")


@inlined
def matrix_of(state: State) -> Matrix:
    """Mirror, rotation and scale."""
    r = state.registers
    return (
        (r[MATRIX], r[MATRIX + 1], r[MATRIX + 2]),
        (r[MATRIX + 3], r[MATRIX + 4], r[MATRIX + 5]),
        (r[MATRIX + 6], r[MATRIX + 7], r[MATRIX + 8]),
    )


@inlined
def to_part(programmed: FloatArray, state: State, part: FloatArray) -> None:
    """Fill in the part coordinates of a programmed position, shape (k,)."""
    for axis in range(len(part)):
        part[axis] = programmed[axis] + state.total[axis]
    turn_place(programmed, state, part)


@inlined
def turn_place(programmed: FloatArray, state: State, part: FloatArray) -> None:
    """Let a sum of programmed position and shifts, shape (k,), heed the matrix.

    Such sums are made in loops over the axes that do other things as well: a loop of its own would
    cost every block a part of its time.
    """
    if state.registers[TURNED] != 0.0:
        _turn(programmed, state, part)


@compilable
def _turn(programmed: FloatArray, state: State, part: FloatArray) -> None:
    put(frame.to_part(matrix_of(state), state.total, vector_of(programmed)), part)


@compilable
def reframe(state: State) -> None:
    """The shifts or the matrix have changed: see where the control stands now."""
    frame.add_up(state.shifts, state.total)
    programmed = state.programmed
    for axis in range(len(state.total)):
        programmed[axis] = state.part[axis] - state.total[axis]
    if state.registers[TURNED] != 0.0:
        put(frame.to_programmed(matrix_of(state), state.total, vector_of(state.part)), programmed)


@compilable
def transform(constants: Constants, state: State) -> None:
    """Mirror, scale and rotation have changed: the matrix, and where the control stands now."""
    registers = state.registers
    signs = (registers[SIGNS], registers[SIGNS + 1], registers[SIGNS + 2])
    axes = directions(constants, state.modal)
    center = (registers[ROTATION_ABSCISSA], registers[ROTATION_ORDINATE])
    matrix, shift = frame.composed(signs, registers[SCALE], axes, registers[ROTATION], center)
    put(matrix[0], registers[MATRIX:])
    put(matrix[1], registers[MATRIX + 3 :])
    put(matrix[2], registers[MATRIX + 6 :])
    registers[TURNED] = 1.0 if matrix != IDENTITY else 0.0
    state.shifts[_ROTATION_SHIFT, :] = 0.0
    put(shift, state.shifts[_ROTATION_SHIFT])
    reframe(state)


@inlined
def put(vector: Vector, target: FloatArray) -> None:
    """Keep a vector in the first places of a column."""
    target[0], target[1], target[2] = vector


@inlined
def directions(constants: Constants, modal: FloatArray) -> Matrix:
    """Abscissa, ordinate and normal of the plane in force: ``Plane.directions``."""
    plane = int(modal[PLANE])
    if plane == len(constants.directions):
        free = modal[FREE_PLANE:]
        return (vector_of(free), vector_of(free[3:]), vector_of(free[6:]))
    of_plane = constants.directions[plane]
    return (vector_of(of_plane[0]), vector_of(of_plane[1]), vector_of(of_plane[2]))
