"""The zero offsets of the Fagor CNC 8070: G54 to G59, G159, and what programs write into the table."""

from twin.nc.control.codes import Action
from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070.machine_coordinates import refuse_change
from twin.nc.dialects.fagor8070.memory import OFFSETS_BY_NUMBER, memory_of, offset_name
from twin.nc.dialects.fagor8070.polar import forget_polar
from twin.nc.iso.offsets import select_offset, shift_by
from twin.nc.text.blocks import Word


def offset_code(number: int) -> Action:
    """G54 to G59, by the number of the G code."""
    return lambda control: _select(control, f"G{number}", control.code_word(number))


def numbered_offset(control: Control, word: Word) -> None:
    """G159=2: the work offset by its number; 1 to 6 are G54 to G59."""
    number = control.number(word)
    if number != int(number) or not 1 <= number <= OFFSETS_BY_NUMBER:
        control.fail("no-offset", f"there is no work offset {number:g}", word)
    refuse_change(control)
    _select(control, offset_name(int(number)), word)
    forget_polar(control)


def _select(control: Control, name: str, word: Word | None) -> None:
    written = memory_of(control).offsets.get(name)
    if written is None:
        select_offset(control, name, word)
    else:
        shift_by(control, written)
