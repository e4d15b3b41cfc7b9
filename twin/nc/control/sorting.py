"""The words of a block by what they are: codes, functions, and all others; which codes exclude each other."""

from collections.abc import Sequence
from typing import NamedTuple

from twin.nc.control.codes import GCode, MCode
from twin.nc.control.control import Control, integer_of, number_of
from twin.nc.control.dialect import Dialect
from twin.nc.text.blocks import Word
from twin.nc.text.expressions.expressions import Expression

Codes = Sequence[tuple[Word, GCode]]
Functions = Sequence[tuple[Word, MCode]]


class WordSorter:
    """Sorts the words of blocks for one control."""

    def __init__(self, control: Control, dialect: Dialect) -> None:
        self._control = control
        self._dialect = dialect
        words = dialect.words
        self._special = frozenset(("G", "M", *words.signed, *words.series))
        expressions = dialect.syntax.expressions
        self._vacant = expressions is not None and expressions.vacant
        self._indexed = words.indexed

    def sort(self, block: Sequence[Word]) -> tuple[Codes, Functions]:
        """Sort the words of a block; those that are no codes become the control's ``words`` and ``series``.

        Returns:
            Its G codes, in the order in which they take effect; its M functions, in the order of the text.

        Raises:
            ProgramError: Some of them cannot be in one block.
        """
        control, dialect = self._control, self._dialect
        codes: list[tuple[Word, GCode]] = []
        functions: list[tuple[Word, MCode]] = []
        words: dict[str, Word] = {}
        control.codes, control.words, control.series = codes, words, []
        special, known = self._special, dialect.codes.g
        for word in block:
            address, value = word.address, word.value
            if type(value) is float:
                if address not in special and address not in words:
                    words[address] = word
                    continue
                if address == "G" and (code := known.get(value)) is not None and not code.refused:
                    codes.append((word, code))
                    continue
            if isinstance(value, Expression) and address not in dialect.words.references:
                value = control.compute(value, word)
                word = Word(address, value, *word[2:])  # in a third of the time of ``_replace``
                if value != value:
                    if not self._vacant:
                        message = f"the value of '{address}' is no number"
                        control.fail("number-range", message, word)
                    continue  # computed of a vacant variable: the word is not there
            if address == "G":
                codes.append((word, self._g_code(word)))
                continue
            if address in dialect.words.signed and number_of(word) < 0.0:
                address = f"{address}-"
                word = word._replace(address=address)
            if address == "M" and not self._takes_m(block):
                functions.append((word, self._m_code(word)))
            elif address in dialect.words.series and self._has_switch(block):
                if isinstance(word.value, Expression):
                    word = word._replace(value=control.compute(word.value, word))
                control.series.append(word)
            elif address in words:
                control.fail(
                    "duplicate-word",
                    f"'{address}' occurs twice in the block",
                    word,
                    "leave one out, or write two blocks",
                )
            else:
                words[address] = word
        if self._indexed is not None and any(address[-1] == "]" for address in words):
            self._resolve_indices(words)
        if len(codes) > 1 or len(functions) > 1:
            codes = codes_that_count(codes, last_of_group=dialect.codes.last_of_group_counts)
            self._refuse_conflict(conflict_of(codes, functions))
            control.codes = codes = in_order(codes, dialect.codes.groups)
        return codes, functions

    def _resolve_indices(self, words: dict[str, Word]) -> None:
        """Give words with an index in their address the axis that it names."""
        assert self._indexed is not None
        for address in [each for each in words if each[-1] == "]"]:
            word = words.pop(address)
            axis = self._indexed(self._control, word)
            if axis in words:
                message = f"'{axis}' occurs twice in the block"
                self._control.fail("duplicate-word", message, word, "write two blocks")
            words[axis] = word._replace(address=axis)

    def _takes_m(self, block: Sequence[Word]) -> bool:
        """Whether M is a word of one of the block's G codes, and no machine function."""
        numbers = (word.value for word in block if word.address == "G")
        codes = (self._dialect.codes.g.get(n) for n in numbers if isinstance(n, float))
        return any(code is not None and "M" in code.consumes for code in codes)

    def _has_switch(self, block: Sequence[Word]) -> bool:
        return any(word.address == self._dialect.words.series[0] for word in block)

    def _g_code(self, word: Word) -> GCode:
        number, codes = number_of(word), self._dialect.codes
        code = codes.g.get(number)
        if code is None:
            message = f"{word.text} is unknown to {self._dialect.name}"
            hint = codes.replacements.get(number) or self._codes_near(number)
            self._control.fail("unknown-g", message, word, hint=hint)
        if code.refused:
            self._control.fail(
                "unsupported-g", f"{word.text} {code.refusal}", word, code.advice or None
            )
        return code

    def _m_code(self, word: Word) -> MCode:
        number, codes = integer_of(number_of(word)), self._dialect.codes
        code = codes.function(number, self._control.settings.m_functions)
        if code is None:
            if number < 0:
                message = f"{word.text}: an M code is a whole number"
                self._control.fail("unknown-m", message, word, "M0 stops, M3 starts the spindle")
            message = f"{word.text} is unknown to {self._dialect.name}"
            own = f'one of the machine\'s builder: [m_functions] M{number} = "what it does" in the job'
            usual = f"{own}; all of them: twin dialects {self._dialect.name}"
            replacement = codes.function_replacements.get(number)
            hint = f"{replacement}; {own}" if replacement else usual
            self._control.fail("unknown-m", message, word, hint=hint)
        return code

    def _codes_near(self, number: float) -> str:
        """The codes whose whole part is that of an unknown one, and where all of them are listed."""
        alike = [
            self._dialect.code_name(each)
            for each, code in sorted(self._dialect.codes.g.items())
            if int(each) == int(number) and not code.refused
        ]
        listed = f"all of them: twin dialects {self._dialect.name}"
        return f"near it: {', '.join(alike[:4])}; {listed}" if alike else listed

    def _refuse_conflict(self, conflict: "Conflict | None") -> None:
        """Say which codes cannot share a block."""
        if conflict is None:
            return
        both = f"{conflict.first.text} and {conflict.second.text}"
        group = f" ({conflict.group})" if conflict.group else ""
        message = f"{both} exclude each other{group}"
        if conflict.performs:
            message = f"{both} cannot share a block"
        hint = "write them in two blocks"
        self._control.fail("conflicting-codes", message, conflict.second, hint=hint)


def in_order(codes: Codes, groups: Sequence[str]) -> list[tuple[Word, GCode]]:
    """G codes as they take effect: by the order of their groups, those without one at last."""
    order = {group: rank for rank, group in enumerate(groups)}
    return sorted(codes, key=lambda pair: order.get(pair[1].group, len(order)))


def codes_that_count(codes: Codes, *, last_of_group: bool) -> list[tuple[Word, GCode]]:
    """G codes without those that another one of their modal group overrules.

    Args:
        last_of_group: The last one overrules all others; else each overrules those that are weak.
    """
    strong = {code.group for _, code in codes if not code.weak}
    last = {code.group: word for word, code in codes}

    def counts(word: Word, code: GCode) -> bool:
        if code.weak and code.group in strong:
            return False
        return last[code.group] is word or not (code.weak or last_of_group)

    return [(word, code) for word, code in codes if not code.group or counts(word, code)]


class Conflict(NamedTuple):
    """Two codes that cannot share a block.

    Attributes:
        group: Their modal group, or empty.
        performs: Both want to replace the motion.
    """

    first: Word
    second: Word
    group: str = ""
    performs: bool = False


def conflict_of(codes: Codes, functions: Functions) -> Conflict | None:
    """The first codes of a block that exclude each other, or None."""
    seen: dict[str, Word] = {}
    performing: Word | None = None
    for word, code in codes:
        if code.group and code.group in seen:
            return Conflict(seen[code.group], word, code.group)
        seen[code.group] = word
        if code.perform is not None:
            if performing is not None:
                return Conflict(performing, word, performs=True)
            performing = word
    seen = {}
    for word, function in functions:
        other = seen.setdefault(function.group or word.text, word)
        if other is not word:
            return Conflict(other, word)
    return None
