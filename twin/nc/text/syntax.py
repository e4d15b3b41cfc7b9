"""How a dialect writes its blocks, and by what its programs are known."""

import dataclasses
from collections.abc import Callable, Collection, Mapping
from typing import Protocol

from twin.nc.text.expressions.expressions import ExpressionSyntax

LONGEST_LINE = 65_536
"""Characters of a line: far beyond any control's block, so that one line cannot eat the memory."""


@dataclasses.dataclass(frozen=True, slots=True)
class Comment:
    """A kind of comment.

    Attributes:
        closing: What ends it; empty: the end of the line.
        whole_line: It can only begin its line, such as a program's heading.
        holds_opening: Its own opening may be in it, as a character like any other.
    """

    opening: str
    closing: str = ""
    whole_line: bool = False
    holds_opening: bool = True


HEADING = Comment("%", whole_line=True)
"""The start of a program and its name: without effect where a dialect does not say otherwise."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Syntax:
    """How a dialect writes its blocks.

    Attributes:
        expressions: How values are computed; None where only numbers are written.
        statement: Regular expression of what begins a statement; its group 1 is the keyword.
        trailing_prose: Words of prose behind a block's words are left out with a warning.
        several_blocks: A further N begins a further block on the same line.
        label: Regular expression of a block's name at its begin, the name as its group 1; empty: blocks
            have none.
        fractional_labels: The number of a block may have a fraction, which does not count.
        skip_levels: Digits that may be behind the slash of a block that can be skipped; a slash alone
            means the first.
        block_end: Character that may end a block, such as ``;``; a remark may follow it, but no further block.
        inner_comments: Comments in brackets may stand anywhere within a statement.
        incremental_suffix: ``X20I`` makes one word incremental.
        forms: Names before a value in brackets that say how it counts, such as ``X=IC(5)``, and whether
            they make the word incremental.
        codes: Names of G codes that are written without a number, and the number that the dialect's table
            has for them.
        texts: Addresses whose value may be a text in quotes, such as ``T="MILL"``.
        names: Regular expression of words that are a name in angle brackets, its group 1 their address; None:
            there are none.
        computed_behind: What must end an address whose value is computed, such as ``=``; empty: nothing.
        aliases: Addresses that mean another one.
        assigned: Character that begins an assignment among the words, such as ``#1=5``; empty: there
            is none.
        open_assignments: What is assigned needs no brackets around its operators.
        blanks_in_numbers: Blanks between the characters of a number do not count.
        decimal_comma: A comma between digits is a decimal point.
        worded: Keywords of statements behind which the block's words stand; a block may also have a bare number
            before it, and none of both.
        line_keyword: The letter that is the keyword of a straight line, which a block may also do without; empty: there
            is none.
        flag: Regular expression of words that have no value, such as ``FMAX``; None: there are none.
        continued: Character at the end of a line whose block goes on in the next one; empty: none does.
        relative: Addresses of words that are incremental, such as ``IX``, and those that they stand for.
        longest_line: Characters that a line may have.
        excused: Why a line that cannot be read may be left out, given it and the line before:
            code of the warning, or None.
    """

    address: str = "[A-Z]"
    comments: tuple[Comment, ...]
    expressions: ExpressionSyntax | None = None
    statement: str | None = None
    trailing_prose: bool = False
    several_blocks: bool = False
    label: str = ""
    fractional_labels: bool = False
    skip_levels: range = range(0)
    block_end: str = ""
    inner_comments: bool = False
    incremental_suffix: bool = False
    forms: Mapping[str, bool] = dataclasses.field(default_factory=dict)
    codes: Mapping[str, float] = dataclasses.field(default_factory=dict)
    texts: frozenset[str] = frozenset()
    names: str | None = None
    computed_behind: str = ""
    aliases: Mapping[str, str] = dataclasses.field(default_factory=dict)
    assigned: str = ""
    open_assignments: bool = False
    blanks_in_numbers: bool = False
    decimal_comma: bool = False
    worded: frozenset[str] = frozenset()
    line_keyword: str = ""
    flag: str | None = None
    continued: str = ""
    relative: Mapping[str, str] = dataclasses.field(default_factory=dict)
    longest_line: int = LONGEST_LINE
    excused: Callable[[str, str], str | None] = lambda _line, _previous: None


class Language(Protocol):
    """What reading a program needs to know of a dialect."""

    @property
    def name(self) -> str:
        """As given on the command line."""
        ...

    @property
    def code_page(self) -> str:
        """Legacy code page of its programs, such as ``cp1252``."""
        ...

    @property
    def syntax(self) -> Syntax:
        """How blocks are written."""
        ...

    @property
    def keywords(self) -> Collection[str]:
        """What statements begin with."""
        ...

    def refusal(self, code: float, /) -> str | None:
        """Why a G code that the control knows is refused, given its number; None: it is not."""
        ...


@dataclasses.dataclass(frozen=True, slots=True)
class Mark:
    """A mark of a dialect: what its programs contain, and few others.

    Attributes:
        pattern: Regular expression, searched line by line without regard to case.
        shown: How a person would say it.
        decides: Where it is, nothing that other dialects know counts.
    """

    pattern: str
    shown: str
    decides: bool = False
