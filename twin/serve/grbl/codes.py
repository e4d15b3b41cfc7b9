"""Answers of Grbl 1.1: its codes of errors and alarms, and which finding of the interpreter has which.

Numbers are those of Grbl's own tables (``error_codes_en_US.csv``, ``alarm_codes_en_US.csv``).
"""

import enum
import re

from twin.nc.text.diagnostics.diagnostics import Diagnostic


class Error(enum.IntEnum):
    """Why a line is refused."""

    EXPECTED_LETTER = 1
    BAD_NUMBER = 2
    INVALID_STATEMENT = 3
    NEGATIVE_VALUE = 4
    NOT_IDLE = 8
    LOCKED = 9
    LINE_OVERFLOW = 11
    TRAVEL_EXCEEDED = 15
    INVALID_JOG = 16
    UNSUPPORTED_COMMAND = 20
    MODAL_GROUP_VIOLATION = 21
    UNDEFINED_FEED = 22
    AXIS_WORD_CONFLICT = 24
    WORD_REPEATED = 25
    NO_AXIS_WORDS = 26
    INVALID_LINE_NUMBER = 27
    VALUE_WORD_MISSING = 28
    UNSUPPORTED_SYSTEM = 29
    G53_WITHOUT_MOTION = 30
    AXIS_WORDS_UNUSED = 31
    INVALID_TARGET = 33
    ARC_RADIUS = 34
    NO_OFFSETS_IN_PLANE = 35
    UNUSED_WORDS = 36
    TOOL_NUMBER = 38


class AlarmNumber(enum.IntEnum):
    """Why the machine stands."""

    HARD_LIMIT = 1
    SOFT_LIMIT = 2
    ABORTED = 3


_ERRORS = {
    "arc-center": Error.INVALID_TARGET,
    "arc-full-by-radius": Error.INVALID_TARGET,
    "arc-overdefined": Error.UNUSED_WORDS,
    "arc-radius": Error.ARC_RADIUS,
    "arc-without-center": Error.NO_OFFSETS_IN_PLANE,
    "code-words": Error.VALUE_WORD_MISSING,
    "conflicting-codes": Error.MODAL_GROUP_VIOLATION,
    "control-character": Error.EXPECTED_LETTER,
    "duplicate-word": Error.WORD_REPEATED,
    "dwell": Error.VALUE_WORD_MISSING,
    "feed-range": Error.NEGATIVE_VALUE,
    "foreign-letter": Error.EXPECTED_LETTER,
    "label": Error.INVALID_LINE_NUMBER,
    "machine-coordinates": Error.G53_WITHOUT_MOTION,
    "missing-value": Error.BAD_NUMBER,
    "no-feed": Error.UNDEFINED_FEED,
    "no-motion-code": Error.AXIS_WORDS_UNUSED,
    "no-machine-zero": Error.UNSUPPORTED_SYSTEM,
    "no-offset": Error.UNSUPPORTED_SYSTEM,
    "number-range": Error.BAD_NUMBER,
    "preset": Error.NO_AXIS_WORDS,
    "spindle-range": Error.NEGATIVE_VALUE,
    "tool-number": Error.TOOL_NUMBER,
    "unreadable": Error.EXPECTED_LETTER,
    "unused-word": Error.UNUSED_WORDS,
}


_NAME = re.compile(r"'[A-Za-z]{2}")
"""A letter where Grbl reads the number of the one before."""


def error_of(finding: Diagnostic) -> Error:
    """Grbl's code of what is wrong with a block; what it has no code for is a command that it does not support."""
    if finding.code == "dwell" and "negative" in finding.message:
        return Error.NEGATIVE_VALUE
    if finding.code == "conflicting-codes" and "axis words" in finding.message:
        return Error.AXIS_WORD_CONFLICT
    if finding.code == "unknown-word" and _NAME.match(finding.message):
        return Error.BAD_NUMBER
    return _ERRORS.get(finding.code, Error.UNSUPPORTED_COMMAND)


def alarm_of(code: str) -> AlarmNumber:
    """Grbl's number of an alarm of the twin.

    Decision: what Grbl cannot sense (collisions, following error, a standing spindle in the stock, the emergency
    stop) is a cycle that was aborted, with its position in doubt; a message names it.
    """
    known = {"hard-limit": AlarmNumber.HARD_LIMIT, "soft-limit": AlarmNumber.SOFT_LIMIT}
    return known.get(code, AlarmNumber.ABORTED)
