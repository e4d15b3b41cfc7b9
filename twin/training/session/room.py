"""The running machine of a scene: stepped in slices, told by commands, seen through snapshots.

Nothing here knows of windows or browsers. A room is stepped as fast as one likes; the same commands
at the same ticks give the same motion, to the last bit.
"""

import dataclasses
from typing import Any

import numpy as np

from twin.cutting.tools import default_cell
from twin.errors import TwinError, UsageError
from twin.job.job_file import StockTable
from twin.machine.model.model import spindle_over_table_mm
from twin.machine.simulation.live import STANDSTILL, LiveMachine
from twin.machine.watching.alarms import Alarm, AlarmCode, AlarmStandsError
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray, Function
from twin.nc.control.settings import ToolData
from twin.nc.functions import COOLANT_OFF, COOLANT_ON, PROGRAM_ENDS, SpindleState
from twin.nc.text.diagnostics import Diagnostic, ProgramError
from twin.nc.text.source import Source
from twin.recording.reader import Samples
from twin.run.placement import part_zero, start_position
from twin.training.scene.fault_table import FaultTable
from twin.training.scene.scene_file import Mode, Scene
from twin.training.session.faults import inject
from twin.training.session.judge import Judge
from twin.training.session.observed import Notice
from twin.training.session.program_run import ProgramRun
from twin.training.session.tables import Tables
from twin.training.session.workpiece import Workpiece

SLICE = 10
"""Servo periods between two looks at the panel: 10 ms at 1 kHz. Time goes on by whole slices, so that
a session that is lived again has its commands, its cuts and its ends at the same borders."""


class Room:
    """The machine of a scene while it runs.

    Attributes:
        scene: What is played.
        machine: The machine with its drives.
        tables: Part zero and tool lengths of its control.
        work: The stock, if there is one.
        judge: Looks after the tasks.
        tick: Servo periods since the beginning.
        mode: Where the mode switch stands.
        feed_override: Feed override dial [%].
        rapid_override: Rapid override dial [%].
        alarm: The alarm that stands.
        pressed: Whether the emergency stop button is pressed.
        spindle: Whether the spindle turns, and how fast.
        running_down: Whether the spindle, stopped by a reset, still turns while the axes brake.
        coolant: Whether coolant flows.
        program: The program as the operator has edited it.
        lines: Its lines.
        entered: What stands in the MDI line.
        run: The program, MDI block or jog that is being run.
        running: What is being run: ``program``, ``mdi``, ``jog``, or nothing.
        waiting: A program waits at a program stop.
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
        zero = part_zero(job, machine, spindle_over_table_mm(machine))
        self.tables = Tables(zero, job.tools)
        for axis, error in file.start.zero_error.items():
            self.tables.zero[machine.axes.index(axis)] += error
        self.tables.lengths[self.tables.spindle] += file.start.tool_length_error
        stand = start_position(job, machine) + zero
        for axis, value in file.start.position.items():
            stand[machine.axes.index(axis)] = value
        self.machine = LiveMachine(machine, job.tools[0], stand)
        rotary = machine.part_frame.rotary
        turn_zero = 0.0 if rotary is None else float(zero[rotary])
        self.part_frame = dataclasses.replace(machine.part_frame, turn_zero=turn_zero)
        self.work = None
        if job.stock is not None:
            head = self.machine.head.above_tip
            stock = _fine(job.stock, scene)
            self.work = Workpiece(stock, job.tools[0], self.part_frame, zero, head)
        self.mode: Mode = file.start.mode
        self.feed_override = file.start.feed_override
        self.rapid_override = file.start.rapid_override
        self.spindle = SpindleState(started=file.start.spindle)
        self.running_down = False
        self.coolant = False
        self.alarm: Notice | None = None
        self.pressed = False
        self.program: Source = preparation.source
        self.lines = tuple(preparation.source.lines)
        self.entered = ""
        self.run: ProgramRun | None = None
        self.running = ""
        self.waiting = False
        self.tick = 0
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
        return self.waiting or (self.run is not None and self.run.held)

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
    def slice_s(self) -> float:
        """Length of a slice [s]."""
        return SLICE * self.machine.machine.file.servo_period_s

    def advance(self, slices: int = 1) -> None:
        """Let the machine go on by slices."""
        for _ in range(slices):
            self._slice(SLICE)

    def _slice(self, count: int) -> None:
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
        self.tick += count
        self._pass_functions()
        self._relabel()
        self._latch(self.machine.alarm)
        self._end_of_part()
        self.judge.look(self)

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
        self.samples = part
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
        self.spindle = self.spindle.after(function)
        if function.word in PROGRAM_ENDS:
            self.spindle = self.spindle.stopped()
        if function.word in COOLANT_ON:
            self.coolant = True
        elif function.word in COOLANT_OFF | PROGRAM_ENDS:
            self.coolant = False

    def _latch(self, alarm: Alarm | None) -> None:
        if alarm is not None and self.alarm is None:
            self.raise_alarm(alarm.code, alarm.message, axis=alarm.axis, line=alarm.line)

    def raise_alarm(
        self,
        code: str,
        message: str,
        *,
        axis: str = "",
        line: int = 0,
        finding: Diagnostic | None = None,
    ) -> None:
        """The control stops everything and says why; the first alarm counts."""
        if self.alarm is None:
            self.alarm = Notice(code, message, axis, line, self.time_s, finding)
            self.judge.note_alarm(code)
        self.drop_run()
        self.spindle = self.spindle.stopped()

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
        if run.dropped or self.running == "jog" or ending in (None, "end"):
            if self.running == "program" and not run.dropped:
                self.judge.note_end(self)
            self.drop_run()
        elif ending == "wait":
            self.go_on()
        elif ending == "stop":
            self.waiting = True
        elif ending == "tool":
            self._change_tool(run)
        else:
            assert ending is not None
            self.raise_alarm(ending, run.message, line=run.ending_line, finding=run.finding)

    def _change_tool(self, run: ProgramRun) -> None:
        try:
            self.mount(run.tool)
        except TwinError as error:
            self.raise_alarm("program", str(error), line=run.ending_line)
        else:
            self.go_on()

    def start_run(self, source: Source, what: str) -> None:
        """Interpret and drive a source from where the axes stand.

        Raises:
            UsageError: It cannot be started now.
        """
        if self.moving:
            raise UsageError("the axes still move")
        self.label = np.zeros(len(self.label))
        preparation = self.scene.preparation
        try:
            settings = dataclasses.replace(preparation.settings, **self._situation())
            run = ProgramRun(
                source,
                preparation.dialect,
                settings,
                self.machine.machine,
                # A jog is kept within the travel by itself, and leads back into it.
                soft_limits=what != "jog",
            )
            run.begin(self.standing_setpoint, self.tables.program_zero)
            self.run, self.running, self.waiting = run, what, False
        except ProgramError as error:
            found = error.diagnostic
            message = f"{found.code}: {found.message}"
            self.raise_alarm("program", message, line=found.line, finding=found)
        except TwinError as error:
            self.raise_alarm("program", str(error))

    def _situation(self) -> dict[str, Any]:
        """What the interpreter must know of the machine as it stands."""
        names = self.machine.machine.axes.names
        zero = self.tables.program_zero
        reference = self.tables.tool.length
        # The panel's control takes the length of the tool in the spindle from its table by itself.
        tools = {
            number: ToolData(radius=tool.diameter / 2.0, length=reference)
            for number, tool in sorted(
                self.tables.tools.items(), key=lambda item: item[0] != self.tables.spindle
            )
        }
        start = self.standing_setpoint - zero
        return {
            "start": dict(zip(names, map(float, start), strict=True)),
            "tools": tools,
            "machine_zero": dict(zip(names, map(float, -zero), strict=True)),
        }

    def go_on(self) -> None:
        """Drive the part of the program that comes next."""
        assert self.run is not None
        self.waiting = False
        self.run.begin(self.standing_setpoint, self.tables.program_zero)

    def drop_run(self) -> None:
        """Forget what runs; the axes slow down where they are."""
        self.run, self.running, self.waiting = None, "", False

    def mount(self, number: int | None) -> None:
        """Put a tool of the scene into the spindle.

        Raises:
            UsageError: The scene has no such tool.
        """
        if number not in self.tables.tools:
            raise UsageError(f"no tool {number}")
        self.tables.spindle = number
        self.machine.mount(self.tables.tool)
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
        if self.machine.alarm is not None:
            self.machine.clear()
        elif self.moving:
            raise AlarmStandsError("the axes still move: an alarm is cleared at rest")
        if self.alarm is not None:
            self.judge.note_cleared(self.alarm.code)
        self.alarm = None
        if self.work is not None:
            self.work.forgive()

    def fail(self, message: str) -> None:
        """Something went wrong within the program that simulates: the axes brake, nothing ends."""
        self.machine.raise_alarm("emergency-stop", message)
        self.raise_alarm("internal", message)

    def _begin_in_alarm(self, code: str) -> None:
        """Begin as the last shift left the machine."""
        message = "the machine was left in this state"
        if code == "hard-limit":
            message = "an axis stands on its limit switch"
            self.machine.raise_alarm("hard-limit", message)
        self.alarm = Notice(code, message, "", 0, 0.0)


def _fine(stock: StockTable, scene: Scene) -> StockTable:
    """The stock with a grid that is as fine as the scene is looked at closely."""
    cell = stock.cell or default_cell(scene.preparation.job.file.tools, stock)
    if scene.cells_across:
        cell = min(cell, min(stock.extent[:2]) / scene.cells_across)
    return stock.model_copy(update={"cell": cell})
