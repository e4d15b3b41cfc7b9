"""Writes one block as bytecode: the vocabulary in which dialects say what their blocks do."""

from collections.abc import Callable, Container, Iterable, Mapping

from twin.nc.bytecode import opcodes
from twin.nc.bytecode.bytecode import MOST_ROWS, MOST_STORES, Bytecode, number_of_location
from twin.nc.bytecode.registers import MOST_WORDS
from twin.nc.bytecode.variables import Variables
from twin.nc.canonical import NO_BLOCK_NUMBER
from twin.nc.text.blocks import Block, Location, Word
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
"""Variables with a computed number are known to the compiled tier below this number."""


Functions = Mapping[Callable[..., float], int]


class UnsupportedError(Exception):
    """The block is left to the interpreter tier."""


class Assembler:
    """Appends the rows of one block.

    Attributes:
        columns: Where the word stands that each row belongs to.
    """

    def __init__(
        self,
        bytecode: Bytecode,
        variables: Variables,
        token_kinds: Mapping[str, int],
        functions: tuple[Functions, Functions, Functions],
        number_kind: int,
        live: Container[str],
    ) -> None:
        """Write into a table.

        Args:
            bytecode: The table.
            variables: The program's.
            token_kinds: What the letters of plain words are.
            functions: Numbers of the functions of one, two and three values.
            number_kind: Kind of the token N.
            live: Variables that only the interpreter tier can read.
        """
        self._bytecode = bytecode
        self._variables = variables
        self._token_kinds = token_kinds
        self._functions = functions
        self._number_kind = number_kind
        self._live = live
        self._stores = 0
        self._begin = 0
        self._has_snapshot = False
        self._column = 0
        self.columns: list[int] = []

    def begin(self, block: Block) -> None:
        """A block begins, with its N number."""
        self._stores = 0
        self._has_snapshot = False
        self._column, self.columns = -1, []
        self._begin = self._bytecode.rows
        self._add(opcodes.BLOCK)
        if block.number != NO_BLOCK_NUMBER:
            self._add(opcodes.WORD_CONSTANT, self._number_kind, float(block.number))

    def end(self) -> None:
        """The block ends."""
        self._append(opcodes.NEXT)

    def _add(self, opcode: int, operand: int = 0, immediate: float = 0.0) -> None:
        if self._bytecode.rows - self._begin > MOST_ROWS:
            raise UnsupportedError
        self._append(opcode, operand, immediate)

    def _append(self, opcode: int, operand: int = 0, immediate: float = 0.0) -> None:
        self._bytecode.add(opcode, operand, immediate)
        self.columns.append(self._column)

    def emit(self, opcode: int, operand: int = 0) -> None:
        """Append one of the instructions that do more than compute, move and jump."""
        if not self._has_snapshot:
            self._has_snapshot = True
            self._add(opcodes.SNAPSHOT)
        self._add(opcode, operand)

    # --- words

    def words(self, words: Iterable[Word], *, often: int | None = None) -> None:
        """Run plain words; ``often``: as many times as the value on the stack, at most these.

        Raises:
            UnsupportedError: One of them has another meaning than plain words.
        """
        self._put(words)
        if often is None:
            self._add(opcodes.RUN)
        else:
            self._add(opcodes.RUN_REPEATEDLY, 0, float(often))

    def codes(self, words: Iterable[Word]) -> None:
        """Run plain words that do not move, before others of the block."""
        self._put(words)
        self.emit(opcodes.RUN_CODES)

    def polar(self, radius: Word | None, angle: Word | None, words: Iterable[Word]) -> None:
        """Move to where R and Q lead, and other axes by plain words."""
        self._put(words)
        for word in (radius, angle):
            if word is not None:
                self.word_value(word)
        self.emit(opcodes.RUN_POLAR, (radius is not None) + 2 * (angle is not None))

    def _put(self, words: Iterable[Word]) -> None:
        words = list(words)
        if len(words) >= MOST_WORDS:
            raise UnsupportedError
        for word in words:
            token_kind = self._token_kinds.get(word.address)
            if token_kind is None or word.incremental:
                raise UnsupportedError
            self._column = word.column
            if isinstance(word.value, Expression):
                self.value(word.value)
                self._add(opcodes.WORD, token_kind)
            else:
                self._add(opcodes.WORD_CONSTANT, token_kind, word.value)

    # --- values

    def word_value(self, word: Word | None, default: float = 0.0) -> None:
        """Put the value of a word on the stack, or of a missing one a default."""
        if word is None:
            self.constant(default)
            return
        self._column = word.column
        if isinstance(word.value, Expression):
            self.value(word.value)
        else:
            self.constant(word.value)

    def value(self, expression: Expression | Tree) -> None:
        """Put a value on the stack.

        Raises:
            UnsupportedError: The compiled tier does not know how to compute it.
        """
        tree = expression.evaluate if isinstance(expression, Expression) else expression
        match tree:
            case Number(value):
                self.constant(value)
            case Variable(name):
                self._add(opcodes.LOAD, self._slot(name))
            case NumberedVariable(name, index):
                self._number_variables(name)
                self.value(index)
                self._add(opcodes.LOAD_NUMBERED)
            case Negative(operand):
                self.value(operand)
                self._add(opcodes.NEGATE)
            case Prefixed(compute, operand):
                self.value(operand)
                self.compute(compute, 1)
            case Exists(Variable(name)):
                self._add(opcodes.DEFINED, self._slot(name))
            case Exists():
                raise UnsupportedError
            case Computed(_, compute, operands):
                for operand in operands:
                    self.value(operand)
                self.compute(compute, len(operands))

    def constant(self, value: float) -> None:
        """Put a number on the stack."""
        self._add(opcodes.CONSTANT, 0, value)

    def load(self, name: str) -> None:
        """Put a variable on the stack."""
        self._add(opcodes.LOAD, self._slot(name))

    def compute(self, compute: Callable[..., float], values: int) -> None:
        """Replace the topmost values by an operator or a function of them.

        Raises:
            UnsupportedError: The compiled tier does not know it.
        """
        number = self._functions[values - 1].get(compute)
        if number is None:
            raise UnsupportedError
        self._add((opcodes.UNARY, opcodes.BINARY, opcodes.TERNARY)[values - 1], number)

    def _slot(self, name: str) -> int:
        if name in self._live:
            raise UnsupportedError
        return self._variables.slot(name)

    def _number_variables(self, name: str) -> None:
        """Let the variables that a name and a number make be found by their number."""
        bytecode = self._bytecode
        if not len(bytecode.numbered):
            bytecode.number_variables(
                [self._variables.slot(f"{name}{number}") for number in range(MOST_NUMBERED)]
            )

    # --- variables

    def assign(self, name: str, *, declared: bool = False) -> None:
        """The topmost value goes to a variable; ``declared``: one that has a value already."""
        self._store(opcodes.STORE_DECLARED if declared else opcodes.STORE, self._slot(name))

    def _store(self, opcode: int, slot: int = 0) -> None:
        self._stores += 1
        if self._stores > MOST_STORES:
            raise UnsupportedError
        self._add(opcode, slot)

    def change(self, name: str, compute: Callable[..., float]) -> None:
        """The topmost value changes a variable: an operator's result for the old and this value."""
        slot = self._slot(name)
        self._add(opcodes.LOAD_BELOW, slot)
        self.compute(compute, 2)
        self._store(opcodes.STORE, slot)

    def assign_numbered(self, name: str, compute: Callable[..., float] | None = None) -> None:
        """As ``assign`` or ``change``, of the variable whose number lies below the value."""
        self._number_variables(name)
        if compute is not None:
            self._add(opcodes.LOAD_NUMBERED_BELOW)
            self.compute(compute, 2)
        self._store(opcodes.STORE_NUMBERED)

    def begin_for(self, name: str, behind: Location) -> None:
        """First, last and step are on the stack: a counted loop begins, or ends at once."""
        self._add(opcodes.BEGIN_FOR)
        self.assign(name)
        self.jump_if(behind)

    def step_for(self, name: str, again: Location) -> None:
        """First, last and step are on the stack: a counted loop goes on."""
        self._add(opcodes.LOAD, self._slot(name))
        self._add(opcodes.STEP_FOR)
        self.assign(name)
        self.jump_if(again)

    # --- flow

    def jump(self, location: Location) -> None:
        """Jump to a location."""
        self._add(opcodes.JUMP, number_of_location(location))

    def jump_if(self, location: Location) -> None:
        """Jump to a location if the topmost value is true."""
        self._add(opcodes.JUMP_IF, number_of_location(location))

    def jump_unless(self, location: Location) -> None:
        """Jump to a location unless the topmost value is true."""
        self._add(opcodes.JUMP_UNLESS, number_of_location(location))

    def jump_case(self, location: Location) -> None:
        """Jump to a location if the topmost value equals the one below, which stays."""
        self._add(opcodes.JUMP_CASE, number_of_location(location))

    def jump_counted(self, location: Location, counter: str, times: float) -> None:
        """Go on at a location so many times; then on, and the counter begins anew."""
        self._add(opcodes.COUNT_DOWN, self._slot(counter), times)
        self.jump_if(location)

    def call(
        self,
        location: Location,
        deepest: int,
        own: Iterable[str] | None = None,
        *,
        restores: bool = False,
    ) -> None:
        """Run the part that begins at a location.

        Args:
            location: Where it begins.
            deepest: Parts that may call each other.
            own: Its own variables, which get the topmost values; None: it has the caller's.
            restores: Its end puts back into force what is in force now.
        """
        self._add(opcodes.CHECK_CALL, deepest)
        if own is not None:
            self._add(opcodes.OWN_VARIABLES)
            done: set[str] = set()
            for name in reversed(list(own)):
                if name in done:
                    self._add(opcodes.DROP)
                else:
                    self._store(opcodes.STORE, self._slot(name))
                done.add(name)
        if restores:
            self._add(opcodes.RESTORE_CODES)
        self._add(opcodes.CALL, number_of_location(location))

    def repeat(self, first: Location, last: Location, deepest: int) -> None:
        """Run a range as often as the topmost value says."""
        self._add(opcodes.CHECK_CALL, deepest)
        self._add(opcodes.RANGE, number_of_location(last))
        self._add(opcodes.REPEAT, number_of_location(first))

    def check_return(self) -> None:
        """What ``go_back`` needs, to be written before anything that cannot be undone."""
        self._add(opcodes.CHECK_RETURN)

    def end_call(self) -> None:
        """Go on behind the call."""
        self._add(opcodes.RETURN)
