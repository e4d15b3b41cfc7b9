"""What a dialect declares: its codes, words, syntax, start state and the decisions behind them."""

import dataclasses
from collections.abc import Callable, Mapping
from pathlib import Path

from twin.nc.control.codes import Action, Vocabulary
from twin.nc.control.control import Control
from twin.nc.control.modal import ActiveCodes, Modal, ModalChanges
from twin.nc.control.settings import ControlSettings
from twin.nc.path.paces import PATH_COUNTS, FeedRule
from twin.nc.text.blocks import Assignment, Block
from twin.nc.text.source import Source
from twin.nc.text.syntax import Language, Mark


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


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Dialect(Vocabulary):
    """One control's language, as data and a few own rules; attributes besides those of its bases.

    Attributes:
        title: The control.
        start: G codes in force when a program starts.
        instead: What to write in place of G codes that other controls have, by number.
        motion_words: Addresses that make a block move, the axes among them.
        declared_letters: Addresses that belong to an M function that the job or the machine declares.
        references: Addresses whose value names a variable and is not computed.
        repeat_word: Address that says how often its block runs, or empty.
        signed: Addresses that are two words, one above and one below 0.
        series: Addresses that may stand several times in a block with a switch point, in order.
        feed_letter: Address that sets the feed and does no more; empty: there is none.
        spindle_letter: Address that sets the spindle's speed; empty: there is none, the drive is set.
        word_meanings: What the addresses mean, for people.
        units: Units of lengths and feeds, for people.
        decisions: Every decision taken for it.
        marks: What tells its programs from others.
        start_state: Fields of ``Modal`` that no G code sets.
        before_motion: Done before every motion block, told whether it is rapid.
        read_variable: Value of a variable, given its name and index.
        write_variable: Gives a variable a value, told its name, its index and the assignment; None:
            variables are written as they are named.
        place_switches: Reports the block's switch points, told the length of its move.
        library: Adds files that the program calls, looked for in the folder of the program and read as the
            dialect is.
        pointless: Addresses whose numbers without a decimal point ``count`` must look at.
        feed_rule: Which part of a move F counts, by the parameters of the control.
        count: Gives words without a decimal point their value in the units of the others.
        prepare: Done before the first block.
        after_motion: Done when a block has moved.
        must_end: A program without an end code is wrong.
        finish: Done when the program ends without an end code.
        tables: Further tables of its page: what is named, and what it is, by title.
        length_by_code: Nothing but a code puts a tool's length into force; else the tool change may.
        acts_on_lines: Something that only this dialect remembers acts on plain lines, so that the kernel
            cannot run them.
    """

    title: str
    start: tuple[float, ...]
    instead: Mapping[float, str] = dataclasses.field(default_factory=dict)
    motion_words: frozenset[str] = frozenset("XYZABCUVWIJKR")
    declared_letters: str = ""
    references: str = ""
    repeat_word: str = ""
    signed: tuple[str, ...] = ()
    series: str = ""
    feed_letter: str = "F"
    spindle_letter: str = "S"
    word_meanings: Mapping[str, str]
    units: str
    decisions: tuple[Decision, ...]
    marks: tuple[Mark, ...]
    start_state: ModalChanges = dataclasses.field(default_factory=ModalChanges)
    before_motion: Callable[[Control, bool], None] | None = None
    read_variable: Callable[[Control, str, float | None], float] | None = None
    write_variable: Callable[[Control, str, float | None, float, Assignment], None] | None = None
    place_switches: Callable[[Control, float], None] | None = None
    library: Callable[[Source, Path, Language], Source] | None = None
    pointless: Callable[[ControlSettings], frozenset[str]] = lambda _settings: frozenset()
    count: Callable[[Control, Block], Block] = lambda _control, block: block
    feed_rule: Callable[[ControlSettings], FeedRule] = lambda _settings: PATH_COUNTS
    prepare: Action | None = None
    after_motion: Action | None = None
    must_end: bool = False
    tables: Mapping[str, Mapping[str, str]] = dataclasses.field(default_factory=dict)
    length_by_code: bool = False
    finish: Action | None = None
    acts_on_lines: Callable[[Control], bool] = lambda _control: False

    def new_modal(self) -> Modal:
        """What is in force of its codes: nothing; groups that have one at the start come first."""
        codes = (*(self.g[number] for number in self.start), *self.g.values())
        return Modal(ActiveCodes(code.group for code in codes if code.group))
