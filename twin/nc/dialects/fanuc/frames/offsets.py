"""Work offsets of a Fanuc control: G54 to G59, G54.1 P, G52, G92, and what programs write into the table.

The job's offsets count from part zero, and G54 is part zero itself where the job gives it no values.
What a program writes (G10 L2, #5221) counts from machine zero, as on the control. G52 and G92 shift
all of them alike; a work offset ends neither (manual).
"""

from twin.nc.control.codes import Action
from twin.nc.control.control import Control
from twin.nc.dialects.fanuc.memory import memory_of, refuse_transformed
from twin.nc.dialects.fanuc.programs import whole
from twin.nc.iso.offsets import (
    note_written,
    refuse_empty_preset,
    select_offset,
    shift_by,
    table_zero,
)
from twin.nc.text.blocks import Word

LARGEST_EXTENDED = 300
"""G54.1 P1 to P300 (the largest number of pairs that the option has)."""


def further(control: Control, number: int) -> str:
    """How the job calls the work offset G54.1 P, of a Haas G154 P or G54.1 P."""
    code = memory_of(control).variant.further_offset
    names = [f"{each} P{number}" for each in (code, "G54.1")]
    return next((each for each in names if each in control.settings.offsets), names[0])


def offset_code(number: int) -> Action:
    """G54 to G59; ``G54 P1`` is G54.1 P1."""

    def action(control: Control) -> None:
        if number == 54 and "P" in control.words:
            extended_offset(control)
        else:
            select(control, f"G{number}", control.code_word(number))

    return action


def extended_offset(control: Control) -> None:
    """G54.1 P, on a Haas G154 P."""
    word = control.take("P")
    if word is None:
        code = memory_of(control).variant.further_offset
        message = "the number of the work offset is missing: P"
        control.fail("no-offset", message, hint=f"{code} P1")
    number = whole(control, word, "no-offset", "number of a work offset")
    if not 1 <= number <= LARGEST_EXTENDED:
        control.fail("no-offset", f"there is no work offset P{number}", word)
    select(control, further(control, number), word)
    memory_of(control).extended_number = number


def select(control: Control, name: str, word: Word | None) -> None:
    """Put a work offset into force."""
    refuse_transformed(control, name)
    memory = memory_of(control)
    if name not in memory.offsets:
        presets = control.frame.shift("preset")
        select_offset(control, name, word)
        control.frame.set_shift("preset", presets)
    memory.offset = name
    put_into_force(control)


def put_into_force(control: Control) -> None:
    """The work offset in force or the external one has new values."""
    memory = memory_of(control)
    values = offset_values(control, memory.offset)
    for axis, value in memory.common_offset.items():
        values[axis] = values.get(axis, 0.0) + value
    shift_by(control, values, ends_preset=False)


def offset_values(control: Control, name: str) -> dict[str, float]:
    """A work offset by axis, from part zero [mm or deg]."""
    written = memory_of(control).offsets.get(name)
    return dict(control.settings.offsets.get(name, {}) if written is None else written)


def write_offset(control: Control, name: str | None, axis: str, value: float, code: str) -> None:
    """Write a work offset, from machine zero; without a name the external one [mm or deg]."""
    memory = memory_of(control)
    if name is None:
        memory.common_offset[axis] = value
    else:
        zero = table_zero(control, code)
        if not control.modal.incremental:
            note_written(control, axis, value)
        values = memory.offsets.setdefault(name, offset_values(control, name))
        values[axis] = value + zero.get(axis, 0.0)


def read_offset(control: Control, name: str | None, axis: str, code: str) -> float:
    """A work offset from machine zero [mm or deg]."""
    if name is None:
        return memory_of(control).common_offset.get(axis, 0.0)
    zero = table_zero(control, code)
    return offset_values(control, name).get(axis, 0.0) - zero.get(axis, 0.0)


def local_offset(control: Control) -> None:
    """G52: shifts all work offsets; coordinates count from the work offset; 0 ends it."""
    refuse_transformed(control, "G52")
    words = control.take_axis_words()
    if not words:
        control.fail("preset", "G52 needs the coordinates of the local origin", hint="G52 X10.")
    shift = control.frame.shift("increment")
    for index, word in words:
        shift[index] = control.axis_value(index, word)
    control.frame.set_shift("increment", shift)
    control.motion.reframed()


def preset(control: Control) -> None:
    """G92: the place where the tool is gets the coordinates of the block; ends G52 there.

    G92 S, the largest speed of the spindle at constant cutting speed, moves nothing.
    """
    refuse_transformed(control, "G92")
    words = control.take_axis_words()
    if not words:
        refuse_empty_preset(control)
    local = control.frame.shift("increment")
    programmed = list(control.motion.programmed)
    for index, word in words:
        local[index] = 0.0
        programmed[index] = control.axis_value(index, word)
    control.frame.set_shift("increment", local)
    control.motion.set_position(programmed, "preset")


def end_preset(control: Control) -> None:
    """G92.1: the coordinates of the work offset hold again for the axes that it names."""
    words = control.take_axis_words()
    if not words:
        control.fail("preset", "G92.1 needs the axes whose preset ends", hint="G92.1 X0 Y0 Z0")
    for name in ("preset", "increment"):
        shift = control.frame.shift(name)
        for index, _ in words:
            shift[index] = 0.0
        control.frame.set_shift(name, shift)
    control.motion.reframed()
