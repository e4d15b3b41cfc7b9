"""Runs the blocks of a program, whatever its dialect, in the order of ``block_order``.

Every word must be used by something; a word that nothing wants is an error, because ignoring it would
be a guess.
"""

from collections.abc import Sequence
from typing import NoReturn

from twin.nc.control.block_order import (
    Conflict,
    SortedBlock,
    codes_that_count,
    conflict_of,
    in_order,
    run_in_order,
)
from twin.nc.control.codes import GCode, Interpolation, MCode
from twin.nc.control.control import Control
from twin.nc.control.dialect import Dialect
from twin.nc.control.modal import ModalChanges
from twin.nc.control.settings import ControlSettings
from twin.nc.control.state import integer_of, number_of
from twin.nc.functions import starts_spindle, turns_behind
from twin.nc.text.blocks import Assignment, Block, Statement, Word
from twin.nc.text.expressions import Expression, ExpressionError
from twin.nc.text.slips import near
from twin.nc.text.source import Source


class Executor(Control):
    """One control while it runs one program.

    Attributes:
        dialect: The language it reads.
    """

    def __init__(self, dialect: Dialect, settings: ControlSettings, source: Source) -> None:
        super().__init__(dialect, settings, source, dialect.new_modal())
        self.dialect = dialect
        self.feed_rule = dialect.feed_rule(settings)
        self._pointless = dialect.pointless(settings)
        self._special = frozenset(("G", "M", *dialect.signed, *dialect.series))
        expressions = dialect.syntax.expressions
        self._vacant = expressions is not None and expressions.vacant
        self._codes: list[tuple[Word, GCode]] = []
        self.modal.put(dialect.start_state)
        for number in dialect.start:
            self.put_into_force(number, dialect.g[number])

    def put_into_force(self, number: float, code: GCode) -> None:
        """Apply a modal code."""
        modal = self.modal
        for name, value in code.sets.items():
            setattr(modal, name, value)
        if code.group:
            modal.active.put(code.group, number)
        if modal.cycle is None:
            self.forget_cycle()

    def run(self, block: Block) -> None:
        """Run one block.

        Raises:
            ProgramError: It is wrong.
        """
        self.block = block
        self.report.line = block.line
        if self.settings.skips(block):
            return
        if self._pointless:
            block = self.block = self.dialect.count(self, block)
        if self.dialect.repeat_word:
            block = self._repeated(block)
        if block.statement is not None:
            self._run_statement(block.statement)
            return
        codes, functions = self._sort_words(block.words)
        if block.assignments:
            self._assign(block.assignments)
        restore = self._apply_codes()
        run_in_order(self, codes, functions, words_first=self.dialect.words_first)
        if self.words or self.series:
            self._refuse_unused()
        for replaced in restore:
            self.modal.put(replaced)

    def act(self, _word: Word, code: GCode) -> None:
        """What a code does before the block moves."""
        if code.action is not None:
            code.action(self)

    def follow(self, _word: Word, code: GCode) -> None:
        """What a code does when the block has moved."""
        assert code.after is not None
        code.after(self)

    def _assign(self, assignments: tuple[Assignment, ...]) -> None:
        """Give variables their values, all of them computed before the first is given."""
        given: list[tuple[Assignment, str, float | None, float]] = []
        for each in assignments:
            span, target, index = (each.column, each.width), each.target, None
            try:
                if each.number is not None:
                    index = each.number.compute(self)
                value = each.value.compute(self)
            except ExpressionError as error:
                self.report.fail(error.code, str(error), *span, error.hint)
            given.append((each, target.name, index, value))
        write = self.dialect.write_variable
        for each, name, index, value in given:
            if write is not None:
                write(self, name, index, value, each)
            else:
                self.variables.write(name if index is None else f"{name}{index:g}", value)

    def prepare(self) -> None:
        """The program begins."""
        if self.dialect.prepare is not None:
            self.dialect.prepare(self)

    def _repeated(self, block: Block) -> Block:
        """Run a block with a repeat word as often as it says, but once; return it without."""
        words = [word for word in block.words if word.address == self.dialect.repeat_word]
        if not words:
            return block
        word = words[0]
        value = word.value
        count = self.evaluate(value, word) if isinstance(value, Expression) else value
        rest = tuple(each for each in block.words if each is not word)
        if count < 1.0 or count != int(count):
            self.fail("repeat-count", f"{word.address} must count 1 or more runs", word)
        if any(each.address in "MTDH" for each in rest):
            self.fail("repeat-count", f"{word.address} repeats motion only, no M, T, D or H", word)
        if count > self.settings.step_limit:
            self.fail("endless-program", f"more than {self.settings.step_limit} runs", word)
        plain = block._replace(words=rest)
        for _ in range(int(count) - 1):
            self.run(plain)
        return plain

    def _run_statement(self, statement: Statement) -> None:
        self.words, self.codes = {}, ()
        action = self.dialect.statements.get(statement.keyword, self.dialect.other_statement)
        assert action is not None
        action(self, statement)

    def finish(self) -> None:
        """The program has ended, by an end code or by its last line."""
        if not self.program_counter.begun:
            self.report.line = 1
            self.report.warn("empty-program", "no line holds a block", hint="is this the program?")
        elif not self.ended and self.dialect.finish is not None:
            self.dialect.finish(self)
        self.path.finish()

    def _apply_codes(self) -> list[ModalChanges]:
        """Apply the block's codes; what those for this block only have replaced."""
        restore: list[ModalChanges] = []
        for word, code in self._codes:
            if code.once:
                restore.append(self.modal.values_of(code.sets))
            if code.alone and len(self.block.words) > 1:
                self.fail("alone", f"{word.text} must stand alone in its block", word)
            self.put_into_force(number_of(word), code)
        return restore

    def _sort_words(self, block: Sequence[Word]) -> SortedBlock:
        """Sort the words of a block; those that are no codes become ``words`` and ``series``.

        Raises:
            ProgramError: Some of them cannot stand in one block.
        """
        dialect = self.dialect
        self.codes = self._codes = codes = []
        self.words = words = {}
        self.series = []
        functions: list[tuple[Word, MCode]] = []
        special = self._special
        for word in block:
            address, value = word.address, word.value
            if address not in special and address not in words and type(value) is float:
                words[address] = word
                continue
            if isinstance(value, Expression) and address not in dialect.references:
                value = self.evaluate(value, word)
                word = word._replace(value=value)
                if value != value:
                    if not self._vacant:
                        message = f"the value of '{address}' is no number"
                        self.fail("number-range", message, word)
                    continue  # computed of a vacant variable: the word is not there
            if address == "G":
                codes.append((word, self._g_code(word)))
                continue
            if address in dialect.signed and number_of(word) < 0.0:
                address = f"{address}-"
                word = word._replace(address=address)
            if address == "M" and not self._takes_m(block):
                functions.append((word, self._m_code(word)))
            elif address in dialect.series and self._has_switch(block):
                if isinstance(word.value, Expression):
                    word = word._replace(value=self.evaluate(word.value, word))
                self.series.append(word)
            else:
                self._add_word(word)
        if len(codes) > 1 or len(functions) > 1:
            codes = codes_that_count(codes, last_of_group=dialect.last_of_group_counts)
            self._refuse_conflict(conflict_of(codes, functions))
            self.codes = self._codes = in_order(codes, dialect.groups)
        return SortedBlock(self._codes, functions)

    def _add_word(self, word: Word) -> None:
        if word.address in self.words:
            message = f"'{word.address}' stands twice in the block"
            self.fail("duplicate-word", message, word, "leave one out, or write two blocks")
        self.words[word.address] = word

    def _takes_m(self, block: Sequence[Word]) -> bool:
        """Whether M is a word of one of the block's G codes, and no machine function."""
        numbers = (word.value for word in block if word.address == "G")
        codes = (self.dialect.g.get(n) for n in numbers if isinstance(n, float))
        return any(code is not None and "M" in code.takes for code in codes)

    def _has_switch(self, block: Sequence[Word]) -> bool:
        return any(word.address == self.dialect.series[0] for word in block)

    def _g_code(self, word: Word) -> GCode:
        number = number_of(word)
        code = self.dialect.g.get(number)
        if code is None:
            known = [f"G{number:g}" for number in sorted(self.dialect.g)]
            instead = self.dialect.instead.get(number)
            self.fail(
                "unknown-g",
                f"{word.text} is unknown to {self.dialect.name}",
                word,
                hint=instead or near(f"G{number:g}", known, self.dialect.name),
            )
        if code.refused:
            self.fail("unsupported-g", f"{word.text} {code.refusal}", word)
        return code

    def _m_code(self, word: Word) -> MCode:
        number = integer_of(number_of(word))
        code = self.dialect.function(number, self.settings.m_functions)
        if code is None:
            if number < 0:
                self.fail("unknown-m", f"{word.text}: an M code is a whole number", word)
            listed = near(f"M{number}", map("M{}".format, self.dialect.m), self.dialect.name)
            self.fail(
                "unknown-m",
                f"{word.text} is unknown to {self.dialect.name}",
                word,
                hint=f'one of the machine\'s builder: [m_functions] M{number} = "what it does" in the job; '
                + listed,
            )
        return code

    def _refuse_conflict(self, conflict: Conflict | None) -> None:
        """Say which codes cannot share a block.

        Raises:
            ProgramError: There are two.
        """
        if conflict is None:
            return
        both = f"{conflict.first.text} and {conflict.second.text}"
        group = f" ({conflict.group})" if conflict.group else ""
        message = f"{both} exclude each other{group}"
        if conflict.performs:
            message = f"{both} cannot share a block"
        hint = "write them in two blocks"
        self.fail("conflicting-codes", message, conflict.second, hint=hint)

    def modal_words(self, reserved: str) -> None:
        """What words such as F, S and T do, but for those that the motion wants."""
        words, modal_words = self.words, self.dialect.words
        if words.keys().isdisjoint(modal_words):
            return
        for address, action in modal_words.items():
            if address in words and address not in reserved:
                action(self, words.pop(address))

    def run_function(self, word: Word, function: MCode) -> None:
        """Run an M function."""
        if function.action is not None:
            function.action(self)
        if function.silent:
            return
        arguments, number = self.take_function_arguments(word), integer_of(number_of(word))
        self.spindle_turns = turns_behind(number, float(self.spindle_turns)) != 0.0
        self.function(f"M{number}", arguments)
        if function.dwell > 0.0:
            self.dwell(function.dwell)
        if function.ends:
            self.ended = True

    def take_function_arguments(self, word: Word) -> dict[str, float]:
        """What belongs to an M function: its own words, and for a spindle start the speed."""
        letters = self.dialect.function_letters
        if integer_of(number_of(word)) not in self.dialect.m:
            letters += self.dialect.declared_letters
        arguments = {
            address: self.take_computed(address) for address in letters if address in self.words
        }
        if starts_spindle(integer_of(number_of(word))) and self.spindle is not None:
            arguments["S"] = self.spindle
        return arguments

    def move(self, instead: GCode | None) -> None:
        """The motion, or what a code does in its place."""
        if instead is not None and instead.perform is not None:
            instead.perform(self)
            return
        words = self.words
        motion_words = self.dialect.motion_words
        if motion_words.isdisjoint(words) and not any(code.begins_cycle for _, code in self._codes):
            self._stand_alone()
            return
        modal = self.modal
        interpolation = modal.interpolation if modal.cycle is None else modal.cycle
        if interpolation is None:
            word = next(each for each in words.values() if each.address in motion_words)
            if word.address not in self.dialect.axis_letters:
                message = f"'{word.text}' belongs to a motion, and no motion code is in force"
                self.fail("no-motion-code", message, word, self._meaning_of(word.address))
            self.fail(
                "no-motion-code",
                f"'{word.text}' would move, but no motion code is in force",
                word,
                hint="write G0, G1, G2 or G3",
            )
        if self.path.compensating and modal.cycle is not None:
            message = "a canned cycle cannot run while radius compensation is in force"
            self.fail("compensation-change", message, hint="end it by G40 first")
        if self.dialect.before_motion is not None:
            self.dialect.before_motion(self, interpolation.rapid)
        assert isinstance(interpolation, Interpolation)
        interpolation.perform(self)
        if self.dialect.after_motion is not None:
            self.dialect.after_motion(self)

    def _stand_alone(self) -> None:
        """A motion code without the words of a motion, where its dialect has a rule for that."""
        for _, code in self._codes:
            mode = code.sets.get("interpolation")
            if isinstance(mode, Interpolation) and mode.without_words is not None:
                mode.without_words(self)

    def _refuse_unused(self) -> NoReturn:
        word = next(iter(self.words.values()), None) or self.series[0]
        if word.address in self.dialect.word_meanings:
            message = f"nothing in this block uses '{word.text}'"
            self.fail("unused-word", message, word, self._meaning_of(word.address))
        name = self.dialect.name
        hint = f"its words are listed by: twin dialects {name}"
        self.fail("unknown-word", f"'{word.address}' is no word of {name}", word, hint)

    def _meaning_of(self, address: str) -> str:
        return f"{address} in {self.dialect.name}: {self.dialect.word_meanings[address]}"

    def place_switches(self, length: float) -> None:
        """Report the block's switch points, told the length of its move."""
        if self.dialect.place_switches is not None:
            self.dialect.place_switches(self, length)

    def read_variable(self, name: str, index: float | None) -> float:
        """Value of a variable of the program, for expressions."""
        if self.dialect.read_variable is None:
            raise ExpressionError("unknown-variable", f"there is no variable {name}")
        return self.dialect.read_variable(self, name, index)
