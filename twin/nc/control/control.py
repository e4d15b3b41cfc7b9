"""A control as the actions of codes and words see it: the words of its block, its moves, its calls."""

import dataclasses
import functools
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import NoReturn, Protocol

from twin.nc.canonical import Dwell, Function
from twin.nc.control.modal import Modal
from twin.nc.control.motion import MotionState
from twin.nc.control.program_counter import Call, ProgramCounter
from twin.nc.control.settings import ControlSettings
from twin.nc.control.statements import StatementReader
from twin.nc.control.tools import Tools
from twin.nc.control.variables import Variables
from twin.nc.geometry.arcs import Point
from twin.nc.path.feed_rates import PATH_COUNTS, STANDING, WITHOUT_SPEED, FeedRule
from twin.nc.path.moves import axis_target
from twin.nc.text.blocks import Assignment, Block, Location, Statement, Word
from twin.nc.text.diagnostics.reporter import Reporter
from twin.nc.text.expressions.expressions import Expression, ExpressionError
from twin.nc.text.lexer import Lexer
from twin.nc.text.source import Source
from twin.nc.text.syntax import Language
from twin.units import LARGEST_COORDINATE

WITHOUT_POINT = "decimal-point"
"""The warning that a number without a decimal point counts increments."""
MOST_CALLS = 64
"""Parts of a program within each other: more than any control allows."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Rules:
    """What a dialect does besides its codes and words.

    Attributes:
        memory: Makes the object that holds what only this dialect remembers.
        before_motion: Done before every motion block, given whether it is rapid.
        finish: Done when the program ends without an end code.
        jog: A straight move by a distance, as its language writes it.
        read_variable: Value of a variable, given its name and index.
        write_variable: Gives a variable a value, given its name, its index and the assignment; None:
            variables are written as they are named.
        is_local: Whether calls with variables of their own have a variable of this name again.
        given_variable: The value of a variable among those of the job, or None.
        place_switches: Reports the block's switch points, given the length of its move.
        without_point: Addresses whose numbers without a decimal point ``count`` must look at.
        increment: What 1 without a decimal point counts behind an address, in a block of a plain move.
        count: Gives words without a decimal point their value in the units of the others.
        feed_rule: Which part of a move F counts, by the parameters of the control.
        length_by_code: Nothing but a code puts a tool's length into force; else the tool change may.
        acts_on_lines: Something that only this dialect remembers acts on plain lines, so that the kernel
            cannot run them.
    """

    memory: Callable[[], object] = object
    prepare: Callable[["Control"], None] | None = None
    before_motion: Callable[["Control", bool], None] | None = None
    after_motion: Callable[["Control"], None] | None = None
    finish: Callable[["Control"], None] | None = None
    jog: str = "N1 G91 G1 {axis}{distance} F{feed}"
    read_variable: Callable[["Control", str, float | None], float] | None = None
    write_variable: Callable[["Control", str, float | None, float, Assignment], None] | None = None
    is_local: Callable[[str], bool] = lambda _name: False
    given_variable: Callable[[Mapping[str, float], str], float | None] = lambda given, name: (
        given.get(name)
    )
    place_switches: Callable[["Control", float], None] | None = None
    without_point: Callable[[ControlSettings], frozenset[str]] = lambda _settings: frozenset()
    increment: Callable[["Control", str], float] = lambda _control, _address: 1.0
    count: Callable[["Control", Block], Block] = lambda _control, block: block
    feed_rule: Callable[[ControlSettings], FeedRule] = lambda _settings: PATH_COUNTS
    length_by_code: bool = False
    acts_on_lines: Callable[["Control"], bool] = lambda _control: False


class HasGroup(Protocol):
    """A code of a block, as far as its modal group."""

    @property
    def group(self) -> str:
        """Its modal group; empty: it is not modal."""
        ...

    @property
    def weak(self) -> bool:
        """Another code of its group in the block takes its place."""
        ...


class Control:
    """One control while it runs one program.

    Attributes:
        frame: From programmed to part coordinates.
        cycle_values: What the cycle in force remembers, by name.
        words: Its words that nothing has taken yet.
        series: Its words for switch points, in order.
        written_zero: What the program has written first into its table of work offsets, by axis [mm or deg].
        run: Runs one block, also one that is within a statement.
    """

    def __init__(
        self,
        language: Language,
        rules: Rules,
        axis_letters: frozenset[str],
        modal: Modal,
        settings: ControlSettings,
        source: Source,
        run: Callable[[Block], None],
    ) -> None:
        """Stand before the first block; arguments as the attributes."""
        self.settings = settings
        self.report = Reporter(source, strict=settings.strict)
        self.modal = modal
        self.memory = rules.memory()
        self._rules = rules
        feed_rule = rules.feed_rule(settings)
        self.motion = MotionState(settings, modal, self.report, self._refuse_feed, feed_rule)
        if rules.place_switches is not None:
            self.motion.before_move = functools.partial(rules.place_switches, self)
        self.frame = self.motion.frame
        self.path = self.motion.path
        self.tools = Tools(settings.tools, any_tool=settings.any_tool)
        syntax = language.syntax
        self.variables = Variables(
            rules.is_local,
            lambda name: rules.given_variable(settings.variables, name),
            vacant=syntax.expressions is not None and syntax.expressions.vacant,
        )
        lexer = Lexer(language, self.report)
        self.program_counter = ProgramCounter(source, lexer, settings.step_limit, self.report)
        self.statements = StatementReader(source.lines, lexer, self.report)
        self.axis_letters = axis_letters
        self.axis_index = {name: index for index, name in enumerate(settings.axes.names)}
        columns = {**self.axis_index}
        columns |= {
            word: self.axis_index[axis]
            for word, axis in settings.axis_words.items()
            if axis is not None
        }
        self._columns = {word: columns[word] for word in columns if word in axis_letters}
        self._axes_that_lack = axis_letters - self._columns.keys()
        self.cycle_values: dict[str, float] = {}
        self.block = Block(0, 0)
        self.words: dict[str, Word] = {}
        self.codes: Sequence[tuple[Word, HasGroup]] = ()
        self.series: list[Word] = []
        self.written_zero: dict[str, float] = {}
        self.run = run
        self.ended = False

    # --- what is wrong

    def fail(
        self,
        code: str,
        message: str,
        word: Word | Statement | None = None,
        hint: str | None = None,
    ) -> NoReturn:
        """Refuse the block; the caret is under a word, a statement's keyword or the last code."""
        self.report.fail(code, message, *self.span_of(word), hint)

    def warn(
        self, code: str, message: str, word: Word | None = None, hint: str | None = None
    ) -> None:
        """Warn; with ``strict``, refuse."""
        self.report.warn(code, message, *self.span_of(word), hint)

    def span_of(self, word: Word | Statement | None) -> tuple[int, int]:
        """Column and width of a word or a statement's keyword; of None of the block's last code or first word."""
        if isinstance(word, Statement):
            return word.column, len(word.keyword)
        if word is None and self.codes:
            word = self.codes[-1][0]
        if word is None and self.block.words:
            word = self.block.words[0]
        return (0, 1) if word is None else (word.column, word.width)

    def code_word(self, number: float) -> Word | None:
        """Where the block writes a G code, for diagnostics."""
        return next((word for word, _ in self.codes if number_of(word) == number), None)

    def _refuse_feed(self, finding: int) -> None:
        """Report what is wrong with the feed rate of a move."""
        if finding == WITHOUT_SPEED:
            self.fail("feed-per-revolution", "a feed per revolution needs a spindle speed S")
        if finding == STANDING:
            message = "a feed per revolution never moves while the spindle stands"
            self.fail("feed-per-revolution", message, hint="start it by M3 or M4 before")
        self.report.warn_once(
            "no-feed",
            "no feed is programmed: the machine's default is used",
            *self.span_of(None),
            hint="write F in the first block that needs it",
        )

    # --- the words of the block

    def take(self, address: str) -> Word | None:
        """Take a word from the block; None where it has none."""
        return self.words.pop(address, None)

    def number(self, word: Word | None) -> float:
        """The value of a word that has been computed; 0 where there is none."""
        return 0.0 if word is None else number_of(word)

    def value(self, word: Word) -> float:
        """The value of a word, which may have to be computed."""
        value = word.value
        return self.compute(value, word) if isinstance(value, Expression) else value

    def length(self, word: Word | None) -> float:
        """The value of a word that counts a length [mm]; 0 where there is none."""
        return 0.0 if word is None else number_of(word) * self.modal.unit

    def axis_value(self, index: int, word: Word) -> float:
        """Value of an axis word [mm or deg]."""
        return number_of(word) * self.motion.unit_of(index)

    def take_axis_words(self) -> list[tuple[int, Word]]:
        """Take the words that name axes; pairs of column and word."""
        words, columns = self.words, self._columns
        if not self._axes_that_lack.isdisjoint(words):
            for name in [each for each in words if each in self._axes_that_lack]:
                word = words.pop(name)
                if name not in self.settings.axis_words or number_of(word) != 0.0:
                    refuse_axis(self, word)
        found: list[tuple[int, Word]] = []
        for each in tuple(words):
            if each in columns:
                found.append((columns[each], words.pop(each)))  # noqa: PERF401 (a call less)
        return found

    def target(self) -> list[float]:
        """Take the axis words; the programmed position that they ask for, shape (k,)."""
        target, linear = list(self.motion.programmed), self.motion.linear
        unit, relative = self.modal.unit, self.modal.incremental
        for index, word in self.take_axis_words():
            written = word.value
            assert isinstance(written, float)
            counts = word.incremental or (relative and not word.mark)
            value = axis_target(written, unit, linear[index], counts, target[index])
            if not -LARGEST_COORDINATE <= value <= LARGEST_COORDINATE:
                self.fail("number-range", f"{word.text} is farther than any machine reaches", word)
            target[index] = value
        return target

    def compute(self, expression: Expression, at: Word | int) -> float:
        """Compute an expression; errors point at a word, or at the column where the expression stands."""
        try:
            return expression.compute(self)
        except ExpressionError as error:
            span = (at, len(expression.text)) if isinstance(at, int) else self.span_of(at)
            self.report.fail(error.code, str(error), *span, error.hint)

    def read_variable(self, name: str, index: float | None) -> float:
        """Value of a variable of the program, for expressions."""
        if self._rules.read_variable is None:
            raise ExpressionError("unknown-variable", f"there is no variable {name}")
        return self._rules.read_variable(self, name, index)

    # --- moves and events

    def line_to(self, target: list[float], *, rapid: bool) -> None:
        """Move straight to a programmed position; nothing when it is there already."""
        self.motion.move_to(target, self.block, rapid=rapid)

    def arc_to(self, target: list[float], center: Point, sweep: float) -> None:
        """Move on an arc about the plane's normal; centre and sweep as for ``MotionState.arc``."""
        self.motion.move_to(target, self.block, arc=self.motion.arc(center, sweep))

    def dwell(self, seconds: float) -> None:
        """Wait."""
        self.path.event(Dwell(0, self.block.line, seconds))

    def function(self, word: str, arguments: Mapping[str, float], at: float = 0.0) -> None:
        """Report a function at this place of the path."""
        self.path.event(Function(0, self.block.line, word, dict(arguments), at))

    def forget_cycle(self) -> None:
        """No cycle is in force any more, and its words hold no longer."""
        self.cycle_values = {}

    # --- jumps and calls

    def jump(self, location: Location) -> None:
        """Let the program go on at a location."""
        self.program_counter.go(location)
        if self.modal.cycle is None:
            self.forget_cycle()

    def call(
        self,
        first: Location,
        deepest: int,
        error_at: Word | Statement,
        values: Iterable[tuple[str, float]] | None = None,
        *,
        restores: bool = False,
        times: float = 1.0,
        last: Location | None = None,
    ) -> None:
        """Run the part that begins at a location and ends by a word, or behind a location.

        Args:
            deepest: Parts that may call each other.
            values: Of its own variables by name; None: it has the caller's.
            restores: Its end puts back into force what is in force now.
            last: Its last block; None: a word ends it.

        Raises:
            ProgramError: Too many parts call each other, or the number of runs is none.
        """
        counter = self.program_counter
        if counter.depth >= min(deepest, MOST_CALLS):
            self.fail("call-depth", f"more than {deepest} calls within calls", error_at)
        if not times >= 1.0 or times != math.floor(times):
            self.fail("repeat-range", "the range or the number of runs is none", error_at)
        call = Call(counter.location, first, int(times) - 1, last)
        counter.calls.append(call)
        self.jump(first)
        if restores:
            call.restores = self.modal.fork()
        if values is not None:
            call.owns_variables = True
            self.variables.enter()
            for name, value in values:
                self.variables.write(name, value)

    def require_caller(self, error_at: Word | Statement | None = None) -> None:
        """A part must be being run that a word ends."""
        if all(call.last is not None for call in self.program_counter.calls):
            self.fail("return-outside", "there is no subroutine to return from", error_at)

    def go_back(self, error_at: Word | Statement | None = None) -> None:
        """The end of a subroutine: back behind its call, or to its beginning again."""
        self.require_caller(error_at)
        ended = self.program_counter.end_call()
        if ended is not None:
            if ended.owns_variables:
                self.variables.leave()
            if ended.restores is not None:
                self.modal.restore(ended.restores)
        if self.modal.cycle is None:
            self.forget_cycle()


def number_of(word: Word) -> float:
    """The value of a word that has been computed."""
    assert isinstance(word.value, float)
    return word.value


def integer_of(value: float) -> int:
    """A code's number; -1 where it is no whole one."""
    return int(value) if value == int(value) else -1


def refuse_axis(control: Control, word: Word) -> NoReturn:
    """The machine lacks the axis that a word names."""
    axes = control.settings.axes
    rotary = next(
        (name for name, line in zip(axes.names, control.motion.linear, strict=True) if not line), ""
    )
    stands = f'; {word.address} = "{rotary}" where it means {rotary}' if rotary else ""
    listed, ignored = ", ".join(axes.names), f'{word.address} = "ignored at 0"'
    hint = f"axes: {listed}; in the job: [axes] {ignored}{stands}; machines with others: twin machine list"
    control.fail("no-such-axis", f"this machine has no axis {word.address}", word, hint)
