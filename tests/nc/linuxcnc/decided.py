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
CENTER = "arc_centre_moved_to_fit"
LAST_PECK = "last_peck"
PASSED_OVER = "values_passed_over"
_KNOWN = {each.example for each in DECISIONS}
assert {
    BREAK,
    LENGTH_BEFORE_CHANGE,
    CLARITY,
    ENDLESS,
    CENTER,
    LAST_PECK,
    PASSED_OVER,
    "tool_of_m61",
} <= _KNOWN

_REFUSED = re.compile(
    r"two codes of the block want its axis words|has no counterpart|a NURBS is ended by G5\.3|a control point needs its weight P"
    r"|has changed the unit since a tool length|cannot be turned while G92|tools have a length along Z"
    r"|#<<|it belongs to lathes|no O-word of the control|O needs a label"
    r"|follows the spindle, which stands at S0|in a block with M72 are lost|M6 needs a tool that T has prepared|cannot be in a block with M0*9[89]|put aside would change the radius|G92(?:\.\d)? and G92(?:\.\d)? exclude"
    r"|probing needs a feed per minute|too much for two points so near each other|error line-too-long|in square brackets.*\n.*elseif"
    r"|nothing in this block uses 'Q.*\n.*G\s*1\s*0\s*L\s*20?(?!\d)",
    re.IGNORECASE,
)
"""What the twin says where it refuses for clarity's sake and ``rs274`` does not."""

_BREAK = re.compile(r"^\s*(?:N\d+\s*)?o\s*(\d+|<[^>]*>)\s*break", re.IGNORECASE)
_ENDWHILE = re.compile(r"^\s*(?:N\d+\s*)?o\s*(\d+|<[^>]*>)\s*endwhile\s*$", re.IGNORECASE)
_PASSED_OVER = re.compile(r"^\s*o\s*(?:\d+|<[^>]*>)\s*(?:return|endsub|while)\b", re.IGNORECASE)
_FIRST_LABEL = 700_000
_MOST_SLIPS = 6
Slip = tuple[float, float, float]
"""How far a place lies beside another one along X, Y and Z [mm]."""
NO_SLIP: Slip = (0.0, 0.0, 0.0)
Slips = list[list[float]]
"""How far it may lie beside it along each of these axes [mm]."""
_SPINDLE = re.compile(r"M0*[345](?![0-9.])")
_LOAD = re.compile(r"^\s*M\s*61\s*Q\s*(\d+)\s*$", re.IGNORECASE)


def for_rs274(text: str) -> tuple[str, frozenset[str]]:
    """A program as ``rs274`` must read it to do what was decided, and the decisions that changed it.

    It remembers a break, even of a loop that was passed over, until a do loop ends, which it then ends:
    behind each while loop that may break an empty do loop stands, which takes the break away. M61
    leaves its tool table as it was: M6 is written in place of it.
    """
    looped = list(_with_empty_loops(text.split("\n")))
    loaded = list(_with_tools(looped))
    changes = {BREAK: "\n".join(looped) != text, "tool_of_m61": loaded != looped}
    return "\n".join(loaded), frozenset(name for name, changed in changes.items() if changed)


def _with_empty_loops(lines: list[str]) -> Iterator[str]:
    broken = {match[1].lower() for line in lines if (match := _BREAK.match(line))}
    for number, line in enumerate(lines):
        yield line
        match = _ENDWHILE.match(line)
        if match and match[1].lower() in broken:
            label = f"o{_FIRST_LABEL + number}"
            yield f"{label} do"
            yield f"{label} while [0]"


def _with_tools(lines: list[str]) -> Iterator[str]:
    """The lines with M6 in the place of M61, and the spindle as it was."""
    spindle = "M5"
    for line in lines:
        for match in _SPINDLE.findall(line.upper()):
            spindle = match
        load = _LOAD.match(line)
        yield line if load is None else f"T{load[1]} M6"
        if load is not None:
            yield spindle


def is_decided_refusal(said: str) -> bool:
    """Whether the twin refuses for clarity's sake."""
    return _REFUSED.search(said) is not None


def is_computed_too_early(said: str) -> bool:
    """Whether ``rs274`` refuses what it computes in a line that a definition or a break passes over."""
    error, _, line = said.partition("\n")
    return _PASSED_OVER.match(line) is not None and not error.startswith(("Unclosed", "Unknown"))


def slips_of(forgotten: list[Slip]) -> Slips:
    """How far the moves of ``rs274`` may lie beside those of the control, axis by axis [mm].

    After a tool change its model of the machine is where the last move ended as it was
    programmed, without the lengths that have come into force since; each change may add its own.
    """
    axes: list[list[float]] = []
    for axis in range(3):
        sums = {0.0}
        for each in forgotten[:_MOST_SLIPS]:
            sums |= {value + each[axis] for value in sums}
        axes.append(sorted(sums, key=abs))
    return axes
