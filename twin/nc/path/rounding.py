"""The stage of the path that blends corners: it looks one move ahead."""

from collections.abc import Callable

from twin.nc.canonical import Event, Motion
from twin.nc.path.blends import Blend, NoBlendError, blend_corner
from twin.nc.path.move_columns import Segment
from twin.nc.path.segments import MoveReport


class Rounding:
    """Blends the corners that it is given to.

    A block whose corner cannot be blended is refused as a whole: what happens before its move waits with it.

    Attributes:
        always: Blend of every corner between two moves that it holds for, or None.
        once: Blend of the next corner, or None.
    """

    def __init__(
        self,
        emit: Callable[[Segment], None],
        happen: Callable[[Event], None],
        withdraw: Callable[[int], list[Event]],
        report: MoveReport,
    ) -> None:
        """Stand before the first move.

        Args:
            emit: Takes moves whose corner is made.
            happen: Takes events behind them.
            withdraw: Gives back the events of a line that no move has followed.
        """
        self._emit_move = emit
        self._happen = happen
        self._withdraw = withdraw
        self._report = report
        self._held: Segment | None = None
        self._blend: Blend | None = None
        self._before: list[Event] = []
        self._waiting: list[Event] = []
        self.always: Blend | None = None
        self.once: Blend | None = None

    def blend_next(self, blend: Blend, line: int | None = None) -> bool:
        """Blend the corner between the last move and the next.

        Args:
            line: Whose feed move that must be; None: any.

        Returns:
            False where there is no such move.
        """
        held = self._held
        if held is None or (line is not None and (held.line, held.motion) != (line, Motion.FEED)):
            return False
        self.once = blend
        self._before = self._withdraw(held.line)
        return True

    def add(self, move: Segment) -> None:
        """The next move."""
        if self._held is not None:
            self._join(self._held, move)
        else:
            self._held = move
        self._blend, self.once = self.always, None

    def _join(self, held: Segment, move: Segment) -> None:
        self._held = move
        blend = self.once or (self._blend if self.always is not None else None)
        feeds = held.motion is Motion.FEED and move.motion is Motion.FEED
        if self.once is not None and not feeds:
            self._report.refuse(move, "blend", "a rapid move cannot be blended")
        if blend is not None and feeds and blend.size > 0.0:
            try:
                held, between, self._held = blend_corner(held, move, blend)
            except NoBlendError as error:
                if self.once is not None:
                    self._report.refuse(move, "blend", f"the corner cannot be blended: {error}")
                between = []
            self._emit(held)
            for each in between:
                self._emit(each)
        else:
            self._emit(held)
        self._let_happen()

    def event(self, event: Event) -> None:
        """Something that happens where the path has come to: behind the corner."""
        if self._held is None:
            self._happen(event)
        else:
            self._waiting.append(event)

    def flush(self) -> None:
        """Nothing follows that could be blended.

        Raises:
            ProgramError: The program asks for a blend here.
        """
        held, self._held = self._held, None
        if held is not None:
            if self.once is not None:
                self._report.refuse(
                    held, "blend", "no move follows with which the corner could be blended"
                )
            self._emit(held)
        self._let_happen()

    def _emit(self, move: Segment) -> None:
        before, self._before = self._before, []
        for event in before:
            self._happen(event)
        self._emit_move(move)

    def _let_happen(self) -> None:
        waiting, self._waiting = self._waiting, []
        for event in waiting:
            self._happen(event)
