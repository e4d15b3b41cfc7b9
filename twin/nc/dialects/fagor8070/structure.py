"""Which $ keywords of a Fagor program belong together."""

import dataclasses
import re
from collections.abc import Sequence

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


@dataclasses.dataclass(frozen=True, slots=True)
class Branch:
    """A further branch of a construct: its keyword and its line, from 0."""

    keyword: str
    line: int


@dataclasses.dataclass(slots=True, eq=False)
class Construct:
    """A condition or a loop.

    Attributes:
        keyword: That begins it.
        begin: Its first line, from 0.
        branches: Further ones, in order.
        end: Its last line; None where it has none.
    """

    keyword: str
    begin: int
    branches: list[Branch] = dataclasses.field(default_factory=list)
    end: int | None = None


@dataclasses.dataclass(slots=True)
class Structure:
    """All constructs of a program.

    Attributes:
        by_line: The construct that each keyword's line belongs to.
        constructs: In the order of their beginnings.
    """

    by_line: dict[int, Construct] = dataclasses.field(default_factory=dict)
    constructs: list[Construct] = dataclasses.field(default_factory=list)
    _around: dict[int, list[Construct]] = dataclasses.field(default_factory=dict)

    def around(self, line: int) -> list[Construct]:
        """The constructs that a line lies in, the outermost first."""
        found = self._around.get(line)
        if found is None:
            found = self._around[line] = [
                each
                for each in self.constructs
                if each.end is not None and each.begin < line < each.end
            ]
        return found


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
