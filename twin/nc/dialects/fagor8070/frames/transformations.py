"""Mirror, scale and rotation of the Fagor CNC 8070."""

import math

from twin.nc.control.codes import Action
from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070.frames.machine_coordinates import refuse_change
from twin.nc.dialects.fagor8070.memory import KINDS, memory_of
from twin.nc.dialects.fagor8070.polar import forget_polar
from twin.nc.geometry.frame import chained, composed
from twin.nc.geometry.matrices import LARGEST_SCALE, SMALLEST_SCALE
from twin.nc.text.blocks import Statement, Word


def mirror_off(control: Control) -> None:
    """G10."""
    memory_of(control).signs[:] = (1.0, 1.0, 1.0)
    update(control)


def mirror(index: int) -> Action:
    """G11, G12, G13: mirror X, Y, Z."""

    def action(control: Control) -> None:
        memory_of(control).signs[index] = -1.0
        update(control)

    return action


def mirror_axes(control: Control) -> None:
    """G14 X-1 Y1: -1 mirrors an axis, 1 ends it."""
    words = control.take_axis_words()
    if not words:
        control.fail("mirror", "G14 needs the axes to mirror", hint="write G14 X-1")
    for index, word in words:
        if index > 2:
            control.fail("mirror", "G14 takes -1 or 1 for X, Y and Z", word)
        sign = control.number(word)
        if abs(sign) != 1.0:
            control.fail("mirror", "a mirror takes -1 or 1 for X, Y and Z", word)
        memory_of(control).signs[index] = sign
    update(control)


def scale(control: Control) -> None:
    """G72 S2: lengths are multiplied; G72 alone or S1 ends it."""
    word = control.take("S")
    set_scale(control, 1.0 if word is None else control.number(word), word)


def set_scale(control: Control, factor: float, error_at: Word | Statement | None) -> None:
    """Multiply lengths."""
    if not SMALLEST_SCALE <= factor <= LARGEST_SCALE:
        control.fail("scale", "a scale lies between 0.001 and 1000", error_at)
    memory_of(control).scale = factor
    update(control, error_at if isinstance(error_at, Statement) else None)


def rotate(control: Control) -> None:
    """G73 Q I J: turn by Q about I J, missing ones part zero; G73 alone ends it.

    Decision: a rotation must end before another begins, since adding and replacing are both known.
    """
    word, memory = control.take("Q"), memory_of(control)
    center = control.length(control.take("I")), control.length(control.take("J"))
    if word is None:
        memory.rotation = math.nan
    else:
        if not math.isnan(memory.rotation):
            hint = "end it by G73 alone"
            control.fail("rotation-active", "a rotation is in force", word, hint)
        memory.rotation, memory.rotation_center = control.number(word), center
    update(control)


def update(control: Control, error_at: Statement | None = None) -> None:
    """Scale, then mirror, then rotation about its centre in the working plane, then #CS, then #ACS hold from here on."""
    refuse_change(control)
    if control.path.compensation.in_force:
        message = "mirror, scale and rotation cannot change while compensation is in force"
        control.fail("compensation-change", message, error_at, "end it by G40 first")
    memory, axes = memory_of(control), control.modal.plane.directions
    x, y, z = memory.signs
    within = composed((x, y, z), memory.scale, axes, memory.rotation, memory.rotation_center)
    matrix, shift = chained(memory.combined(*KINDS), within)
    control.frame.set_matrix(matrix)
    others = [0.0] * (len(control.settings.axes) - 3)
    control.frame.set_shift("rotation", [*shift, *others])
    control.motion.reframed()
    forget_polar(control)
