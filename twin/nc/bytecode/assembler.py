"""Writes one block as instructions: the vocabulary in which dialects say what their blocks do."""

from collections.abc import Callable, Iterable, Mapping

from twin.nc.bytecode.opcodes import MOST_ROWS, MOST_STORES, Instructions, Step, number_of_place
from twin.nc.bytecode.registers import MOST_WORDS
from twin.nc.canonical import NO_BLOCK_NUMBER
from twin.nc.control.flow import Place
from twin.nc.control.variables import Variables
from twin.nc.text.blocks import Block, Word
from twin.nc.text.expressions import (
    Computed,
    Exists,
    Expression,
    Negative,
    Number,
    NumberedVariable,
    Prefixed,
    Tree,
    Variable,
)

MOST_NUMBERED = 1000
"""Variables with a computed number are known to the fast way below this number."""


Functions = Mapping[Callable[..., float], int]


class NotTranslatableError(Exception):
    """The block is left to the general way."""


class BlockWriter:
    """Appends the rows of one block.

    Attributes:
        columns: Where the word stands that each row belongs to.
    """

    def __init__(
        self,
        instructions: Instructions,
        variables: Variables,
        roles: Mapping[str, int],
        functions: tuple[Functions, Functions, Functions],
        number_role: int,
        live: frozenset[str],
    ) -> None:
        """Write into a table.

        Args:
            instructions: The table.
            variables: The program's.
            roles: What the letters of plain words are.
            functions: Numbers of the functions of one, two and three values.
            number_role: Role of N.
            live: Variables that only the general way can read.
        """
        self._instructions = instructions
        self._variables = variables
        self._roles = roles
        self._functions = functions
        self._number_role = number_role
        self._live = live
        self._stores = 0
        self._begin = 0
        self._keeps = False
        self._column = 0
        self.columns: list[int] = []

    def begin(self, block: Block) -> None:
        """A block begins, with its N number."""
        self._stores = 0
        self._keeps = False
        self._column, self.columns = -1, []
        self._begin = self._instructions.rows
        self._add(Step.BLOCK)
        if block.number != NO_BLOCK_NUMBER:
            self._add(Step.WORD_NUMBER, self._number_role, float(block.number))

    def end(self) -> None:
        """The block ends."""
        self._append(Step.NEXT)

    def _add(self, step: Step, argument: int = 0, number: float = 0.0) -> None:
        if self._instructions.rows - self._begin > MOST_ROWS:
            raise NotTranslatableError
        self._append(step, argument, number)

    def _append(self, step: Step, argument: int = 0, number: float = 0.0) -> None:
        self._instructions.add(step, argument, number)
        self.columns.append(self._column)

    def step(self, step: Step, argument: int = 0) -> None:
        """Append one of the steps that do more than compute, move and jump."""
        if not self._keeps:
            self._keeps = True
            self._add(Step.KEEP)
        self._add(step, argument)

    # --- words

    def words(self, words: Iterable[Word], *, often: int | None = None) -> None:
        """Run plain words; ``often``: as many times as the value on the stack, at most these.

        Raises:
            NotTranslatableError: One of them has another meaning than plain words.
        """
        self._put(words)
        if often is None:
            self._add(Step.RUN)
        else:
            self._add(Step.RUN_OFTEN, 0, float(often))

    def codes(self, words: Iterable[Word]) -> None:
        """Run plain words that do not move, before others of the block."""
        self._put(words)
        self.step(Step.RUN_CODES)

    def polar(self, radius: Word | None, angle: Word | None, words: Iterable[Word]) -> None:
        """Move to where R and Q lead, and other axes by plain words."""
        self._put(words)
        for word in (radius, angle):
            if word is not None:
                self.word_value(word)
        self.step(Step.RUN_POLAR, (radius is not None) + 2 * (angle is not None))

    def _put(self, words: Iterable[Word]) -> None:
        words = list(words)
        if len(words) >= MOST_WORDS:
            raise NotTranslatableError
        for word in words:
            role = self._roles.get(word.address)
            if role is None or word.incremental:
                raise NotTranslatableError
            self._column = word.column
            if isinstance(word.value, Expression):
                self.value(word.value)
                self._add(Step.WORD, role)
            else:
                self._add(Step.WORD_NUMBER, role, word.value)

    # --- values

    def word_value(self, word: Word | None, default: float = 0.0) -> None:
        """Put the value of a word on the stack, or of a missing one a default."""
        if word is None:
            self.number(default)
            return
        self._column = word.column
        if isinstance(word.value, Expression):
            self.value(word.value)
        else:
            self.number(word.value)

    def value(self, expression: Expression | Tree) -> None:
        """Put a value on the stack.

        Raises:
            NotTranslatableError: The fast way does not know how to compute it.
        """
        tree = expression.evaluate if isinstance(expression, Expression) else expression
        match tree:
            case Number(value):
                self.number(value)
            case Variable(name):
                self._add(Step.LOAD, self._slot(name))
            case NumberedVariable(name, index):
                self._number_variables(name)
                self.value(index)
                self._add(Step.LOAD_NUMBERED)
            case Negative(operand):
                self.value(operand)
                self._add(Step.NEGATE)
            case Prefixed(compute, operand):
                self.value(operand)
                self._compute(compute, 1)
            case Exists(Variable(name)):
                self._add(Step.DEFINED, self._slot(name))
            case Exists():
                raise NotTranslatableError
            case Computed(_, compute, operands):
                for operand in operands:
                    self.value(operand)
                self._compute(compute, len(operands))

    def number(self, value: float) -> None:
        """Put a number on the stack."""
        self._add(Step.NUMBER, 0, value)

    def _compute(self, compute: Callable[..., float], values: int) -> None:
        number = self._functions[values - 1].get(compute)
        if number is None:
            raise NotTranslatableError
        self._add((Step.ONE, Step.TWO, Step.THREE)[values - 1], number)

    def _slot(self, name: str) -> int:
        if name in self._live:
            raise NotTranslatableError
        return self._variables.slot(name)

    def _number_variables(self, name: str) -> None:
        """Let the variables that a name and a number make be found by their number."""
        instructions = self._instructions
        if not len(instructions.numbered):
            instructions.number_variables(
                [self._variables.slot(f"{name}{number}") for number in range(MOST_NUMBERED)]
            )

    # --- variables

    def assign(self, name: str, *, declared: bool = False) -> None:
        """The topmost value goes to a variable; ``declared``: one that has a value already."""
        self._store(Step.STORE_DECLARED if declared else Step.STORE, self._slot(name))

    def _store(self, step: Step, slot: int = 0) -> None:
        self._stores += 1
        if self._stores > MOST_STORES:
            raise NotTranslatableError
        self._add(step, slot)

    def change(self, name: str, compute: Callable[..., float]) -> None:
        """The topmost value changes a variable: an operator's result for the old and this value."""
        slot = self._slot(name)
        self._add(Step.LOAD_BELOW, slot)
        self._compute(compute, 2)
        self._store(Step.STORE, slot)

    def assign_numbered(self, name: str, compute: Callable[..., float] | None = None) -> None:
        """As ``assign`` or ``change``, of the variable whose number lies below the value."""
        self._number_variables(name)
        if compute is not None:
            self._add(Step.LOAD_NUMBERED_BELOW)
            self._compute(compute, 2)
        self._store(Step.STORE_NUMBERED)

    def begin_for(self, name: str, behind: Place) -> None:
        """First, last and step are on the stack: a counted loop begins, or ends at once."""
        self._add(Step.BEGIN_FOR)
        self.assign(name)
        self.jump_if(behind)

    def step_for(self, name: str, again: Place) -> None:
        """First, last and step are on the stack: a counted loop goes on."""
        self._add(Step.LOAD, self._slot(name))
        self._add(Step.STEP_FOR)
        self.assign(name)
        self.jump_if(again)

    # --- flow

    def jump(self, place: Place) -> None:
        """Go on at a place."""
        self._add(Step.JUMP, number_of_place(place))

    def jump_if(self, place: Place) -> None:
        """The same where the topmost value is true."""
        self._add(Step.JUMP_IF, number_of_place(place))

    def jump_unless(self, place: Place) -> None:
        """The same where it is not."""
        self._add(Step.JUMP_UNLESS, number_of_place(place))

    def jump_case(self, place: Place) -> None:
        """The same where it equals the value below, which stays."""
        self._add(Step.JUMP_CASE, number_of_place(place))

    def jump_counted(self, place: Place, counter: str, times: float) -> None:
        """Go on at a place so many times; then on, and the counter begins anew."""
        self._add(Step.COUNT_DOWN, self._slot(counter), times)
        self.jump_if(place)

    def call(
        self,
        place: Place,
        deepest: int,
        own: Iterable[str] | None = None,
        *,
        restores: bool = False,
    ) -> None:
        """Run the part that begins at a place.

        Args:
            place: Where it begins.
            deepest: Parts that may call each other.
            own: Its own variables, which get the topmost values; None: it has the caller's.
            restores: Its end puts back into force what is in force now.
        """
        self._add(Step.MAY_CALL, deepest)
        if own is not None:
            self._add(Step.OWN_VARIABLES)
            done: set[str] = set()
            for name in reversed(list(own)):
                if name in done:
                    self._add(Step.DROP)
                else:
                    self._store(Step.STORE, self._slot(name))
                done.add(name)
        if restores:
            self._add(Step.RESTORING)
        self._add(Step.CALL, number_of_place(place))

    def repeat(self, first: Place, last: Place, deepest: int) -> None:
        """Run a range as often as the topmost value says."""
        self._add(Step.MAY_CALL, deepest)
        self._add(Step.RANGE, number_of_place(last))
        self._add(Step.REPEAT, number_of_place(first))

    def may_return(self) -> None:
        """What ``go_back`` needs, to be written before anything that cannot be undone."""
        self._add(Step.MAY_RETURN)

    def go_back(self) -> None:
        """Go on behind the call."""
        self._add(Step.RETURN)
