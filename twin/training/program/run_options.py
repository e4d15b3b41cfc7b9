"""How a program is run, and where its blocks come from."""

import dataclasses
from typing import Protocol

from twin.nc.control.executor import Executor
from twin.nc.text.blocks import Block
from twin.nc.text.diagnostics import Diagnostic
from twin.training.program.inherited import Inherited


class BlockStream(Protocol):
    """Blocks that come while they are run, as a sender streams them.

    They are a program part as long as they come: it ends where none came for a while before the axes have begun,
    or where the planner has caught up with them.
    """

    @property
    def quiet(self) -> bool:
        """Whether no block has come for a while."""
        ...

    def next(self, executor: Executor, moves_ahead: int) -> Block | None:
        """The next block; None: none has come, or none is wanted.

        Args:
            executor: Is to run it.
            moves_ahead: How many moves lie ahead of the axes.
        """
        ...

    def refuse(self, executor: Executor, finding: Diagnostic) -> None:
        """The last block is wrong: it is to leave no trace."""
        ...


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class RunOptions:
    """How a program is run.

    Attributes:
        soft_limits: Whether to stop before a move that leaves the travel.
        dry_feed: What all feeds are replaced by in a dry run [mm/min]; None: none.
        search: Source line to begin at: what stands before it is only computed. 0: the beginning.
        inherited: What is in force at the beginning; None: what the control begins with.
        stream: Where blocks come from, in place of the source.
    """

    soft_limits: bool = True
    dry_feed: float | None = None
    search: int = 0
    inherited: Inherited | None = None
    stream: BlockStream | None = None
