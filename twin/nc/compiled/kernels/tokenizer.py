"""The bytes of a plain line to words: letters with plain numbers, and comments passed over.

A line is plain when the reading of lines (``line_reader``) would find nothing in it but words of
the letters that ``DecodeTables`` names, each with a plain number, and comments. Whatever else it
holds, right or wrong, is left to that reader: it alone makes diagnostics.
"""

import numpy as np

from twin.compilation.compilable import compilable
from twin.nc.bytecode.registers import MOST_WORDS
from twin.nc.bytecode.token_kinds import NUMBER, OTHER, UNSUPPORTED, ByteArray, LineTables
from twin.nc.canonical import FloatArray, IntArray

_BLANK, _TAB, _PLUS, _MINUS, _POINT = 32, 9, 43, 45, 46
_DIGIT_0, _DIGIT_9, _LETTER_A, _LETTER_Z, _TO_UPPER = 48, 57, 65, 90, 0xDF
_EXACT_MANTISSA = 2**53 // 10 - 1
"""A mantissa up to here takes a further digit and is still exact as a double."""
_POWERS = 10.0 ** np.arange(23)
"""The powers of ten that are exact as doubles.

A quotient of two exact doubles is the double nearest to the decimal number, as ``float`` gives it
(W. D. Clinger, How to read floating point numbers accurately, 1990).
"""


@compilable
def line_end(data: ByteArray, begin: int, following: int) -> int:
    """End of a line without its CR, LF or CR LF, given where it and the next one begin."""
    end = following
    if end > begin and data[end - 1] == 10:
        end -= 1
        if end > begin and data[end - 1] == 13:
            end -= 1
    elif end > begin and data[end - 1] == 13:
        end -= 1
    return end


@compilable
def read_words(
    data: ByteArray,
    begin: int,
    end: int,
    tables: LineTables,
    token_kinds: IntArray,
    values: FloatArray,
) -> int:
    """Read a line.

    Args:
        data: The program as UTF-8.
        begin: First byte of the line.
        end: Behind its last byte.
        tables: How the dialect's lines are read.
        token_kinds: Filled with what each word's letter is, shape (``MOST_WORDS``,).
        values: Filled with the words' values, shape (``MOST_WORDS``,).

    Returns:
        How many words it has, or ``UNSUPPORTED``.
    """
    count, at = 0, begin
    while True:
        at = skip_blanks(data, at, end)
        if at == end:
            return count
        letter = int(data[at]) & _TO_UPPER
        if not _LETTER_A <= letter <= _LETTER_Z:
            at = _skip_comment(data, begin, at, end, tables)
            if at == UNSUPPORTED:
                return UNSUPPORTED
            continue
        token_kind = tables.token_kinds[letter - _LETTER_A]
        if token_kind == OTHER or count == MOST_WORDS or (token_kind == NUMBER and count > 0):
            return UNSUPPORTED
        value, pointed, at = _read_number(data, skip_blanks(data, at + 1, end), end)
        if at == UNSUPPORTED:
            return UNSUPPORTED
        if not pointed and value != 0.0 and tables.pointed[letter - _LETTER_A]:
            return UNSUPPORTED
        token_kinds[count], values[count] = token_kind, value
        count += 1


@compilable
def skip_blanks(data: ByteArray, at: int, end: int) -> int:
    """The first place from ``at`` on that holds no blank, or ``end``."""
    while at < end and (data[at] == _BLANK or data[at] == _TAB):
        at += 1
    return at


@compilable
def _read_number(data: ByteArray, at: int, end: int) -> tuple[float, bool, int]:
    """A number, whether it has a point, and the place behind it.

    That place is ``UNSUPPORTED`` where there is no number or it is very long.
    """
    negative = at < end and data[at] == _MINUS
    if negative or (at < end and data[at] == _PLUS):
        at += 1
    mantissa, digits, decimals, fraction = 0, 0, 0, False
    while at < end:
        byte = int(data[at])
        if byte == _POINT:
            if fraction:
                return 0.0, True, UNSUPPORTED
            fraction = True
        elif _DIGIT_0 <= byte <= _DIGIT_9:
            if mantissa > _EXACT_MANTISSA:
                return 0.0, fraction, UNSUPPORTED
            mantissa = 10 * mantissa + byte - _DIGIT_0
            digits += 1
            decimals += fraction
        else:
            break
        at += 1
    if digits == 0 or decimals >= len(_POWERS):
        return 0.0, fraction, UNSUPPORTED
    value = mantissa / _POWERS[decimals]
    return (-value if negative else value), fraction, at


@compilable
def _skip_comment(data: ByteArray, begin: int, at: int, end: int, tables: LineTables) -> int:
    """The place behind the comment that begins here; ``UNSUPPORTED`` where none does."""
    for kind in range(len(tables.openings)):
        behind = _behind(data, at, end, tables.openings[kind])
        if behind == UNSUPPORTED:
            continue
        if tables.whole_line[kind] and skip_blanks(data, begin, end) != at:
            continue
        closing = tables.closings[kind]
        for place in range(behind, end):
            if data[place] < _BLANK and data[place] != _TAB:
                return UNSUPPORTED
            if closing[0] != 0:
                closed = _behind(data, place, end, closing)
                if closed != UNSUPPORTED:
                    return closed
        return end if closing[0] == 0 else UNSUPPORTED
    return UNSUPPORTED


@compilable
def _behind(data: ByteArray, at: int, end: int, mark: ByteArray) -> int:
    """The place behind a mark of one or two bytes; ``UNSUPPORTED`` where it does not stand here."""
    if at >= end or data[at] != mark[0]:
        return UNSUPPORTED
    if mark[1] == 0:
        return at + 1
    if at + 1 < end and data[at + 1] == mark[1]:
        return at + 2
    return UNSUPPORTED
