"""The control that every dialect shares: it runs blocks, keeps what is modal, and moves.

A block takes effect in a fixed order: modal codes by group, set-up actions, modal words (F, S, T),
early M functions, the motion or what stands in its place, late M functions, jumps. Every word must
be used by something; a word that nothing wants is an error, because ignoring it would be a guess.
"""

import dataclasses
import math
from collections.abc import Mapping
from typing import NoReturn

from twin.nc.blocks import Block, Statement, Word
from twin.nc.canonical import Corner, Motion
from twin.nc.dialect import Dialect, FeedMode, GCode, MCode, Modal
from twin.nc.expressions import Expression, ExpressionError
from twin.nc.flow import Flow
from twin.nc.frame import Frame
from twin.nc.lexer import Lexer
from twin.nc.move_columns import NAN, Segment
from twin.nc.path import Path
from twin.nc.planes import Plane, Vector, cross
from twin.nc.reporter import Reporter
from twin.nc.settings import ControlSettings
from twin.nc.source import Source
from twin.nc.tools import Tools

_LARGEST_COORDINATE = 1e7
"""Ten kilometres, or 27 thousand turns: beyond it a coordinate is a slip of the pen."""


class Control:
    """The state of one control while it runs one program.

    Attributes:
        dialect: The language it reads.
        settings: What it was told of the machine and the job.
        report: Where its diagnostics go.
        modal: What stays in force.
        active: Number of the G code in force in each group.
        memory: What only this dialect remembers.
        frame: From programmed to part coordinates.
        programmed: Where it stands, as its screen shows it, shape (k,) [mm or deg].
        part: Where it stands in part coordinates, shape (k,) [mm or deg].
        feed: F as programmed, or None.
        spindle: S as programmed, or None [1/min].
        tools: The tools in use.
        path: Where moves and events go.
        flow: Which block comes next.
        cycle_values: What the words of a canned cycle were last, by address.
        block: The block that is being run.
        words: Its words that nothing has taken yet.
        codes: Its G codes.
        series: Its words for switch points, in order.
        rapid_feed: Feed of rapids where the program limits it [mm/min]; NaN: the machine's.
        axis_limits: Largest velocity of single axes, by column [mm/min or deg/min].
        axis_accelerations: Their largest acceleration [mm/s² or deg/s²].
        ended: An end code was run.
    """

    def __init__(self, dialect: Dialect, settings: ControlSettings, source: Source) -> None:
        self.dialect = dialect
        self.settings = settings
        self.report = Reporter(source, strict=settings.strict)
        self.axis_index = {name: index for index, name in enumerate(settings.axes.names)}
        self.linear = tuple(kind == "linear" for kind in settings.axes.kinds)
        self.modal = Modal()
        for name, value in dialect.start_state.items():
            setattr(self.modal, name, value)
        self.active: dict[str, int] = {}
        self.memory = dialect.memory()
        self.frame = Frame(len(settings.axes))
        self.programmed = [settings.start.get(name, 0.0) for name in settings.axes.names]
        self.part = list(self.programmed)
        self.feed: float | None = None
        self.spindle: float | None = None
        self.acceleration = NAN
        self.deceleration = NAN
        self.tools = Tools(settings.tools)
        self.path = Path(settings.axes, self.part, self._refuse_move)
        self.flow = Flow(source, Lexer(dialect, self.report), settings.step_limit, self.report)
        self.cycle_values: dict[str, float] = {}
        self.block = Block(0, 0)
        self.words: dict[str, Word] = {}
        self.codes: list[tuple[Word, GCode]] = []
        self.series: list[Word] = []
        self.rapid_feed = NAN
        self.axis_limits: dict[int, float] = {}
        self.axis_accelerations: dict[int, float] = {}
        self.ended = False
        for number in dialect.start:
            self._set(number, dialect.g[number])

    # --- running a block

    def run(self, block: Block) -> None:
        """Run one block.

        Raises:
            ProgramError: It is wrong.
        """
        self.block = block
        self.report.line = block.line
        if block.skippable and self.settings.block_skip:
            return
        if block.statement is not None:
            self._run_statement(block.statement)
            return
        functions = self._sort_words(block)
        codes = self.codes
        restore = self._put_into_force()
        for _, code in codes:
            if code.action is not None:
                code.action(self)
        instead = next((code for _, code in codes if code.perform is not None), None)
        self._run_modal_words("" if instead is None else instead.takes)
        for word, function in functions:
            if not function.late:
                self._run_function(word, function)
        if instead is not None and instead.perform is not None:
            instead.perform(self)
        else:
            self._move()
        for _, code in codes:
            if code.after is not None:
                code.after(self)
        for word, function in functions:
            if function.late:
                self._run_function(word, function)
        if self.words or self.series:
            self._refuse_unused()
        for name, value in restore:
            setattr(self.modal, name, value)

    def prepare(self) -> None:
        """The program begins."""
        if self.dialect.prepare is not None:
            self.dialect.prepare(self)

    def _run_statement(self, statement: Statement) -> None:
        self.words, self.codes = {}, []
        action = self.dialect.statements.get(statement.keyword, self.dialect.other_statement)
        assert action is not None
        action(self, statement)

    def finish(self) -> None:
        """The program has ended, by an end code or by its last line."""
        if not self.ended and self.dialect.finish is not None:
            self.dialect.finish(self)
        self.path.end_compensation()

    def _put_into_force(self) -> list[tuple[str, object]]:
        """Apply the block's codes; what those for this block only have replaced."""
        restore: list[tuple[str, object]] = []
        for word, code in self.codes:
            if code.once:
                restore += [(name, getattr(self.modal, name)) for name in code.sets]
            if code.alone and len(self.block.words) > 1:
                self.fail("alone", f"{word.text} must stand alone in its block", word)
            self._set(int(_number(word)), code)
        return restore

    def _sort_words(self, block: Block) -> list[tuple[Word, MCode]]:
        self.codes = []
        self.words = {}
        self.series = []
        functions: list[tuple[Word, MCode]] = []
        for word in block.words:
            if isinstance(word.value, Expression) and word.address not in self.dialect.references:
                word = word._replace(value=self.evaluate(word.value, word))
            if word.address in self.dialect.signed and _number(word) < 0.0:
                word = word._replace(address=f"{word.address}-")
            if word.address == "G":
                self.codes.append((word, self._g_code(word)))
            elif word.address == "M":
                functions.append((word, self._m_code(word)))
            elif word.address in self.dialect.series and self._has_switch(block):
                self.series.append(word)
            elif word.address in self.words:
                self.fail("duplicate-word", f"'{word.address}' stands twice in the block", word)
            else:
                self.words[word.address] = word
        if len(self.codes) > 1:
            self._check_groups()
        return functions

    def _has_switch(self, block: Block) -> bool:
        return any(word.address == self.dialect.series[0] for word in block.words)

    def _g_code(self, word: Word) -> GCode:
        code = self.dialect.g.get(_integer(_number(word)))
        if code is None:
            self.fail(
                "unknown-g",
                f"{word.text} is unknown to {self.dialect.name}",
                word,
                hint=f"known: {', '.join(f'G{number}' for number in sorted(self.dialect.g))}",
            )
        if code.refused:
            self.fail("unsupported-g", f"{word.text} ({code.meaning}): {code.refused}", word)
        return code

    def _m_code(self, word: Word) -> MCode:
        number = _integer(_number(word))
        code = self.dialect.m.get(number)
        if code is None and self.dialect.any_m and number >= 0:
            return MCode(meaning="machine function")
        if code is None:
            self.fail(
                "unknown-m",
                f"{word.text} is unknown to {self.dialect.name}",
                word,
                hint=f"known: {', '.join(f'M{number}' for number in sorted(self.dialect.m))}",
            )
        return code

    def _check_groups(self) -> None:
        seen: dict[str, Word] = {}
        performing: Word | None = None
        for word, code in self.codes:
            if code.group and code.group in seen:
                other = seen[code.group]
                self.fail(
                    "conflicting-codes",
                    f"{other.text} and {word.text} exclude each other ({code.group})",
                    word,
                    hint="write them in two blocks",
                )
            seen[code.group] = word
            if code.perform is not None:
                if performing is not None:
                    message = f"{performing.text} and {word.text} cannot share a block"
                    self.fail("conflicting-codes", message, word, hint="write them in two blocks")
                performing = word
        order = {group: rank for rank, group in enumerate(self.dialect.groups)}
        self.codes.sort(key=lambda pair: order.get(pair[1].group, len(order)))

    def _set(self, number: int, code: GCode) -> None:
        for name, value in code.sets.items():
            setattr(self.modal, name, value)
        if code.group:
            self.active[code.group] = number

    def set_code(self, number: int) -> None:
        """Put a G code into force as if the program had written it."""
        self._set(number, self.dialect.g[number])

    def _run_modal_words(self, reserved: str) -> None:
        words = self.words
        for address, action in self.dialect.words.items():
            if address in words and address not in reserved:
                action(self, words.pop(address))

    def _run_function(self, word: Word, code: MCode) -> None:
        if code.action is not None:
            code.action(self)
        arguments = self.take_function_arguments(word)
        self.function(f"M{_integer(_number(word))}", arguments)
        if code.ends:
            self.ended = True

    def take_function_arguments(self, word: Word) -> dict[str, float]:
        """What belongs to an M function: its own words, and for a spindle start the speed."""
        arguments = {
            address: self.take_computed(address)
            for address in self.dialect.function_letters
            if address in self.words
        }
        if _integer(_number(word)) in (3, 4) and self.spindle is not None:
            arguments["S"] = self.spindle
        return arguments

    def _move(self) -> None:
        words = self.words
        if not words or not any(address in self.dialect.motion_words for address in words):
            return
        interpolation = self.modal.cycle or self.modal.interpolation
        if interpolation is None:
            word = next(iter(words.values()))
            self.fail(
                "no-motion-code",
                f"'{word.text}' would move, but no motion code is in force",
                word,
                hint="write G0, G1, G2 or G3",
            )
        if self.dialect.before_motion is not None:
            self.dialect.before_motion(self, interpolation.rapid)
        interpolation.perform(self)

    def _refuse_unused(self) -> NoReturn:
        word = next(iter(self.words.values()), None) or self.series[0]
        if word.address in self.dialect.word_meanings:
            message = f"nothing in this block uses '{word.text}'"
        else:
            message = f"'{word.address}' is no word of {self.dialect.name}"
        known = ", ".join(self.dialect.word_meanings)
        code = "unused-word" if word.address in self.dialect.word_meanings else "unknown-word"
        self.fail(code, message, word, hint=f"words of {self.dialect.name}: {known}")

    def saved_modal(self) -> tuple[Modal, dict[str, int]]:
        """What is in force, to be restored later."""
        return dataclasses.replace(self.modal), dict(self.active)

    def restore_modal(self, saved: tuple[Modal, dict[str, int]]) -> None:
        """Put back what ``saved_modal`` gave."""
        self.modal, self.active = saved

    def code_word(self, number: int) -> Word | None:
        """Where the block writes a G code, for diagnostics."""
        return next((word for word, _ in self.codes if _number(word) == number), None)

    # --- taking words

    def take(self, address: str) -> Word | None:
        """Take a word from the block; None where it has none."""
        return self.words.pop(address, None)

    def take_number(self, address: str, default: float = 0.0) -> float:
        """Take the value of a word from the block."""
        word = self.words.pop(address, None)
        return default if word is None else _number(word)

    def take_computed(self, address: str) -> float:
        """Take the value of a word that may be a reference to a variable."""
        word = self.words.pop(address)
        if isinstance(word.value, Expression):
            return self.evaluate(word.value, word)
        return word.value

    def number(self, word: Word) -> float:
        """The value of a word."""
        return _number(word)

    def length(self, word: Word | None) -> float:
        """The value of a word that counts a length [mm]; 0 where there is none."""
        return 0.0 if word is None else _number(word) * self.modal.unit

    def take_axis_words(self) -> list[tuple[int, Word]]:
        """Take the words that name axes; pairs of column and word.

        Raises:
            ProgramError: The machine lacks an axis.
        """
        taken = []
        for address in [a for a in self.words if a in self.dialect.axis_letters]:
            word = self.words.pop(address)
            index = self.axis_index.get(address)
            if index is None:
                self.refuse_axis(word)
            taken.append((index, word))
        return taken

    def refuse_axis(self, word: Word) -> NoReturn:
        """The machine lacks the axis that the word names."""
        names = ", ".join(self.settings.axes.names)
        self.fail(
            "no-such-axis", f"this machine has no axis {word.address}", word, f"axes: {names}"
        )

    def axis_value(self, index: int, word: Word) -> float:
        """Value of an axis word [mm or deg]."""
        return _number(word) * (self.modal.unit if self.linear[index] else 1.0)

    def evaluate(self, expression: Expression, word: Word) -> float:
        """Compute an expression; errors point at the word."""
        try:
            return float(expression.evaluate(self))
        except ExpressionError as error:
            self.fail(error.code, str(error), word, hint=error.hint)

    def expression(self, text: str, column: int) -> Expression:
        """Read a text that must be one expression."""
        (only,) = self.expressions(text, column, 1)
        return only

    def expressions(self, text: str, column: int, count: int | None = None) -> list[Expression]:
        """Read a text that must be expressions separated by commas."""
        if not text.strip() and not count:
            return []
        try:
            found, end = self.flow.lexer.expressions.read_list(text, 0)
        except ExpressionError as error:
            at = column + (error.column or 0)
            self.report.fail(error.code, str(error), at, 1, error.hint)
        if text[end:].strip() or (count is not None and len(found) != count):
            wanted = "values" if count is None else f"{count} value" + "s" * (count > 1)
            self.report.fail("expression", f"{wanted} must stand here and no more", column + end)
        return found

    def compute(self, expression: Expression, column: int) -> float:
        """Compute an expression of a statement; errors point at its column."""
        try:
            return float(expression.evaluate(self))
        except ExpressionError as error:
            self.report.fail(error.code, str(error), column, len(expression.text), error.hint)

    def read_variable(self, name: str, index: float | None) -> float:
        """Value of a variable of the program, for expressions."""
        if self.dialect.read_variable is None:
            raise ExpressionError("unknown-variable", f"there is no variable {name}")
        return self.dialect.read_variable(self, name, index)

    # --- moving

    def target(self) -> list[float]:
        """Take the axis words; the programmed position that they ask for, shape (k,)."""
        target = list(self.programmed)
        for index, word in self.take_axis_words():
            value = self.axis_value(index, word)
            if self.modal.incremental or word.incremental:
                value += target[index]
            if not abs(value) <= _LARGEST_COORDINATE:
                self.fail("number-range", f"{word.text} is farther than any machine reaches", word)
            target[index] = value
        return target

    def line_to(self, target: list[float], *, rapid: bool) -> None:
        """Move straight to a programmed position; nothing when it stands there already."""
        self._add(target, rapid=rapid)

    def arc_to(self, target: list[float], center: Vector, sweep: float) -> None:
        """Move on an arc about the plane's normal.

        Args:
            target: Programmed position of its end, shape (k,).
            center: Programmed centre at the height of the start [mm].
            sweep: Signed angle with all turns [deg].
        """
        normal, sweep = self.frame.arc(self.modal.plane.normal, sweep)
        self._add(target, rapid=False, center=self.frame.point(center), normal=normal, sweep=sweep)

    def _add(
        self,
        target: list[float],
        *,
        rapid: bool,
        center: Vector | None = None,
        normal: Vector = (NAN, NAN, NAN),
        sweep: float = 0.0,
    ) -> None:
        end = self.frame.to_part(target)
        if center is None and end == self.part:
            self.programmed = target
            return
        modal = self.modal
        is_arc = center is not None
        if self.series and self.dialect.place_switches is not None:
            self.dialect.place_switches(self, self._length(end, center, normal, sweep))
        feed = self.rapid_feed if rapid else self._feed_per_minute(end, is_arc)
        acceleration, deceleration = self.acceleration, self.deceleration
        if self.axis_limits or self.axis_accelerations:
            length = self._length(end, center, normal, sweep)
            share = self._axis_shares(end, length, is_arc)
            feed = _limited(feed, self.axis_limits, share)
            acceleration = _limited(acceleration, self.axis_accelerations, share)
            deceleration = _limited(deceleration, self.axis_accelerations, share)
        self.path.add(
            Segment(
                motion=Motion.RAPID if rapid else Motion.FEED,
                line=self.block.line,
                block=self.block.number,
                start=self.part,
                end=end,
                display=target,
                feed=feed,
                corner=Corner.EXACT_STOP if rapid else modal.corner,
                corner_tolerance=modal.corner_tolerance,
                acceleration=acceleration,
                deceleration=deceleration,
                center=center,
                normal=normal,
                sweep=sweep,
            )
        )
        self.programmed = target
        self.part = end

    def _length(
        self, end: list[float], center: Vector | None, normal: Vector, sweep: float
    ) -> float:
        """What the feed counts, by the convention of ``canonical`` [mm or deg]."""
        start = self.part
        if center is not None:
            radius = math.dist(start[:3], center)
            advance = sum((end[i] - start[i]) * normal[i] for i in range(3))
            return math.hypot(radius * math.radians(sweep), advance)
        spatial = math.dist(start[:3], end[:3])
        return spatial or math.dist(start[3:], end[3:])

    def _axis_shares(self, end: list[float], length: float, is_arc: bool) -> list[float]:
        """How much of the path's speed each axis takes at most."""
        shares = [abs(new - old) / length for new, old in zip(end, self.part, strict=True)]
        return [1.0, 1.0, 1.0, *shares[3:]] if is_arc else shares

    def _feed_per_minute(self, end: list[float], is_arc: bool) -> float:
        turning = not is_arc and all(
            new == old or not linear
            for new, old, linear in zip(end, self.part, self.linear, strict=True)
        )
        if self.feed is None:
            self.report.warn_once(
                "no-feed",
                "no feed is programmed: the machine's default is used",
                hint="write F in the first block that needs it",
            )
            settings = self.settings
            return settings.default_rotary_feed if turning else settings.default_feed
        feed = self.feed if turning else self.feed * self.modal.unit
        mode = self.modal.feed_mode
        if mode is FeedMode.PER_MINUTE:
            return feed
        if mode is FeedMode.PER_SECOND:
            return feed * 60.0
        if not self.spindle:
            self.fail("feed-per-revolution", "a feed per revolution needs a spindle speed S")
        return feed * self.spindle

    def dwell(self, seconds: float) -> None:
        """Wait."""
        line = self.block.line
        self.path.event(lambda columns: columns.dwell(line, seconds))

    def function(self, word: str, arguments: Mapping[str, float], at: float = 0.0) -> None:
        """Report a function at this place of the path."""
        line, given = self.block.line, dict(arguments)
        self.path.event(lambda columns: columns.function(line, word, given, at))

    def part_plane(self) -> Plane:
        """The working plane as the part sees it."""
        plane, frame = self.modal.plane, self.frame
        if frame.plain:
            return plane
        normal, _ = frame.arc(plane.normal, 0.0)
        abscissa, _ = frame.arc(plane.abscissa, 0.0)
        return Plane(plane.name, abscissa, cross(normal, abscissa), normal)

    def _refuse_move(self, move: Segment, code: str, message: str) -> NoReturn:
        self.report.line = move.line
        self.report.fail(code, message)

    # --- labels of the screen

    def relabel(self, programmed: list[float], shift: str) -> None:
        """Give the place where it stands other programmed coordinates; nothing moves."""
        here = self.frame.to_part(programmed)
        values = self.frame.shift(shift)
        moved = [
            value + part - other for value, part, other in zip(values, self.part, here, strict=True)
        ]
        self.frame.set_shift(shift, moved)
        self.programmed = programmed

    def reframed(self) -> None:
        """The frame has changed: see where it stands now."""
        self.programmed = self.frame.to_programmed(self.part)

    # --- diagnostics

    def fail(
        self, code: str, message: str, word: Word | None = None, hint: str | None = None
    ) -> NoReturn:
        """Refuse the block.

        Raises:
            ProgramError: Always.
        """
        self.report.fail(code, message, *self._blamed(word), hint)

    def warn(
        self, code: str, message: str, word: Word | None = None, hint: str | None = None
    ) -> None:
        """Warn; with ``strict``, refuse."""
        self.report.warn(code, message, *self._blamed(word), hint)

    def _blamed(self, word: Word | None) -> tuple[int, int]:
        """Column and width of a word; without one of the block's last code or first word."""
        if word is None and self.codes:
            word = self.codes[-1][0]
        if word is None and self.block.words:
            word = self.block.words[0]
        return (0, 1) if word is None else (word.column, word.width)


def _limited(value: float, limits: Mapping[int, float], shares: list[float]) -> float:
    """A value along the path so that no axis exceeds its own limit; NaN is no limit."""
    bounds = [limit / shares[index] for index, limit in limits.items() if shares[index] > 0.0]
    return min([value, *bounds]) if value == value else min(bounds, default=value)


def _number(word: Word) -> float:
    assert isinstance(word.value, float)
    return word.value


def _integer(value: float) -> int:
    return int(value) if value == int(value) else -1
