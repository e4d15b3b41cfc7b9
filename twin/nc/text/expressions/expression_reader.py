"""Reading expressions: precedence climbing, from text to trees."""

import re
from typing import NoReturn

from twin.nc.text.expressions.expressions import (
    LARGEST_NUMBER,
    Computed,
    Exists,
    Expression,
    ExpressionError,
    ExpressionSyntax,
    Negative,
    Number,
    NumberedVariable,
    OrZero,
    Tree,
    Variable,
)
from twin.nc.text.plain_word import BLANKS, NUMBER

_DEEPEST = 40
"""Brackets within brackets that an expression may have."""
_LONGEST = 200
"""Operators and functions that an expression may have."""


_MOST_KEPT = 4096
"""Expressions that are kept once they were read: loops compute the same ones again and again."""
_COMPARISONS = (
    ("unequal", ("<>", "!=", "NE")),
    ("less or equal", ("<=", "LE")),
    ("greater or equal", (">=", "GE")),
    ("less", ("<", "LT")),
    ("greater", (">", "GT")),
    ("equal", ("==", "=", "EQ")),
)
"""Comparisons, the longer signs before the shorter, and how languages write them."""


class ExpressionReader:
    """Reads the expressions of one dialect."""

    def __init__(self, syntax: ExpressionSyntax) -> None:
        self._syntax = syntax
        self._kept: dict[tuple[str, int, bool], tuple[Expression, int]] = {}
        symbols = sorted(syntax.operators, key=len, reverse=True)
        self.operator = re.compile(
            rf"{BLANKS}({'|'.join(map(operator_pattern, symbols))})", re.IGNORECASE
        )
        self.number = re.compile(NUMBER)
        self.variable = re.compile(syntax.variable, re.IGNORECASE)
        self.name = re.compile(r"[A-Z_][A-Z_0-9]*", re.IGNORECASE)
        self.quotient = re.compile(rf"{BLANKS}/{BLANKS}(?={re.escape(syntax.brackets[0])})")

    def read(self, text: str, start: int) -> tuple[Expression, int]:
        """Read the longest expression that begins at ``start``; return it with its end.

        Raises:
            ExpressionError: There is none, or it is malformed.
        """
        return self._read(text, start, operand=False)

    def read_operand(self, text: str, start: int) -> tuple[Expression, int]:
        """As ``read``, but up to the first operator only, such as the index of ``P[5] += 1``."""
        return self._read(text, start, operand=True)

    def _read(self, text: str, start: int, *, operand: bool) -> tuple[Expression, int]:
        read = self._kept.get((text, start, operand))
        if read is None:
            reading = _Reading(self._syntax, self, text, start)
            tree = reading.operand(0) if operand else reading.operation(0, 0)
            read = Expression(text[start : reading.at].strip(), tree), reading.at
            if len(self._kept) < _MOST_KEPT:
                self._kept[text, start, operand] = read
        return read

    def read_value(self, text: str, start: int) -> tuple[Expression, int]:
        """Read the value of a word or an assignment, as far as the dialect lets it go."""
        return (self.read_operand if self._syntax.bracketed else self.read)(text, start)

    def read_list(self, text: str, start: int) -> tuple[list[Expression], int]:
        """Read expressions separated by commas; return them with the end of the last."""
        expressions = []
        while True:
            expression, end = self.read(text, start)
            expressions.append(expression)
            rest = text[end:].lstrip()
            if not rest.startswith(","):
                return expressions, end
            start = len(text) - len(rest) + 1

    def comparison_at(self, text: str, at: int) -> str | None:
        """How the comparison is written that another language's sign or name asks for at a place; None: there is none."""
        operators = {name.upper() for name in self._syntax.operators}
        behind = text[at:].lstrip().upper()
        for meaning, spellings in _COMPARISONS:
            own = next((each for each in spellings if each in operators), None)
            if own is not None and any(map(behind.startswith, spellings)):
                return f"{meaning} is written {own}"
        return None


def operator_pattern(symbol: str) -> str:
    """Regular expression of an operator; two slashes begin a comment."""
    if symbol == "/":
        return "/(?!/)"
    return re.escape(symbol) + (r"(?![A-Z_])" if symbol[-1].isalpha() else "")


A_VALUE = "write a number or a variable here"


class _Reading:
    """One expression being read: the text and the place reached."""

    def __init__(
        self, syntax: ExpressionSyntax, reader: ExpressionReader, text: str, at: int
    ) -> None:
        self._syntax = syntax
        self._reader = reader
        self._text = text
        self._operations = 0
        self.at = at

    def operation(self, lowest: int, depth: int) -> Tree:
        """Operands joined by operators that bind at least as tightly as ``lowest``."""
        if depth > _DEEPEST:
            self._fail("expression-depth", f"more than {_DEEPEST} brackets within brackets")
        left, exclusive = self.operand(depth), False
        while (match := self._reader.operator.match(self._text, self.at)) is not None:
            operator = self._syntax.operators[match[1].upper()]
            if operator.precedence < lowest:
                break
            self._count()
            symbol = match[1].upper()
            if exclusive and symbol in self._syntax.exclusive:
                hint = "each comparison in brackets of its own"
                self._fail("expression", f"{symbol} needs brackets around what it compares", hint)
            exclusive = symbol in self._syntax.exclusive
            self.at = match.end()
            right = self.operation(operator.precedence + 1, depth + 1)
            operands = (left, right)
            if symbol not in self._syntax.of_vacant:
                operands = (self._or_zero(left), self._or_zero(right))
            left = Computed(symbol, operator.compute, operands)
        return left

    def _or_zero(self, tree: Tree) -> Tree:
        """A value of which something is computed."""
        if self._syntax.vacant and isinstance(tree, Variable | NumberedVariable):
            return OrZero(tree)
        return tree

    def operand(self, depth: int) -> Tree:
        """A value without operators behind it."""
        self._skip_blanks()
        opening, closing = self._syntax.brackets
        character = self._text[self.at : self.at + 1]
        if character in ("+", "-") and character:
            self._count()
            self.at += 1
            if depth > _DEEPEST:
                self._fail("expression-depth", f"more than {_DEEPEST} signs in a row")
            if self._syntax.one_sign and self._text[self.at :].lstrip()[:1] in ("+", "-"):
                self._fail("expression", "a sign follows a sign")
            inner = self.operand(depth + 1)
            return inner if character == "+" else Negative(self._or_zero(inner))
        if character == opening:
            self.at += 1
            inner = self.operation(0, depth + 1)
            self._expect(closing)
            return inner
        if (match := self._reader.number.match(self._text, self.at)) is not None:
            self.at = match.end()
            value = float(match[0])
            if value > LARGEST_NUMBER:
                error = ExpressionError.too_large()
                self._fail(error.code, str(error))
            return Number(value)
        return self._named(depth)

    def _named(self, depth: int) -> Tree:
        opening = self._syntax.brackets[0]
        if (match := self._reader.variable.match(self._text, self.at)) is not None:
            self.at = match.end()
            return self._subscripted(self._syntax.spelled(match[0]), depth)
        indirect = self._syntax.indirect
        if indirect and self._text[self.at : self.at + 1] == indirect:
            self._count()
            self.at += 1
            return NumberedVariable(indirect, self._or_zero(self.operand(depth + 1)))
        match = self._reader.name.match(self._text, self.at)
        if match is None:
            foreign = self._text[self.at : self.at + 1] in ("(", "[", "{")
            hint = f"brackets are {opening} {self._syntax.brackets[1]}" if foreign else A_VALUE
            self._fail("expression", "a value is missing here", hint)
        name, after = self._syntax.full_name(match[0].upper()), match.end()
        if name in self._syntax.indexed and self._text[after : after + 1] == opening:
            (index,) = self._arguments(name, after, 1, depth)
            return NumberedVariable(name, index)
        if name in self._syntax.existence:
            (value,) = self._arguments(name, after, 1, depth)
            return Exists(value)
        if name in self._syntax.prefixes:
            self._count()
            self.at = after
            return Computed(name, self._syntax.prefixes[name], (self.operand(depth + 1),))
        if name in self._syntax.constants:
            self.at = after
            return Number(self._syntax.constants[name])
        if name in self._syntax.quotients:
            return self._quotient(name, after, depth)
        if name not in self._syntax.functions:
            known = ", ".join(sorted(self._syntax.functions))
            self._fail("unknown-function", f"'{name}' is no function here", f"functions: {known}")
        function = self._syntax.functions[name]
        arguments = self._arguments(name, after, function.arguments, depth)
        return Computed(name, function.compute, tuple(arguments))

    def _subscripted(self, name: str, depth: int) -> Tree:
        """A variable with the indices behind it, if there are any."""
        brackets = self._syntax.subscripts
        if not brackets or self._text[self.at :].lstrip()[:1] != brackets[0]:
            return Variable(name)
        indices = self._arguments(name, self.at, None, depth, brackets)
        if len(indices) > 2:
            self._fail("expression", f"{name} takes one or two indices")
        if len(indices) == 2:
            return NumberedVariable(name, Computed(name, self._syntax.joined, tuple(indices)))
        return NumberedVariable(name, indices[0])

    def _quotient(self, name: str, at: int, depth: int) -> Tree:
        """``ATAN[1]/[2]``; where the dialect has them ``ATAN[1,2]`` and ``ATAN[1]``."""
        function = self._syntax.functions.get(name)
        arguments = self._arguments(name, at, 1 if function is None else None, depth)
        slash = self._reader.quotient.match(self._text, self.at)
        if slash is not None:
            arguments += self._arguments(name, slash.end(), 1, depth)
        elif function is None:
            self._expect("/")
        if len(arguments) == 2:
            return Computed(name, self._syntax.quotients[name], tuple(arguments))
        if function is None or len(arguments) != function.arguments:
            self._fail("expression", f"{name} does not take {len(arguments)} values")
        return Computed(name, function.compute, tuple(arguments))

    def _arguments(
        self, name: str, at: int, count: int | None, depth: int, brackets: str = ""
    ) -> list[Tree]:
        self._count()
        self.at = at
        opening, closing = brackets or self._syntax.brackets
        self._skip_blanks()
        self._expect(opening, f"write {name}{opening}...{closing}")
        arguments = [self._or_zero(self.operation(0, depth + 1))]
        self._skip_blanks()
        while self._text[self.at : self.at + 1] == ",":
            self.at += 1
            arguments.append(self._or_zero(self.operation(0, depth + 1)))
            self._skip_blanks()
        if count is not None and len(arguments) != count:
            self._fail("expression", f"{name} takes {count} values, not {len(arguments)}")
        self._expect(closing)
        return arguments

    def _expect(self, character: str, hint: str | None = None) -> None:
        self._skip_blanks()
        if self._text[self.at : self.at + 1] != character:
            closing = f"write {character} where its bracket ends"
            hint = self._reader.comparison_at(self._text, self.at) or hint or closing
            self._fail("expression", f"'{character}' is missing here", hint)
        self.at += 1

    def _skip_blanks(self) -> None:
        while self._text[self.at : self.at + 1] in (" ", "\t") and self.at < len(self._text):
            self.at += 1

    def _count(self) -> None:
        self._operations += 1
        if self._operations > _LONGEST:
            self._fail("expression-depth", f"more than {_LONGEST} operations in an expression")

    def _fail(self, code: str, message: str, hint: str | None = None) -> NoReturn:
        raise ExpressionError(code, message, self.at, hint)
