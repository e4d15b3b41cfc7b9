"""How a plain word is written: blanks, an address, blanks, a number.

One table of steps says it: regular expressions for the interpreter tier are made of it, and the
compiled tier's tokenizer goes by it from byte to byte.
"""

import string
from collections.abc import Collection, Mapping

import numpy as np

BLANK, LETTER, DIGIT, POINT, SIGN, _OTHER = range(6)
"""Kinds of characters."""
_CHARACTERS: Mapping[int, str] = {
    BLANK: " \t",
    LETTER: string.ascii_letters,
    DIGIT: string.digits,
    POINT: ".",
    SIGN: "+-",
}

BEGIN, _ADDRESS, _SIGNED, _WHOLE, _LONE_POINT, FRACTION = range(6)
"""How far a word has been read: blanks alone; its address; a sign; digits; a point without digits
before it; digits with a point."""
_NUMBER = {DIGIT: _WHOLE, POINT: _LONE_POINT}
_STEPS: Mapping[int, Mapping[int, int]] = {
    BEGIN: {BLANK: BEGIN, LETTER: _ADDRESS},
    _ADDRESS: {BLANK: _ADDRESS, **_NUMBER, SIGN: _SIGNED},
    _SIGNED: _NUMBER,
    _WHOLE: {DIGIT: _WHOLE, POINT: FRACTION},
    _LONE_POINT: {DIGIT: FRACTION},
    FRACTION: {DIGIT: FRACTION},
}
"""Where each kind of character leads; any other one ends the word."""
_ENDS = (_WHOLE, FRACTION)
"""What a whole word has come to."""


def _repeated(stage: int) -> str:
    """Regular expression of what does not lead on."""
    characters = [_CHARACTERS[kind] for kind, to in _STEPS[stage].items() if to == stage]
    return f"[{characters[0]}]*" if characters else ""


def _onward(stage: int, ends: Collection[int]) -> str:
    """Regular expression of what leads on, up to the end of the word."""
    steps = [(_CHARACTERS[kind], to) for kind, to in _STEPS[stage].items() if to != stage]
    ways = [f"[{characters}]{_repeated(to)}{_onward(to, ends)}" for characters, to in steps]
    if not ways:
        return ""
    return f"(?:{'|'.join(ways)})" + ("?" if stage in ends else "")


BLANKS, BLANKS_BETWEEN = _repeated(BEGIN), _repeated(_ADDRESS)
"""What may stand before an address, and behind it; as all others, for regular expressions."""
NUMBER, SIGNED_NUMBER = _onward(_SIGNED, _ENDS), _onward(_ADDRESS, _ENDS)
"""A number without a sign, and a word's, which may have one."""
SIGNED_POINTED_NUMBER = _onward(_ADDRESS, (FRACTION,))
"""That of a word, with a decimal point."""


def _kinds() -> np.ndarray[tuple[int], np.dtype[np.uint8]]:
    kinds = np.full(256, _OTHER, np.uint8)
    for kind, characters in _CHARACTERS.items():
        kinds[list(characters.encode())] = kind
    return kinds


def _steps() -> np.ndarray[tuple[int, int], np.dtype[np.int8]]:
    steps = np.full((len(_STEPS), _OTHER + 1), -1, np.int8)
    for stage, to in _STEPS.items():
        steps[stage, list(to)] = list(to.values())
    return steps


KINDS = _kinds()
"""Kind of each byte of UTF-8, shape (256,)."""
STEPS = _steps()
"""Where each kind leads from each stage, -1: it ends the word; shape (6, 6)."""
IS_WORD = np.isin(np.arange(len(_STEPS)), _ENDS)
"""Whether what has come to a stage is a whole word, shape (6,)."""
