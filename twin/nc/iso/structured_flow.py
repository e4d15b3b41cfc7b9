"""Conditions and loops whose keywords are on lines of their own, as far as they mean the same on every control."""

import dataclasses
import math
from collections.abc import Callable

from twin.nc.control.constructs import Construct, Structure
from twin.nc.control.control import Control
from twin.nc.text.blocks import Location, Statement


@dataclasses.dataclass(frozen=True, slots=True)
class StructuredFlow:
    """What the keywords of a language's constructs do.

    Attributes:
        structure: The constructs of the program that runs.
        hint: What a keyword lacks that has no counterpart.
        value_of: The value behind a keyword.
        deepest: Constructs that may be within each other.
    """

    structure: Callable[[Control], Structure]
    hint: str
    value_of: Callable[[Control, Statement], float]
    deepest: float = math.inf

    def construct_of(self, control: Control, statement: Statement) -> Construct:
        """The construct that a statement of the block belongs to."""
        construct = self.structure(control).by_line.get(control.block.line - 1)
        if construct is None or construct.end is None:
            message = f"{statement.keyword} has no counterpart"
            control.fail("open-structure", message, statement, self.hint)
        if construct.depth > self.deepest:
            message = f"more than {self.deepest} constructs within each other"
            control.fail("structure", message, statement)
        return construct

    def refuse_jump_inside(self, control: Control, statement: Statement, place: Location) -> None:
        """Refuse a jump into a construct that the block is not in."""
        structure = self.structure(control)
        here = structure.around(control.block.line - 1)
        if any(construct not in here for construct in structure.around(place.line)):
            message = "a jump must not lead into a structure"
            control.fail("jump-into-structure", message, statement)

    def mark(self, control: Control, statement: Statement) -> None:
        """A keyword that only marks a place, which must have its counterpart."""
        self.construct_of(control, statement)

    def leave(self, control: Control, statement: Statement) -> None:
        """A branch reached from the one before: go on behind the construct."""
        control.jump(self.construct_of(control, statement).behind)

    def run_while(self, control: Control, statement: Statement) -> None:
        """Run the body as long as the condition at its beginning holds."""
        construct = self.construct_of(control, statement)
        if not self.value_of(control, statement):
            control.jump(construct.behind)

    def go_back(self, control: Control, statement: Statement) -> None:
        """Go to the beginning, where a condition is looked at again."""
        control.jump(Location(self.construct_of(control, statement).begin, 0))

    def repeat_while(self, control: Control, statement: Statement) -> None:
        """Run the body again as long as the condition at its end holds."""
        self._repeat(control, statement, wanted=True)

    def repeat_until(self, control: Control, statement: Statement) -> None:
        """Run the body again until the condition at its end holds."""
        self._repeat(control, statement, wanted=False)

    def _repeat(self, control: Control, statement: Statement, *, wanted: bool) -> None:
        construct = self.construct_of(control, statement)
        if (self.value_of(control, statement) != 0.0) is wanted:
            control.jump(Location(construct.begin + 1, 0))
