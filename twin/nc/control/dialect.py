"""What a dialect declares: its codes, words, syntax, start state and the decisions behind them."""

import dataclasses
import enum
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from twin.nc.canonical import Corner
from twin.nc.control.interpolation import Interpolation
from twin.nc.geometry.planes import XY, Plane
from twin.nc.text.expressions import ExpressionSyntax

if TYPE_CHECKING:
    from twin.nc.bytecode.assembler import Assembler
    from twin.nc.bytecode.block_compiler import BlockWords
    from twin.nc.control.control import Control
    from twin.nc.text.blocks import Block, Statement, Word
    from twin.nc.text.source import Source

Action = Callable[["Control"], None]
WordAction = Callable[["Control", "Word"], None]
Compiler = Callable[["BlockWords", "Assembler"], None]
"""Writes as instructions what a code or a word does, taking the words that belong to it."""
StatementAction = Callable[["Control", "Statement"], None]

Ground = Literal["seed", "manual", "decision"]
"""On what a code's meaning rests: the control's own page, its manuals, or this project."""


class FeedMode(enum.Enum):
    """What F counts."""

    PER_MINUTE = "per minute"
    PER_SECOND = "per second"
    SECONDS_PER_BLOCK = "seconds per block"
    PER_REVOLUTION = "per revolution of the spindle"


@dataclasses.dataclass(slots=True)
class Modal:
    """What stays in force from block to block; G codes set it by name."""

    interpolation: Interpolation | None = None
    cycle: Interpolation | None = None
    """A canned cycle; while it is in force it stands in the place of the interpolation."""
    return_to_reference: bool = False
    """Cycles end at their reference plane, not at the height where they were called."""
    plane: Plane = XY
    incremental: bool = False
    center_absolute: bool = False
    unit: float = 1.0
    """Of programmed lengths [mm]."""
    feed_mode: FeedMode = FeedMode.PER_MINUTE
    corner: Corner = Corner.EXACT_PATH
    corner_tolerance: float = float("nan")
    square_corners: bool = False
    """Compensation extends lines at outside corners instead of rolling around them."""
    indirect_leads: bool = False
    """Compensation begins and ends around the contour's first and last point."""
    correct_center: bool = True
    """A centre that start and end are not equally far from is moved to fit."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class GCode:
    """One G code.

    Attributes:
        meaning: For people, in a few words.
        group: Modal group; codes of one group exclude each other in a block. Empty: not modal.
        sets: Fields of ``Modal`` and their values.
        action: Done before the block moves.
        perform: Done in place of a move.
        takes: Addresses that ``perform`` wants although they have a modal meaning elsewhere.
        after: Done when the block has moved.
        once: What it sets holds for its block only.
        alone: No other word may stand in its block.
        refused: Why the twin refuses a code that the control knows; empty: it does not.
        compiler: Compiles what ``action`` or ``perform`` does ; None: it has no compiled form.
        ground: On what the meaning rests.
    """

    meaning: str
    group: str = ""
    sets: Mapping[str, object] = dataclasses.field(default_factory=dict)
    action: Action | None = None
    perform: Action | None = None
    takes: str = ""
    after: Action | None = None
    once: bool = False
    alone: bool = False
    refused: str = ""
    compiler: Compiler | None = None
    ground: Ground = "decision"

    @property
    def begins_cycle(self) -> bool:
        """It calls a canned cycle."""
        return self.sets.get("cycle") is not None


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class MCode:
    """One M code.

    Attributes:
        meaning: For people.
        group: Codes of one group exclude each other in a block; empty: it has none.
        late: Takes effect when the block has moved.
        ends: Ends the program.
        action: What it does besides being reported as a function.
        silent: It is not reported.
        compiler: Compiles what ``action`` does ; None: it has no compiled form.
        ground: On what the meaning rests.
    """

    meaning: str
    group: str = ""
    late: bool = False
    ends: bool = False
    silent: bool = False
    action: Action | None = None
    compiler: Compiler | None = None
    ground: Ground = "decision"


@dataclasses.dataclass(frozen=True, slots=True)
class Comment:
    """A kind of comment.

    Attributes:
        opening: What begins it.
        closing: What ends it; empty: the end of the line.
        whole_line: It can only begin its line, such as a program's heading.
    """

    opening: str
    closing: str = ""
    whole_line: bool = False


HEADING = Comment("%", whole_line=True)
"""The start of a program and its name: without effect where a dialect does not say otherwise."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Syntax:
    """How a dialect writes its blocks.

    Attributes:
        address: Regular expression of an address.
        comments: Kinds of comments.
        expressions: How values are computed; None where only numbers are written.
        statement: Regular expression of what begins a statement; its group 1 is the keyword.
        trailing_prose: Words of prose behind a block's words are left out with a warning.
        several_blocks: A further N begins a further block on the same line.
        named_labels: ``[NAME]`` at its begin names a block.
        incremental_suffix: ``X20I`` makes one word incremental.
        aliases: Addresses that mean another one.
        excused: Why a line that cannot be read may be left out, given it and the line before:
            code of the warning, or None.
    """

    address: str = "[A-Z]"
    comments: tuple[Comment, ...]
    expressions: ExpressionSyntax | None = None
    statement: str | None = None
    trailing_prose: bool = False
    several_blocks: bool = False
    named_labels: bool = False
    incremental_suffix: bool = False
    aliases: Mapping[str, str] = dataclasses.field(default_factory=dict)
    excused: Callable[[str, str], str | None] = lambda _line, _previous: None


@dataclasses.dataclass(frozen=True, slots=True)
class Decision:
    """What the project decided where the control's documents are silent.

    Attributes:
        question: What they leave open.
        answer: What the twin does.
        reason: Why.
        example: Name of the program that shows it, among the tests' golden files.
    """

    question: str
    answer: str
    reason: str
    example: str


@dataclasses.dataclass(frozen=True, slots=True)
class Mark:
    """Something that only this dialect's programs hold.

    Attributes:
        pattern: Regular expression, searched line by line without regard to case.
        shown: How a person would say it.
    """

    pattern: str
    shown: str


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Dialect:
    """One control's language, as data and a few own rules.

    Attributes:
        name: As given on the command line.
        title: The control.
        code_page: Legacy code page of its programs.
        syntax: How blocks are written.
        groups: Modal groups in the order in which they take effect.
        g: G codes by number.
        start: G codes in force when a program starts.
        m: M codes by number.
        instead: What to write in place of G codes that other controls have, by number.
        any_m: M codes outside the table are functions too.
        axis_letters: Addresses that name axes.
        motion_words: Addresses that make a block move, the axes among them.
        function_letters: Addresses that belong to an M function of their block.
        references: Addresses whose value names a variable and is not computed.
        repeat_word: Address that says how often its block runs, or empty.
        signed: Addresses that are two words, one above and one below 0.
        series: Addresses that may stand several times in a block with a switch point, in order.
        words: Addresses with a modal meaning, and what they do.
        word_compilers: The compilers of those that have one.
        statements: Keywords of statements, and what they do.
        other_statement: What the others do, which begin with a name.
        word_meanings: What the addresses mean, for people.
        units: Units of lengths and feeds, for people.
        decisions: Every decision taken for it.
        marks: What tells its programs from others.
        start_state: Fields of ``Modal`` that no G code sets.
        memory: Makes the object that holds what only this dialect remembers.
        before_motion: Done before every motion block, told whether it is rapid.
        read_variable: Value of a variable, given its name and index.
        is_local: Whether calls with variables of their own have a variable of this name anew.
        given_variable: The value of a variable among those of the job, or None.
        live_variables: Variables that no memory holds: the dialect knows their value itself.
        place_switches: Reports the block's switch points, told the length of its move.
        library: Adds files that the program calls, looked for in the folder of the program.
        prepare: Done before the first block.
        after_motion: Done when a block has moved.
        finish: Done when the program ends without an end code.
        compile_block: Compiles one of its blocks that is more than plain words;
            raises ``UnsupportedError`` for what is left to the interpreter tier; None: all is.
        disturbed: Something that only this dialect remembers acts on plain blocks now, so that they
            the interpreter tier must run them; None: nothing can.
        registers: What the compiled tier is given of its memory, by places in ``registers``.
        take_registers: Takes all of them back.
    """

    name: str
    title: str
    code_page: str
    syntax: Syntax
    groups: tuple[str, ...]
    g: Mapping[int, GCode]
    start: tuple[int, ...]
    m: Mapping[int, MCode]
    instead: Mapping[int, str] = dataclasses.field(default_factory=dict)
    any_m: bool = False
    axis_letters: frozenset[str] = frozenset("XYZABCUVW")
    motion_words: frozenset[str] = frozenset("XYZABCUVWIJKR")
    function_letters: str = ""
    references: str = ""
    repeat_word: str = ""
    signed: tuple[str, ...] = ()
    series: str = ""
    words: Mapping[str, WordAction]
    word_compilers: Mapping[str, Compiler] = dataclasses.field(default_factory=dict)
    statements: Mapping[str, StatementAction] = dataclasses.field(default_factory=dict)
    other_statement: StatementAction | None = None
    word_meanings: Mapping[str, str]
    units: str
    decisions: tuple[Decision, ...]
    marks: tuple[Mark, ...]
    start_state: Mapping[str, object] = dataclasses.field(default_factory=dict)
    memory: Callable[[], object] = object
    before_motion: Callable[["Control", bool], None] | None = None
    read_variable: Callable[["Control", str, float | None], float] | None = None
    is_local: Callable[[str], bool] = lambda _name: False
    given_variable: Callable[[Mapping[str, float], str], float | None] = lambda given, name: (
        given.get(name)
    )
    live_variables: frozenset[str] = frozenset()
    place_switches: Callable[["Control", float], None] | None = None
    library: Callable[["Source", Path], "Source"] | None = None
    prepare: Action | None = None
    after_motion: Action | None = None
    finish: Action | None = None
    compile_block: Callable[["Control", "Block", "Assembler"], None] | None = None
    disturbed: Callable[["Control"], bool] | None = None
    registers: Callable[["Control"], Mapping[int, float]] = lambda _control: {}
    take_registers: Callable[["Control", list[float]], None] = lambda _control, _values: None
