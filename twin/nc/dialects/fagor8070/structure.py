"""Which $ keywords of a Fagor program belong together."""

import re
from collections.abc import Sequence

from twin.nc.control.constructs import Structure

_KEYWORD = re.compile(
    r"[ \t]*/?[ \t]*(?:N[ \t]*[0-9]+[ \t]*|\[\w+\][ \t]*)?(\$[A-Z]+)(.*)", re.IGNORECASE
)
_ENDS = {
    "$ENDIF": "$IF",
    "$ENDWHILE": "$WHILE",
    "$ENDDO": "$DO",
    "$ENDFOR": "$FOR",
    "$ENDSWITCH": "$SWITCH",
}
_BRANCHES = {"$ELSEIF": "$IF", "$ELSE": "$IF", "$CASE": "$SWITCH", "$DEFAULT": "$SWITCH"}


def structure_of(lines: Sequence[str]) -> Structure:
    """Pair the keywords of a program; those that have no counterpart stay open."""
    structure = Structure(_ENDS, _BRANCHES)
    for line, text in enumerate(lines):
        if "$" in text and (match := _KEYWORD.match(text)) is not None:
            keyword = match[1].upper()
            if not (keyword == "$IF" and "$" in match[2]):
                structure.add(keyword, line)
    return structure
