"""What a dialect declares of its G and M codes, its statements and its words."""

import dataclasses
from collections.abc import Callable, Mapping
from typing import Literal

from twin.nc.control.control import Control
from twin.nc.control.modal import ActiveCodes, Modal, ModalChanges, MotionMode
from twin.nc.control.settings import MachineFunction
from twin.nc.functions import acts
from twin.nc.text.blocks import Statement, Word

Action = Callable[[Control], None]
WordAction = Callable[[Control, Word], None]
StatementAction = Callable[[Control, Statement], None]
"""What a code does. What the control would refuse, an action or a cycle raises as ``ProgramError`` at its word."""

Basis = Literal["control page", "manual", "decision"]
"""On what a code's meaning rests: the control's own page, its manuals, or this project."""


@dataclasses.dataclass(frozen=True, slots=True)
class Interpolation(MotionMode):
    """How axis words become a move.

    Attributes:
        without_words: Done where its code is in a block without words of a motion; None: nothing.
    """

    perform: Action
    without_words: Action | None = None


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class GCode:
    """One G code.

    Attributes:
        group: Modal group; codes of one group exclude each other in a block. Empty: not modal.
        action: Done before the block moves.
        consumes: Addresses that the code wants although they have a meaning of their own elsewhere.
        after_motion: Done when the block has moved.
        non_modal: What it sets holds for its block only.
        exclusive: No other word may be in its block.
        weak: Another code of its group in the block takes its place.
        refused: Why the twin refuses a code that the control knows; empty: it does not.
        advice: What to write in place of one that is refused.
    """

    meaning: str
    group: str = ""
    sets: ModalChanges = dataclasses.field(default_factory=ModalChanges)
    action: Action | None = None
    perform: Action | None = None
    consumes: str = ""
    after_motion: Action | None = None
    non_modal: bool = False
    exclusive: bool = False
    weak: bool = False
    refused: str = ""
    advice: str = ""
    basis: Basis = "decision"

    @property
    def refusal(self) -> str:
        """Meaning and reason of a code that is refused."""
        return f"({self.meaning}): {self.refused}"

    @property
    def begins_cycle(self) -> bool:
        """It calls a canned cycle."""
        return self.sets.get("cycle") is not None


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class MCode:
    """One M code.

    Attributes:
        group: Codes of one group exclude each other in a block; empty: it has none.
        after_motion: Takes effect when the block has moved.
        action: What it does besides being reported as a function.
        dwell: How long the program waits for it [s].
    """

    meaning: str
    group: str = ""
    after_motion: bool = False
    ends: bool = False
    silent: bool = False
    dwell: float = 0.0
    action: Action | None = None
    basis: Basis = "decision"


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Codes:
    """The codes and statements of a dialect.

    Attributes:
        groups: Modal groups in the order in which they take effect.
        g: G codes by number, such as 54 or 54.1.
        start_state: Fields of ``Modal`` that no G code sets.
        replacements: What to write in place of G codes that other controls have, by number.
        function_replacements: The same of M codes.
        any_m: M codes outside the table are functions too.
        last_of_group_counts: Of several G codes of a modal group in a block the last one counts; else they
            are refused.
        statements: What statements do, by their keywords.
        other_statement: What statements do that begin with a name.
    """

    groups: tuple[str, ...]
    g: Mapping[float, GCode]
    m: Mapping[int, MCode]
    start: tuple[float, ...]
    start_state: ModalChanges = dataclasses.field(default_factory=ModalChanges)
    replacements: Mapping[float, str] = dataclasses.field(default_factory=dict)
    function_replacements: Mapping[int, str] = dataclasses.field(default_factory=dict)
    any_m: bool = False
    last_of_group_counts: bool = False
    statements: Mapping[str, StatementAction] = dataclasses.field(default_factory=dict)
    other_statement: StatementAction | None = None

    def function(self, number: int, declared: Mapping[int, MachineFunction]) -> MCode | None:
        """The M code with a number; None where it has no meaning.

        Args:
            number: Below 0 where it is no whole one.
            declared: What the machine's builder has declared, of codes that neither control nor machine act upon.
        """
        code, own = self.m.get(number), declared.get(number)
        if own is not None:
            reported = MCode(meaning="") if code is None else code
            return dataclasses.replace(reported, meaning=own.meaning, dwell=own.dwell)
        if code is None and self.any_m and number >= 0:
            return MCode(meaning="machine function")
        return code

    def meaning_acted_upon(self, number: int) -> str:
        """What control or machine do at an M code, so that no builder can give it another meaning; else empty."""
        code = self.m.get(number)
        if code is not None and (code.action or code.ends or code.silent or acts(number)):
            return code.meaning
        return acts(number) if self.any_m else ""

    def new_modal(self) -> Modal:
        """What is in force of them: nothing; groups that have one at the start come first."""
        codes = (*(self.g[number] for number in self.start), *self.g.values())
        return Modal(ActiveCodes(code.group for code in codes if code.group))


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Words:
    """The words of a dialect, by their addresses.

    Attributes:
        actions: Addresses with a modal meaning, and what they do.
        before_codes: F, S, T and early M functions take effect before what G codes do besides the
            modal state that they set.
        motion: Addresses that make a block move, the axes among them.
        of_functions: Addresses that belong to an M function of their block.
        of_declared: Addresses that belong to an M function that the job or the machine declares.
        references: Addresses whose value names a variable and is not computed.
        repeat: Address that says how often its block runs, or empty.
        signed: Addresses that are two words, one above and one below 0.
        indexed: The axis that a word names whose address ends with an index, such as AX[A]; None: none does.
        series: Addresses that may stand several times in a block with a switch point, in order.
        feed: Address that sets the feed and does no more; empty: there is none.
        spindle: Address that sets the spindle's speed; empty: there is none, the drive is set.
    """

    actions: Mapping[str, WordAction]
    before_codes: bool = False
    axes: frozenset[str] = frozenset("XYZABCUVW")
    motion: frozenset[str] = frozenset("XYZABCUVWIJKR")
    of_functions: str = ""
    of_declared: str = ""
    references: str = ""
    repeat: str = ""
    signed: tuple[str, ...] = ()
    indexed: Callable[[Control, Word], str] | None = None
    series: str = ""
    feed: str = "F"
    spindle: str = "S"
    meanings: Mapping[str, str]
