"""Which $ keywords of a Fagor program belong together."""

import re
from collections.abc import Sequence

from twin.nc.control.constructs import Branch, Construct, Structure

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
    structure = Structure()
    open_ones: list[Construct] = []
    for line, text in enumerate(lines):
        if "$" not in text or (match := _KEYWORD.match(text)) is None:
            continue
        keyword = match[1].upper()
        inner = open_ones[-1] if open_ones else None
        if keyword in _ENDS.values() and not (keyword == "$IF" and "$" in match[2]):
            inner = Construct(keyword, line)
            open_ones.append(inner)
            structure.constructs.append(inner)
        elif inner is not None and _BRANCHES.get(keyword) == inner.keyword:
            inner.branches.append(Branch(keyword, line))
        elif inner is not None and _ENDS.get(keyword) == inner.keyword:
            inner.end = line
            open_ones.pop()
        else:
            continue
        structure.by_line[line] = inner
    return structure
