"""Planes, offsets, mirror, scale and rotation of the Fagor CNC 8070."""

from twin.nc.arcs import direction
from twin.nc.block_words import BlockWords
from twin.nc.block_writer import BlockWriter, NotTranslatableError
from twin.nc.blocks import Word
from twin.nc.control import Control
from twin.nc.dialects.fagor8070.memory import memory_of
from twin.nc.dialects.fagor8070.polar import forget_polar, reset_polar_origin
from twin.nc.frame import IDENTITY, Matrix, multiply
from twin.nc.instructions import Step
from twin.nc.offsets import (
    refuse_plane_change,
    select_offset,
    set_length,
    tool_numbered,
    write_programmed_shift,
)
from twin.nc.planes import Plane, Vector, cross

OFFSETS_BY_NUMBER = 20
"""Work offsets that G159 can name; the first six are G54 to G59."""


def change_plane(control: Control) -> None:
    """G17, G18, G19: the polar origin goes back to part zero."""
    refuse_plane_change(control)
    if memory_of(control).rotation is not None:
        control.fail("rotation-active", "the plane cannot change while G73 turns it")
    reset_polar_origin(control)


def any_plane(control: Control) -> None:
    """G20 X1 Z2: abscissa (1), ordinate (2) and, if written, perpendicular axis (3).

    Decision: G03 turns from the abscissa towards the ordinate, whatever axes they are.
    """
    change_plane(control)
    roles: dict[int, Vector] = {}
    for index, word in control.take_axis_words():
        role = int(control.number(word))
        if role not in (1, 2, 3) or role in roles or index > 2:
            control.fail(
                "plane-axes", "1, 2 and 3 name abscissa, ordinate and the axis across", word
            )
        x, y, z = (1.0 if each == index else 0.0 for each in range(3))
        roles[role] = (x, y, z)
    if 1 not in roles or 2 not in roles:
        control.fail("plane-axes", "G20 needs abscissa and ordinate", hint="write G20 X1 Y2")
    normal = cross(roles[1], roles[2])
    control.modal.plane = Plane("G20", roles[1], roles[2], normal)


def incremental_offset(control: Control) -> None:
    """G158 X Y: added to the work offset; without axes it ends."""
    shift = [0.0] * len(control.settings.axes)
    for index, word in control.take_axis_words():
        shift[index] = control.axis_value(index, word)
    control.frame.set_shift("increment", shift)
    control.reframed()
    forget_polar(control)


def numbered_offset(control: Control, word: Word) -> None:
    """G159=2: the work offset by its number; 1 to 6 are G54 to G59."""
    number = control.number(word)
    if number != int(number) or not 1 <= number <= OFFSETS_BY_NUMBER:
        control.fail("no-offset", f"there is no work offset {number:g}", word)
    name = f"G{53 + int(number)}" if number <= 6 else f"G159={int(number)}"
    select_offset(control, name, word)
    forget_polar(control)


# --- mirror, scale, rotation


def mirror_off(control: Control) -> None:
    """G10."""
    memory_of(control).mirrored = frozenset()
    _update(control)


def mirror_x(control: Control) -> None:
    """G11."""
    _mirror(control, 0, on=True)


def mirror_y(control: Control) -> None:
    """G12."""
    _mirror(control, 1, on=True)


def mirror_z(control: Control) -> None:
    """G13."""
    _mirror(control, 2, on=True)


def mirror_axes(control: Control) -> None:
    """G14 X-1 Y1: -1 mirrors an axis, 1 ends it."""
    words = control.take_axis_words()
    for index, word in words:
        if abs(control.number(word)) != 1.0 or index > 2:
            control.fail("mirror", "G14 takes -1 or 1 for X, Y and Z", word)
        _mirror(control, index, on=control.number(word) < 0.0)
    if not words:
        control.fail("mirror", "G14 needs the axes to mirror", hint="write G14 X-1")


def _mirror(control: Control, index: int, *, on: bool) -> None:
    memory = memory_of(control)
    memory.mirrored = memory.mirrored | {index} if on else memory.mirrored - {index}
    _update(control)


def scale(control: Control) -> None:
    """G72 S2: lengths are multiplied; G72 alone or S1 ends it."""
    word = control.take("S")
    factor = 1.0 if word is None else control.number(word)
    if not 1e-3 <= factor <= 1e3:
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
    memory, frame = memory_of(control), control.frame
    if control.path.compensating:
        message = "mirror, scale and rotation cannot change while compensation is in force"
        control.fail("compensation-change", message, hint="end it by G40 first")
    rows = [
        tuple(
            (-memory.scale if row in memory.mirrored else memory.scale) if row == column else 0.0
            for column in range(3)
        )
        for row in range(3)
    ]
    matrix: Matrix = ((*rows[0],), (*rows[1],), (*rows[2],))  # pyright: ignore[reportAssignmentType]
    shift: Vector = (0.0, 0.0, 0.0)
    if memory.rotation is not None:
        angle, center = memory.rotation
        turning = _about_normal(control.modal.plane, angle)
        matrix = multiply(turning, matrix)
        middle = control.modal.plane.world(*center, 0.0)
        moved = [sum(a * b for a, b in zip(row, middle, strict=True)) for row in turning]
        shift = (middle[0] - moved[0], middle[1] - moved[1], middle[2] - moved[2])
    frame.set_matrix(IDENTITY if matrix == IDENTITY else matrix)
    frame.set_shift("rotation", [*shift, *([0.0] * (len(control.settings.axes) - 3))])
    control.reframed()
    forget_polar(control)


def _about_normal(plane: Plane, angle: float) -> Matrix:
    """The rotation about a plane's normal, in X, Y, Z."""
    cosine, sine = direction(angle)
    to_world: Matrix = _transposed((plane.abscissa, plane.ordinate, plane.normal))
    turn: Matrix = ((cosine, -sine, 0.0), (sine, cosine, 0.0), (0.0, 0.0, 1.0))
    return multiply(multiply(to_world, turn), (plane.abscissa, plane.ordinate, plane.normal))


def _transposed(matrix: Matrix) -> Matrix:
    a, b, c = matrix
    return ((a[0], b[0], c[0]), (a[1], b[1], c[1]), (a[2], b[2], c[2]))


# --- tools and the rotary axis


def tool_offset(control: Control, word: Word) -> None:
    """D1: the tool's own length and radius; D0: none."""
    number = control.number(word)
    if number not in (0.0, 1.0):
        message = f"the job gives every tool one offset, D1, not D{number:g}"
        control.fail("tool-offset", message, word)
    tool = control.tools.data(control.tools.spindle)
    longer = 0.0 if number == 0.0 or tool is None else control.tools.longer(tool)
    memory_of(control).offset_on = number == 1.0
    set_length(control, longer)


def select_tool(control: Control, word: Word) -> None:
    """T: the tool that M06 brings, known to the job."""
    number = tool_numbered(control, word) if control.tools.table else int(control.number(word))
    control.tools.selected = number
    control.function(f"T{number}", {})


def write_tool_offset(block: BlockWords, writer: BlockWriter) -> None:
    """D0, D1, for the fast way.

    Raises:
        NotTranslatableError: It is neither.
    """
    value = block.words.pop("D").value
    if value not in (0.0, 1.0):
        raise NotTranslatableError
    writer.step(Step.OFFSET_ON, int(value == 1.0))
    writer.step(Step.TOOL_LENGTH)


def write_tool(block: BlockWords, writer: BlockWriter) -> None:
    """T, for the fast way."""
    writer.word_value(block.words.pop("T"))
    writer.step(Step.TOOL, 1)


def write_tool_change(_block: BlockWords, writer: BlockWriter) -> None:
    """M06, for the fast way."""
    writer.step(Step.CHANGE_TOOL)
    writer.step(Step.OFFSET_ON, 1)
    writer.step(Step.TOOL_LENGTH)


def write_increment(block: BlockWords, writer: BlockWriter) -> None:
    """G158, for the fast way."""
    write_programmed_shift("increment", block, writer)
    writer.step(Step.REFRAME)
    writer.step(Step.FORGET_POLAR)


def change_tool(control: Control) -> None:
    """M06: the tool goes into the spindle with its offset D1."""
    control.tools.change()
    memory_of(control).offset_on = True
    tool = control.tools.data(control.tools.spindle)
    if tool is not None:
        set_length(control, control.tools.longer(tool))


def turn_in_commanded_direction(control: Control, _rapid: bool) -> None:
    """With ``module_rotary``: G90 turns in the direction of the sign, by less than a turn.

    Raises:
        ProgramError: The target is a turn or more.
    """
    if not control.settings.module_rotary or control.modal.incremental:
        return
    for index, name in enumerate(control.settings.axes.names):
        word = control.words.get(name)
        if word is None or control.linear[index] or word.incremental:
            continue
        value = control.number(word)
        if abs(value) >= 360.0:
            control.fail("module-range", "the target of a module axis is below one turn", word)
        target, here = abs(value), control.programmed[index] % 360.0
        backwards = value < 0.0 or str(value).startswith("-")
        start = here
        if backwards and here < target:
            start = here + 360.0
        elif not backwards and here > target:
            start = here - 360.0
        programmed = list(control.programmed)
        programmed[index] = start
        control.relabel(programmed, "turns")
        control.words[name] = word._replace(value=target)
