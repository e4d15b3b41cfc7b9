"""Writes blocks as bytecode."""

from collections.abc import Callable, Container, Iterable, Mapping

from twin.nc.bytecode import opcodes
from twin.nc.bytecode.assembler import Assembler, Otherwise, UnsupportedError
from twin.nc.bytecode.bytecode import MOST_ROWS, MOST_STORES, Bytecode
from twin.nc.bytecode.expressions import Operation, code_of, operation_of
from twin.nc.bytecode.registers import MOST_WORDS
from twin.nc.bytecode.variables import NO_SLOT, Variables
from twin.nc.canonical import NO_BLOCK_NUMBER
from twin.nc.text.blocks import Block, Word
from twin.nc.text.expressions import Expression, Tree

MOST_NUMBERED = 1000
"""Variables with a computed number are known to the compiled tier below this number."""


class BytecodeAssembler(Assembler):
    """Appends the rows of one block.

    Attributes:
        columns: Where the word stands that each row belongs to.
    """

    def __init__(
        self,
        bytecode: Bytecode,
        variables: Variables,
        token_kinds: Mapping[str, int],
        number_kind: int,
        live: Container[str],
    ) -> None:
        """Write into a table.

        Args:
            bytecode: The table.
            variables: The program's.
            token_kinds: What the letters of plain words are.
            number_kind: Kind of the token N.
            live: Variables that only the interpreter tier can read.
        """
        self._bytecode = bytecode
        self._variables = variables
        self._token_kinds = token_kinds
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
        self._stores += opcodes.STORE <= opcode <= opcodes.STORE_NUMBERED
        if self._bytecode.rows - self._begin > MOST_ROWS or self._stores > MOST_STORES:
            raise UnsupportedError
        self._append(opcode, operand, immediate)

    def _append(self, opcode: int, operand: int = 0, immediate: float = 0.0) -> None:
        self._bytecode.add(opcode, operand, immediate)
        self.columns.append(self._column)

    def emit(self, opcode: int, operand: int = 0, immediate: float = 0.0) -> None:
        """Append one of the instructions that do more than compute, move and jump."""
        if not self._has_snapshot:
            self._has_snapshot = True
            self._add(opcodes.SNAPSHOT)
        self._add(opcode, operand, immediate)

    def check(
        self, check: int, otherwise: Otherwise, bound: float = 0.0, blamed: Word | None = None
    ) -> None:
        """Append a check; where it does not hold, the interpreter tier runs the block."""
        del otherwise, blamed
        self.emit(opcodes.CHECK, check, bound)

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

    def value(self, expression: Expression | Tree, column: int = 0) -> None:
        """Put a value on the stack.

        Raises:
            UnsupportedError: The compiled tier does not know how to compute it.
        """
        del column
        tree = expression.tree if isinstance(expression, Expression) else expression
        for each in code_of(tree):
            if each.opcode == opcodes.LOAD:
                self._add(opcodes.LOAD, self._slot(each.name))
            elif each.opcode == opcodes.LOAD_NUMBERED:
                self._number_variables(each.name)
                self._add(opcodes.LOAD_NUMBERED)
            elif each.opcode == opcodes.DEFINED:
                if [inner.opcode for inner in each.inner] != [opcodes.LOAD]:
                    raise UnsupportedError
                self._add(opcodes.DEFINED, self._slot(each.inner[0].name))
            else:
                self._compute(each)

    def compute(self, function: Callable[..., float]) -> None:
        """Replace the topmost values by a function of them; as ``value``."""
        self._compute(operation_of(function))

    def _compute(self, operation: Operation) -> None:
        if not operation.has_compiled_form:
            raise UnsupportedError
        self._add(operation.opcode, operation.operand, operation.immediate)

    def _slot(self, name: str) -> int:
        if name in self._live:
            raise UnsupportedError
        return self._variables.slot(name)

    def _number_variables(self, name: str) -> None:
        """Let the variables that a name and a number make be found by their number."""
        bytecode = self._bytecode
        if not len(bytecode.numbered):
            bytecode.number_variables(
                [
                    NO_SLOT if each in self._live else self._variables.slot(each)
                    for each in (f"{name}{number}" for number in range(MOST_NUMBERED))
                ]
            )

    # --- variables

    def assign_numbered(self, name: str) -> None:
        """The topmost value goes to the variable whose number lies below it."""
        self._number_variables(name)
        self._add(opcodes.STORE_NUMBERED)

    def disturbed(self, action: Callable[[], None]) -> None:
        """Nothing: the compiled tier does not run then."""

    def known(self, word: Word) -> float:
        """The value of a word that is not computed."""
        if isinstance(word.value, Expression):
            raise UnsupportedError
        return word.value

    def interpreted(self, action: Callable[[], None]) -> None:
        """Leave the block to the interpreter tier."""
        del action
        raise UnsupportedError
