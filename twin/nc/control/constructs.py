"""Conditions and loops of a program whose keywords stand on lines of their own."""

import dataclasses


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
        name: Its label; empty where it has none.
    """

    keyword: str
    begin: int
    branches: list[Branch] = dataclasses.field(default_factory=list)
    end: int | None = None
    name: str = ""


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
