"""What a dialect is made of: its syntax, its codes, its words, its rules, and the decisions behind them."""

import dataclasses
import enum
from collections.abc import Collection, Mapping

from twin.nc.control.codes import Codes, Words
from twin.nc.control.control import Rules
from twin.nc.text.library import Library
from twin.nc.text.syntax import Mark, Syntax


class JobKey(enum.StrEnum):
    """Keys of a job that some controls have a setting for, and most have not."""

    DECIMAL_POINT = "decimal_point"
    OFFSET_ROWS = "offset_rows"
    ROLLOVER = "rollover"


@dataclasses.dataclass(frozen=True, slots=True)
class Decision:
    """A decision where the control's documents are silent.

    Attributes:
        example: Name of the program that shows it, among the tests' golden files.
    """

    question: str
    answer: str
    reason: str
    example: str


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Dialect:
    """One control's language, as data and a few own rules.

    Attributes:
        code_page: Legacy code page of its programs, such as ``cp1252``.
        units: Units of lengths and feeds, for people.
        suffixes: Ends of the names of files that hold its programs alone, lower case.
        tables: Further tables of its page: what is named, and what it is, by title.
        library: Adds files that the program calls, looked for in the folder of the program and read as the
            dialect is.
        job_keys: Those that its control has a setting for.
    """

    name: str
    title: str
    code_page: str
    syntax: Syntax
    codes: Codes
    words: Words
    rules: Rules = dataclasses.field(default_factory=Rules)
    units: str
    decisions: tuple[Decision, ...]
    marks: tuple[Mark, ...]
    suffixes: tuple[str, ...] = ()
    tables: Mapping[str, Mapping[str, str]] = dataclasses.field(default_factory=dict)
    library: Library | None = None
    job_keys: frozenset[JobKey] = frozenset()

    @property
    def keywords(self) -> Collection[str]:
        """What statements begin with."""
        return self.codes.statements.keys()

    def code_name(self, number: float) -> str:
        """How a G code of the table is written."""
        names = (name for name, code in self.syntax.codes.items() if code == number)
        return next(names, f"G{number:g}")

    def refusal(self, code: float) -> str | None:
        """Why a G code that the control knows is refused, given its number; None: it is not."""
        declared = self.codes.g.get(code)
        return None if declared is None or not declared.refused else declared.refusal
