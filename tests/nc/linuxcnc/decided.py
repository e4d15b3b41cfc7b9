"""Where the twin differs from ``rs274`` on purpose: the decisions that a comparison knows.

A difference counts as decided only where it is the one that its decision describes; any other one
of the same program is shown.
"""

import re
from collections.abc import Iterator

from twin.nc.dialects.linuxcnc.decisions import DECISIONS

BREAK = "break_within_do"
LENGTH_BEFORE_CHANGE = "position_after_a_tool_change"
CLARITY = "refused_for_clarity"
ENDLESS = "main_program_repeats"
_KNOWN = {each.example for each in DECISIONS}
assert {BREAK, LENGTH_BEFORE_CHANGE, CLARITY, ENDLESS} <= _KNOWN

_REFUSED = re.compile(
    r"two codes of the block want its axis words|has no counterpart|a NURBS is ended by G5\.3"
    r"|error line-too-long|in square brackets.*\n.*elseif",
    re.IGNORECASE,
)
"""What the twin says where it refuses for clarity's sake and ``rs274`` does not."""

_BREAK = re.compile(r"^\s*(?:N\d+\s*)?o\s*(\d+|<[^>]*>)\s*break", re.IGNORECASE)
_ENDWHILE = re.compile(r"^\s*(?:N\d+\s*)?o\s*(\d+|<[^>]*>)\s*endwhile\s*$", re.IGNORECASE)
_FIRST_LABEL = 700_000


def without_lasting_breaks(text: str) -> str:
    """A program in which ``rs274`` forgets a break where its while loop ends.

    It remembers one, even of a loop that was passed over, until a do loop ends, which it then ends.
    Behind each loop that may break an empty do loop stands, which takes the break away.
    """
    return "\n".join(_with_empty_loops(text.split("\n")))


def _with_empty_loops(lines: list[str]) -> Iterator[str]:
    broken = {match[1].lower() for line in lines if (match := _BREAK.match(line))}
    for number, line in enumerate(lines):
        yield line
        match = _ENDWHILE.match(line)
        if match and match[1].lower() in broken:
            label = f"o{_FIRST_LABEL + number}"
            yield f"{label} do"
            yield f"{label} while [0]"


def is_decided_refusal(said: str) -> bool:
    """Whether the twin refuses for clarity's sake."""
    return _REFUSED.search(said) is not None


def slips_of(forgotten: list[float]) -> list[float]:
    """How far along Z the moves of ``rs274`` may lie beside those of the control [mm].

    After a tool change its model of the machine stands where the last move ended as it was
    programmed, without the lengths that have come into force since; each change may add its own.
    """
    slips = {0.0}
    for each in forgotten:
        slips |= {slip + each for slip in slips}
    return sorted(slips, key=abs)
