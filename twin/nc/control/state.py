"""What a control remembers while it runs a program, and how it refuses."""

import dataclasses
import math
import re
from collections.abc import Callable, Mapping, Sequence
from typing import NoReturn, Protocol

import numpy as np

from twin.nc.bytecode.frames import MOST_CALLS
from twin.nc.bytecode.registers import (
    ACCELERATION,
    CYCLE_STATE,
    CYCLE_WORDS,
    DECELERATION,
    MATRIX,
    MOST_EVENTS,
    PROGRAMMED_FEED,
    RAPID_FEED,
    REGISTERS,
    SPINDLE,
    SPINDLE_TURNS,
    TURNED,
    Constants,
    cells,
    new_state,
)
from twin.nc.bytecode.variables import Variables
from twin.nc.control.modal import Modal
from twin.nc.control.program_counter import ProgramCounter
from twin.nc.control.settings import ControlSettings, ToolData
from twin.nc.control.tools import Tools
from twin.nc.geometry.frame import Frame
from twin.nc.geometry.planes import PLANE_ORDER
from twin.nc.path.drilling_cycle import START, forget
from twin.nc.path.hole import MOST_STOPS, most_acts
from twin.nc.path.move_columns import NAN, Segment
from twin.nc.path.paces import PATH_COUNTS
from twin.nc.path.path import Path
from twin.nc.path.rows import new_rows
from twin.nc.text.blocks import Block, Word
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
        registers: Names of registers of its own, for the instructions of its codes, and what they begin
            with.
        is_local: Whether calls with variables of their own have a variable of this name anew.
        given_variable: The value of a variable among those of the job, or None.
    """

    axis_letters: frozenset[str] = frozenset("XYZABCUVW")
    memory: Callable[[], object] = object
    registers: Mapping[str, float] = dataclasses.field(default_factory=dict)
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


class Register:
    """A register of a control; NaN: none."""

    def __init__(self, place: int) -> None:
        self._place = place

    def __get__(self, control: "ControlState", _kind: type) -> float:
        return control.registers[self._place]

    def __set__(self, control: "ControlState", value: float) -> None:
        control.registers[self._place] = value


class ControlState:
    """The state of one control while it runs one program.

    Attributes:
        settings: What it was told of the machine and the job.
        report: Where its diagnostics go.
        modal: What stays in force.
        active: Number of the G code in force in each group, a part of that.
        memory: What only this dialect remembers.
        state: What both tiers remember, as columns.
        registers: Those of its registers, one by one.
        constants: What stays, for both tiers.
        frame: From programmed to part coordinates, on the columns of the state.
        programmed: Where it stands, as its screen shows it, shape (k,) [mm or deg]; a list, which the columns
            get for a run or an instruction: to work on columns costs a plain block 8 % of its time here.
        part: Where it stands in part coordinates, likewise, shape (k,) [mm or deg].
        tools: The tools in use.
        path: Where moves and events go.
        axis_letters: Addresses that name axes.
        program_counter: Which block comes next.
        modal_of_calls: What was in force when each part was called, shape (``MOST_CALLS``, m).
        variables: What the program computes with.
        cycle_values: What the words of a milling cycle were last, by address.
        cycle_state: What a drilling cycle remembers, as ``drilling_cycle`` counts it.
        block: The block that is being run.
        words: Its words that nothing has taken yet.
        codes: Its G codes.
        series: Its words for switch points, in order.
        rapid_acceleration: Acceleration of rapids where the program sets their own [mm/s²]; NaN:
            that of the path.
        rapid_deceleration: Deceleration of rapids, likewise [mm/s²].
        interpreted_functions: M codes that only the interpreter tier may run: those that wait.
        axis_limits: Largest velocity of single axes, by column [mm/min or deg/min].
        axis_accelerations: Their largest acceleration [mm/s² or deg/s²].
        axis_decelerations: Their largest deceleration [mm/s² or deg/s²].
        ended: An end code was run.
        feed_rule: Which part of a move F counts.
    """

    acceleration = Register(ACCELERATION)
    """[mm/s²]; NaN: the machine's."""
    deceleration = Register(DECELERATION)
    """[mm/s²]; NaN: the machine's."""
    rapid_feed = Register(RAPID_FEED)
    """Feed per second of rapids [mm/s]; 0: they follow F; NaN: they have the machine's pace."""

    def __init__(
        self, language: ControlLanguage, settings: ControlSettings, source: Source, modal: Modal
    ) -> None:
        self.settings = settings
        self.feed_rule = PATH_COUNTS
        self.report = Reporter(source, strict=settings.strict)
        self.axis_index = {name: index for index, name in enumerate(settings.axes.names)}
        self.linear = tuple(kind == "linear" for kind in settings.axes.kinds)
        self.modal, self.active = modal, modal.active
        self.memory = language.memory()
        self.axis_letters = language.axis_letters
        self._axis_columns = {
            name: index for name, index in self.axis_index.items() if name in self.axis_letters
        }
        self._axes_that_lack = self.axis_letters - self.axis_index.keys()
        self.programmed = [settings.start.get(name, 0.0) for name in settings.axes.names]
        self.part = list(self.programmed)
        self._own_registers = {name: REGISTERS + at for at, name in enumerate(language.registers)}
        self.state = new_state(self.programmed, modal.column, language.registers.values())
        columns = self.state.registers
        self.registers = cells(columns)
        self.frame = Frame(
            self.state.shifts,
            self.state.total,
            columns[MATRIX:REGISTERS],
            columns[TURNED : TURNED + 1],
        )
        self.rapid_acceleration = NAN
        self.rapid_deceleration = NAN
        self.tools = Tools(settings.tools, self.registers, any_tool=settings.any_tool)
        self.constants = self._new_constants()
        self._event_room = new_rows(0, MOST_EVENTS, len(self.linear))
        self.path = Path(settings.axes, self.part, self._refuse_move, self._warn_of_move)
        lexer = Lexer(language, self.report)
        self.program_counter = ProgramCounter(source, lexer, settings.step_limit, self.report)
        self.modal_of_calls = np.zeros((MOST_CALLS, len(modal.column)))
        self.variables = Variables(
            language.is_local,
            lambda name: language.given_variable(settings.variables, name),
            self.program_counter.progress,
            vacant=language.syntax.expressions is not None and language.syntax.expressions.vacant,
        )
        self.cycle_values: dict[str, float] = {}
        self.cycle_state = self.registers[CYCLE_STATE:CYCLE_WORDS]
        self.block = Block(0, 0)
        self.words: dict[str, Word] = {}
        self.codes: Sequence[tuple[Word, HasGroup]] = ()
        self.series: list[Word] = []
        self.interpreted_functions = frozenset(
            number for number, each in settings.m_functions.items() if each.dwell > 0.0
        )
        self.axis_limits: dict[int, float] = {}
        self.axis_accelerations: dict[int, float] = {}
        self.axis_decelerations: dict[int, float] = {}
        self._last: Segment | None = None
        self.ended = False

    def _new_constants(self) -> Constants:
        """What stays as it is; a run of the compiled tier puts in what is in force then."""
        settings, tools, axes = self.settings, self.tools, len(self.linear)
        other = ToolData(NAN, 0.0) if tools.any is None else tools.any
        longer = [tools.longer(tool) for tool in tools.table.values()]
        return Constants(
            default_feed=settings.default_feed,
            default_rotary_feed=settings.default_rotary_feed,
            feed_may_lack=False,
            linear=np.array(self.linear),
            planes=np.array([plane.axes for plane in PLANE_ORDER]),
            directions=np.array([plane.directions for plane in PLANE_ORDER]),
            tools=np.array([float(number) for number in tools.table]),
            longer=np.array([*longer, 0.0]),
            radii=np.array([tool.radius for tool in (*tools.table.values(), other)]),
            over=np.zeros(axes),
            room=np.zeros((3, axes)),
            hole=np.zeros((4, most_acts(MOST_STOPS))),
        )

    def forget_cycle(self) -> None:
        """No cycle is in force any more, and its words hold no longer."""
        if self.cycle_values:
            self.cycle_values = {}
        if not math.isnan(self.cycle_state[START]):
            forget(self.cycle_state)

    def own_register(self, name: str) -> int:
        """Place of a register that the dialect declares, among ``registers``."""
        return self._own_registers[name]

    @property
    def feed(self) -> float | None:
        """F as programmed, or None."""
        return _or_none(self.registers[PROGRAMMED_FEED])

    @feed.setter
    def feed(self, feed: float | None) -> None:
        self.registers[PROGRAMMED_FEED] = NAN if feed is None else feed

    @property
    def spindle(self) -> float | None:
        """S as programmed, or None [1/min]."""
        return _or_none(self.registers[SPINDLE])

    @spindle.setter
    def spindle(self, speed: float | None) -> None:
        self.registers[SPINDLE] = NAN if speed is None else speed

    @property
    def spindle_turns(self) -> bool:
        """M3 or M4 of the program is in force; what a cycle does at a hole ends with the hole."""
        return self.registers[SPINDLE_TURNS] != 0.0

    @spindle_turns.setter
    def spindle_turns(self, turns: bool) -> None:
        self.registers[SPINDLE_TURNS] = turns

    def code_word(self, number: float) -> Word | None:
        """Where the block writes a G code, for diagnostics."""
        return next((word for word, _ in self.codes if number_of(word) == number), None)

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
        number = rf"N[ \t]*0*{move.block}(?![0-9])" if move.block >= 0 else r"\S+"
        match = re.search(number, text, re.IGNORECASE)
        return (0, 1) if match is None else (match.start(), len(match[0]))


def _or_none(register: float) -> float | None:
    return None if math.isnan(register) else register


def number_of(word: Word) -> float:
    """The value of a word that has been computed."""
    assert isinstance(word.value, float)
    return word.value


def integer_of(value: float) -> int:
    """A code's number; -1 where it is no whole one."""
    return int(value) if value == int(value) else -1
