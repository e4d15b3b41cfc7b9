"""G and M codes: what a dialect declares of each, and how axis words become a move."""

import dataclasses
from collections.abc import Callable, Mapping
from typing import Literal

from twin.nc.control.control import Control
from twin.nc.control.interpolation import MotionMode
from twin.nc.control.modal import ModalChanges
from twin.nc.control.settings import MachineFunction
from twin.nc.control.state import ControlLanguage
from twin.nc.text.blocks import Statement, Word

Action = Callable[[Control], None]
WordAction = Callable[[Control, Word], None]
StatementAction = Callable[[Control, Statement], None]

Ground = Literal["seed", "manual", "decision"]
"""On what a code's meaning rests: the control's own page, its manuals, or this project."""


@dataclasses.dataclass(frozen=True, slots=True)
class Interpolation(MotionMode):
    """How axis words become a move.

    Attributes:
        perform: Takes the block's words and moves.
        without_words: Done where its code stands in a block without words of a motion; None: nothing.
    """

    perform: Action
    without_words: Action | None = None


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class GCode:
    """One G code.

    Attributes:
        meaning: For people, in a few words.
        group: Modal group; codes of one group exclude each other in a block. Empty: not modal.
        sets: What it puts into force.
        action: Done before the block moves.
        perform: Done in place of a move.
        takes: Addresses that the code wants although they have a meaning of their own elsewhere.
        after: Done when the block has moved.
        once: What it sets holds for its block only.
        alone: No other word may stand in its block.
        yields: Another code of its group in the block takes its place.
        refused: Why the twin refuses a code that the control knows; empty: it does not.
        ground: On what the meaning rests.
    """

    meaning: str
    group: str = ""
    sets: ModalChanges = dataclasses.field(default_factory=ModalChanges)
    action: Action | None = None
    perform: Action | None = None
    takes: str = ""
    after: Action | None = None
    once: bool = False
    alone: bool = False
    yields: bool = False
    refused: str = ""
    ground: Ground = "decision"

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
        meaning: For people.
        group: Codes of one group exclude each other in a block; empty: it has none.
        late: Takes effect when the block has moved.
        ends: Ends the program.
        action: What it does besides being reported as a function.
        silent: It is not reported.
        dwell: How long the program waits for it [s].
        ground: On what the meaning rests.
    """

    meaning: str
    group: str = ""
    late: bool = False
    ends: bool = False
    silent: bool = False
    dwell: float = 0.0
    action: Action | None = None
    ground: Ground = "decision"


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Vocabulary(ControlLanguage):
    """What the words of a dialect do.

    Attributes:
        groups: Modal groups in the order in which they take effect.
        g: G codes by number, such as 54 or 54.1.
        m: M codes by number.
        any_m: M codes outside the table are functions too.
        last_of_group_counts: Of several G codes of a modal group in a block the last one counts; else they
            are refused.
        words: Addresses with a modal meaning, and what they do.
        words_first: F, S, T and early M functions take effect before what G codes do besides the
            modal state that they set.
        other_statement: What statements do that begin with a name.
        function_letters: Addresses that belong to an M function of their block.
    """

    groups: tuple[str, ...]
    g: Mapping[float, GCode]
    m: Mapping[int, MCode]
    any_m: bool = False
    last_of_group_counts: bool = False
    words: Mapping[str, WordAction]
    words_first: bool = False
    statements: Mapping[str, StatementAction] = dataclasses.field(default_factory=dict)
    other_statement: StatementAction | None = None
    function_letters: str = ""

    def refusal(self, code: float) -> str | None:
        """Why a G code that the control knows is refused, given its number; None: it is not."""
        declared = self.g.get(code)
        return None if declared is None or not declared.refused else declared.refusal

    def function(self, number: int, declared: Mapping[int, MachineFunction]) -> MCode | None:
        """The M code with a number; None where it has no meaning.

        Args:
            number: Below 0 where it is no whole one.
            declared: What the machine's builder has declared of the codes outside the table.
        """
        code, own = self.m.get(number), declared.get(number)
        if code is None and own is not None:
            return MCode(meaning=own.meaning, dwell=own.dwell)
        if code is None and self.any_m and number >= 0:
            return MCode(meaning="machine function")
        return code
