"""The words of a block that is being translated, sorted by what they do and in their order.

``Control.run`` does what is in force, then actions, words, early functions, the motion or what
stands in its place, late functions; ``write_words`` writes the same. Where a block is doubtful it
writes nothing: the general way alone says what is wrong.
"""

import dataclasses
from collections.abc import Iterable
from typing import TYPE_CHECKING

from twin.nc.bytecode.assembler import BlockWriter, NotTranslatableError
from twin.nc.bytecode.opcodes import Step
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
            NotTranslatableError: The machine lacks one of them.
        """
        taken: list[tuple[int, Word]] = []
        for address in [each for each in self.words if each in self.control.dialect.axis_letters]:
            index = self.control.axis_index.get(address)
            if index is None:
                raise NotTranslatableError
            taken.append((index, self.words.pop(address)))
        return taken

    def starts_spindle(self) -> bool:
        """An M function of the block carries the speed."""
        return any(f"M{number}" in SPINDLE_STARTS for number, _ in self.functions)


def sorted_words(control: "Control", words: Iterable[Word]) -> BlockWords:
    """Sort the words of a block.

    Raises:
        NotTranslatableError: It is doubtful.
    """
    dialect = control.dialect
    found = BlockWords(control, [], [], {})
    seen: set[str] = set()
    for word in words:
        if word.address in ("G", "M"):
            if isinstance(word.value, Expression) or word.value != int(word.value):
                raise NotTranslatableError
            number = int(word.value)
            table = dialect.g if word.address == "G" else dialect.m
            code = table.get(number)
            if code is None and word.address == "M" and dialect.any_m and number >= 0:
                code = MCode(meaning="machine function")
            name = word.text if code is None else code.group or word.text
            if code is None or name in seen:
                raise NotTranslatableError
            seen.add(name)
            if isinstance(code, MCode):
                found.functions.append((number, code))
            else:
                found.codes.append((word, code))
        elif word.address in found.words:
            raise NotTranslatableError
        else:
            found.words[word.address] = word
    order = {group: rank for rank, group in enumerate(dialect.groups)}
    found.codes.sort(key=lambda pair: order.get(pair[1].group, len(order)))
    return found


def write_words(control: "Control", words: Iterable[Word], writer: BlockWriter) -> None:
    """Write a block of words.

    Raises:
        NotTranslatableError: It is left to the general way.
    """
    words = list(words)
    dialect = control.dialect
    if not _acts(control, words):
        writer.words(words)
        return
    block = sorted_words(control, words)
    acting = [(word, code) for word, code in block.codes if code.translate is not None]
    plain = [word for word, code in block.codes if code.translate is None or code.begins_cycle]
    if any(code.after is not None or code.once or code.alone for _, code in acting):
        raise NotTranslatableError
    performing = [code for _, code in block.codes if code.perform is not None]
    if len(performing) > 1 or (performing and performing[0].translate is None):
        raise NotTranslatableError
    if performing and any(code.begins_cycle for _, code in acting):
        raise NotTranslatableError
    for word, code in acting:
        assert not isinstance(word.value, Expression)
        if code.group and not code.begins_cycle:
            writer.step(Step.IN_FORCE, int(word.value))
        if code.perform is None:
            _translate(code, block, writer)
    reserved = performing[0].takes if performing else ""
    for address in dialect.words:
        translation = dialect.word_translations.get(address)
        if address in block.words and address not in reserved and translation is not None:
            translation(block, writer)
    _write_functions(block, writer, late=False)
    feed = block.words.get("F")
    moving = [] if feed is None or "F" in reserved else [block.words.pop("F")]
    if performing:
        writer.codes([*plain, *moving])
        _translate(performing[0], block, writer)
        if block.words:
            raise NotTranslatableError
    else:
        writer.words([*plain, *moving, *block.words.values()])
    _write_functions(block, writer, late=True)


def _acts(control: "Control", words: list[Word]) -> bool:
    """Whether the block does more than its plain words."""
    dialect, functions = control.dialect, 0
    for word in words:
        if word.address in dialect.word_translations:
            return True
        if isinstance(word.value, Expression):
            continue
        if word.address == "G":
            code = dialect.g.get(int(word.value))
            if code is not None and code.translate is not None:
                return True
        elif word.address == "M":
            function = dialect.m.get(int(word.value))
            functions += 1
            if function is not None and function.translate is not None:
                return True
    return functions > 1


def _translate(code: GCode | MCode, block: BlockWords, writer: BlockWriter) -> None:
    if code.translate is None:
        raise NotTranslatableError
    code.translate(block, writer)


def _write_functions(block: BlockWords, writer: BlockWriter, *, late: bool) -> None:
    for number, code in block.functions:
        if code.late != late:
            continue
        if code.ends or code.silent or (code.action is not None and code.translate is None):
            raise NotTranslatableError
        if any(letter in block.words for letter in block.control.dialect.function_letters):
            raise NotTranslatableError
        if code.translate is not None:
            code.translate(block, writer)
        starts = f"M{number}" in SPINDLE_STARTS
        writer.step(Step.SPINDLE_FUNCTION if starts else Step.FUNCTION, number)
