"""The words of a block that is being compiled, sorted by what they do and in their order.

``Control.run`` does what is in force, then actions, words, early functions, the motion or what
stands in its place, late functions; ``compile_words`` writes the same. Where a block is doubtful it
compiles nothing: the interpreter tier alone says what is wrong.
"""

import dataclasses
from collections.abc import Iterable
from typing import TYPE_CHECKING

from twin.nc.bytecode import opcodes
from twin.nc.bytecode.assembler import Assembler, UnsupportedError
from twin.nc.control.dialect import GCode, MCode
from twin.nc.functions import SPINDLE_STARTS
from twin.nc.text.blocks import Word
from twin.nc.text.expressions import Expression

if TYPE_CHECKING:
    from twin.nc.control.control import Control


@dataclasses.dataclass(slots=True)
class BlockWords:
    """The words of one block that nothing has taken yet, besides G and M.

    Attributes:
        control: Whose block it is.
        codes: Its G codes, in the order in which they take effect.
        functions: Its M functions, in the order of the text.
        words: The others by address.
    """

    control: "Control"
    codes: list[tuple[Word, GCode]]
    functions: list[tuple[int, MCode]]
    words: dict[str, Word]

    def take(self, address: str) -> Word | None:
        """Take a word; None where there is none."""
        return self.words.pop(address, None)

    def take_axes(self) -> list[tuple[int, Word]]:
        """Take the words that name axes; pairs of column and word.

        Raises:
            UnsupportedError: The machine lacks one of them.
        """
        taken: list[tuple[int, Word]] = []
        for address in [each for each in self.words if each in self.control.dialect.axis_letters]:
            index = self.control.axis_index.get(address)
            if index is None:
                raise UnsupportedError
            taken.append((index, self.words.pop(address)))
        return taken

    def starts_spindle(self) -> bool:
        """An M function of the block carries the speed."""
        return any(f"M{number}" in SPINDLE_STARTS for number, _ in self.functions)


def sorted_words(control: "Control", words: Iterable[Word]) -> BlockWords:
    """Sort the words of a block.

    Raises:
        UnsupportedError: It is doubtful.
    """
    dialect = control.dialect
    found = BlockWords(control, [], [], {})
    seen: set[str] = set()
    for word in words:
        if word.address in ("G", "M"):
            if isinstance(word.value, Expression) or word.value != int(word.value):
                raise UnsupportedError
            number = int(word.value)
            table = dialect.g if word.address == "G" else dialect.m
            code = table.get(number)
            if code is None and word.address == "M" and dialect.any_m and number >= 0:
                code = MCode(meaning="machine function")
            name = word.text if code is None else code.group or word.text
            if code is None or name in seen:
                raise UnsupportedError
            seen.add(name)
            if isinstance(code, MCode):
                found.functions.append((number, code))
            else:
                found.codes.append((word, code))
        elif word.address in found.words:
            raise UnsupportedError
        else:
            found.words[word.address] = word
    order = {group: rank for rank, group in enumerate(dialect.groups)}
    found.codes.sort(key=lambda pair: order.get(pair[1].group, len(order)))
    return found


def compile_words(control: "Control", words: Iterable[Word], assembler: Assembler) -> None:
    """Write a block of words.

    Raises:
        UnsupportedError: It is left to the interpreter tier.
    """
    words = list(words)
    dialect = control.dialect
    if not _acts(control, words):
        assembler.words(words)
        return
    block = sorted_words(control, words)
    acting = [(word, code) for word, code in block.codes if code.compiler is not None]
    moving_codes = [
        word for word, code in block.codes if code.compiler is None or code.begins_cycle
    ]
    if any(code.after is not None or code.once or code.alone for _, code in acting):
        raise UnsupportedError
    performing = [code for _, code in block.codes if code.perform is not None]
    if len(performing) > 1 or (performing and performing[0].compiler is None):
        raise UnsupportedError
    if performing and any(code.begins_cycle for _, code in acting):
        raise UnsupportedError
    for word, code in acting:
        assert not isinstance(word.value, Expression)
        if code.group and not code.begins_cycle:
            assembler.emit(opcodes.ACTIVATE, int(word.value))
        if code.perform is None:
            _compile(code, block, assembler)
    reserved = performing[0].takes if performing else ""
    for address in dialect.words:
        compiler = dialect.word_compilers.get(address)
        if address in block.words and address not in reserved and compiler is not None:
            compiler(block, assembler)
    _compile_functions(block, assembler, late=False)
    feed = block.words.get("F")
    moving = [] if feed is None or "F" in reserved else [block.words.pop("F")]
    if performing:
        assembler.codes([*moving_codes, *moving])
        _compile(performing[0], block, assembler)
        if block.words:
            raise UnsupportedError
    else:
        assembler.words([*moving_codes, *moving, *block.words.values()])
    _compile_functions(block, assembler, late=True)


def _acts(control: "Control", words: list[Word]) -> bool:
    """Whether the block does more than its plain words."""
    dialect, functions = control.dialect, 0
    for word in words:
        if word.address in dialect.word_compilers:
            return True
        if isinstance(word.value, Expression):
            continue
        if word.address == "G":
            code = dialect.g.get(int(word.value))
            if code is not None and code.compiler is not None:
                return True
        elif word.address == "M":
            function = dialect.m.get(int(word.value))
            functions += 1
            if function is not None and function.compiler is not None:
                return True
    return functions > 1


def _compile(code: GCode | MCode, block: BlockWords, assembler: Assembler) -> None:
    if code.compiler is None:
        raise UnsupportedError
    code.compiler(block, assembler)


def _compile_functions(block: BlockWords, assembler: Assembler, *, late: bool) -> None:
    for number, code in block.functions:
        if code.late != late:
            continue
        if code.ends or code.silent or (code.action is not None and code.compiler is None):
            raise UnsupportedError
        if any(letter in block.words for letter in block.control.dialect.function_letters):
            raise UnsupportedError
        if code.compiler is not None:
            code.compiler(block, assembler)
        starts = f"M{number}" in SPINDLE_STARTS
        assembler.emit(opcodes.SPINDLE_FUNCTION if starts else opcodes.FUNCTION, number)
