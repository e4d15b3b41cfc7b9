"""Work offsets and presets: codes that most dialects share.

Decisions, for every dialect: a work offset counts from the job's part zero; G54 is part zero itself
where the job gives it no values; a work offset ends a preset (G92). G53 puts coordinates back to
machine zero until the next work offset.
"""

from collections.abc import Iterable, Mapping
from typing import NoReturn

from twin.nc.control.codes import GCode
from twin.nc.control.control import Control
from twin.nc.text.blocks import Word


def select_offset(control: Control, name: str, word: Word | None) -> None:
    """Put a work offset of the job into force."""
    shift_by(control, offset_of_job(control, name, word))


def offset_of_job(control: Control, name: str, word: Word | None) -> Mapping[str, float]:
    """The values that the job gives a work offset; a word asks for it."""
    values = control.settings.offsets.get(name)
    if values is None and name != "G54":
        known = ", ".join(sorted(control.settings.offsets)) or "none"
        key = name if name.isalnum() else f'"{name}"'
        message = f"the job gives no work offset {name}"
        hint = f"write it under [offsets.{key}]; the job has: {known}"
        control.fail("no-offset", message, word, hint=hint)
    return values or {}


def cancel_offset(control: Control) -> None:
    """G53: coordinates count from machine zero."""
    shift_by(control, machine_zero(control, "G53"))


def machine_zero(control: Control, code: str) -> Mapping[str, float]:
    """Part coordinates of machine zero by axis [mm or deg], for a code that counts from there."""
    zero = control.settings.machine_zero
    if zero is None:
        message = f"{code} counts from machine zero, and the job does not say where that lies"
        hint = "write part_zero with its Z into the job file; twin init writes a first one"
        control.fail("no-machine-zero", message, hint=hint)
    return zero


def place_from_machine_zero(control: Control, code: str) -> list[float]:
    """Where the axes are, machine coordinates, shape (k,) [mm or deg], for a code that stores it."""
    zero, names = machine_zero(control, code), control.settings.axes.names
    return [at - zero.get(name, 0.0) for name, at in zip(names, control.motion.part, strict=True)]


def table_zero(control: Control, code: str) -> Mapping[str, float]:
    """Part coordinates of the point from which the control's table of work offsets counts, by axis [mm or deg].

    It is machine zero, or lies so that what the program writes there first is part zero (the job's ``written_zero``).
    """
    written = control.settings.written_zero
    if written is None:
        return machine_zero(control, code)
    return {axis: -written[axis] for axis in written}


def note_written(control: Control, axis: str, value: float) -> None:
    """The program writes a value of a work offset into the control's table; the first one of an axis is kept [mm or deg]."""
    control.written_zero.setdefault(axis, value)


def shift_by(control: Control, values: Mapping[str, float], *, ends_preset: bool = True) -> None:
    """Put a work offset by its values into force, 0 for axes that it leaves out [mm or deg]."""
    names = control.settings.axes.names
    control.frame.set_shift("offset", [values.get(name, 0.0) for name in names])
    if ends_preset:
        control.frame.set_shift("preset", [0.0] * len(names))
    control.motion.reframed()


def programmed_shift(control: Control, name: str) -> None:
    """A shift with the block's values, 0 for the axes that it leaves out."""
    words = dict(control.take_axis_words())
    axes = range(len(control.settings.axes))
    values = [control.axis_value(axis, words[axis]) if axis in words else 0.0 for axis in axes]
    control.frame.set_shift(name, values)
    control.motion.reframed()


def refuse_empty_preset(control: Control) -> NoReturn:
    """G92 names no axis."""
    message = "G92 needs the coordinates that this place shall have"
    control.fail("preset", message, hint="G92 X0 Y0 makes it X0 Y0")


def preset(control: Control) -> None:
    """G92: the place where the machine is gets the coordinates of the block."""
    words = control.take_axis_words()
    if not words:
        refuse_empty_preset(control)
    set_position(control, words, "preset")


def set_position(control: Control, words: Iterable[tuple[int, Word]], shift: str) -> None:
    """Words of axes give the place where the machine is other coordinates, by a shift."""
    programmed = list(control.motion.programmed)
    for index, word in words:
        programmed[index] = control.axis_value(index, word)
    control.motion.set_position(programmed, shift)


def _work_offset(number: int) -> GCode:
    name = f"G{number}"

    def action(control: Control) -> None:
        select_offset(control, name, control.code_word(number))

    return GCode(meaning=f"work offset {name} of the job", group="offset", action=action)


OFFSETS = {
    53: GCode(
        meaning="offsets cancelled: machine coordinates", group="offset", action=cancel_offset
    ),
    **{number: _work_offset(number) for number in range(54, 60)},
}
PRESET = {92: GCode(meaning="preset the position", perform=preset)}
