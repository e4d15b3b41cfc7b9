"""What a control remembers while it runs a program, and how it refuses."""

import dataclasses
import re
from collections.abc import Callable, Mapping, Sequence
from typing import NoReturn, Protocol

from twin.nc.control.modal import ActiveCodes, Modal
from twin.nc.control.program_counter import ProgramCounter
from twin.nc.control.settings import ControlSettings
from twin.nc.control.tools import Tools
from twin.nc.control.variables import Variables
from twin.nc.geometry.frame import Frame
from twin.nc.path.drilling_cycle import START, no_values
from twin.nc.path.move_columns import NAN, Segment
from twin.nc.path.paces import PATH_COUNTS
from twin.nc.path.path import Path
from twin.nc.text.blocks import Block, Statement, Word
from twin.nc.text.lexer import Lexer
from twin.nc.text.reporter import Reporter
from twin.nc.text.source import Source
from twin.nc.text.syntax import Language


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class ControlLanguage(Language):
    """What a control needs to know of a dialect.

    Attributes:
        axis_letters: Addresses that name axes.
        memory: Makes the object that holds what only this dialect remembers.
        is_local: Whether calls with variables of their own have a variable of this name anew.
        given_variable: The value of a variable among those of the job, or None.
    """

    axis_letters: frozenset[str] = frozenset("XYZABCUVW")
    memory: Callable[[], object] = object
    is_local: Callable[[str], bool] = lambda _name: False
    given_variable: Callable[[Mapping[str, float], str], float | None] = lambda given, name: (
        given.get(name)
    )


class HasGroup(Protocol):
    """A code of a block, as far as its modal group."""

    @property
    def group(self) -> str:
        """Its modal group; empty: it is not modal."""
        ...

    @property
    def yields(self) -> bool:
        """Another code of its group in the block takes its place."""
        ...


class ControlState:
    """The state of one control while it runs one program.

    Attributes:
        settings: What it was told of the machine and the job.
        report: Where its diagnostics go.
        modal: What stays in force.
        memory: What only this dialect remembers.
        frame: From programmed to part coordinates.
        programmed: Where it stands, as its screen shows it, shape (k,) [mm or deg].
        part: Where it stands in part coordinates, shape (k,) [mm or deg].
        feed: F as programmed, or None.
        spindle: S as programmed, or None [1/min].
        spindle_turns: M3 or M4 of the program is in force; what a cycle does at a hole ends with the hole.
        tools: The tools in use.
        path: Where moves and events go.
        axis_letters: Addresses that name axes.
        program_counter: Which block comes next.
        variables: What the program computes with.
        cycle_values: What the words of a milling cycle were last, by address.
        cycle_state: What a drilling cycle remembers, as ``drilling_cycle`` counts it.
        block: The block that is being run.
        words: Its words that nothing has taken yet.
        codes: Its G codes.
        series: Its words for switch points, in order.
        acceleration: [mm/s²]; NaN: the machine's.
        deceleration: [mm/s²]; NaN: the machine's.
        rapid_feed: Feed per second of rapids [mm/s]; 0: they follow F; NaN: they have the machine's pace.
        rapid_acceleration: Acceleration of rapids where the program sets their own [mm/s²]; NaN:
            that of the path.
        rapid_deceleration: Deceleration of rapids, likewise [mm/s²].
        axis_limits: Largest velocity of single axes, by column [mm/min or deg/min].
        axis_accelerations: Their largest acceleration [mm/s² or deg/s²].
        axis_decelerations: Their largest deceleration [mm/s² or deg/s²].
        ended: An end code was run.
        feed_rule: Which part of a move F counts.
    """

    def __init__(
        self, language: ControlLanguage, settings: ControlSettings, source: Source, modal: Modal
    ) -> None:
        self.settings = settings
        self.feed_rule = PATH_COUNTS
        self.report = Reporter(source, strict=settings.strict)
        self.axis_index = {name: index for index, name in enumerate(settings.axes.names)}
        self.linear = tuple(kind == "linear" for kind in settings.axes.kinds)
        self.modal = modal
        self.memory = language.memory()
        self.axis_letters = language.axis_letters
        self._axis_columns = {
            name: index for name, index in self.axis_index.items() if name in self.axis_letters
        }
        self._axis_columns |= {
            word: self.axis_index[axis]
            for word, axis in settings.axis_words.items()
            if axis is not None and word in self.axis_letters
        }
        self._axes_that_lack = self.axis_letters - self._axis_columns.keys()
        self.programmed = [settings.start.get(name, 0.0) for name in settings.axes.names]
        self.part = list(self.programmed)
        self.frame = Frame(len(self.part))
        self.feed: float | None = None
        self.spindle: float | None = None
        self.spindle_turns = False
        self.acceleration = self.deceleration = self.rapid_feed = NAN
        self.rapid_acceleration = self.rapid_deceleration = NAN
        self.tools = Tools(settings.tools, any_tool=settings.any_tool)
        self.path = Path(settings.axes, self.part, self._refuse_move, self._warn_of_move)
        lexer = Lexer(language, self.report)
        self.program_counter = ProgramCounter(source, lexer, settings.step_limit, self.report)
        self.variables = Variables(
            language.is_local,
            lambda name: language.given_variable(settings.variables, name),
            vacant=language.syntax.expressions is not None and language.syntax.expressions.vacant,
        )
        self.cycle_values: dict[str, float] = {}
        self.cycle_state = no_values()
        self.block = Block(0, 0)
        self.words: dict[str, Word] = {}
        self.codes: Sequence[tuple[Word, HasGroup]] = ()
        self.series: list[Word] = []
        self.axis_limits: dict[int, float] = {}
        self.axis_accelerations: dict[int, float] = {}
        self.axis_decelerations: dict[int, float] = {}
        self._last: Segment | None = None
        self.ended = False

    @property
    def active(self) -> ActiveCodes:
        """Number of the G code in force in each group."""
        return self.modal.active

    def forget_cycle(self) -> None:
        """No cycle is in force any more, and its words hold no longer."""
        if self.cycle_values or self.cycle_state[START] == self.cycle_state[START]:
            self.cycle_values = {}
            self.cycle_state = no_values()

    def code_word(self, number: float) -> Word | None:
        """Where the block writes a G code, for diagnostics."""
        return next((word for word, _ in self.codes if number_of(word) == number), None)

    def fail(
        self,
        code: str,
        message: str,
        word: Word | Statement | None = None,
        hint: str | None = None,
    ) -> NoReturn:
        """Refuse the block; the caret stands under a word, a statement's keyword or the last code.

        Raises:
            ProgramError: Always.
        """
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

    def _refuse_move(self, move: Segment, code: str, message: str) -> NoReturn:
        self.report.line = move.line
        self.report.fail(code, message, *self._span_of(move))

    def _warn_of_move(self, move: Segment, code: str, message: str) -> None:
        line, self.report.line = self.report.line, move.line
        self.report.warn(code, message, *self._span_of(move))
        self.report.line = line

    def _span_of(self, move: Segment) -> tuple[int, int]:
        """Column and width of a move's block number; without one of the line's first word."""
        text = self.program_counter.lines[move.line - 1]
        number = rf"(?:N|^)[ \t/]*0*{move.block}(?![0-9])" if move.block >= 0 else r"\S+"
        match = re.search(number, text, re.IGNORECASE)
        return (0, 1) if match is None else (match.start(), len(match[0]))


def number_of(word: Word) -> float:
    """The value of a word that has been computed."""
    assert isinstance(word.value, float)
    return word.value


def integer_of(value: float) -> int:
    """A code's number; -1 where it is no whole one."""
    return int(value) if value == int(value) else -1
