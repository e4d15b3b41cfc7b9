"""Frames of the SINUMERIK: work offsets, G53 to SUPA, and the programmable frame (TRANS, ROT, SCALE, MIRROR).

A work offset shifts what the programmable frame makes of the programmed position. TRANS, ROT, SCALE and MIRROR
replace the whole programmable frame; ATRANS, AROT, ASCALE and AMIRROR go on from it. Several angles of one ROT turn
about Z, then about the new Y, then about the new X (RPY). TRANS, ROT, SCALE or MIRROR alone ends the frame.
"""

import math
from collections.abc import Callable, Mapping

from twin.nc.control.codes import Action
from twin.nc.control.control import Control
from twin.nc.dialects.sinumerik.memory import memory_of
from twin.nc.dialects.sinumerik.targets import forget_polar, frame_changed, frame_changes
from twin.nc.geometry.frame import chained
from twin.nc.geometry.matrices import (
    IDENTITY,
    LARGEST_SCALE,
    SMALLEST_SCALE,
    Matrix,
    applied,
    rotated,
    transposed,
)
from twin.nc.geometry.planes import XY, YZ, ZX, Vector
from twin.nc.iso.machine_coordinates import enter_machine_frame, leave_machine_frame
from twin.nc.iso.offsets import machine_zero, offset_of_job
from twin.nc.iso.tool_compensation import set_length
from twin.nc.text.blocks import Word

_NO_SHIFT: Vector = (0.0, 0.0, 0.0)
_SAME_SCALE = 1e-9
"""Scales that differ by a smaller share are the same."""
_ABOUT = (YZ, ZX, XY)
"""The plane that a rotation about X, Y or Z turns."""


# --- work offsets


def offset_name(number: int) -> str:
    """What a row of $P_UIFR is called: 1 to 4 are G54 to G57, the others G505 to G599; 0 is G500."""
    return f"G{53 + number}" if 1 <= number <= 4 else f"G{500 + number}"


def work_offset(number: int) -> Action:
    """G54 to G57."""
    return lambda control: select_offset(control, f"G{number}", control.code_word(number))


def numbered_offset(control: Control, word: Word) -> None:
    """G505 to G599, read as a word so that the table of codes needs no line for each."""
    number = 500 + int(control.number(word))
    other = next((each for each, code in control.codes if code.group == "offset"), None)
    if other is not None:
        message = f"{other.text} and G{number} exclude each other (offset)"
        control.fail("conflicting-codes", message, word, "write them in two blocks")
    select_offset(control, f"G{number}", word)
    control.modal.active.put("offset", float(number))


def select_offset(control: Control, name: str, word: Word | None) -> None:
    """Put a work offset into force: one of the job, or one that the program has written."""
    memory = memory_of(control)
    values = memory.offsets.get(name)
    memory.offset = name
    put_offset(control, offset_of_job(control, name, word) if values is None else values)


def put_offset(control: Control, values: Mapping[str, float]) -> None:
    """Put the values of a work offset into force, 0 for axes that it leaves out [mm or deg]."""
    _refuse_while_compensating(control)
    before = frame_changes(control)
    memory_of(control).machine_pending = False
    shift = [values.get(name, 0.0) for name in control.settings.axes.names]
    control.frame.set_shift("offset", shift)
    frame_changed(control, before)


def cancel_offsets(control: Control) -> None:
    """G500: no work offset, so that coordinates count from machine zero, as soon as something moves."""
    memory = memory_of(control)
    memory.offset = "G500"
    zero = memory.offsets.get("G500") or control.settings.machine_zero
    if zero is None:
        memory.machine_pending = True
    else:
        put_offset(control, zero)


def require_machine_zero(control: Control) -> None:
    """A block moves: G500 must know where machine zero is."""
    if memory_of(control).machine_pending:
        machine_zero(control, "G500")


def machine_position(code: str) -> Action:
    """G53, G153, SUPA: the block counts from machine zero, without any frame."""

    def action(control: Control) -> None:
        memory = memory_of(control)
        if control.path.compensation.in_force:
            message = "machine coordinates know no radius compensation"
            control.fail("compensation-change", message, hint=f"end it by G40 before {code}")
        memory.part_frame = enter_machine_frame(control, code)

    return action


def leave_machine_position(control: Control) -> None:
    """Behind G53, G153 or SUPA frames count again; a tool offset of the block stays."""
    memory, frame = memory_of(control), control.frame
    if memory.part_frame is not None:
        length = frame.shift("length") if _sets_length(control) else None
        leave_machine_frame(control, memory.part_frame)
        memory.part_frame = memory.carried = None
        if length is not None:
            set_length(control, length[2])
        forget_polar(control)


def _sets_length(control: Control) -> bool:
    return any(
        word.address == "D" or (word.address, word.value) == ("M", 6.0)
        for word in control.block.words
    )


# --- the programmable frame


def _refuse_while_compensating(control: Control) -> None:
    if control.path.compensation.in_force:
        message = "a frame cannot change while radius compensation is in force"
        control.fail("compensation-change", message, hint="end it by G40 first")


def programmable(control: Control) -> tuple[Matrix, Vector]:
    """Matrix and translation of the programmable frame."""
    memory = memory_of(control)
    return memory.matrix, memory.translation


def put_programmable(control: Control, matrix: Matrix, translation: Vector) -> None:
    """Put another programmable frame into force."""
    _refuse_while_compensating(control)
    before, memory = frame_changes(control), memory_of(control)
    memory.matrix, memory.translation = matrix, translation
    lengths = [math.hypot(*row) for row in transposed(matrix)]
    memory.uneven = max(lengths) - min(lengths) > _SAME_SCALE * max(lengths)
    x, y, z = (a + b for a, b in zip(translation, memory.fine, strict=True))
    shift: Vector = (x, y, z)
    if memory.swivel is not None:
        matrix, shift = chained(memory.swivel, (matrix, shift))
    control.frame.set_matrix(matrix)
    others = [memory.other_shifts.get(axis, 0.0) for axis in range(3, len(control.settings.axes))]
    control.frame.set_shift("rotation", [*shift, *others])
    frame_changed(control, before)


def end_programmable(control: Control) -> None:
    """No programmable frame: TRANS, ROT, SCALE or MIRROR alone."""
    memory = memory_of(control)
    memory.fine, memory.other_shifts = _NO_SHIFT, {}
    put_programmable(control, IDENTITY, _NO_SHIFT)


Change = Callable[[Control], tuple[Matrix, Vector]]
"""Takes the words of a block; the frame that they say."""


def frame_code(change: Change, *, additive: bool) -> Action:
    """The action of TRANS, ROT, SCALE, MIRROR, or of those with an A before them."""

    def action(control: Control) -> None:
        bare = not control.words
        memory = memory_of(control)
        if not additive:
            memory.fine, memory.other_shifts = _NO_SHIFT, {}
        if bare and not additive:
            end_programmable(control)
            return
        matrix, shift = change(control)
        if additive:
            before = memory.matrix, memory.translation
            matrix, shift = chained(before, (matrix, shift))
        put_programmable(control, matrix, shift)

    return action


def _axis_words(control: Control, meaning: str) -> dict[int, Word]:
    words = dict(control.take_axis_words())
    if not words:
        control.fail("frame", f"the block needs axes: {meaning}")
    return words


def _only_geometry(control: Control, words: Mapping[int, Word]) -> None:
    for axis, word in words.items():
        if axis > 2:
            message = (
                f"{word.address} is no axis that a frame turns, scales or mirrors: X, Y and Z are"
            )
            control.fail("frame", message, word)


def translation(control: Control) -> tuple[Matrix, Vector]:
    """TRANS X Y Z: a shift; of further axes too."""
    words = _axis_words(control, "TRANS X10 Y5")
    values = {axis: control.axis_value(axis, word) for axis, word in words.items()}
    others = memory_of(control).other_shifts
    for axis, value in values.items():
        if axis > 2:
            others[axis] = others.get(axis, 0.0) + value
    return IDENTITY, (values.get(0, 0.0), values.get(1, 0.0), values.get(2, 0.0))


def rotation(control: Control) -> tuple[Matrix, Vector]:
    """ROT X Y Z or ROT RPL=: turns [deg]."""
    plane_angle = control.take("RPL")
    if plane_angle is not None:
        if control.words:
            control.fail("frame", "RPL= has no axes", plane_angle, "write ROT RPL=45 or ROT Z45")
        directions = control.modal.plane.directions
        return rotated(IDENTITY, directions, control.number(plane_angle), (0.0, 0.0))[0], _NO_SHIFT
    words = _axis_words(control, "ROT Z45, or ROT RPL=45")
    _only_geometry(control, words)
    matrix = IDENTITY
    for axis in sorted(words):
        angle = control.number(words[axis])
        matrix = rotated(matrix, _ABOUT[axis].directions, angle, (0.0, 0.0))[0]
    return matrix, _NO_SHIFT


def scaling(control: Control) -> tuple[Matrix, Vector]:
    """SCALE X Y Z: factors of axes."""
    words = _axis_words(control, "SCALE X2 Y2")
    _only_geometry(control, words)
    factors = [1.0, 1.0, 1.0]
    for axis, word in words.items():
        factors[axis] = control.number(word)
        if not SMALLEST_SCALE <= factors[axis] <= LARGEST_SCALE:
            control.fail("scale", "a scale lies between 0.001 and 1000", word)
    return _diagonal(factors), _NO_SHIFT


def mirroring(control: Control) -> tuple[Matrix, Vector]:
    """MIRROR X0: the values of the words do not count (manual)."""
    words = _axis_words(control, "MIRROR X0")
    _only_geometry(control, words)
    return _diagonal([-1.0 if axis in words else 1.0 for axis in range(3)]), _NO_SHIFT


def _diagonal(values: list[float]) -> Matrix:
    a, b, c = values
    return ((a, 0.0, 0.0), (0.0, b, 0.0), (0.0, 0.0, c))


def translate_axes(*, fine: bool) -> Action:
    """G58: the shift of the axes that are named, whatever turns; G59: their fine shift."""

    def action(control: Control) -> None:
        memory = memory_of(control)
        words = _axis_words(control, "G58 X10")
        _only_geometry(control, words)
        shift = list(memory.fine if fine else memory.translation)
        for axis, word in words.items():
            shift[axis] = control.axis_value(axis, word)
        x, y, z = shift
        if fine:
            memory.fine = (x, y, z)
        put_programmable(control, memory.matrix, memory.translation if fine else (x, y, z))

    return action


def refuse_uneven_arc(control: Control) -> None:
    """An arc under a scale that is not the same along both axes of its plane is no arc."""
    matrix, plane = control.frame.matrix, control.modal.plane
    lengths = [math.hypot(*applied(matrix, each)) for each in (plane.abscissa, plane.ordinate)]
    if abs(lengths[0] - lengths[1]) > _SAME_SCALE * max(lengths):
        message = "the scales of both axes of the plane differ, and an arc becomes an ellipse"
        control.fail("scale", message, hint="scale both axes alike, or write lines")
