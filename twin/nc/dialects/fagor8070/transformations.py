"""Mirror, scale and rotation of the Fagor CNC 8070, and the same for the compiled tier."""

import math

from twin.nc.bytecode import opcodes
from twin.nc.bytecode.assembler import Assembler, UnsupportedError
from twin.nc.control.block_words import BlockWords
from twin.nc.control.codes import Compiler
from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070.machine_coordinates import refuse_change
from twin.nc.dialects.fagor8070.memory import memory_of
from twin.nc.dialects.fagor8070.polar import forget_polar
from twin.nc.geometry.frame import composed
from twin.nc.geometry.matrices import LARGEST_SCALE, SMALLEST_SCALE
from twin.nc.text.blocks import Word


def mirror_off(control: Control) -> None:
    """G10."""
    memory_of(control).signs = (1.0, 1.0, 1.0)
    _update(control)


def mirror_x(control: Control) -> None:
    """G11."""
    _mirror(control, 0, -1.0)


def mirror_y(control: Control) -> None:
    """G12."""
    _mirror(control, 1, -1.0)


def mirror_z(control: Control) -> None:
    """G13."""
    _mirror(control, 2, -1.0)


def mirror_axes(control: Control) -> None:
    """G14 X-1 Y1: -1 mirrors an axis, 1 ends it."""
    words = control.take_axis_words()
    for index, word in words:
        if abs(control.number(word)) != 1.0 or index > 2:
            control.fail("mirror", "G14 takes -1 or 1 for X, Y and Z", word)
        _mirror(control, index, control.number(word))
    if not words:
        control.fail("mirror", "G14 needs the axes to mirror", hint="write G14 X-1")


def _mirror(control: Control, index: int, sign: float) -> None:
    memory = memory_of(control)
    x, y, z = (sign if each == index else old for each, old in enumerate(memory.signs))
    memory.signs = (x, y, z)
    _update(control)


def scale(control: Control) -> None:
    """G72 S2: lengths are multiplied; G72 alone or S1 ends it."""
    word = control.take("S")
    set_scale(control, 1.0 if word is None else control.number(word), word)


def set_scale(control: Control, factor: float, word: Word | None = None) -> None:
    """Multiply lengths by a factor, told the word that gives it."""
    if not SMALLEST_SCALE <= factor <= LARGEST_SCALE:
        control.fail("scale", "a scale lies between 0.001 and 1000", word)
    memory_of(control).scale = factor
    _update(control)


def rotate(control: Control) -> None:
    """G73 Q I J: turn by Q about I J, missing ones part zero; G73 alone ends it.

    Decision: a rotation must end before another begins, since adding and replacing are both known.
    """
    angle = control.take("Q")
    center = [control.length(control.take(letter)) for letter in "IJ"]
    memory = memory_of(control)
    if angle is None:
        memory.rotation = None
    else:
        if memory.rotation is not None:
            control.fail("rotation-active", "a rotation is in force", angle, "end it by G73 alone")
        memory.rotation = (control.number(angle), (center[0], center[1]))
    _update(control)


def _update(control: Control) -> None:
    """Compose scale, then mirror, then rotation about its centre in the working plane."""
    refuse_change(control)
    memory, frame = memory_of(control), control.frame
    if control.path.compensating:
        message = "mirror, scale and rotation cannot change while compensation is in force"
        control.fail("compensation-change", message, hint="end it by G40 first")
    angle, center = (math.nan, (0.0, 0.0)) if memory.rotation is None else memory.rotation
    plane = control.modal.plane.directions
    matrix, shift = composed(memory.signs, memory.scale, plane, angle, center)
    frame.set_matrix(matrix)
    frame.set_shift("rotation", [*shift, *([0.0] * (len(control.settings.axes) - 3))])
    control.reframed()
    forget_polar(control)


# --- for the compiled tier


def compile_mirror_off(_block: BlockWords, assembler: Assembler) -> None:
    """G10."""
    for index in range(3):
        assembler.constant(1.0)
        assembler.emit(opcodes.MIRROR, index)
    _compile_update(assembler)


def compile_mirror(index: int) -> Compiler:
    """G11, G12, G13."""

    def write(_block: BlockWords, assembler: Assembler) -> None:
        assembler.constant(-1.0)
        assembler.emit(opcodes.MIRROR, index)
        _compile_update(assembler)

    return write


def compile_mirror_axes(block: BlockWords, assembler: Assembler) -> None:
    """G14.

    Raises:
        UnsupportedError: It names no axis, or one that no mirror turns.
    """
    words = block.take_axes()
    if not words or any(index > 2 for index, _ in words):
        raise UnsupportedError
    for index, word in words:
        assembler.word_value(word)
        assembler.emit(opcodes.MIRROR, index)
    _compile_update(assembler)


def compile_scale(block: BlockWords, assembler: Assembler) -> None:
    """G72."""
    assembler.word_value(block.take("S"), 1.0)
    assembler.emit(opcodes.SCALE)
    _compile_update(assembler)


def compile_rotation(block: BlockWords, assembler: Assembler) -> None:
    """G73.

    Raises:
        UnsupportedError: It has a centre without an angle.
    """
    angle, center = block.take("Q"), [block.take("I"), block.take("J")]
    if angle is None:
        if center != [None, None]:
            raise UnsupportedError
        assembler.emit(opcodes.END_ROTATION)
    else:
        for word in (angle, *center):
            assembler.word_value(word)
        assembler.emit(opcodes.ROTATE)
    _compile_update(assembler)


def _compile_update(assembler: Assembler) -> None:
    assembler.emit(opcodes.TRANSFORM)
    assembler.emit(opcodes.FORGET_POLAR)
