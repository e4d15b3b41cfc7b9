"""The path of moves from the control to the columns.

The stages, in order: splines through points, blends at corners, tool radius compensation, loops cut
out, additional axes that go evenly, tool centre point control. Each is there only while a program asks for it,
and holds few moves. Under tool centre point control all others see the tip in the part.
"""

from collections.abc import Callable

from twin.nc.canonical import Axes, Event, FloatArray, IntArray, Motion
from twin.nc.geometry.matrices import Matrix
from twin.nc.geometry.planes import Plane
from twin.nc.path.blends import Blend
from twin.nc.path.compensation.stage import OFF, Compensation
from twin.nc.path.loops import Loops
from twin.nc.path.move_columns import MoveColumns, Segment, segment_of
from twin.nc.path.rounding import Rounding
from twin.nc.path.segments import MoveReport
from twin.nc.path.splines import Spline
from twin.nc.path.synchronous_axes import MOST_MOVES, SynchronousAxes
from twin.nc.path.tool_center.tool_center import ToolCenter
from twin.nc.text.diagnostics.reporter import Reporter


class Path:
    """Takes moves and events in program order.

    Attributes:
        position: Where the emitted path has come to, shape (k,) [mm or deg].
        defer: Takes an event that happens behind moves which a dialect holds back; False: it holds none.
        leads: Called with the next move: makes the moves that lead to it, and returns whether it is to be made; None: nothing
            does. The next move begins where they end on the contour, not where the path has come to.
        tool_center: From the tip to the axes; None: moves are those of the axes.
    """

    def __init__(self, axes: Axes, start: list[float], report: Reporter) -> None:
        self.columns = MoveColumns(axes)
        self._report = MoveReport(report)
        self._before: Segment | None = None
        self._spline: Spline | None = None
        self._rounding: Rounding | None = None
        self.compensation = Compensation(self._emit, self._record, self._report)
        self._loops: Loops | None = None
        self._synchronous: SynchronousAxes | None = None
        self.position = start
        self.defer: Callable[[Event], bool] = holds_none
        self.leads: Callable[[Segment], bool] | None = None
        self.tool_center: ToolCenter | None = None

    def finish(self) -> None:
        """Nothing follows: emit what the stages hold."""
        self.flush()
        self.end_compensation()
        self.keep_loops()
        if self._synchronous is not None:
            self._synchronous.finish()

    # --- what the control adds

    def add(self, move: Segment) -> None:
        """The next programmed move."""
        if self.leads is not None:
            leads, self.leads = self.leads, None
            if not leads(move):
                return
        if self._spline is not None:
            self.end_spline(move)
        self._before = move
        self._round(move)

    @property
    def passes_on(self) -> bool:
        """No stage holds or changes moves: what is added is emitted as it is."""
        stages = (
            self._spline,
            self._rounding,
            self._loops,
            self._synchronous,
            self.tool_center,
        )
        free = self.compensation.stage is OFF and self.leads is None
        return free and all(stage is None for stage in stages)

    def add_rows(
        self,
        codes: IntArray,
        values: FloatArray,
        positions: FloatArray,
        screen: Matrix | None = None,
    ) -> Segment | None:
        """Programmed moves as ``MoveColumns`` takes them, while ``passes_on``; the last of them."""
        if not len(codes):
            return None
        self.columns.add_rows(codes, values, positions, screen)
        self._before = segment_of(codes[-1], values[-1], positions[-1])
        self._before.screen = screen
        self.position = self._before.end
        return self._before

    def add_point(self, move: Segment, *, flat: bool) -> None:
        """The straight path to the next point of a spline; ``flat``: its height goes linearly."""
        if self._spline is None:
            before = self._before
            cuts = before is not None and before.motion is Motion.FEED
            self._spline = Spline(before if cuts else None, self._round)
        self._spline.add(move, flat=flat)
        self._before = None

    def event(self, event: Event) -> None:
        """Something that happens between the moves so far and the next, whatever its ``before``."""
        if self.defer(event):
            return
        self.end_spline()
        self._before = None
        if self._rounding is None:
            self.compensation.event(event)
        else:
            self._rounding.event(event)

    def end_spline(self, behind: Segment | None = None) -> None:
        """The spline ends, before the move that follows, if one does; its next point begins a new one."""
        if self._spline is not None:
            cuts = behind is not None and behind.motion is Motion.FEED
            self._spline.finish(behind if cuts else None)
            self._spline = None

    # --- blends

    def _round(self, move: Segment) -> None:
        if self._rounding is None:
            self._compensate(move)
        else:
            self._rounding.add(move)

    def hold_for_blends(self) -> Rounding:
        """From now on moves are kept until their successor is known, by the stage that blends corners."""
        if self._rounding is None:
            self._rounding = Rounding(
                self._compensate,
                self.compensation.event,
                self.columns.withdraw_events,
                self._report,
            )
        return self._rounding

    def blend_always(self, blend: Blend | None) -> None:
        """Blend every corner between two moves that follow; None: no more."""
        self.end_spline()
        if blend is not None:
            self.hold_for_blends()
        if self._rounding is not None:
            self._rounding.always = blend
            if blend is None:
                self._rounding.flush()
                self._rounding = None

    def flush(self) -> None:
        """Emit what splines and blends hold."""
        self.end_spline()
        if self._rounding is not None:
            self._rounding.flush()

    # --- compensation

    def _compensate(self, move: Segment) -> None:
        if self.compensation.stage is OFF:
            self._emit(move)
        else:
            self.compensation.add(move, self.position)

    def compensate(
        self,
        plane: Plane,
        signed_offset: float,
        *,
        square: bool,
        indirect: bool,
        look_ahead: int,
        led: bool = False,
    ) -> None:
        """Compensate from the next move on; arguments as for ``Compensation.begin``."""
        self.flush()
        self.compensation.begin(
            plane.directions,
            signed_offset,
            square=square,
            indirect=indirect,
            look_ahead=look_ahead,
            led=led,
        )

    def end_compensation(self, *, led: bool = False) -> None:
        """The next line leads out, unless that is ``led`` otherwise."""
        if self.compensation.in_force:
            self.flush()
            self.compensation.end(led=led)

    # --- loops

    @property
    def cutting_loops(self) -> bool:
        """Loops are cut out."""
        return self._loops is not None

    def cut_loops(self, plane: Plane) -> None:
        """Loops of the path in a plane are cut out from now on."""
        if self._loops is None:
            self.flush()
            self._loops = Loops(plane, self._out, self._note)

    def keep_loops(self) -> None:
        """Loops stay."""
        if self._loops is not None:
            self.flush()
            self._loops.flush()
            self._loops = None

    # --- additional axes

    def go_evenly(self, axis: int) -> None:
        """From now on the axis of this column goes evenly over the moves that follow."""
        self.flush()
        if self._synchronous is None:
            self._synchronous = SynchronousAxes(self._write, self.columns.add_event)
        self._synchronous.begin(axis)

    def go_as_programmed(self, axis: int) -> None:
        """It has arrived, and goes with each move again."""
        if self._synchronous is not None:
            self.flush()
            self._synchronous.end(axis)
            if self._synchronous.idle:
                self._synchronous = None

    def _emit(self, move: Segment) -> None:
        if move.center is None and move.start == move.end:
            return
        self.position = move.end
        if self._loops is not None:
            self._loops.add(move)
        elif self._synchronous is not None:
            self._out(move)
        elif self.tool_center is None:
            self.columns.add(move)
        else:
            self._write(move)

    def _out(self, move: Segment) -> None:
        if self._synchronous is None:
            self._write(move)
        elif not self._synchronous.add(move):
            message = f"an axis cannot go evenly over more than {MOST_MOVES} moves"
            self._report.refuse(move, "even-axis", message)

    def _write(self, move: Segment) -> None:
        if self.tool_center is None:
            self.columns.add(move)
            return
        try:
            for part in self.tool_center.moves_of(move):
                self.columns.add(part)
        except ValueError as error:
            self._report.refuse(move, "tool-center", str(error))

    def _record(self, event: Event) -> None:
        if self._loops is None:
            self._note(event)
        else:
            self._loops.event(event)

    def _note(self, event: Event) -> None:
        if self._synchronous is None:
            self.columns.add_event(event)
        else:
            self._synchronous.event(event)


def holds_none(_event: Event) -> bool:
    """What takes events where a dialect holds no moves back."""
    return False
