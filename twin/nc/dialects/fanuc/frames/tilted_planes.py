"""How G68.2 and G268 name a tilted plane: by angles, points or vectors.

Sources: operator's manual of the Series 30i (tilted working plane command) as far as it is public, the same forms in the
published G68.2 of LinuxCNC, and posts, by which roll, pitch and yaw turn about the axes of the work offset. Of G268 the post
of FreeCAD. Decision: where the manual's figure alone says which sense an angle has (P4), the form is refused.
"""

import enum
import math
from collections.abc import Mapping

from twin.nc.control.control import Control
from twin.nc.dialects.fanuc.frames.transformations import set_tilt
from twin.nc.dialects.fanuc.memory import PlaneBlock, memory_of
from twin.nc.geometry.matrices import IDENTITY, Matrix, dot, product
from twin.nc.geometry.planes import Vector, cross
from twin.nc.iso.orientation.tilted_plane import about, directions_of
from twin.nc.text.blocks import Word


class _Form(enum.IntEnum):
    """Forms of G68.2 by P."""

    EULER = 0
    ROLL_PITCH_YAW = 1
    POINTS = 2
    VECTORS = 3


_BLOCKS: Mapping[int, int] = {_Form.POINTS: 4, _Form.VECTORS: 2}
"""How many blocks say a plane, numbered by Q."""

_SQUARE = 1e-3
"""Cosine between two vectors up to which they are at right angles: as posts round them (decision)."""


def tilt(control: Control) -> None:
    """G68.2: the origin of the tilted plane, and its angles (P0, P1), three points (P2) or two vectors (P3)."""
    memory = memory_of(control)
    form_word, order = control.take("P"), control.take("Q")
    form = 0 if form_word is None else int(control.number(form_word))
    if form not in tuple(_Form):
        message = "of the forms of G68.2 P0 to P3 are followed"
        hint = "P0 Euler's angles, P1 roll, pitch and yaw, P2 three points, P3 two vectors"
        control.fail("tilted-plane", message, form_word, hint)
    if memory.tilt is not None:
        control.fail("tilted-plane", "a tilted plane is in force", hint="end it by G69 first")
    block = _block(control)
    if form == _Form.EULER:
        set_tilt(control, euler(*block.angles), block.place)
    elif form == _Form.ROLL_PITCH_YAW:
        set_tilt(control, turned_in_order(control, order, block.angles, "123"), block.place)
    else:
        _collect(control, form, order, block)


def tilt_by_order(control: Control) -> None:
    """G268: the origin of the feature coordinate system, and turns I J K about X, Y and Z in the order of Q.

    Raises:
        ProgramError: It has no angles, the order of several is not said, or a plane is in force.
    """
    if memory_of(control).tilt is not None:
        control.fail("tilted-plane", "G268 is in force already", hint="end it by G269 first")
    if not any(letter in control.words for letter in "IJK"):
        message = (
            "G268 without I, J and K takes the plane from the rotary axes, which is not followed"
        )
        control.fail("tilted-plane", message, hint="G268 X0 Y0 Z0 I30. J0 K0 Q123")
    order, block = control.take("Q"), _block(control)
    set_tilt(control, turned_in_order(control, order, block.angles, ""), block.place)


def euler(first: float, second: float, third: float) -> Matrix:
    """Turns about Z, the new X and the new Z [deg]; its columns are the directions of the plane's axes."""
    return product(about(2, first), product(about(0, second), about(2, third)))


def turned_in_order(control: Control, order: Word | None, angles: Vector, default: str) -> Matrix:
    """Turns about X, Y and Z, which rest, one after the other [deg].

    Args:
        order: Q: the axes, 1 to 3, in turn.
        default: The order where the program says none; empty: that of several turns must be said.
    """
    axes = default if order is None else f"{control.number(order):g}"
    if not axes and sum(angle != 0.0 for angle in angles) <= 1:
        axes = "123"
    if sorted(axes) != ["1", "2", "3"]:
        message = "Q says in which order X, Y and Z are turned about"
        control.fail("tilted-plane", message, order, "Q123: about X, then Y, then Z")
    matrix = IDENTITY
    for axis in axes:
        matrix = product(about(int(axis) - 1, angles[int(axis) - 1]), matrix)
    return matrix


def _block(control: Control) -> PlaneBlock:
    place = list(control.motion.programmed[:3])
    for index, word in control.take_axis_words():
        if index > 2:
            control.fail("tilted-plane", f"{word.address} has no place in a tilted plane", word)
        place[index] = control.axis_value(index, word)
    i, j, k = (control.number(control.take(letter)) for letter in "IJK")
    return PlaneBlock((place[0], place[1], place[2]), (i, j, k), control.number(control.take("R")))


def _collect(control: Control, form: int, number: Word | None, block: PlaneBlock) -> None:
    """Blocks of a plane by points or vectors, in any order; the last one tilts it."""
    memory = memory_of(control)
    place = 0 if number is None else int(control.number(number))
    if place not in range(_BLOCKS[form]):
        message = f"Q0 to Q{_BLOCKS[form] - 1} number the blocks of G68.2 P{form}"
        control.fail("tilted-plane", message, number)
    if memory.plane_form != form:
        memory.plane_form, memory.plane_blocks = form, {}
    memory.plane_blocks[place] = block
    if len(memory.plane_blocks) < _BLOCKS[form]:
        return
    blocks, memory.plane_form, memory.plane_blocks = memory.plane_blocks, None, {}
    if form == _Form.POINTS:
        first, second, third = (blocks[each].place for each in (1, 2, 3))
        along, aside = _from(first, second), _from(first, third)
    else:
        along, normal = blocks[0].angles, blocks[1].angles
        lengths = math.hypot(*along) * math.hypot(*normal)
        if abs(dot(along, normal)) > _SQUARE * lengths:
            message = "the vectors of X and Z of a tilted plane are not at right angles"
            control.fail("tilted-plane", message, number)
        aside = cross(normal, along)
    try:
        matrix = directions_of(along, aside)
    except ValueError as error:
        control.fail("tilted-plane", f"G68.2 P{form}: {error}", number)
    set_tilt(control, product(matrix, about(2, blocks[0].turn)), blocks[0].place)


def _from(start: Vector, end: Vector) -> Vector:
    x, y, z = (there - here for here, there in zip(start, end, strict=True))
    return (x, y, z)
