"""Runs the blocks of a program, whatever its dialect.

Modal codes take effect by group, then set-up actions, modal words (F, S, T), early M functions, the motion or
what is in its place, late M functions, jumps. In some dialects the words come before the actions. Every
word must be used by something; a word that nothing wants is an error, because ignoring it would be a guess.
"""

from typing import NoReturn

from twin.nc.control.codes import GCode, Interpolation, MCode
from twin.nc.control.control import Control, integer_of, number_of
from twin.nc.control.dialect import Dialect
from twin.nc.control.modal import ModalChanges
from twin.nc.control.settings import ControlSettings
from twin.nc.control.sorting import Codes, Functions, WordSorter
from twin.nc.functions import starts_spindle, turns_behind
from twin.nc.text.blocks import Assignment, Block, Statement, Word
from twin.nc.text.diagnostics.slips import slip_at
from twin.nc.text.expressions.expressions import ExpressionError
from twin.nc.text.source import Source

_IN_INCHES: dict[float, float] = {21: 20, 71: 70, 710: 700}
"""The code of inches by that of millimetres, of the controls that begin with it."""
_INCH = 25.4


class Executor:
    """Runs blocks of a dialect on a control."""

    def __init__(self, dialect: Dialect, settings: ControlSettings, source: Source) -> None:
        self.dialect = dialect
        modal, letters = dialect.codes.new_modal(), dialect.words.axes
        self.control = control = Control(
            dialect, dialect.rules, letters, modal, settings, source, self.run
        )
        self._sorter = WordSorter(control, dialect)
        self._repeats = dialect.words.repeat != ""
        self._without_point = dialect.rules.without_point(settings)
        modal.put(dialect.codes.start_state)
        for number in dialect.codes.start:
            if settings.units == "inch" and number in _IN_INCHES:
                number = _IN_INCHES[number]
                modal.unit = _INCH
            self.put_into_force(number, dialect.codes.g[number])

    def put_into_force(self, number: float, code: GCode) -> None:
        """Apply a modal code."""
        modal = self.control.modal
        for name, value in code.sets.items():
            setattr(modal, name, value)
        if code.group:
            modal.active.put(code.group, number)
        if modal.cycle is None and self.control.cycle_values:
            self.control.forget_cycle()

    def prepare(self) -> None:
        """The program begins."""
        if self.dialect.rules.prepare is not None:
            self.dialect.rules.prepare(self.control)

    def finish(self) -> None:
        """The program has ended, by an end code or by its last line."""
        control, finish = self.control, self.dialect.rules.finish
        if not control.program_counter.begun:
            control.report.line = 1
            hint = "is this the program?"
            control.report.warn("empty-program", "no line holds a block", hint=hint)
        elif not control.ended and finish is not None:
            finish(control)
        control.path.finish()

    def run(self, block: Block) -> None:
        """Run one block."""
        control = self.control
        control.block = block
        control.report.line = block.line
        if block.skippable and control.settings.skips(block):
            return
        if self._without_point:
            block = control.block = self.dialect.rules.count(control, block)
        if self._repeats:
            block = self._repeated(block)
        if block.statement is not None:
            self._run_statement(block.statement)
            return
        codes, functions = self._sorter.sort(block.words)
        if block.assignments:
            self._assign(block.assignments)
        restore = self._apply_codes(codes) if codes else ()
        self._run_in_order(codes, functions)
        if control.words or control.series:
            self._refuse_unused()
        for replaced in restore:
            control.modal.put(replaced)

    def _run_in_order(self, codes: Codes, functions: Functions) -> None:
        """All that a block does, when its modal codes are in force."""
        control, before_codes = self.control, self.dialect.words.before_codes
        performing = None
        for _, code in codes:
            if code.action is not None and not before_codes:
                code.action(control)
            if code.perform is not None:
                performing = code
        self._run_modal_words("" if performing is None else performing.consumes)
        for word, function in functions:
            if not function.after_motion:
                self._run_function(word, function)
        if before_codes:
            for _, code in codes:
                if code.action is not None:
                    code.action(control)
        if performing is not None and performing.perform is not None:
            performing.perform(control)
        else:
            self._move(codes)
        for _, code in codes:
            if code.after_motion is not None:
                code.after_motion(control)
        for word, function in functions:
            if function.after_motion:
                self._run_function(word, function)

    def _run_statement(self, statement: Statement) -> None:
        control, codes = self.control, self.dialect.codes
        control.words, control.codes = {}, ()
        action = codes.statements.get(statement.keyword, codes.other_statement)
        assert action is not None
        action(control, statement)

    def _assign(self, assignments: tuple[Assignment, ...]) -> None:
        """Give variables their values, all of them computed before the first is given."""
        control = self.control
        given: list[tuple[Assignment, str, float | None, float]] = []
        for each in assignments:
            span, target, index = (each.column, each.width), each.target, None
            try:
                if each.number is not None:
                    index = each.number.compute(control)
                value = each.value.compute(control)
            except ExpressionError as error:
                control.report.fail(error.code, str(error), *span, error.hint)
            given.append((each, target.name, index, value))
        write = self.dialect.rules.write_variable
        for each, name, index, value in given:
            if write is not None:
                write(control, name, index, value, each)
            else:
                control.variables.write(name if index is None else f"{name}{index:g}", value)

    def _repeated(self, block: Block) -> Block:
        """Run a block with a repeat word as often as it says, but once; return it without."""
        control, address = self.control, self.dialect.words.repeat
        words = [word for word in block.words if word.address == address]
        if not words:
            return block
        word = words[0]
        count = control.value(word)
        rest = tuple(each for each in block.words if each is not word)
        if count < 1.0 or count != int(count):
            control.fail("repeat-count", f"{address} must count 1 or more runs", word)
        if any(each.address in "MTDH" for each in rest):
            control.fail("repeat-count", f"{address} repeats motion only, no M, T, D or H", word)
        most = control.settings.step_limit
        if count > most:
            control.fail("endless-program", f"more than {most} runs", word)
        plain = block._replace(words=rest)
        for _ in range(int(count) - 1):
            self.run(plain)
        return plain

    def _apply_codes(self, codes: Codes) -> list[ModalChanges]:
        """Apply the block's codes; what those for this block only have replaced."""
        control = self.control
        restore: list[ModalChanges] = []
        for word, code in codes:
            if code.non_modal:
                restore.append(control.modal.values_of(code.sets))
            if code.exclusive and len(control.block.words) > 1:
                message = f"{word.text} must stand alone in its block"
                control.fail(
                    "alone", message, word, "write the other words in a block of their own"
                )
            self.put_into_force(number_of(word), code)
        return restore

    def _run_modal_words(self, reserved: str) -> None:
        """What words such as F, S and T do, but for those that a code wants."""
        words, actions = self.control.words, self.dialect.words.actions
        if words.keys().isdisjoint(actions):
            return
        for address, action in actions.items():
            if address in words and address not in reserved:
                action(self.control, words.pop(address))

    def _run_function(self, word: Word, function: MCode) -> None:
        """Run an M function."""
        control = self.control
        if function.action is not None:
            function.action(control)
        if function.silent:
            return
        arguments, number = self._take_arguments(word), integer_of(number_of(word))
        turns = float(control.motion.spindle_turns)
        control.motion.spindle_turns = turns_behind(number, turns) != 0.0
        control.function(f"M{number}", arguments)
        if function.dwell > 0.0:
            control.dwell(function.dwell)
        if function.ends:
            control.ended = True

    def _take_arguments(self, word: Word) -> dict[str, float]:
        """What belongs to an M function: its own words, and for a spindle start the speed."""
        control, number = self.control, integer_of(number_of(word))
        letters = self.dialect.words.of_functions
        if number not in self.dialect.codes.m:
            letters += self.dialect.words.of_declared
        arguments: dict[str, float] = {}
        for address in letters:
            if (own := control.take(address)) is not None:
                arguments[address] = control.value(own)
        if starts_spindle(number) and control.motion.spindle is not None:
            arguments["S"] = control.motion.spindle
        return arguments

    def _move(self, codes: Codes) -> None:
        """The motion that the block's words ask for, if they do."""
        control, rules = self.control, self.dialect.rules
        if self.dialect.words.motion.isdisjoint(control.words) and not any(
            code.begins_cycle for _, code in codes
        ):
            self._stand_alone(codes)
            return
        modal = control.modal
        interpolation = modal.interpolation if modal.cycle is None else modal.cycle
        if interpolation is None:
            self._refuse_motion()
        if modal.cycle is not None and control.path.compensation.in_force:
            message = "a canned cycle cannot run while radius compensation is in force"
            control.fail("compensation-change", message, hint="end it by G40 first")
        if rules.before_motion is not None:
            rules.before_motion(control, interpolation.rapid)
        assert isinstance(interpolation, Interpolation)
        interpolation.perform(control)
        if rules.after_motion is not None:
            rules.after_motion(control)

    def _stand_alone(self, codes: Codes) -> None:
        """A motion code without the words of a motion, where its dialect has a rule for that."""
        for _, code in codes:
            mode = code.sets.get("interpolation")
            if isinstance(mode, Interpolation) and mode.without_words is not None:
                mode.without_words(self.control)

    def _refuse_motion(self) -> NoReturn:
        """Words of a motion are in the block, and no motion code is in force."""
        control, known = self.control, self.dialect.words
        word = next(each for each in control.words.values() if each.address in known.motion)
        if word.address not in known.axes:
            message = f"'{word.text}' belongs to a motion, and no motion code is in force"
            control.fail("no-motion-code", message, word, self._meaning_of(word.address))
        message = f"'{word.text}' would move, but no motion code is in force"
        control.fail("no-motion-code", message, word, "write G0, G1, G2 or G3")

    def _refuse_unused(self) -> NoReturn:
        control, meanings = self.control, self.dialect.words.meanings
        word = next(iter(control.words.values()), None) or control.series[0]
        if word.address in meanings:
            message = f"nothing in this block uses '{word.text}'"
            control.fail("unused-word", message, word, self._meaning_of(word.address))
        message = f"'{word.address}' is no word of {self.dialect.name}"
        line = control.report.text_of(control.block.line)
        listed = f"its words are listed by: twin dialects {self.dialect.name}"
        hint = slip_at(line, word.column, self.dialect.name) or listed
        control.fail("unknown-word", message, word, hint)

    def _meaning_of(self, address: str) -> str:
        return f"{address} in {self.dialect.name}: {self.dialect.words.meanings[address]}"
