"""Conditions and loops of a program whose keywords are on lines of their own."""

import dataclasses
from collections.abc import Mapping

from twin.nc.text.blocks import Location


@dataclasses.dataclass(frozen=True, slots=True)
class Branch:
    """A further branch of a construct: its keyword and its line, from 0."""

    keyword: str
    line: int


@dataclasses.dataclass(slots=True, eq=False)
class Construct:
    """A condition or a loop.

    Attributes:
        begin: Its first line, from 0.
        depth: Constructs around it, and itself.
        end: Its last line; None where it has none.
        name: Its label; empty where it has none.
    """

    keyword: str
    begin: int
    depth: int
    branches: list[Branch] = dataclasses.field(default_factory=list)
    end: int | None = None
    name: str = ""

    @property
    def behind(self) -> Location:
        """The place behind it, where it has an end."""
        assert self.end is not None
        return Location(self.end + 1, 0)


@dataclasses.dataclass(slots=True)
class Structure:
    """All constructs of a program.

    Attributes:
        ends: Keywords that end one, with those that begin it.
        branches: Keywords that begin a further branch of one, with those that begin it.
        by_line: The construct that each keyword's line belongs to.
        constructs: In the order of their beginnings.
    """

    ends: Mapping[str, str]
    branches: Mapping[str, str] = dataclasses.field(default_factory=dict)
    by_line: dict[int, Construct] = dataclasses.field(default_factory=dict)
    constructs: list[Construct] = dataclasses.field(default_factory=list)
    _open: list[Construct] = dataclasses.field(default_factory=list)
    _around: dict[int, list[Construct]] = dataclasses.field(default_factory=dict)

    def add(self, keyword: str, line: int, name: str = "") -> None:
        """The next keyword of the text: it ends or divides the innermost open construct, or begins one."""
        found, inner = None, self._open[-1] if self._open else None
        if inner is not None and inner.name == name:
            if self.branches.get(keyword) == inner.keyword:
                inner.branches.append(Branch(keyword, line))
                found = inner
            elif self.ends.get(keyword) == inner.keyword:
                inner.end = line
                found = self._open.pop()
        if found is None and keyword in self.ends.values():
            found = Construct(keyword, line, len(self._open) + 1, name=name)
            self._open.append(found)
            self.constructs.append(found)
        if found is not None:
            self.by_line[line] = found

    @property
    def is_open(self) -> bool:
        """A construct has begun, and not ended yet."""
        return bool(self._open)

    def close(self) -> None:
        """What has begun and not ended has no end."""
        self._open.clear()

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
