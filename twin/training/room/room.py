"""The running machine of a scene: stepped in slices, given commands, seen through snapshots.

Nothing here knows of windows or browsers. A room is stepped as fast as one likes; the same commands
at the same ticks give the same motion, to the last bit.
"""

import dataclasses
from collections.abc import Iterable

from twin.errors import TwinError, UsageError
from twin.machine.simulation.live import LiveMachine, moving
from twin.nc.canonical import FloatArray
from twin.nc.functions import SPINDLE_LIMITED, SpindleState
from twin.nc.iso.base import jog_block
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.nc.text.source import Source, source_from_text
from twin.recording.alarms import Alarm, AlarmCode, AlarmStandsError
from twin.recording.reader import Samples
from twin.training.program.program_run import ProgramRun
from twin.training.program.run_options import RunOptions
from twin.training.room.control.auxiliaries import Auxiliaries
from twin.training.room.control.manual_motion import JogMove, ManualMotion
from twin.training.room.control.panel import Panel
from twin.training.room.control.program_memory import ProgramMemory
from twin.training.room.control.program_slot import Kind, ProgramSlot
from twin.training.room.control.tables import Tables
from twin.training.room.faults import Faults
from twin.training.room.judging.alarm_log import AlarmLog
from twin.training.room.judging.inspection import PartInspection, inspect_part, moment_of
from twin.training.room.judging.judge import Judge
from twin.training.room.observed import RoomAlarm
from twin.training.room.rest import Rest
from twin.training.room.run_settings import run_settings
from twin.training.room.setup.setup import Setup, scene_tables
from twin.training.scene.scene_file import Scene

SLICE = 10
"""Servo periods between two looks at the panel: 10 ms at 1 kHz. Time goes on by whole slices, so that
a session that is lived again has its commands, its cuts and its ends at the same borders."""


class Room:
    """The machine of a scene while it runs; each of its parts changes by its own methods alone.

    Attributes:
        alarms: Alarms and broken tools.
        rest: Whether the machine rests, and need not be computed.
        tick: Servo periods since the beginning.
        handed_in: The part as it was when the scene was judged; None: it has not been.
    """

    def __init__(self, scene: Scene) -> None:
        """Switch the machine of a scene on.

        Raises:
            ConfigError: The scene does not fit its machine.
        """
        preparation, file = scene.preparation, scene.file
        self.scene = scene
        self.machine, tables = _switched_on(scene)
        self.setup = Setup(scene, self.machine, tables)
        self.panel = Panel.at_start(file.start)
        self.program = ProgramMemory(preparation.source)
        self.slot = ProgramSlot(len(self.machine.machine.axes))
        self.manual = ManualMotion()
        spindle = preparation.spindle
        self.auxiliaries = Auxiliaries(
            dataclasses.replace(spindle, started=file.start.spindle, speed=file.start.speed)
        )
        self.alarms = AlarmLog()
        self.faults = Faults()
        self.judge = Judge(scene)
        self.rest = Rest()
        self.tick = 0
        self.samples = self.machine.hold(1)
        self.handed_in: PartInspection | None = None
        for fault in file.faults:
            self.faults.inject(self, fault)
        if file.start.alarm:
            left = self.alarms.begin_with(file.start.alarm)
            if left.code == "hard-limit":
                self.machine.raise_alarm("hard-limit", left.message)

    @property
    def time_s(self) -> float:
        """Machine time since the beginning [s]."""
        return self.tick * self.machine.machine.file.servo_period_s

    @property
    def slice_s(self) -> float:
        """Length of a slice [s]."""
        return SLICE * self.machine.machine.file.servo_period_s

    @property
    def alarm(self) -> RoomAlarm | None:
        """The alarm that has not been cleared."""
        return self.alarms.active

    @property
    def line(self) -> int:
        """Source line of the program that runs, or behind which it waits; 0: none."""
        return self.slot.line(self.machine.setpoint)

    @property
    def standing_setpoint(self) -> FloatArray:
        """Where the setpoints have come to, machine coordinates, shape (k,)."""
        return self.machine.setpoint.position[0].copy()

    def advance(self, slices: int = 1) -> None:
        """Let the machine go on by slices."""
        for _ in range(slices):
            self.tick += SLICE
            if self.slot.run is not None or not self.rest.lasts:
                self._step(SLICE)
            self.rest.look(self, self.slice_s)
            self.judge.look(self)
            if self.judge.over and self.handed_in is None:
                last = moment_of(self, RoomAlarm("", "", time_s=self.time_s))
                self.handed_in = inspect_part(self, last)

    def _step(self, count: int) -> None:
        spindle = self.auxiliaries.spindle
        self.setup.cut.turn(spindle, self.panel.spindle_override / 100.0)
        parts: list[Samples] = []
        if self.machine.alarm is None:
            setpoints = self.slot.drive(count, self.panel)
            if setpoints is not None and len(setpoints):
                parts.append(self.machine.follow(setpoints))
        missing = count - sum(map(len, parts))
        if missing:
            rest = self.machine.hold if self.machine.alarm is None else self.machine.brake
            parts.append(rest(missing))
        for part in parts:
            self._look_at(part)
        for function in self.slot.functions(self.samples.setpoint):
            self.turn_spindle(self.auxiliaries.spindle.after(function), function.line)
            self.auxiliaries.follow(function)
        self.slot.relabel(self.machine.setpoint)
        self._latch(self.machine.alarm)
        if self.setup.finder is not None and self.setup.finder.broken:
            self.alarms.note_broken(self.setup.finder.number)
        for found in self.setup.cut.new_breaks():
            line = found.alarm.line if self.slot.running == "program" else 0
            notice = RoomAlarm(found.alarm.code, found.alarm.message, line=line)
            self.alarms.note_break(self, found.tool, notice)
        self._end_of_part()

    def _look_at(self, part: Samples) -> None:
        """Cut along samples; what must not be cut raises an alarm."""
        if not len(part):
            return
        self.samples = part = self.setup.warm(part)
        if self.setup.work is None or self.machine.alarm is not None:
            return
        self.auxiliaries.run_down(axes_move=moving(part))
        edges_stand = self.auxiliaries.edges_stand
        alarm = self.setup.cut_along(part, self.slot.run, edges_stand=edges_stand)
        _halt(self.machine, alarm)

    def turn_spindle(self, state: SpindleState, line: int = 0) -> None:
        """Change what the spindle is commanded; a speed that is limited is a warning, and stops nothing."""
        limit = state.limit_of(state.speed)
        if limit and state.speed != self.auxiliaries.spindle.speed:
            self.alarms.warn(self, RoomAlarm(SPINDLE_LIMITED, limit, line=line))
        self.auxiliaries.turn(state)

    def _latch(self, alarm: Alarm | None) -> None:
        # An axis that is jogged off its switch may meet the next alarm while the first one is active.
        if alarm is not None and (self.alarm is None or self.slot.run is not None):
            # A move by hand is a block of its own, which nobody has written.
            line = 0 if self.slot.running == "jog" else alarm.line
            self.raise_alarm(
                RoomAlarm(alarm.code, alarm.message, alarm.axis, line, between=alarm.between)
            )

    def raise_alarm(self, notice: RoomAlarm) -> None:
        """The control stops everything and gives the reason; the first alarm counts."""
        self.alarms.activate(self, notice)
        self.give_up()
        self.auxiliaries.stop()

    def _end_of_part(self) -> None:
        """What comes when the present part of a program has come to its end."""
        slot, run = self.slot, self.slot.run
        if run is None or slot.waiting or not run.finished:
            return
        if self.machine.alarm is None:
            _halt(self.machine, self.setup.catch_up())
            self._latch(self.machine.alarm)
        if slot.run is None:
            return
        reader = run.reader
        ending = reader.ending
        self.judge.note_singly(self)
        # An MDI block has no use for a stop that is optional.
        passes_m1 = reader.optional and not (slot.running == "program" and self.panel.optional_stop)
        if run.dropped or ending in (None, "end"):
            self._end_of_run(run)
        elif ending == "wait" or (ending == "stop" and passes_m1):
            self.go_on(paused=ending == "stop" and self.panel.mode == "single")
        elif ending == "stop":
            slot.wait(waiting=True)
        elif ending == "tool":
            self.mount(reader.tool)
            self.go_on(paused=self.panel.mode == "single")
        else:
            assert ending is not None
            line, finding = reader.ending_line, reader.finding
            self.raise_alarm(RoomAlarm(ending, reader.message, line=line, finding=finding))

    def _end_of_run(self, run: ProgramRun) -> None:
        """A program, an MDI block or a move by hand is over."""
        slot = self.slot
        if slot.running == "jog":
            if not self.machine.moving:
                self.manual.finish_move()
                slot.drop(self.machine.setpoint)
                self._begin_jog()
            return
        if slot.running == "program" and not run.dropped:
            self.judge.note_end(self)
        elif slot.running == "mdi" and not run.dropped:
            slot.inherit()
        slot.drop(self.machine.setpoint)

    def start_run(self, source: Source, kind: Kind, options: RunOptions | None = None) -> None:
        """Interpret and drive a source from where the axes are.

        Raises:
            UsageError: It cannot be started now.
        """
        if self.machine.moving:
            raise UsageError("the axes still move")
        self.slot.reset_label()
        dialect = self.scene.preparation.dialect
        try:
            run = ProgramRun(
                source, dialect, run_settings(self), self.machine.machine, options or RunOptions()
            )
            self._begin_part(run)
            self.slot.begin(run, kind)
        except ProgramError as error:
            found = error.diagnostic
            message = f"{found.code}: {found.message}"
            self.raise_alarm(RoomAlarm("program", message, line=found.line, finding=found))
        except TwinError as error:
            self.raise_alarm(RoomAlarm("program", str(error)))

    def go_on(self, *, paused: bool = False) -> None:
        """Drive the part of the program that comes next; ``paused``: start is waited for."""
        assert self.slot.run is not None
        self.slot.wait(waiting=False)
        self._begin_part(self.slot.run, paused=paused)

    def _begin_part(self, run: ProgramRun, *, paused: bool = False) -> None:
        zero = self.setup.tables.program_zero
        run.begin(self.standing_setpoint, zero, self.auxiliaries.spindle, paused=paused)

    def give_up(self) -> None:
        """Forget what runs, what was held, and what was still to be driven by hand."""
        self.slot.drop(self.machine.setpoint)
        self.slot.forget_suspended()
        self.manual.clear()

    def drive_by_hand(self, moves: Iterable[JogMove]) -> None:
        """Drive axes one after the other.

        Where an axis is on its limit switch, the drives are switched on for it: the alarm
        is active until it has left the switch (Fagor 8070: with the limit overridden only jogging away
        is allowed; LinuxCNC: "Override Limits").

        Raises:
            UsageError: An axis moves.
        """
        if self.machine.moving:
            raise UsageError("the axes still move")
        if self.machine.alarm is not None:
            self.machine.clear()
        self.manual.plan(moves)
        self._begin_jog()

    def _begin_jog(self) -> None:
        """Begin the next move by hand."""
        found = self.manual.next_move(self.machine.machine, self.standing_setpoint)
        if found is not None:
            move, distance = found
            block = jog_block(self.scene.preparation.dialect, move.axis, distance, move.feed)
            # A jog is kept within the travel by itself, and leads back into it.
            options = RunOptions(soft_limits=False, typed=True)
            self.start_run(source_from_text(block, "jog"), "jog", options)

    def mount(self, number: int | None) -> None:
        """Put a tool of the scene into the spindle.

        Raises:
            UsageError: The scene has no such tool.
        """
        self.setup.mount(number)
        self.auxiliaries.mount(self.setup.tables.tool.speed)

    def stop_all(self, code: AlarmCode, message: str) -> None:
        """An alarm from outside that brings the axes to rest at once."""
        self.machine.raise_alarm(code, message)
        self._latch(self.machine.alarm)

    def clear(self) -> None:
        """Clear the alarm, at rest and with its cause gone.

        Raises:
            AlarmStandsError: An axis moves, or the button is still pressed.
        """
        if self.panel.stop_pressed:
            raise AlarmStandsError("the emergency stop button is pressed: turn it free first")
        axis = self.machine.on_limit_switch
        if self.alarm is not None and self.alarm.code == "hard-limit" and axis:
            raise AlarmStandsError(f"{axis} is on its limit switch: jog it back first")
        if self.machine.alarm is not None:
            self.machine.clear()
        elif self.machine.moving:
            raise AlarmStandsError("the axes still move: an alarm is cleared at rest")
        if self.alarm is not None:
            self.judge.note_cleared(self.alarm.code)
        self.alarms.clear()
        self.setup.forgive()

    def fail(self, message: str) -> None:
        """Something went wrong within the program that simulates: the axes brake, nothing ends."""
        self.machine.raise_alarm("emergency-stop", message)
        self.raise_alarm(RoomAlarm("internal", message))


def _halt(machine: LiveMachine, alarm: Alarm | None) -> None:
    """Stop at a cut that must not be."""
    if alarm is not None:
        machine.raise_alarm(alarm.code, alarm.message)


def _switched_on(scene: Scene) -> tuple[LiveMachine, Tables]:
    """The machine of a scene where its axes begin, and the tables of its control."""
    preparation, start = scene.preparation, scene.file.start
    machine, job = preparation.machine, preparation.job.file
    layout = preparation.layout
    zero, stand = layout.part_zero, layout.start + layout.part_zero
    for axis, value in start.position.items():
        stand[machine.axes.index(axis)] = value
    return LiveMachine(machine, job.tools[0], stand, layout.blank), scene_tables(scene, zero)
