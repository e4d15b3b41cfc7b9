"""Compiles the words of a block, sorted by what they do and in their order.

``Executor.run`` does what is in force, then actions, words, early functions, the motion or what
stands in its place, late functions; the instructions do so in the same order. Of a doubtful block
nothing is compiled: the interpreter tier alone says what is wrong.
"""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from twin.nc.bytecode import opcodes
from twin.nc.bytecode.assembler import UnsupportedError
from twin.nc.bytecode.bytecode_assembler import BytecodeAssembler
from twin.nc.control.block_words import BlockWords
from twin.nc.control.codes import GCode, MCode, StatementEffect, Vocabulary, WordEffect
from twin.nc.control.control import Control
from twin.nc.functions import SPINDLE_STARTS
from twin.nc.text.blocks import Block, Word
from twin.nc.text.expressions import Expression


class SortedBlock(NamedTuple):
    """A block by what its words are.

    Attributes:
        codes: Its G codes, in the order in which they take effect.
        functions: Its M functions, in the order of the text.
        words: The others.
    """

    codes: list[tuple[Word, GCode]]
    functions: list[tuple[int, MCode]]
    words: BlockWords


class BlockCompiler:
    """Compiles the blocks of one program, for a dialect that says what they do.

    Attributes:
        control: Whose program it is.
        vocabulary: The codes and words of its dialect.
        assembler: Takes the instructions.
        acting: Addresses of words that do something by themselves, such as S and T.
    """

    def __init__(
        self, control: Control, vocabulary: Vocabulary, assembler: BytecodeAssembler
    ) -> None:
        self.control = control
        self.vocabulary = vocabulary
        self.assembler = assembler
        effects = (each for each, do in vocabulary.words.items() if isinstance(do, WordEffect))
        self.acting = frozenset((*vocabulary.word_compilers, *effects))

    def sorted(self, words: Iterable[Word]) -> SortedBlock:
        """Sort the words of a block.

        Raises:
            UnsupportedError: It is doubtful.
        """
        vocabulary = self.vocabulary
        codes: list[tuple[Word, GCode]] = []
        functions: list[tuple[int, MCode]] = []
        others: dict[str, Word] = {}
        seen: set[str] = set()
        for word in words:
            if word.address in ("G", "M"):
                code = self._code(word)
                name = code.group or word.text
                if name in seen:
                    raise UnsupportedError
                seen.add(name)
                if isinstance(code, MCode):
                    functions.append((_number(word), code))
                else:
                    codes.append((word, code))
            elif word.address in others:
                raise UnsupportedError
            else:
                others[word.address] = word
        self.control.words, self.control.codes = others, codes
        order = {group: rank for rank, group in enumerate(vocabulary.groups)}
        codes.sort(key=lambda pair: order.get(pair[1].group, len(order)))
        return SortedBlock(
            codes,
            functions,
            BlockWords(
                self.control,
                others,
                tuple(_number(word) for word, _ in codes),
                tuple(number for number, _ in functions),
                any(code.action is not None for _, code in functions),
                self.acting,
            ),
        )

    def _code(self, word: Word) -> GCode | MCode:
        number, vocabulary = _number(word), self.vocabulary
        code = vocabulary.g.get(number) if word.address == "G" else vocabulary.m.get(number)
        if word.address == "M" and number in self.control.interpreted_functions:
            raise UnsupportedError
        if code is None and word.address == "M" and vocabulary.any_m and number >= 0:
            return MCode(meaning="machine function")
        if code is None:
            raise UnsupportedError
        return code

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
        codes, functions, block = self.sorted(words)
        acting = [(word, code) for word, code in codes if code.writer is not None]
        moving_codes = [word for word, code in codes if code.writer is None or code.begins_cycle]
        if any(code.after is not None or code.once or code.alone for _, code in acting):
            raise UnsupportedError
        performing = [code for _, code in codes if code.perform is not None]
        if len(performing) > 1 or (performing and performing[0].writer is None):
            raise UnsupportedError
        if performing and any(code.begins_cycle for _, code in acting):
            raise UnsupportedError
        reserved = performing[0].takes if performing else ""
        if self.vocabulary.words_first:
            self._modal_words(block, reserved)
            self._functions(functions, block, late=False)
        for word, code in acting:
            if code.group and not code.begins_cycle:
                self.assembler.emit(opcodes.ACTIVATE, _number(word))
            if code.perform is None:
                self._compile(code, block)
        if not self.vocabulary.words_first:
            self._modal_words(block, reserved)
            self._functions(functions, block, late=False)
        feed = block.words.get("F")
        moving = [] if feed is None or "F" in reserved else [block.words.pop("F")]
        if performing:
            if moving_codes or moving:
                self.assembler.codes([*moving_codes, *moving])
            self._compile(performing[0], block)
            if block.words:
                raise UnsupportedError
        else:
            self.assembler.words([*moving_codes, *moving, *block.words.values()])
        self._functions(functions, block, late=True)

    def known_codes(self, words: Iterable[Word]) -> Iterator[GCode]:
        """The G codes among words, as far as the dialect knows them."""
        for word in words:
            if word.address == "G" and not isinstance(word.value, Expression):
                code = self.vocabulary.g.get(word.value)
                if code is not None:
                    yield code

    def _acts(self, words: list[Word]) -> bool:
        """Whether the block does more than its plain words."""
        functions = 0
        for word in words:
            if word.address in self.acting:
                return True
            if isinstance(word.value, Expression):
                continue
            if word.address == "G":
                code = self.vocabulary.g.get(word.value)
                if code is not None and code.writer is not None:
                    return True
            elif word.address == "M":
                function = self.vocabulary.m.get(int(word.value))
                functions += 1
                if function is not None and function.writer is not None:
                    return True
        return functions > 1

    def _compile(self, code: GCode | MCode, block: BlockWords) -> None:
        writer = code.writer
        if writer is None:
            raise UnsupportedError
        writer(block, self.assembler)

    def _modal_words(self, block: BlockWords, reserved: str) -> None:
        compilers = self.vocabulary.word_compilers
        for address, effect in self.vocabulary.words.items():
            if address not in block.words or address in reserved:
                continue
            if isinstance(effect, WordEffect):
                effect.write(self.control, block.words.pop(address), self.assembler)
            elif address in compilers:
                compilers[address](block, self.assembler)

    def _functions(
        self, functions: list[tuple[int, MCode]], block: BlockWords, *, late: bool
    ) -> None:
        for number, code in functions:
            if code.late != late:
                continue
            if code.ends or code.silent or (code.action is not None and code.writer is None):
                raise UnsupportedError
            if any(letter in block.words for letter in self.vocabulary.function_letters):
                raise UnsupportedError
            writer = code.writer
            if writer is not None:
                writer(block, self.assembler)
            starts = f"M{number}" in SPINDLE_STARTS
            self.assembler.emit(opcodes.SPINDLE_FUNCTION if starts else opcodes.FUNCTION, number)


def _number(word: Word) -> int:
    """The number of a code.

    Raises:
        UnsupportedError: It is computed, or no whole one.
    """
    if isinstance(word.value, Expression) or word.value != int(word.value):
        raise UnsupportedError
    return int(word.value)
