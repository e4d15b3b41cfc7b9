"""Numbers without a decimal point: what they count on a Fanuc control.

Decision after the manual's default (parameter 3401 #0 at 0): a coordinate, radius, depth or angle
without a point counts least input increments, 0.001 mm, 0.0001 inch or 0.001 degree, so that X10 is
0.010 mm; a feed per minute counts mm/min or 0.01 inch/min. A job or a machine file says
``decimal_point = "calculator"`` where the control counts whole millimetres. The time P counts
milliseconds on either. The first number that is changed so is warned of.
"""

import operator

from twin.nc.control.control import WITHOUT_POINT, Control
from twin.nc.control.settings import ControlSettings
from twin.nc.dialects.fanuc.macros.variables import rounding_to, rounds
from twin.nc.dialects.fanuc.memory import memory_of
from twin.nc.path.feed_rates import FeedMode
from twin.nc.text.blocks import Block, Word
from twin.nc.text.expressions.expressions import Computed, Expression, Number

LENGTHS = frozenset("XYZUVWIJKRQ") | {",R", ",C"}
ANGLES = frozenset("ABC")
_MILLI = 0.001
_INCH_INCREMENT = 0.0001
CYCLES = frozenset({73.0, 74.0, 76.0, 77.0, *map(float, range(81, 90))})
"""Codes of cycles: their P counts milliseconds, their K holes."""
_TAPS = frozenset({74.0, 84.0})
_END_CYCLES = frozenset({0.0, 1.0, 2.0, 3.0, 80.0})
_OWN_P = frozenset({8.0, 10.0, 30.0, 51.0, 54.0, 54.1, 65.0, 66.0, 154.0})
"""Codes with a P that is no time, also while a cycle is in force."""
_CALLS = frozenset({97.0, 98.0, 99.0})
"""M functions with a P that names a program or a block."""
_SCALED = 51.0
_TURNED = 68.0
_PLANES = frozenset({68.2, 268.0})
"""Codes of tilted planes: their I, J, K and R are angles, their Q is a number."""
_CYLINDER = frozenset({7.1, 107.0})
"""Codes whose rotary axis gives a radius."""
_FEED_MODES = {
    93.0: FeedMode.BLOCKS_PER_MINUTE,
    95.0: FeedMode.PER_REVOLUTION,
    94.0: FeedMode.PER_MINUTE,
}
_UNTOUCHED = frozenset({5.1, 8.0})
"""Codes whose words are switches."""


def addresses_without_point(settings: ControlSettings) -> frozenset[str]:
    """Addresses whose numbers without a point are looked at."""
    if settings.decimal_point == "calculator":
        return frozenset("P")
    return LENGTHS | ANGLES | frozenset("PF")


def count(control: Control, block: Block) -> Block:
    """Give the words of a block the value that their numbers without a point count."""
    *others, second = block.assignments or (None,)
    if second is not None and (others or block.words):
        message = "an assignment must be alone in its block"
        control.report.line = block.line
        control.report.fail("assignment", message, second.column, second.width, "write two blocks")
    if any(isinstance(word.value, Expression) and rounds(word.value) for word in block.words):
        block = _rounded(control, block)
    looked_at = addresses_without_point(control.settings)
    if not any(word.address in looked_at for word in block.words):
        return block
    codes = {word.value for word in block.words if word.address == "G"}
    calls = any(word.address == "M" and word.value in _CALLS for word in block.words)
    words = [
        _counted(control, word, codes, calls=calls) if word.address in looked_at else word
        for word in block.words
    ]
    return block._replace(words=tuple(words))


def _counted(
    control: Control, word: Word, codes: set[float | Expression], *, calls: bool = False
) -> Word:
    goes_on = control.modal.cycle is not None and codes.isdisjoint(_END_CYCLES)
    cycles = goes_on or not codes.isdisjoint(CYCLES)
    if word.address == "P":
        waits = 4.0 in codes or (cycles and not calls and codes.isdisjoint(_OWN_P))
        return _time(control, word) if waits else _scale(word, codes)
    if not word.without_point or not isinstance(word.value, float) or word.value == 0.0:
        return word
    numbers_block = word.address == "Q" and bool(codes & _PLANES)
    if codes & _UNTOUCHED or numbers_block:
        return word
    if cycles and _is_number(control, word.address, codes):
        return word
    factor, unit = _increment(control, word.address, codes)
    if factor == 1.0:
        return word
    value = word.value * factor
    message = (
        f"{word.text} has no decimal point: it counts {factor:g} {unit}, so it is {value:g} {unit}"
    )
    hint = f'write {word.text}. for whole units, or decimal_point = "calculator" into the job'
    control.report.warn_once(WITHOUT_POINT, message, word.column, word.width, hint=hint)
    return word._replace(value=value)


def increment_of_plain_move(control: Control, address: str) -> float:
    """What 1 without a point counts where no code of the block and no cycle says more."""
    factor, _ = _increment(control, address, set())
    return factor


def _is_number(control: Control, address: str, codes: set[float | Expression]) -> bool:
    """Whether a word of a cycle says how often or how many times, not how far."""
    if memory_of(control).variant.own_cycle_words:
        return address == "L" or (address == "J" and not codes.isdisjoint(_TAPS))
    return address in "KL"


def is_counted(control: Control, word: Word) -> bool:
    """Whether an argument of a macro counts increments."""
    letters = LENGTHS | ANGLES
    counts = control.settings.decimal_point != "calculator"
    return counts and word.without_point and word.address in letters and word.value != 0.0


def argument(control: Control, word: Word) -> Word:
    """An argument of a macro: without a point it counts the increments of its address (manual)."""
    return _counted(control, word, set()) if is_counted(control, word) else word


def _rounded(control: Control, block: Block) -> Block:
    """ROUND in a word goes to the least increment of its address."""
    words = list(block.words)
    for place, word in enumerate(block.words):
        value = word.value
        if isinstance(value, Expression) and rounds(value):
            increment, _ = _increment(control, word.address, set())
            words[place] = word._replace(value=rounding_to(value, increment))
    return block._replace(words=tuple(words))


def _increment(control: Control, address: str, codes: set[float | Expression]) -> tuple[float, str]:
    """How much 1 without a point counts, and its unit for people."""
    inches = 20.0 in codes or (control.modal.unit != 1.0 and 21.0 not in codes)
    length = (_INCH_INCREMENT, "inch") if inches else (_MILLI, "mm")
    if address == "F":
        return _feed_increment(control, codes, inches=inches)
    if address in ANGLES and codes & _CYLINDER:
        return length
    plane_angle = address in "IJKR" and bool(codes & _PLANES)
    if address in ANGLES or plane_angle or (address == "R" and _TURNED in codes):
        return _MILLI, "degrees"
    if 4.0 in codes:
        return _MILLI, "seconds"
    if _SCALED in codes and address in "IJK":
        return _MILLI, "times"
    if _is_polar_angle(control, address):
        return _MILLI, "degrees"
    return length


def _feed_increment(
    control: Control, codes: set[float | Expression], *, inches: bool
) -> tuple[float, str]:
    written = (mode for code, mode in _FEED_MODES.items() if code in codes)
    mode = next(written, control.modal.feed_mode)
    if mode is FeedMode.BLOCKS_PER_MINUTE:
        return 1.0, ""
    if mode is FeedMode.PER_REVOLUTION:
        return (_INCH_INCREMENT, "inch") if inches else (0.01, "mm")
    of_mm, of_inch = memory_of(control).variant.feed_increments
    return (of_inch, "inch/min") if inches else (of_mm, "mm/min")


def _is_polar_angle(control: Control, address: str) -> bool:
    if not memory_of(control).polar:
        return False
    return control.axis_index.get(address) == control.modal.plane.axes[1]


def _time(control: Control, word: Word) -> Word:
    """P of a dwell: milliseconds, without a point."""
    if isinstance(word.value, Expression):
        return word._replace(value=_times(word.value, _MILLI))
    if not word.without_point:
        if memory_of(control).variant.seconds_by_point:
            return word
        message = f"{word.address} counts milliseconds and takes no decimal point"
        control.fail("dwell", message, word, hint="P1500 is 1.5 seconds; so is X1.5 of G4")
    return word._replace(value=word.value * _MILLI)


def _scale(word: Word, codes: set[float | Expression]) -> Word:
    """P of G51: thousandths, where it has no point."""
    if _SCALED in codes and word.without_point and isinstance(word.value, float):
        return word._replace(value=word.value * _MILLI)
    return word


def _times(expression: Expression, factor: float) -> Expression:
    times = Computed("*", operator.mul, (expression.tree, Number(factor)))
    return Expression(expression.text, times)
