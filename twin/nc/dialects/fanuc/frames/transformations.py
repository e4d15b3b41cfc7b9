"""Mirror, scale and rotation of a Fanuc control: G50.1, G51.1, G50, G51, G68, G69.

A block's coordinates are mirrored, then scaled, then rotated (manual). Centres are coordinates of the
block's place, and what comes before acts on them as well.
"""

from twin.nc.control.codes import Action
from twin.nc.control.control import Control
from twin.nc.dialects.fanuc.memory import memory_of
from twin.nc.geometry.arcs import Point
from twin.nc.geometry.frame import chained
from twin.nc.geometry.matrices import (
    IDENTITY,
    LARGEST_SCALE,
    SMALLEST_SCALE,
    Matrix,
    applied,
    rotated,
    stretched,
)
from twin.nc.geometry.planes import Vector

PLAIN: Vector = (1.0, 1.0, 1.0)


def mirror(control: Control) -> None:
    """G51.1 X10.: mirror along X at X10."""
    words = control.take_axis_words()
    if not words:
        control.fail("mirror", "G51.1 needs the axes to mirror, with the place of the mirror")
    for index, word in words:
        if index > 2:
            control.fail("mirror", f"{word.address} cannot be mirrored: X, Y and Z can", word)
        memory_of(control).mirror[index] = control.axis_value(index, word)
    _update(control)


def end_mirror(control: Control) -> None:
    """G50.1 X0: X is mirrored no longer; G50.1 alone ends all mirrors."""
    words, mirrors = control.take_axis_words(), memory_of(control).mirror
    for index in [index for index, _ in words] or list(mirrors):
        mirrors.pop(index, None)
    _update(control)


def scale(control: Control) -> None:
    """G51 X Y Z P, or I J K: the centre, and one factor or one for each axis.

    A factor without a point counts thousandths; a negative one mirrors.
    """
    center = list(control.motion.programmed[:3])
    for index, word in control.take_axis_words():
        if index < 3:
            center[index] = control.axis_value(index, word)
    common = control.take("P")
    single = [control.take(letter) for letter in "IJK"]
    if common is not None and any(single):
        control.fail("scale", "G51 takes P for all axes, or I, J and K for each", common)
    if common is None and not any(single):
        control.fail("scale", "G51 needs its factor: P, or I, J and K", None, "G51 X0 Y0 P2.")
    words = [common] * 3 if common is not None else single
    factors = [1.0 if word is None else control.number(word) for word in words]
    for word, factor in zip(words, factors, strict=True):
        if not SMALLEST_SCALE <= abs(factor) <= LARGEST_SCALE:
            control.fail("scale", "a scale lies between 0.001 and 1000", word)
    if control.modal.cycle is not None:
        control.fail("scale", "a scale cannot begin while a cycle is in force", None, "G80 first")
    memory_of(control).scale = (
        (factors[0], factors[1], factors[2]),
        (center[0], center[1], center[2]),
    )
    _update(control)


def end(name: str) -> Action:
    """G50, G69: there is no scale, or no rotation."""

    def action(control: Control) -> None:
        setattr(memory_of(control), name, None)
        _update(control)

    return action


def rotate(control: Control) -> None:
    """G68 X Y R: turn by R in the working plane about a point, or about where the tool is."""
    angle = control.take("R")
    if angle is None:
        control.fail("rotation-angle", "G68 needs its angle R", None, "G68 X0 Y0 R45.")
    plane = control.modal.plane
    memory = memory_of(control)
    if control.modal.incremental and memory.rotation is not None:
        message = "R counts from the plane's first axis, and does not add to the rotation in force"
        span = angle.column, angle.width
        control.report.warn_once("rotation-absolute", message, *span, memory.variant.adds_rotation)
    turned, turned_shift = _transformation(control)
    x, y, z = control.motion.programmed[:3]
    place = applied(turned, (x, y, z))
    center = [at + by for at, by in zip(place, turned_shift, strict=True)]
    matrix, shift = _before_rotation(control)
    for index, word in control.take_axis_words():
        if index == plane.axes[2] or index > 2:
            message = f"{word.address} does not lie in the plane {plane.name} that G68 turns"
            control.fail("rotation-angle", message, word, "turning in space is not simulated")
        center[index] = matrix[index][index] * control.axis_value(index, word) + shift[index]
    middle = plane.local((center[0], center[1], center[2]))
    memory.rotation = (control.number(angle), (middle.abscissa, middle.ordinate))
    _update(control)


def refuse_uneven_arc(control: Control) -> None:
    """An arc in a plane whose axes have different scales would be no arc."""
    memory = memory_of(control)
    if memory.scale is None:
        return
    abscissa, ordinate, _ = control.modal.plane.axes
    factors = memory.scale[0]
    if abs(factors[abscissa]) != abs(factors[ordinate]):
        message = "an arc between axes of different scales is not simulated"
        control.fail("scale", message, hint="one factor P for all axes keeps arcs round")


def refuse_scaled_pecks(control: Control, name: str) -> None:
    """A cycle whose depths or shifts no scale changes on the control."""
    if memory_of(control).scale is not None:
        message = f"{name} under a scale is not simulated: the scale leaves its pecks and shifts as they are"
        control.fail("scale", message, hint="end the scale by G50 before it")


def _before_rotation(control: Control) -> tuple[Matrix, Vector]:
    """Mirror and scale: matrix, and the shift that comes after it."""
    memory = memory_of(control)
    factors, center = memory.scale or (PLAIN, (0.0, 0.0, 0.0))
    signs = tuple(-1.0 if axis in memory.mirror else 1.0 for axis in range(3))
    middle = [memory.mirror.get(axis, 0.0) for axis in range(3)]
    product = [sign * factor for sign, factor in zip(signs, factors, strict=True)]
    shift = [
        factor * (at - sign * at - about) + about
        for sign, factor, at, about in zip(signs, factors, middle, center, strict=True)
    ]
    matrix = stretched((product[0], product[1], product[2]), 1.0)
    return matrix, (shift[0], shift[1], shift[2])


def _transformation(control: Control) -> tuple[Matrix, Vector]:
    """Mirror, scale and rotation in force: matrix, and the shift that comes after it."""
    rotation: tuple[float, Point] | None = memory_of(control).rotation
    matrix, shift = _before_rotation(control)
    if rotation is None:
        return matrix, shift
    axes = control.modal.plane.directions
    turning, behind = rotated(IDENTITY, axes, *rotation)
    x, y, z = applied(turning, shift)
    matrix, _ = rotated(matrix, axes, *rotation)
    return matrix, (x + behind[0], y + behind[1], z + behind[2])


def set_tilt(control: Control, matrix: Matrix | None, origin: Vector = (0.0, 0.0, 0.0)) -> None:
    """Tilt the plane of all the others by the directions of its axes, as columns, and its origin; None: no longer."""
    memory_of(control).tilt = None if matrix is None else (matrix, origin)
    _update(control)


def _update(control: Control) -> None:
    if control.path.compensation.in_force:
        message = "mirror, scale and rotation cannot change while compensation is in force"
        control.fail("compensation-change", message, hint="end it by G40 first")
    matrix, shift = _transformation(control)
    tilt = memory_of(control).tilt
    if tilt is not None:
        matrix, shift = chained(tilt, (matrix, shift))
    control.frame.set_matrix(matrix)
    others = [0.0] * (len(control.settings.axes) - 3)
    control.frame.set_shift("rotation", [*shift, *others])
    control.motion.reframed()
