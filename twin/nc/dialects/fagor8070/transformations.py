"""Mirror, scale and rotation of the Fagor CNC 8070."""

from twin.nc.bytecode import opcodes
from twin.nc.bytecode.assembler import Assembler, Finding
from twin.nc.bytecode.registers import (
    ROTATION,
    ROTATION_ABSCISSA,
    ROTATION_ORDINATE,
    SCALE,
    SIGNS,
)
from twin.nc.control.codes import Effect
from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070.machine_coordinates import refuse_change
from twin.nc.dialects.fagor8070.polar import write_forgotten_polar
from twin.nc.geometry.matrices import LARGEST_SCALE, SMALLEST_SCALE
from twin.nc.iso.findings import SCALE_RANGE, TRANSFORM_COMPENSATED

_MIRROR_SIGN = Finding("mirror", "a mirror takes -1 or 1 for X, Y and Z")
_ROTATED_ALREADY = Finding("rotation-active", "a rotation is in force", "end it by G73 alone")


def mirror_off(control: Control, assembler: Assembler) -> None:
    """G10."""
    for index in range(3):
        assembler.constant(1.0)
        assembler.set_register(SIGNS + index)
    _update(control, assembler)


def mirror(index: int) -> Effect:
    """G11, G12, G13: mirror X, Y, Z."""

    def write(control: Control, assembler: Assembler) -> None:
        assembler.constant(-1.0)
        assembler.set_register(SIGNS + index)
        _update(control, assembler)

    return Effect(write)


def mirror_axes(control: Control, assembler: Assembler) -> None:
    """G14 X-1 Y1: -1 mirrors an axis, 1 ends it."""
    words = control.take_axis_words()
    if not words:
        control.fail("mirror", "G14 needs the axes to mirror", hint="write G14 X-1")
    for index, word in words:
        if index > 2:
            control.fail("mirror", "G14 takes -1 or 1 for X, Y and Z", word)
        assembler.word_value(word)
        assembler.check(opcodes.SIGN, _MIRROR_SIGN)
        assembler.set_register(SIGNS + index)
    _update(control, assembler)


def scale(control: Control, assembler: Assembler) -> None:
    """G72 S2: lengths are multiplied; G72 alone or S1 ends it."""
    assembler.word_value(control.take("S"), 1.0)
    write_scale(control, assembler)


def write_scale(control: Control, assembler: Assembler) -> None:
    """Multiply lengths by the topmost value."""
    assembler.check(opcodes.AT_LEAST, SCALE_RANGE, SMALLEST_SCALE)
    assembler.check(opcodes.AT_MOST, SCALE_RANGE, LARGEST_SCALE)
    assembler.set_register(SCALE)
    _update(control, assembler)


def rotate(control: Control, assembler: Assembler) -> None:
    """G73 Q I J: turn by Q about I J, missing ones part zero; G73 alone ends it.

    Decision: a rotation must end before another begins, since adding and replacing are both known.
    """
    angle, center = control.take("Q"), [control.take("I"), control.take("J")]
    if angle is None:
        assembler.empty_register(ROTATION)
    else:
        for word in (angle, *center):
            assembler.word_value(word)
        assembler.register(ROTATION)
        assembler.check(opcodes.ABSENT, _ROTATED_ALREADY, blamed=angle)
        assembler.drop()
        for register in (ROTATION_ORDINATE, ROTATION_ABSCISSA):
            assembler.emit(opcodes.TO_MILLIMETRES)
            assembler.set_register(register)
        assembler.set_register(ROTATION)
    _update(control, assembler)


def _update(control: Control, assembler: Assembler) -> None:
    """Scale, then mirror, then rotation about its centre in the working plane hold from here on."""
    assembler.disturbed(lambda: refuse_change(control))
    assembler.check(opcodes.UNCOMPENSATED, TRANSFORM_COMPENSATED)
    assembler.emit(opcodes.TRANSFORM)
    write_forgotten_polar(assembler)
