"""Compiles the blocks of a program in the order of ``block_order``.

Of a doubtful block nothing is compiled: the interpreter tier alone says what is wrong.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence

from twin.nc.bytecode import opcodes
from twin.nc.bytecode.assembler import UnsupportedError
from twin.nc.bytecode.bytecode_assembler import BytecodeAssembler
from twin.nc.control.block_order import SortedBlock, run_in_order
from twin.nc.control.codes import GCode, MCode, StatementEffect, Vocabulary, WordEffect
from twin.nc.control.control import Control
from twin.nc.text.blocks import Block, Word
from twin.nc.text.expressions import Expression

_BESIDE_CYCLE = "ST"
"""Words that may stand beside the call of a cycle: they change nothing of where the tool stands."""
_WRITTEN = frozenset(("plane", "cycle"))
"""What a code with instructions of its own may set: they put these into force, and nothing else."""


Sort = Callable[[Sequence[Word], Callable[[Expression, Word], float | None]], SortedBlock]
"""``Executor.sort_words``."""


class BlockCompiler:
    """Compiles the blocks of one program, for a dialect that says what they do.

    Attributes:
        control: Whose program it is.
        vocabulary: The codes and words of its dialect.
        assembler: Takes the instructions.
        acting: Addresses of words that do something by themselves, such as S and T.
    """

    def __init__(
        self, control: Control, vocabulary: Vocabulary, assembler: BytecodeAssembler, sort: Sort
    ) -> None:
        """Compile for a control, whose words this sorts."""
        self.control = control
        self.vocabulary = vocabulary
        self.assembler = assembler
        self.acting = frozenset(
            each for each, do in vocabulary.words.items() if isinstance(do, WordEffect)
        )
        self._sort = sort
        self._sorted = SortedBlock([], [])

    def sorted(self, words: Iterable[Word]) -> SortedBlock:
        """Sort the words of a block, before those that are computed have a value.

        Raises:
            UnsupportedError: A code is computed.
            ProgramError: Some of them cannot stand in one block.
        """

        def evaluate(_value: Expression, word: Word) -> None:
            if word.address in ("G", "M"):
                raise UnsupportedError

        return self._sort(list(words), evaluate)

    def block(self, block: Block) -> None:
        """Compile a block.

        Raises:
            UnsupportedError: It is left to the interpreter tier.
        """
        statement, vocabulary = block.statement, self.vocabulary
        if block.assignments:
            raise UnsupportedError
        if statement is None:
            self.words(block.words)
            return
        effect = vocabulary.statements.get(statement.keyword, vocabulary.other_statement)
        if not isinstance(effect, StatementEffect):
            raise UnsupportedError
        effect.write(self.control, statement, self.assembler)

    def words(self, words: Iterable[Word]) -> None:
        """Compile a block of words.

        Raises:
            UnsupportedError: It is left to the interpreter tier.
        """
        words = list(words)
        if not self._acts(words):
            self.assembler.words(words)
            return
        codes, functions = self._sorted = self.sorted(words)
        run_in_order(self, codes, functions, words_first=self.vocabulary.words_first)

    def _refuse_beside_cycle(self) -> None:
        """A drilling cycle has its words: leave what else acts to the interpreter tier.

        Raises:
            UnsupportedError: Something does.
        """
        codes, functions = self._sorted
        acting = self.control.words.keys() & self.acting - set(_BESIDE_CYCLE)
        performs = any(code.perform is not None for _, code in codes)
        if acting or performs or any(function.action is not None for _, function in functions):
            raise UnsupportedError

    def act(self, word: Word, code: GCode) -> None:
        """Write what a code does before the block moves."""
        if code.writer is None:
            return
        if code.after is not None or code.once or code.alone or code.sets.keys() - _WRITTEN:
            raise UnsupportedError
        if code.group and not code.begins_cycle:
            self.assembler.emit(opcodes.ACTIVATE, _number(word))
        if code.perform is None:
            code.writer(self.control, self.assembler)
        if code.begins_cycle:
            self._refuse_beside_cycle()

    def modal_words(self, reserved: str) -> None:
        """Write what words such as S and T do."""
        words = self.control.words
        for address, effect in self.vocabulary.words.items():
            if address in words and address not in reserved and isinstance(effect, WordEffect):
                effect.write(self.control, words.pop(address), self.assembler)

    def run_function(self, word: Word, function: MCode) -> None:
        """Write an M function."""
        number, writer = _number(word), function.writer
        acts = function.action is not None
        if function.ends or function.silent or (acts and writer is None):
            raise UnsupportedError
        if number in self.control.interpreted_functions:
            raise UnsupportedError
        if any(letter in self.control.words for letter in self.vocabulary.function_letters):
            raise UnsupportedError
        if writer is not None:
            writer(self.control, self.assembler)
        self.assembler.emit(opcodes.FUNCTION, number)

    def move(self, instead: GCode | None) -> None:
        """Write the motion, or what a code does in its place."""
        words, codes = self.control.words, self._sorted.codes
        plain = [word for word, code in codes if code.writer is None or code.begins_cycle]
        reserved = "" if instead is None else instead.takes
        if "F" in words and "F" not in reserved:
            plain.append(words.pop("F"))
        if instead is None:
            self.assembler.words([*plain, *words.values()])
            return
        if instead.writer is None:
            raise UnsupportedError
        if plain:
            self.assembler.codes(plain)
        instead.writer(self.control, self.assembler)
        if words:
            raise UnsupportedError

    def follow(self, _word: Word, _code: GCode) -> None:
        """Nothing: codes that act behind the move are not compiled."""

    def known_codes(self, words: Iterable[Word]) -> Iterator[GCode]:
        """The G codes among words, as far as the dialect knows them."""
        for word in words:
            if word.address == "G" and not isinstance(word.value, Expression):
                code = self.vocabulary.g.get(word.value)
                if code is not None:
                    yield code

    def _acts(self, words: list[Word]) -> bool:
        """Whether the block does more than its plain words."""
        values = (word.value for word in words if word.address == "M")
        functions = [value for value in values if isinstance(value, float)]
        known = (self.vocabulary.m.get(int(number)) for number in functions)
        codes = (*self.known_codes(words), *filter(None, known))
        return (
            len(functions) > 1
            or any(word.address in self.acting for word in words)
            or any(code.writer is not None for code in codes)
        )


def _number(word: Word) -> int:
    """The number of a code.

    Raises:
        UnsupportedError: It is computed, or no whole one.
    """
    if isinstance(word.value, Expression) or word.value != int(word.value):
        raise UnsupportedError
    return int(word.value)
