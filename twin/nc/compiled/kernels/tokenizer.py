"""The bytes of a plain line to words: letters with plain numbers, and comments passed over.

A line is plain when the reading of lines (``line_reader``) would find nothing in it but words of
the letters that ``DecodeTables`` names, each with a plain number, and comments. How these are
written, ``text.plain_word`` and ``text.comments`` say for both. Whatever else the line holds, right or
wrong, is left to that reader: it alone makes diagnostics.
"""

import numpy as np

from twin.compilation.compilable import compilable, inlined
from twin.nc.bytecode.registers import MOST_WORDS
from twin.nc.bytecode.token_kinds import NUMBER, OTHER, UNSUPPORTED, ByteArray, LineTables
from twin.nc.canonical import FloatArray, IntArray
from twin.nc.text.comments import comment_end
from twin.nc.text.plain_word import (
    ADDRESS,
    BEGIN,
    END,
    FRACTION,
    IS_DIGIT,
    IS_WORD,
    SIGNED,
    WALK,
)

_MINUS, _POINT, _DIGIT_0 = ord("-"), ord("."), ord("0")
_LETTER_A, _TO_UPPER = ord("A"), 0xDF
_EXACT_MANTISSA = 2**53 // 10 - 1
"""A mantissa up to here takes a further digit and is still exact as a double."""
_POWERS = 10.0 ** np.arange(23)
"""The powers of ten that are exact as doubles.

A quotient of two exact doubles is the double nearest to the decimal number, as ``float`` gives it
(W. D. Clinger, How to read floating point numbers accurately, 1990).
"""


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
        stage, letter, value, at = _read_word(data, at, end)
        if stage == BEGIN:
            if at == end:
                return count
            at = comment_end(data, begin, at, end, tables.comments)
            if at < 0:
                return UNSUPPORTED
            continue
        token_kind = tables.token_kinds[letter]
        if token_kind == OTHER or count == MOST_WORDS or (token_kind == NUMBER and count > 0):
            return UNSUPPORTED
        if at == UNSUPPORTED or (stage != FRACTION and value != 0.0 and tables.pointed[letter]):
            return UNSUPPORTED
        token_kinds[count], values[count] = token_kind, value
        count += 1


@compilable
def _read_word(data: ByteArray, at: int, end: int) -> tuple[int, int, float, int]:
    """A word: the stage that it has come to, its letter from 0, its number, and the place behind it.

    That place is ``UNSUPPORTED`` where the word has no number or a very long one. A number's stages
    follow from its digits and its point: a loop that went by them from byte to byte would wait for each.
    """
    at = _stay(data, at, end, BEGIN)
    if at == end or WALK[BEGIN << 8 | int(data[at])] == END:
        return BEGIN, 0, 0.0, at
    letter = (int(data[at]) & _TO_UPPER) - _LETTER_A
    at = _stay(data, at + 1, end, ADDRESS)
    signed = at < end and WALK[ADDRESS << 8 | int(data[at])] == SIGNED
    negative = at < end and data[at] == _MINUS
    stage = SIGNED if signed else ADDRESS
    at += signed
    mantissa, digits, decimals, pointed = 0, 0, 0, False
    while at < end:
        byte = int(data[at])
        if IS_DIGIT[byte]:
            if mantissa > _EXACT_MANTISSA:
                return stage, letter, 0.0, UNSUPPORTED
            mantissa = 10 * mantissa + byte - _DIGIT_0
            digits += 1
            decimals += pointed
        elif byte == _POINT and not pointed:
            pointed = True
        else:
            break
        at += 1
    if digits > decimals:  # further digits stay at the stage of the first
        stage = int(WALK[stage << 8 | _DIGIT_0])
    if pointed:
        stage = int(WALK[stage << 8 | _POINT])
    if decimals > 0:
        stage = int(WALK[stage << 8 | _DIGIT_0])
    if not IS_WORD[stage] or decimals >= len(_POWERS):
        return stage, letter, 0.0, UNSUPPORTED
    value = mantissa / _POWERS[decimals]
    return stage, letter, (-value if negative else value), at


@inlined
def _stay(data: ByteArray, at: int, end: int, stage: int) -> int:
    """The first place from ``at`` on whose byte leads on from a stage, or ``end``."""
    while at < end and WALK[stage << 8 | int(data[at])] == stage:
        at += 1
    return at
