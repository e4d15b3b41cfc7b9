"""From programmed coordinates to the part's, compiled: ``Frame`` and what changes it.

The geometry is that of ``matrices``, compiled as it stands there.
"""

import numpy as np

from twin.compilation.compilable import compilable, inlined
from twin.nc.bytecode.registers import (
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
from twin.nc.canonical import FloatArray, IntArray
from twin.nc.geometry import matrices, planes
from twin.nc.geometry.frame import SHIFTS
from twin.nc.geometry.matrices import IDENTITY, Matrix
from twin.nc.geometry.planes import Vector
from twin.nc.path.compensation import leads
from twin.nc.path.compensation.contour import OFF, STAGE, Contour

_ROTATION_SHIFT = SHIFTS.index("rotation")


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
    place = (programmed[0], programmed[1], programmed[2])
    x, y, z = matrices.applied(matrix_of(state), place)
    part[0], part[1], part[2] = x + state.total[0], y + state.total[1], z + state.total[2]


@compilable
def turn_arc(value: FloatArray, state: State) -> None:
    """Centre, normal and sweep of an arc, as ``Rows.values`` has them, become the part's."""
    matrix = matrix_of(state)
    x, y, z = matrices.applied(matrix, (value[0], value[1], value[2]))
    value[0], value[1], value[2] = x + state.total[0], y + state.total[1], z + state.total[2]
    value[3], value[4], value[5] = matrices.turned_unit(matrix, (value[3], value[4], value[5]))
    value[6] *= matrices.handedness(matrix)


@compilable
def add_up(state: State) -> None:
    """The shifts have changed: their sum."""
    for axis in range(len(state.total)):
        total = 0.0
        for shift in range(len(state.shifts)):
            total += state.shifts[shift, axis]
        state.total[axis] = total


@compilable
def reframe(state: State) -> None:
    """The shifts or the matrix have changed: see where the control stands now."""
    add_up(state)
    programmed = state.programmed
    for axis in range(len(state.total)):
        programmed[axis] = state.part[axis] - state.total[axis]
    if state.registers[TURNED] != 0.0:
        place = (programmed[0], programmed[1], programmed[2])
        x, y, z = matrices.applied(matrices.inverse(matrix_of(state)), place)
        programmed[0], programmed[1], programmed[2] = x, y, z


@compilable
def transform(constants: Constants, state: State) -> None:
    """Mirror, scale and rotation have changed: the matrix, and where the control stands now."""
    registers = state.registers
    signs = (registers[SIGNS], registers[SIGNS + 1], registers[SIGNS + 2])
    matrix, shift = matrices.stretched(signs, registers[SCALE]), (0.0, 0.0, 0.0)
    if not np.isnan(registers[ROTATION]):
        axes = directions(constants.planes[int(state.modal[PLANE])])
        center = (registers[ROTATION_ABSCISSA], registers[ROTATION_ORDINATE])
        matrix, shift = matrices.rotated(matrix, axes, registers[ROTATION], center)
    put(matrix[0], registers[MATRIX:])
    put(matrix[1], registers[MATRIX + 3 :])
    put(matrix[2], registers[MATRIX + 6 :])
    registers[TURNED] = 1.0 if matrix != IDENTITY else 0.0
    state.shifts[_ROTATION_SHIFT, :] = 0.0
    put(shift, state.shifts[_ROTATION_SHIFT])
    reframe(state)


@compilable
def begin_compensation(
    side: int, radius: float, constants: Constants, state: State, contour: Contour
) -> bool:
    """Compensate from the next move on: ``tool_compensation.compensate``; False where that refuses.

    Args:
        side: +1 left of the contour, -1 right of it.
        radius: Of the tool [mm].
        constants: What stays.
        state: Its plane, as the part sees it, is compensated.
        contour: Is made to wait for the move that leads in.
    """
    if contour.counts[STAGE] != OFF or not radius >= 0.0:
        return False
    if radius == 0.0:
        return True
    abscissa, ordinate, normal = directions(constants.planes[int(state.modal[PLANE])])
    signed_offset = side * radius
    if state.registers[TURNED] != 0.0:
        matrix = matrix_of(state)
        normal = matrices.turned_unit(matrix, normal)
        abscissa = matrices.turned_unit(matrix, abscissa)
        ordinate = planes.cross(normal, abscissa)
        signed_offset *= matrices.handedness(matrix)
    put(abscissa, contour.plane[0])
    put(ordinate, contour.plane[1])
    put(normal, contour.plane[2])
    leads.begin(contour, signed_offset, constants.square_corners, constants.indirect_leads)
    return True


@inlined
def put(vector: Vector, target: FloatArray) -> None:
    """Keep a vector in the first places of a column."""
    target[0], target[1], target[2] = vector


@inlined
def directions(plane: IntArray) -> Matrix:
    """Abscissa, ordinate and normal of a plane along the axes: ``Plane.directions``."""
    return (_along(plane[0]), _along(plane[1]), _along(plane[2]))


@inlined
def _along(axis: int) -> tuple[float, float, float]:
    return (
        1.0 if axis == 0 else 0.0,
        1.0 if axis == 1 else 0.0,
        1.0 if axis == 2 else 0.0,
    )
