"""G70 and G71 of a Haas: the holes of the canned cycle in force lie on a circle or on an arc.

I is the radius, J the angle of the first hole from +X, K of G71 the angle from hole to hole, L how many
holes. The centre is where the tool is, or the X and Y of the block.
"""

import math

from twin.nc.control.codes import GCode, Interpolation
from twin.nc.control.control import Control
from twin.nc.dialects.fanuc.programs import whole
from twin.nc.geometry.arcs import direction
from twin.nc.geometry.planes import XY
from twin.nc.text.blocks import Word


def bolt_holes(number: int) -> GCode:
    """G70, on a whole circle, or G71, on an arc."""
    shape = "a circle: I J L" if number == 70 else "an arc: I J K L"
    return GCode(
        meaning=f"holes of the cycle in force on {shape}",
        perform=lambda control: _drill(control, number),
        basis="manual",
    )


def _drill(control: Control, code: int) -> None:
    cycle = control.modal.cycle
    if cycle is None:
        message = f"G{code} places the holes of a canned cycle, and none is in force"
        hint = "write it before: G81 Z-5. R1. F100. L0; inches are G20, millimetres G21"
        control.fail("cycle-word", message, control.code_word(code), hint)
    assert isinstance(cycle, Interpolation)
    if control.modal.plane is not XY:
        control.fail("cycle-plane", f"the holes of G{code} lie in X Y", None, "write G17")
    radius, often = control.take("I"), control.take("L")
    first, spacing = control.take("J"), control.take("K") if code == 71 else None
    if radius is None or often is None or (code == 71 and spacing is None):
        needed = "I and L" if code == 70 else "I, K and L"
        control.fail("cycle-word", f"G{code} needs {needed}", control.code_word(code))
    count = whole(control, often, "repeat-count", "count of holes")
    if not 1 <= count <= control.settings.step_limit:
        control.fail("repeat-count", f"{often.text} is no count of holes", often)
    center = [_coordinate(control, index) for index in range(2)]
    angle = 0.0 if first is None else control.number(first)
    step = 360.0 / count if spacing is None else control.number(spacing)
    given = dict(control.words)
    for number in range(count):
        cosine, sine = direction(math.fmod(angle + number * step, 360.0))
        length = control.length(radius)
        place = center[0] + length * cosine, center[1] + length * sine
        control.words = {**given, **_words_to(control, place, radius)}
        cycle.perform(control)
        given = {}


def _coordinate(control: Control, index: int) -> float:
    """Of the centre [mm]."""
    here = control.motion.programmed[index]
    word = control.take("XY"[index])
    if word is None:
        return here
    return control.axis_value(index, word) + (here if control.modal.incremental else 0.0)


def _words_to(control: Control, place: tuple[float, float], error_at: Word) -> dict[str, Word]:
    """The words that lead to a place, as the block could have written them."""
    words: dict[str, Word] = {}
    for index, (address, value) in enumerate(zip("XY", place, strict=True)):
        begin = control.motion.programmed[index] if control.modal.incremental else 0.0
        count = (value - begin) / control.modal.unit
        words[address] = Word(address, count, error_at.column, error_at.width)
    return words
