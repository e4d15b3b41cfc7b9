"""The bytes of a plain line to values: letters with plain numbers, and comments passed over.

How words and comments are written, ``text.plain_word`` and ``text.comments`` say for Python's reader and for
this one. Whatever else a line holds, right or wrong, is left to Python: it alone makes diagnostics.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from twin.compilation.compilable import compilable, inlined
from twin.nc.canonical import FloatArray, IntArray
from twin.nc.text.comments import CommentMarks, comment_end
from twin.nc.text.expressions.expressions import LARGEST_NUMBER
from twin.nc.text.plain_word import (
    ADDRESS,
    BEGIN,
    END,
    FRACTION,
    IS_BLANK,
    IS_DIGIT,
    IS_WORD,
    SCAN_TABLE,
    SIGNED,
)

ByteArray = npt.NDArray[np.uint8]

# Numbers of the kernels of ``twin.nc``, here and elsewhere, are plain integers: CPython runs these functions too,
# and takes three times as long to compare with a member of an enumeration.
OTHER, NUMBER, CODE, FEED_WORD, RADIUS, CENTER, AXIS = -1, 0, 1, 2, 3, 4, 7
"""Roles of letters: none in a plain line; N, G, F, R; I, J, K from ``CENTER`` on; axes by their column from
``AXIS`` on."""
NOT_PLAIN = -1
_MINUS, _POINT, _DIGIT_0 = ord("-"), ord("."), ord("0")
_LETTER_A, _TO_UPPER = ord("A"), 0xDF
_EXACT_MANTISSA = 2**53 // 10 - 1
"""A mantissa up to here takes a further digit and is still exact as a double."""
_LONGEST_NUMBER = 12
"""Digits of a bare block number (as ``text.keyword_line`` reads it)."""
_POWERS = 10.0 ** np.arange(23)
"""The powers of ten that are exact as doubles.

A quotient of two exact doubles is the double nearest to the decimal number, as ``float`` gives it
(W. D. Clinger, How to read floating point numbers accurately, 1990).
"""


class LineFormat(NamedTuple):
    """How a dialect writes plain lines on a machine.

    Attributes:
        roles: Of each letter, shape (26,).
        longest: Bytes of a line that may be plain.
        keyword: Letter, from 0, that a line may begin with behind a bare block number; -1: none, and no such numbers.
        continued: Byte at the end of a line that goes on in the next one; 0: none does.
    """

    roles: IntArray
    comments: CommentMarks
    longest: int
    keyword: int = -1
    continued: int = 0


@compilable
def read_line(
    data: ByteArray,
    begin: int,
    end: int,
    form: LineFormat,
    increments: FloatArray,
    values: FloatArray,
) -> int:
    """Read a line.

    Args:
        data: The program as UTF-8.
        begin: First byte of the line.
        end: Behind its last byte.
        form: How lines are written.
        increments: What 1 without a decimal point counts behind each letter; NaN: the line is not plain, shape (26,).
        values: Filled with the value of each role that the line has, shape (roles,).

    Returns:
        The roles that it has, as bits; or ``NOT_PLAIN``.
    """
    seen, at = int(np.int64(0)), begin
    if form.keyword >= 0:
        seen, at = _read_keyword(data, begin, end, form, values)
        if seen == NOT_PLAIN:
            return NOT_PLAIN
    while True:
        stage, letter, value, at = _read_word(data, at, end)
        if stage == BEGIN:
            if at == end:
                return seen
            at = comment_end(data, begin, at, end, form.comments)
            if at < 0:
                return NOT_PLAIN
            continue
        role = form.roles[letter]
        if role == OTHER or seen >> role & 1 or (role == NUMBER and seen):
            return NOT_PLAIN
        if at == NOT_PLAIN or abs(value) > LARGEST_NUMBER:
            return NOT_PLAIN
        if stage != FRACTION and value != 0.0:
            value *= increments[letter]
            if value != value:
                return NOT_PLAIN
        seen |= 1 << role
        values[role] = value


@compilable
def _read_keyword(
    data: ByteArray, begin: int, end: int, form: LineFormat, values: FloatArray
) -> tuple[int, int]:
    """A bare block number and the keyword, where a line has them: its roles so far, and the place behind both."""
    last = end
    while last > begin and IS_BLANK[data[last - 1]]:
        last -= 1
    if last > begin and data[last - 1] == form.continued:
        return NOT_PLAIN, begin
    seen, at = int(np.int64(0)), _stay(data, begin, end, BEGIN)
    first, number = at, 0
    while at < end and IS_DIGIT[data[at]] and at - first < _LONGEST_NUMBER:
        number = 10 * number + int(data[at]) - _DIGIT_0
        at += 1
    if at > first:
        if at < end and not IS_BLANK[data[at]]:
            return NOT_PLAIN, begin
        seen, values[NUMBER] = 1 << NUMBER, number
        at = _stay(data, at, end, BEGIN)
    is_keyword = at < end and (int(data[at]) & _TO_UPPER) - _LETTER_A == form.keyword
    if is_keyword and (at + 1 == end or IS_BLANK[data[at + 1]]):
        at += 1
    return seen, at


@compilable
def _read_word(data: ByteArray, at: int, end: int) -> tuple[int, int, float, int]:
    """A word: the stage that it has come to, its letter from 0, its number, and the place behind it.

    That place is ``NOT_PLAIN`` where the word has no number or a very long one. A number's stages
    follow from its digits and its point: a loop that went by them from byte to byte would wait for each.
    """
    at = _stay(data, at, end, BEGIN)
    if at == end or SCAN_TABLE[BEGIN << 8 | int(data[at])] == END:
        return BEGIN, 0, 0.0, at
    letter = (int(data[at]) & _TO_UPPER) - _LETTER_A
    at = _stay(data, at + 1, end, ADDRESS)
    signed = at < end and SCAN_TABLE[ADDRESS << 8 | int(data[at])] == SIGNED
    negative = at < end and data[at] == _MINUS
    stage = SIGNED if signed else ADDRESS
    at += signed
    mantissa, digits, decimals, pointed = 0, 0, 0, False
    while at < end:
        byte = int(data[at])
        if IS_DIGIT[byte]:
            if mantissa > _EXACT_MANTISSA:
                return stage, letter, 0.0, NOT_PLAIN
            mantissa = 10 * mantissa + byte - _DIGIT_0
            digits += 1
            decimals += pointed
        elif byte == _POINT and not pointed:
            pointed = True
        else:
            break
        at += 1
    if digits > decimals:  # further digits stay at the stage of the first
        stage = int(SCAN_TABLE[stage << 8 | _DIGIT_0])
    if pointed:
        stage = int(SCAN_TABLE[stage << 8 | _POINT])
    if decimals > 0:
        stage = int(SCAN_TABLE[stage << 8 | _DIGIT_0])
    if not IS_WORD[stage] or decimals >= len(_POWERS):
        return stage, letter, 0.0, NOT_PLAIN
    value = mantissa / _POWERS[decimals]
    return stage, letter, (-value if negative else value), at


@inlined
def _stay(data: ByteArray, at: int, end: int, stage: int) -> int:
    """The first place from ``at`` on whose byte leads on from a stage, or ``end``."""
    while at < end and SCAN_TABLE[stage << 8 | int(data[at])] == stage:
        at += 1
    return at
