"""The running machine of a scene: stepped in slices, told by commands, seen through snapshots.

Nothing here knows of windows or browsers. A room is stepped as fast as one likes; the same commands
at the same ticks give the same motion, to the last bit.
"""

import dataclasses
from collections import deque
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from twin.cutting.tools import default_cell
from twin.errors import TwinError, UsageError
from twin.job.job_file import StockTable
from twin.machine.model.model import spindle_over_table_mm
from twin.machine.simulation.growth import Growth
from twin.machine.simulation.live import STANDSTILL, LiveMachine
from twin.machine.watching.alarms import Alarm, AlarmCode, AlarmStandsError
from twin.machine.watching.watch import limit_switches
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray, Function
from twin.nc.control.settings import ControlSettings, ToolData
from twin.nc.functions import (
    COOLANT_OFF,
    COOLANT_ON,
    PROGRAM_ENDS,
    SPINDLE_LIMITED,
    SpindleState,
)
from twin.nc.iso.base import jog_block
from twin.nc.text.diagnostics import ProgramError
from twin.nc.text.source import Source, source_from_text
from twin.recording.reader import Samples
from twin.run.placement import part_zero, start_position, with_blank
from twin.training.scene.fault_table import FaultTable
from twin.training.scene.scene_file import Mode, Scene
from twin.training.session.block_walk import ModalState
from twin.training.session.faults import inject
from twin.training.session.inspection import Inspection, Moment, inspect_part, moment_of
from twin.training.session.judge import Judge
from twin.training.session.live_cut import LiveCut
from twin.training.session.observed import Notice, block_number
from twin.training.session.preview import PathToCome
from twin.training.session.program_run import Inherited, ProgramRun, RunOptions
from twin.training.session.rest import Rest
from twin.training.session.tables import Tables
from twin.training.session.workpiece import Workpiece

SLICE = 10
"""Servo periods between two looks at the panel: 10 ms at 1 kHz. Time goes on by whole slices, so that
a session that is lived again has its commands, its cuts and its ends at the same borders."""

ALARMS_KEPT = 50
"""Alarms that the history shows."""
WORK_OFFSETS = ("G54", "G55", "G56", "G57", "G58", "G59")
"""Rows of the table of work offsets, where the control knows them."""
MOMENTS_KEPT = 12
"""Alarms that the score sheet has pictures of."""
SHORTEST_WAY = 1e-4
"""Way that counts as none when an axis is driven by hand [mm or deg]: below the handwheel's least step."""
ON_PATH = 1e-3
"""How near to where it was held a program may go on [mm or deg]."""


class Leg(NamedTuple):
    """A way of one axis by hand.

    Attributes:
        axis: Its name.
        target: Machine coordinates, within the travel [mm or deg].
        feed: [mm/min or deg/min].
        wheel: The handwheel asked for it.
    """

    axis: str
    target: float
    feed: float
    wheel: bool = False


class Suspended(NamedTuple):
    """A program that was held, while the axes are jogged.

    Attributes:
        run: The program.
        place: Where it was held, machine coordinates, shape (k,) [mm or deg].
        line: Source line of the block that was held.
        waits: It waits at a program stop, behind that block.
    """

    run: ProgramRun
    place: FloatArray
    line: int
    waits: bool


@dataclasses.dataclass(slots=True)
class Switches:
    """What the panel's switches say of how programs run.

    Attributes:
        optional_stop: M1 stops.
        block_skip: Blocks that begin with a slash are left out.
        dry_run: Feeds go at the feed of the dry run.
    """

    optional_stop: bool = False
    block_skip: bool = False
    dry_run: bool = False


class Room:
    """The machine of a scene while it runs.

    Attributes:
        scene: What is played.
        machine: The machine with its drives.
        tables: Part zero and tool lengths of its control.
        work: The stock, if there is one.
        cut: The force of the cut.
        judge: Looks after the tasks.
        tick: Servo periods since the beginning.
        rest: Whether the machine rests, and need not be computed.
        mode: Where the mode switch stands.
        feed_override: Feed override dial [%].
        rapid_override: Rapid override dial [%].
        spindle_override: Spindle override dial [%].
        switches: Optional stop, block skip, dry run.
        searched: Line at which the next start begins; 0: the first.
        alarm: The alarm that stands.
        alarms: Those that came, the newest last.
        moments: How the tool stood in the part at each of them.
        handed_in: The part as it was when the scene was judged; None: it has not been.
        broken: Tools that have lost their edge, by number, with what was said of it.
        pressed: Whether the emergency stop button is pressed.
        spindle: Whether the spindle turns, and how fast.
        running_down: Whether the spindle, stopped by a reset, still turns while the axes brake.
        coolant: Whether coolant flows.
        program: The program as the operator has edited it.
        lines: Its lines.
        edits: What the lines were before each change.
        entered: What stands in the MDI line.
        run: The program, MDI block or jog that is being run.
        running: What is being run: ``program``, ``mdi``, ``jog``, or nothing.
        waiting: A program waits at a program stop.
        suspended: A program that was held, while the axes are jogged.
        legs: Ways by hand: the first is under way, the others follow.
        modal: What was in force last, where nothing runs.
        inherited: What the last MDI block left in force for the next one.
        faults: What is broken.
        samples: The last slice.
        label: What the screen adds to the position, shape (k,) [mm or deg].
    """

    def __init__(self, scene: Scene) -> None:
        """Switch the machine of a scene on.

        Raises:
            ConfigError: The scene does not fit its machine.
        """
        preparation, file = scene.preparation, scene.file
        machine, job = preparation.machine, preparation.job.file
        self.scene = scene
        over_table = spindle_over_table_mm(machine)
        zero = part_zero(job, machine, over_table)
        self.tables = Tables(zero, job.tools, _offsets(scene))
        for axis, error in file.start.zero_error.items():
            self.tables.zero[machine.axes.index(axis)] += error
        self.tables.lengths[self.tables.spindle] += file.start.tool_length_error
        stand = start_position(job, machine) + zero
        for axis, value in file.start.position.items():
            stand[machine.axes.index(axis)] = value
        self.machine = LiveMachine(with_blank(machine, job, zero, over_table), job.tools[0], stand)
        self.part_frame = machine.part_frame.at(zero, job.tools[0].length)
        self.cut = LiveCut(self.machine, job, self.part_frame, self.tables.true_zero)
        self.work = self._clamped_blank()
        self._growth = Growth(self.machine.machine, self.cut.told_speed)
        self.mode: Mode = file.start.mode
        self.feed_override = file.start.feed_override
        self.rapid_override = file.start.rapid_override
        self.spindle_override = 100
        self.switches = Switches()
        self.searched = 0
        self.spindle = dataclasses.replace(
            preparation.spindle, started=file.start.spindle, speed=file.start.speed
        )
        self.running_down = False
        self.coolant = False
        self.alarm: Notice | None = None
        self.alarms: deque[Notice] = deque(maxlen=ALARMS_KEPT)
        self.moments: deque[Moment] = deque(maxlen=MOMENTS_KEPT)
        self.handed_in: Inspection | None = None
        self.broken: dict[int, Notice] = {}
        self.pressed = False
        self.program: Source = preparation.source
        self.lines = tuple(preparation.source.lines)
        self.edits: list[tuple[str, ...]] = []
        self.entered = ""
        self.run: ProgramRun | None = None
        self.running = ""
        self.waiting = False
        self.suspended: Suspended | None = None
        self.legs: deque[Leg] = deque()
        self.modal: ModalState | None = None
        self.inherited: Inherited | None = None
        self.tick = 0
        self.rest = Rest()
        self.samples = self.machine.hold(1)
        self.label = np.zeros(len(stand))
        self.faults: list[FaultTable] = []
        for fault in file.faults:
            inject(self, fault)
        if file.start.alarm:
            self._begin_in_alarm(file.start.alarm)
        self.judge = Judge(self)

    @property
    def time_s(self) -> float:
        """Machine time since the beginning [s]."""
        return self.tick * self.machine.machine.file.servo_period_s

    @property
    def held(self) -> bool:
        """Whether cycle start is waited for in the midst of something that runs."""
        held = self.suspended is not None and self.run is None
        return held or self.waiting or (self.run is not None and self.run.held)

    @property
    def moving(self) -> bool:
        """Whether any axis moves."""
        return bool(np.abs(self.samples.joint_velocity[-1]).max() > STANDSTILL)

    @property
    def standing_setpoint(self) -> FloatArray:
        """Where the setpoints have come to, machine coordinates, shape (k,)."""
        return self.machine.setpoint.position[0].copy()

    @property
    def touches(self) -> bool:
        """Whether the feeler lamp is lit: the tool stands still and touches the blank."""
        if self.work is None or self.spindle.turns:
            return False
        return self.work.touches(self.machine.position - self.tables.longer)

    @property
    def line(self) -> int:
        """Source line of the program that runs, or behind which it waits; 0: none."""
        if self.suspended is not None:
            return self.suspended.line
        if self.running != "program" or self.run is None:
            return 0
        if self.waiting:
            return self.run.ending_line
        return self.run.line(int(self.machine.setpoint.line[0]))

    @property
    def slice_s(self) -> float:
        """Length of a slice [s]."""
        return SLICE * self.machine.machine.file.servo_period_s

    def advance(self, slices: int = 1) -> None:
        """Let the machine go on by slices."""
        for _ in range(slices):
            self.tick += SLICE
            if self.run is not None or not self.rest.lasts:
                self._move(SLICE)
            self.rest.look(self, self.slice_s)
            self.judge.look(self)
            if self.judge.over and self.handed_in is None:
                last = self._moment(Notice("", "", time_s=self.time_s))
                self.handed_in = inspect_part(self, last)

    def _move(self, count: int) -> None:
        self.cut.turn(self.spindle, self.spindle_override / 100.0)
        parts: list[Samples] = []
        if self.machine.alarm is None:
            setpoints = self._setpoints(count)
            if len(setpoints):
                parts.append(self.machine.follow(setpoints))
        missing = count - sum(map(len, parts))
        if missing:
            rest = self.machine.hold if self.machine.alarm is None else self.machine.brake
            parts.append(rest(missing))
        for part in parts:
            self._see(part)
        self._pass_functions()
        self._relabel()
        self._latch(self.machine.alarm)
        self._note_breaks()
        self._end_of_part()

    def _setpoints(self, count: int) -> Setpoints:
        if self.run is None or self.waiting:
            return self.machine.setpoint[:0]
        setpoints = self.run.drive(
            count,
            self.feed_override / 100.0,
            self.rapid_override / 100.0,
            single=self.running == "program" and self.mode == "single",
        )
        return self.machine.setpoint[:0] if setpoints is None else setpoints

    def _see(self, part: Samples) -> None:
        """Cut along samples; what must not be cut raises an alarm."""
        if not len(part):
            return
        self.samples = part = self._growth.warm(part)
        if self.work is None or self.machine.alarm is not None:
            return
        longer = self.tables.longer
        tips = dataclasses.replace(
            part,
            setpoint=dataclasses.replace(part.setpoint, position=part.setpoint.position - longer),
            joint_position=part.joint_position - longer,
        )
        moves = part.setpoint.move
        run = self.run
        rapid = np.array([run is not None and run.rapid(int(move)) for move in moves], np.bool_)
        self.running_down = self.running_down and self.moving
        standing = np.full(len(part), not self.spindle.turns and not self.running_down)
        # Only what a feed with a turning spindle does to the stock may be seen a little later.
        at_once = self.moving and bool(rapid.any() or standing.any())
        self._halt(self.work.cut(tips, rapid, standing, at_once=at_once))

    def _halt(self, alarm: Alarm | None) -> None:
        """Stop at a cut that must not be."""
        if alarm is not None:
            self.machine.raise_alarm(alarm.code, alarm.message)

    def _pass_functions(self) -> None:
        if self.run is not None:
            for function in self.run.passed(self.samples.setpoint):
                self._function(function)

    def _relabel(self) -> None:
        """What the screen adds to the position: a control may relabel an axis that turns."""
        if self.run is None:
            return
        target = self.run.target(int(self.machine.setpoint.move[0]))
        if target is not None:
            end, display = target
            self.label = display - end

    def _function(self, function: Function) -> None:
        self.turn_spindle(self.spindle.after(function), function.line)
        if function.word in COOLANT_ON:
            self.coolant = True
        elif function.word in COOLANT_OFF | PROGRAM_ENDS:
            self.coolant = False

    def turn_spindle(self, state: SpindleState, line: int = 0) -> None:
        """Let the spindle go on otherwise; a speed that is limited is told, and stops nothing."""
        said = state.limit_of(state.speed)
        if said and state.speed != self.spindle.speed:
            self.alarms.append(self._placed(Notice(SPINDLE_LIMITED, said, line=line)))
        self.spindle = state

    def _latch(self, alarm: Alarm | None) -> None:
        # An axis that is jogged off its switch may meet the next alarm while the first one stands.
        if alarm is not None and (self.alarm is None or self.run is not None):
            self.raise_alarm(
                Notice(alarm.code, alarm.message, alarm.axis, alarm.line, between=alarm.between)
            )

    def raise_alarm(self, notice: Notice) -> None:
        """The control stops everything and says why; the first alarm counts."""
        if self.alarm is None:
            self.alarm = self._noted(notice)
        self.give_up()
        self.spindle = self.spindle.stopped()
        self.coolant = False

    def _noted(self, notice: Notice) -> Notice:
        """Enter what went wrong into the history, for the sheet and the judge too."""
        notice = self._placed(notice)
        moment = self._moment(notice)
        notice = dataclasses.replace(notice, place=tuple(moment.tip.tolist()))
        self.alarms.append(notice)
        self.moments.append(moment)
        self.judge.note_alarm(notice.code)
        return notice

    def _placed(self, notice: Notice) -> Notice:
        """A notice with the time and the block at which it comes."""
        here = self.running == "program" or (self.running == "" and notice.line > 0)
        dialect = self.scene.preparation.dialect
        block = block_number(dialect, self.program, notice.line) if here else ""
        return dataclasses.replace(notice, time_s=self.time_s, block=block)

    def _note_breaks(self) -> None:
        """Tools that have lost their edge: the machine does not feel it, and goes on without."""
        for found in self.cut.new_breaks():
            alarm = found.alarm
            line = alarm.line if self.running == "program" else 0
            self.broken[found.tool] = self._noted(Notice(alarm.code, alarm.message, line=line))

    def _moment(self, alarm: Notice) -> Moment:
        """How the tool stands in the part, for the score sheet."""
        at = self.machine.position - self.tables.longer
        tip = self.part_frame.position(at[None])[0]
        stock = None if self.work is None else self.work.map
        running = self.run is not None and self.running == "program"
        text = self.lines[alarm.line - 1] if running and 0 < alarm.line <= len(self.lines) else ""
        return moment_of(alarm, text.strip(), tip, self.tables.tool, stock)

    def _end_of_part(self) -> None:
        """What comes when the present part of a program has come to its end."""
        run = self.run
        if run is None or self.waiting or not run.finished:
            return
        if self.work is not None and self.machine.alarm is None:
            self._halt(self.work.catch_up())
            self._latch(self.machine.alarm)
        if self.run is None:
            return
        ending = run.ending
        self.judge.note_singly(self)
        if run.dropped or ending in (None, "end"):
            if self.running == "jog":
                self._end_of_leg()
                return
            if self.running == "program" and not run.dropped:
                self.judge.note_end(self)
            elif self.running == "mdi" and not run.dropped:
                self.inherited = run.left()
            self.drop_run()
        elif ending == "wait" or (ending == "stop" and run.optional and not self._stops_at_m1):
            self.go_on(paused=ending == "stop" and self.mode == "single")
        elif ending == "stop":
            self.waiting = True
        elif ending == "tool":
            self.mount(run.tool)
            self.go_on(paused=self.mode == "single")
        else:
            assert ending is not None
            self.raise_alarm(Notice(ending, run.message, line=run.ending_line, finding=run.finding))

    @property
    def _stops_at_m1(self) -> bool:
        """An MDI block has no use for a stop that is optional."""
        return self.running == "program" and self.switches.optional_stop

    def start_run(self, source: Source, what: str, options: RunOptions | None = None) -> None:
        """Interpret and drive a source from where the axes stand.

        Raises:
            UsageError: It cannot be started now.
        """
        if self.moving:
            raise UsageError("the axes still move")
        self.label = np.zeros(len(self.label))
        preparation = self.scene.preparation
        try:
            run = ProgramRun(
                source,
                preparation.dialect,
                self.settings_here(),
                self.machine.machine,
                options or RunOptions(),
            )
            self._begin_part(run)
            self.run, self.running, self.waiting = run, what, False
            if what == "program":
                self.inherited = None
        except ProgramError as error:
            found = error.diagnostic
            message = f"{found.code}: {found.message}"
            self.raise_alarm(Notice("program", message, line=found.line, finding=found))
        except TwinError as error:
            self.raise_alarm(Notice("program", str(error)))

    def path_to_come(self) -> PathToCome:
        """What a start of the program would begin with; nothing of it changes with the room."""
        preparation, tables = self.scene.preparation, self.tables
        return PathToCome(
            source=self.program,
            dialect=preparation.dialect,
            settings=self.settings_here(),
            machine=self.machine.machine,
            search=self.searched,
            stand=self.standing_setpoint,
            zero=tables.zero.copy(),
            longer=tables.longer_by_table(),
            tool=tables.spindle,
            spindle=self.spindle,
            frame=self.part_frame,
        )

    def settings_here(self) -> ControlSettings:
        """What the interpreter must know of the machine as it stands."""
        names = self.machine.machine.axes.names
        zero = self.tables.program_zero
        reference = self.tables.tool.length
        # The panel's control takes the length of the tool in the spindle from its table by itself.
        tools = {
            number: ToolData(radius=self.tables.radii[number], length=reference)
            for number, _ in sorted(
                self.tables.tools.items(), key=lambda item: item[0] != self.tables.spindle
            )
        }
        start = self.standing_setpoint - zero
        settings = self.scene.preparation.settings
        return dataclasses.replace(
            settings,
            start=dict(zip(names, map(float, start), strict=True)),
            tools=tools,
            machine_zero=dict(zip(names, map(float, -zero), strict=True)),
            # A copy: a run that is made again begins with the table as it was.
            offsets={name: dict(values) for name, values in self.tables.offsets.items()},
            block_skip=settings.block_skip or self.switches.block_skip,
        )

    def go_on(self, *, paused: bool = False) -> None:
        """Drive the part of the program that comes next; ``paused``: start is waited for."""
        assert self.run is not None
        self.waiting = False
        self._begin_part(self.run, paused=paused)

    def _begin_part(self, run: ProgramRun, *, paused: bool = False) -> None:
        where = self.standing_setpoint, self.tables.program_zero
        run.begin(*where, self.spindle, paused=paused)

    def drop_run(self) -> None:
        """Forget what runs; the axes slow down where they are."""
        if self.run is not None and self.running != "jog":
            self.modal = self.run.modal(int(self.machine.setpoint.move[0]))
        self.run, self.running, self.waiting = None, "", False

    def give_up(self) -> None:
        """Forget what runs, what was held, and what was still to be driven by hand."""
        self.drop_run()
        self.suspended = None
        self.legs.clear()

    def suspend(self) -> None:
        """Let the axes be jogged while the program is held, or waits at a program stop.

        At M0 a part is measured and chips are cleared (Fagor 8070: tool inspection; SINUMERIK Operate:
        JOG in an interruption, REPOS).
        """
        assert self.run is not None
        run = self.run
        self.suspended = Suspended(run, self.standing_setpoint, self.line, self.waiting)
        self.modal = run.modal(int(self.machine.setpoint.move[0]))
        self.run, self.running, self.waiting = None, "", False

    def resume(self) -> None:
        """Take the held program up again.

        Raises:
            UsageError: The axes stand elsewhere.
        """
        assert self.suspended is not None
        if np.abs(self.standing_setpoint - self.suspended.place).max() > ON_PATH:
            raise UsageError("the axes stand off the path: return to it first")
        self.run, self.running, self.waiting = self.suspended.run, "program", self.suspended.waits
        self.suspended = None

    def drive_by_hand(self, legs: Iterable[Leg]) -> None:
        """Drive axes one after the other.

        Where an axis stands on its limit switch, the drives are switched on for it: the alarm
        stands until it has left the switch (Fagor 8070: with the limit overridden only jogging away
        is allowed; LinuxCNC: "Override Limits").

        Raises:
            UsageError: An axis moves.
        """
        if self.moving:
            raise UsageError("the axes still move")
        if self.machine.alarm is not None:
            self.machine.clear()
        self.legs = deque(legs)
        self._begin_leg()

    def follow_wheel(self, leg: Leg) -> None:
        """Let the axis that follows the handwheel go on to another place, or back at once."""
        assert self.run is not None
        under_way = self.legs[0]
        stands = float(self.standing_setpoint[self.machine.machine.axes.index(leg.axis)])
        self.legs = deque((under_way, leg))
        if (leg.target - under_way.target) * (under_way.target - stands) < 0.0:
            self.run.drop()

    def stop_driving_by_hand(self) -> None:
        """Come to rest on a way by hand, and forget the others."""
        self.legs.clear()
        if self.running == "jog" and self.run is not None:
            self.run.drop()

    def _begin_leg(self) -> None:
        """Begin the first way by hand that is not done yet."""
        while self.legs and self.run is None:
            axis, target, feed, _ = self.legs[0]
            stands = float(self.standing_setpoint[self.machine.machine.axes.index(axis)])
            if abs(target - stands) < SHORTEST_WAY:
                self.legs.popleft()
            else:
                block = jog_block(self.scene.preparation.dialect, axis, target - stands, feed)
                # A jog is kept within the travel by itself, and leads back into it.
                self.start_run(source_from_text(block, "jog"), "jog", RunOptions(soft_limits=False))

    def _end_of_leg(self) -> None:
        """A way by hand has been gone: it ends, and the next one begins, when the axes stand."""
        if self.moving:
            return
        if self.legs:
            self.legs.popleft()
        self.drop_run()
        self._begin_leg()

    def within_travel(self, axis: str, target: float) -> float:
        """How far an axis goes by hand: to the end of its travel; from beyond it only back."""
        machine = self.machine.machine
        low, high = machine.axis(axis).travel or (-np.inf, np.inf)
        stands = float(self.standing_setpoint[machine.axes.index(axis)])
        return min(max(target, min(low, stands)), max(high, stands))

    def new_blank(self) -> None:
        """Clamp a new blank."""
        self.judge.note_blank()
        self.work = self._clamped_blank()
        if self.work is not None:
            self.work.mount(self.tables.tool)

    def renew_tool(self, number: int) -> None:
        """Put a new tool into the place of one that has lost its edge."""
        self.broken.pop(number, None)
        self.cut.renew(number)

    def _clamped_blank(self) -> Workpiece | None:
        job = self.scene.preparation.job.file
        if job.stock is None:
            return None
        head = self.machine.head.above_tip
        stock = _fine(job.stock, self.scene)
        self.cut.clamp(stock)
        return Workpiece(stock, job.tools[0], self.part_frame, self.tables.true_zero, head)

    def mount(self, number: int | None) -> None:
        """Put a tool of the scene into the spindle.

        Raises:
            UsageError: The scene has no such tool.
        """
        if number not in self.tables.tools:
            raise UsageError(f"no tool {number}")
        self.tables.spindle = number
        self.spindle = dataclasses.replace(self.spindle, tool_speed=self.tables.tool.speed)
        self.machine.mount(self.tables.tool)
        self.cut.mount(self.tables.tool, float(self.tables.longer[2]))
        if self.work is not None:
            self.work.mount(self.tables.tool)

    def stop_all(self, code: AlarmCode, message: str) -> None:
        """An alarm from outside that brings the axes to rest at once."""
        self.machine.raise_alarm(code, message)
        self._latch(self.machine.alarm)

    def clear(self) -> None:
        """Clear the alarm, at rest and with its cause gone.

        Raises:
            AlarmStandsError: An axis moves, or the button is still pressed.
        """
        if self.pressed:
            raise AlarmStandsError("the emergency stop button is pressed: turn it free first")
        axis = self.on_switch
        if self.alarm is not None and self.alarm.code == "hard-limit" and axis:
            raise AlarmStandsError(f"{axis} stands on its limit switch: jog it back first")
        if self.machine.alarm is not None:
            self.machine.clear()
        elif self.moving:
            raise AlarmStandsError("the axes still move: an alarm is cleared at rest")
        if self.alarm is not None:
            self.judge.note_cleared(self.alarm.code)
        self.alarm = None
        if self.work is not None:
            self.work.forgive()
            self.cut.resume(self.work.map.heights)

    @property
    def on_switch(self) -> str:
        """Name of an axis that stands on its limit switch; empty: none does."""
        machine = self.machine.machine
        for name, place in zip(machine.axes.names, self.machine.position, strict=True):
            low, high = limit_switches(machine.axis(name))
            if not low < place < high:
                return name
        return ""

    def fail(self, message: str) -> None:
        """Something went wrong within the program that simulates: the axes brake, nothing ends."""
        self.machine.raise_alarm("emergency-stop", message)
        self.raise_alarm(Notice("internal", message))

    def _begin_in_alarm(self, code: str) -> None:
        """Begin as the last shift left the machine."""
        message = "the machine was left in this state"
        if code == "hard-limit":
            message = "an axis stands on its limit switch"
            self.machine.raise_alarm("hard-limit", message)
        self.alarm = Notice(code, message)
        self.alarms.append(self.alarm)


def _offsets(scene: Scene) -> dict[str, dict[str, float]]:
    """The work offsets that the control's table has, with the values of the job."""
    job, dialect = scene.preparation.job.file, scene.preparation.dialect
    names = [
        f"G{number:g}"
        for number in sorted(dialect.codes.g)
        if dialect.codes.g[number].group == "offset"
    ]
    wanted = [name for name in names if name in WORK_OFFSETS]
    return {name: dict(job.offsets.get(name, {})) for name in wanted} | dict(job.offsets)


def _fine(stock: StockTable, scene: Scene) -> StockTable:
    """The stock with a grid that is as fine as the scene is looked at closely."""
    cell = stock.cell or default_cell(scene.preparation.job.file.tools, stock)
    if scene.cells_across:
        cell = min(cell, min(stock.extent[:2]) / scene.cells_across)
    return stock.model_copy(update={"cell": cell})
