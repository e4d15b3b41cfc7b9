"""How cycles are called: their values by the names that the manuals give the parameters."""

from collections.abc import Callable, Mapping
from typing import NamedTuple, NoReturn

from twin.nc.control.control import Control
from twin.nc.dialects.sinumerik.variables.expressions import bracketed, split_values
from twin.nc.geometry.arcs import Point
from twin.nc.text.blocks import Statement

MOST_PLACES = 10_000
"""Places or slots of one pattern: more is a slip of the pen."""


class CycleCall(NamedTuple):
    """A cycle that is being called.

    Attributes:
        values: What the call gives, by the name of the parameter.
        texts: What it gives as a text in quotes.
    """

    control: Control
    statement: Statement
    values: Mapping[str, float]
    texts: Mapping[str, str]

    def get(self, name: str, default: float = 0.0) -> float:
        """A value, or where it is left out another one."""
        return self.values.get(name, default)

    def length(self, name: str, default: float = 0.0) -> float:
        """A length [mm]."""
        return self.get(name, default) * self.control.modal.unit

    def point(self, abscissa: str, ordinate: str) -> Point:
        """A point of the plane [mm]."""
        return (self.length(abscissa), self.length(ordinate))

    def count(self, name: str) -> int:
        """A number of places, which must be there."""
        value = self.get(name)
        if value != int(value) or not 1.0 <= value <= MOST_PLACES:
            self.refuse("cycle-word", f"needs {name}, 1 to {MOST_PLACES} places")
        return int(value)

    def need(self, *names: str) -> None:
        """The values of these parameters must be there."""
        missing = [name for name in names if name not in self.values]
        if missing:
            self.refuse("cycle-word", f"needs {' and '.join(missing)}")

    def refuse(self, code: str, message: str, hint: str | None = None) -> NoReturn:
        """Refuse the call."""
        self.control.fail(code, f"{self.statement.keyword} {message}", self.statement, hint)

    def only(self, name: str, *followed: float) -> float:
        """A value that must be one of those that are followed; 0 where it is left out."""
        value = self.get(name)
        if value not in (0.0, *followed):
            known = ", ".join(f"{each:g}" for each in (0.0, *followed))
            self.refuse("unsupported-word", f"is followed with {name} {known} alone, not {value:g}")
        return value


class CycleForm(NamedTuple):
    """A cycle.

    Attributes:
        names: Its parameters in their order, with blanks between them and without the underscores before them.
        run: What it does.
    """

    names: str
    run: Callable[[CycleCall], None]

    @property
    def parameters(self) -> list[str]:
        """Its parameters in their order."""
        return self.names.split()


def read_call(control: Control, statement: Statement, form: CycleForm) -> CycleCall:
    """The values of a call."""
    inner, column, end = bracketed(control, statement.text, statement.text_column)
    if statement.text[end:].strip():
        at = statement.text_column + end
        control.report.fail("call-values", f"nothing may follow {statement.keyword}", at)
    values, texts = dict[str, float](), dict[str, str]()
    given = split_values(inner) if inner.strip() else []
    if len(given) > len(form.parameters):
        message = f"{statement.keyword} takes {len(form.parameters)} values, not {len(given)}"
        control.fail("call-values", message, statement, ", ".join(form.parameters))
    for name, (text, begin) in zip(form.parameters, given, strict=False):
        bare = text.strip()
        if bare.startswith('"'):
            texts[name] = bare.strip('"')
        elif bare:
            at = column + begin
            values[name] = control.compute(control.statements.expression(text, at), at)
    return CycleCall(control, statement, values, texts)


def require_no_compensation(call: CycleCall) -> None:
    """A cycle moves the tool's centre by itself."""
    if call.control.path.compensation.in_force:
        message = "cannot run while radius compensation is in force"
        call.refuse("compensation-change", message, "end it by G40 first")
