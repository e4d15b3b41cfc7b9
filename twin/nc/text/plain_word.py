"""How a plain word is written: blanks, an address, blanks, a number.

One table of steps says it: regular expressions are made of it, and the kernel of plain lines goes by it from
byte to byte.
"""

import string
from collections.abc import Mapping

import numpy as np

_BLANK, _LETTER, _DIGIT, _POINT, _SIGN = range(5)
"""Kinds of characters."""
_CHARACTERS: Mapping[int, str] = {
    _BLANK: " \t",
    _LETTER: string.ascii_letters,
    _DIGIT: string.digits,
    _POINT: ".",
    _SIGN: "+-",
}

BEGIN, ADDRESS, SIGNED, WHOLE, _LONE_POINT, FRACTION, END = range(7)
"""How far a word has been read: blanks alone; its address; a sign; digits; a point without digits
before it; digits with a point. Or it has ended before."""
_NUMBER = {_DIGIT: WHOLE, _POINT: _LONE_POINT}
_STEPS: Mapping[int, Mapping[int, int]] = {
    BEGIN: {_BLANK: BEGIN, _LETTER: ADDRESS},
    ADDRESS: {_BLANK: ADDRESS, **_NUMBER, _SIGN: SIGNED},
    SIGNED: _NUMBER,
    WHOLE: {_DIGIT: WHOLE, _POINT: FRACTION},
    _LONE_POINT: {_DIGIT: FRACTION},
    FRACTION: {_DIGIT: FRACTION},
    END: {},
}
"""Where each kind of character leads; any other one ends the word."""
_ENDS = (WHOLE, FRACTION)
"""What a whole word has come to."""


def _repeated(stage: int) -> str:
    """Regular expression of what does not lead on."""
    characters = [_CHARACTERS[kind] for kind, to in _STEPS[stage].items() if to == stage]
    return f"[{characters[0]}]*" if characters else ""


def _onward(stage: int) -> str:
    """Regular expression of what leads on, up to the end of the word."""
    steps = {kind: to for kind, to in _STEPS[stage].items() if to != stage}
    branches: list[str] = []
    for kind, to in steps.items():
        one = f"[{_CHARACTERS[kind]}]"
        rest = {other: behind for other, behind in steps.items() if other != kind}
        if rest and rest == _STEPS[to]:  # may be left out
            return f"{one}?{_onward(to)}"
        several = _repeated(to)
        branches.append((f"{one}+" if several == f"{one}*" else one + several) + _onward(to))
    if stage in _ENDS and branches:
        return f"(?:{'|'.join(branches)})?"
    return f"(?:{'|'.join(branches)})" if len(branches) > 1 else "".join(branches)


BLANKS, BLANKS_BETWEEN = _repeated(BEGIN), _repeated(ADDRESS)
"""What may be before an address, and behind it; as all others, for regular expressions."""
NUMBER, SIGNED_NUMBER = _onward(SIGNED), _onward(ADDRESS)
"""A number without a sign, and a word's, which may have one."""


def _scan_table() -> np.ndarray[tuple[int], np.dtype[np.uint8]]:
    table = np.full((len(_STEPS), 256), END, np.uint8)
    for stage, steps in _STEPS.items():
        for kind, to in steps.items():
            table[stage, list(_CHARACTERS[kind].encode())] = to
    return table.ravel()


SCAN_TABLE = _scan_table()
"""The stage that a byte of UTF-8 leads to: 256 for each stage, shape (1792,)."""
IS_BLANK = SCAN_TABLE[:256] == BEGIN
"""Whether a byte is a blank, shape (256,)."""
IS_DIGIT = SCAN_TABLE[FRACTION << 8 : (FRACTION + 1) << 8] == FRACTION
"""Whether a byte is a digit, shape (256,)."""
IS_WORD = np.isin(np.arange(len(_STEPS)), _ENDS)
"""Whether what has come to a stage is a whole word, shape (7,)."""
