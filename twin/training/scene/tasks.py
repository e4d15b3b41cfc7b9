"""Tasks: conditions that are checked against the running machine.

A task is done at the moment at which its condition holds, and stays done. A task with ``to_end``
is one that must never be broken: it fails at the moment at which it is, and is done at the end. What
is in the control's tables is judged when the scene is handed in, so that no value can be found
by trying.
"""

from typing import Annotated, Literal

import pydantic
from pydantic import Field

from twin.files.toml import Table
from twin.training.scene.vocabulary import Text


class ReachedTable(Table):
    """The axes are at a place."""

    at: Annotated[dict[str, float], Field(min_length=1)]
    """By axis [mm or deg]."""
    tolerance: Annotated[float, Field(gt=0)] = 0.1
    """[mm or deg]."""
    frame: Literal["part", "machine"] = "part"
    """From the part's true zero, whatever the control believes; or machine coordinates."""
    by_program: bool = False
    """Only where a program has brought them that has finished the part."""


class StayedTable(Table):
    """An axis never leaves a range."""

    axis: str
    """Its name."""
    low: float
    """Least place of the tip [mm or deg], from the part's true zero."""
    high: float
    """Greatest [mm or deg]."""


class ZeroTable(Table):
    """The control's part zero is where the part's is."""

    axes: Annotated[tuple[str, ...], Field(min_length=1)]
    """Which of them."""
    tolerance: Annotated[float, Field(gt=0)] = 0.05
    """[mm or deg]."""


class QuestionTable(Table):
    """Something that is to be found out."""

    choices: Annotated[tuple[str, ...], Field(min_length=2)]
    """What may be answered."""
    right: str
    """The answer that is right."""

    @pydantic.model_validator(mode="after")
    def _has_right(self) -> "QuestionTable":
        if self.right not in self.choices:
            raise ValueError("the right answer is not among the choices")
        return self


class TaskTable(Table):
    """One task: a text, points, and exactly one condition."""

    text: Text
    """What is to be done, for the operator."""
    points: Annotated[int, Field(ge=1)] = 1
    """What it is worth."""
    reached: ReachedTable | None = None
    stayed: StayedTable | None = None
    """Holds to the end."""
    zero: ZeroTable | None = None
    tool_length: Annotated[float, Field(gt=0)] | None = None
    """The table's length of the tool that the job begins with is right within this [mm]."""
    finished: bool = False
    """The program has run to its end, without an alarm on the way."""
    single_block: tuple[Annotated[int, Field(ge=1)], ...] = ()
    """These lines have been run in single block."""
    held: tuple[Annotated[int, Field(ge=1)], ...] = ()
    """The axes have been held to a stand within one of these lines."""
    cleared: str = ""
    """An alarm of this code has been cleared, and none stands."""
    no_alarm: tuple[str, ...] = ()
    """None of these alarms comes; ``any`` for all. Holds to the end."""
    within_s: Annotated[float, Field(gt=0)] | None = None
    """All other tasks are done within this machine time [s]."""
    blanks: Annotated[int, Field(ge=1)] | None = None
    """No more blanks than these have been clamped, the first one counted. Holds to the end."""
    removed_mm3: tuple[float, float] | None = None
    """What has been cut off lies in this range when the program has ended [mm³]."""
    question: QuestionTable | None = None

    @pydantic.model_validator(mode="after")
    def _one_condition(self) -> "TaskTable":
        given = [name for name in CONDITIONS if getattr(self, name)]
        if len(given) != 1:
            known = ", ".join(CONDITIONS)
            raise ValueError(f"a task has exactly one condition of {known}; it has {len(given)}")
        return self

    @property
    def condition(self) -> str:
        """The name of its condition."""
        return next(name for name in CONDITIONS if getattr(self, name))

    @property
    def to_end(self) -> bool:
        """Whether it is judged at the end, since it can be broken until then."""
        return self.condition in ("stayed", "no_alarm", "within_s", "blanks")

    @property
    def at_end(self) -> bool:
        """Whether it is looked at only when the scene is handed in."""
        return self.condition in ("zero", "tool_length")

    def axes_named(self) -> list[str]:
        """The axes that its condition speaks of."""
        found = [] if self.reached is None else list(self.reached.at)
        found += [] if self.stayed is None else [self.stayed.axis]
        return found + ([] if self.zero is None else list(self.zero.axes))


CONDITIONS = (
    "reached", "stayed", "zero", "tool_length", "finished", "single_block", "held", "cleared",
    "no_alarm", "within_s", "blanks", "removed_mm3", "question",
)  # fmt: skip
"""Keys of a task that are conditions."""
