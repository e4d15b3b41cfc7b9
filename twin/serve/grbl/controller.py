"""A control that speaks Grbl 1.1, over the machine of a room.

All of it runs on the machine's own thread, between two slices of time: bytes in, bytes out. Lines of G code and jogs
become program runs of the room (``GrblStream``); everything else is done here.
"""

import time

from twin.errors import TwinError
from twin.nc.control.executor import Executor
from twin.nc.dialects.grbl.memory import GrblMemory, memory_of
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.nc.text.source import source_from_text
from twin.recording.alarms import AlarmStandsError
from twin.serve.grbl import realtime
from twin.serve.grbl.codes import Error, alarm_of
from twin.serve.grbl.reports import BUILD, HELP, WELCOME, ParserState, ReportWriter, parser_state
from twin.serve.grbl.serial_buffer import SerialBuffer, cleaned
from twin.serve.grbl.settings import GrblSettings
from twin.serve.grbl.stream import MOST_AHEAD, GrblStream
from twin.training.program.program_run import ProgramRun
from twin.training.program.run_options import Inherited, RunOptions
from twin.training.room.room import Room
from twin.training.room.run_settings import run_settings
from twin.training.session import commands as c
from twin.training.session.actions import carry_out

NO_PROGRAM = source_from_text("", "grbl")
"""What a run of streamed blocks has for a source."""
_ANYTIME = frozenset(("$", "$$", "$G", "$I", "$N", "$#", "$X"))
"""Commands that change nothing, or that free a machine which is locked."""


class GrblController:
    """One control; one sender talks to it."""

    def __init__(self, room: Room) -> None:
        self.serial = SerialBuffer()
        self.settings = GrblSettings(room.machine.machine)
        self._reporter = ReportWriter(self.settings)
        self._out: list[str] = []
        self._stream: GrblStream | None = None
        self._run: ProgramRun | None = None
        self._left: Inherited | None = None
        self._checking: Executor | None = None
        self._locked = self._halted = self._homing = self._door = False
        self._reported_lost = 0
        self._reset_state(room, None)

    # --- what the line asks for

    def welcome(self) -> bytes:
        """What is sent to a sender that has just come; a line that another one has not ended is forgotten."""
        self.serial.forget_open()
        self._greet()
        return self._take_output()

    def _greet(self) -> None:
        self._out.append(WELCOME)
        if self._locked:
            self._tell("'$H'|'$X' to unlock")
        self._reporter.refresh()

    def work(self, room: Room, data: bytes = b"") -> bytes:
        """Take bytes from the line and carry out what the machine is ready for; the bytes to send."""
        if data and self._stream is not None:
            self._stream.last_received = time.monotonic()
        for command in self.serial.receive(data):
            if command == realtime.RESET:
                self._reset(room)
            elif command == realtime.STATUS:
                self._out.append(self._status(room))
            elif not self._halted:
                realtime.obey(room, command, jogging=self._jogs)
                self._door = self._door_behind(command)
        if self.serial.lost > self._reported_lost:
            self._tell(f"the serial buffer ran over: {self.serial.lost} bytes are lost")
        self._reported_lost = self.serial.lost
        self._look(room)
        if not self._halted:
            self._run_lines(room)
        if self._run is not None and room.slot.run is self._run and not room.slot.held:
            # Not with the next slice of time: senders wait for each answer.
            self._run.take_streamed()
            self._look(room)
        return self._take_output()

    def _take_output(self) -> bytes:
        lines, self._out = self._out, []
        return "".join(f"{line}\r\n" for line in lines).encode("ascii", "replace")

    def _tell(self, text: str) -> None:
        self._out.append(f"[MSG:{text}]")

    def _answer(self, error: Error | None) -> None:
        self._out.append("ok" if error is None else f"error:{error:d}")

    def _door_behind(self, command: int) -> bool:
        return command == realtime.DOOR or (self._door and command != realtime.START)

    # --- state

    @property
    def _jogs(self) -> bool:
        return self._stream is not None and self._stream.jogging

    def _state(self, room: Room) -> str:
        """The machine's state, in Grbl's words."""
        if self._locked or self._halted:
            return "Alarm"
        if self._homing:
            return "Home"
        if self._checking is not None:
            return "Check"
        if room.slot.run is None and not room.machine.moving:
            return "Idle"
        if room.slot.held:
            kind = "Door" if self._door else "Hold"
            return f"{kind}:{int(room.machine.moving)}"
        return "Jog" if self._jogs else "Run"

    def _status(self, room: Room) -> str:
        ahead = self._run.moves_ahead if self._run is not None else 0
        free = (max(MOST_AHEAD - ahead, 0), self.serial.free)
        return self._reporter.status(self._state(room), room, self._parser.memory, free)

    @property
    def _parser(self) -> ParserState:
        """What is in force behind the last block."""
        executor = self._stream.executor if self._stream is not None else self._checking
        if executor is not None:
            control, motion = executor.control, executor.control.motion
            return ParserState(
                control.modal, motion.feed or 0.0, motion.spindle or 0.0, memory_of(control)
            )
        assert self._left is not None
        memory = self._left.memory
        assert isinstance(memory, GrblMemory)
        return ParserState(
            self._left.modal, self._left.feed or 0.0, self._left.spindle or 0.0, memory
        )

    def _new_control(self, room: Room) -> Executor:
        executor = Executor(room.scene.preparation.dialect, run_settings(room), NO_PROGRAM)
        executor.prepare()
        return executor

    def _reset_state(self, room: Room, memory: GrblMemory | None) -> None:
        """What is in force behind a reset: coordinate systems and stored positions stay, G92 and G43.1 go."""
        control = self._new_control(room).control
        fresh = memory_of(control)
        if memory is not None:
            fresh.systems, fresh.homes = memory.systems, memory.homes
        shifts = [list(shift) for shift in control.frame.shifts]
        self._left = Inherited(control.modal.fork(), shifts, None, None, fresh)

    # --- what happens by itself

    def _look(self, room: Room) -> None:
        """Send answers; notice the end of a run, and alarms."""
        if self._stream is not None:
            self._out += self._stream.answers
            self._stream.answers.clear()
            if room.slot.run is not self._run:
                assert self._run is not None
                self._left = self._run.reader.left()
                self._stream = self._run = None
        if room.alarm is not None and not self._locked and not self._halted:
            self._out.append(f"ALARM:{alarm_of(room.alarm.code):d}")
            self._tell(f"{room.alarm.code}: {room.alarm.message}")
            self._tell("Reset to continue")
            self._halted, self._homing = True, False
        if (
            self._homing
            and room.slot.run is None
            and not room.manual.moves
            and not room.machine.moving
        ):
            self._homing = False
            self._answer(None)

    def _reset(self, room: Room) -> None:
        """Ctrl-X: while axes move that is an alarm, since steps are lost."""
        memory = self._parser.memory
        if room.machine.moving and room.alarm is None:
            room.stop_all("emergency-stop", "reset while the axes moved")
            self._out.append(f"ALARM:{alarm_of('emergency-stop'):d}")
        self._locked = room.alarm is not None
        room.give_up()
        realtime.stop_all(room)
        self._stream = self._run = self._checking = None
        self._halted = self._homing = self._door = False
        self._reset_state(room, memory)
        self._greet()

    # --- lines

    def _run_lines(self, room: Room) -> None:
        """Do what the lines ask for that come next and are no blocks; begin a run where blocks come."""
        while not self._homing and (head := self.serial.head) is not None:
            text = cleaned(head)
            if text.startswith("$J="):
                if not self._begin_or_refuse(room, jogging=True):
                    return
            elif text.startswith("$"):
                if self._stream is not None and text not in _ANYTIME:
                    if not self._refuse_unless_idle(room):
                        return
                    continue
                self.serial.pop()
                self._command(room, text)
            elif self._locked:
                self.serial.pop()
                self._answer(Error.LOCKED)
            elif self._checking is not None:
                self._check_line(self._checking)
            elif not self._begin_or_refuse(room, jogging=False):
                return

    def _refuse_unless_idle(self, room: Room) -> bool:
        """Refuse a command that wants a machine at rest; False: the blocks before it are not interpreted yet."""
        assert self._stream is not None
        self.serial.pop()
        self._answer(Error.NOT_IDLE)
        return room.slot.run is not None

    def _begin_or_refuse(self, room: Room, *, jogging: bool) -> bool:
        """Begin a run for the next line, or refuse it; False: it waits for its turn."""
        if self._stream is not None:
            if self._stream.jogging == jogging:
                return False  # The run takes it.
            self.serial.pop()
            self._answer(Error.NOT_IDLE if jogging else Error.LOCKED)
            return True
        if jogging and (self._locked or self._checking is not None):
            self.serial.pop()
            self._answer(Error.NOT_IDLE)
            return True
        if room.slot.run is not None or room.machine.moving:
            return False
        stream = GrblStream(self.serial, room.machine.machine, jogging=jogging)
        room.panel.select("mdi")
        options = RunOptions(inherited=self._left, stream=stream, soft_limits=not jogging)
        room.start_run(NO_PROGRAM, "mdi", options)
        if room.slot.run is not None:
            self._stream, self._run = stream, room.slot.run
        return False

    def _command(self, room: Room, text: str) -> None:
        """A line that begins with $."""
        simple = {"$$": self.settings.lines, "$I": lambda: list(BUILD), "$": lambda: [HELP],
                  "$N": lambda: ["$N0=", "$N1="]}  # fmt: skip
        if text in simple:
            self._out += simple[text]()
            self._answer(None)
        elif text == "$G":
            self._out.append(
                parser_state(
                    self._parser, room.auxiliaries.spindle, coolant=room.auxiliaries.coolant
                )
            )
            self._answer(None)
        elif text == "$#":
            self._out += self._reporter.parameters(room, self._parser.memory)
            self._answer(None)
        elif text == "$X":
            self._unlock(room)
        elif text == "$H":
            self._home(room)
        elif text == "$C":
            self._check_mode(room)
        elif text in ("$N0=", "$N1="):
            self._answer(None)
        elif text[1:2].isdigit():
            self._answer(self.settings.write(text[1:]))
        else:
            self._answer(Error.INVALID_STATEMENT)

    def _unlock(self, room: Room) -> None:
        if self._locked:
            try:
                room.clear()
            except AlarmStandsError as error:
                if not room.machine.on_limit_switch:
                    self._tell(str(error))
                    self._answer(Error.NOT_IDLE)
                    return
                # As in Grbl, the axis is jogged off its switch then.
                room.machine.clear()
                room.alarms.clear()
            self._locked = False
            self._tell("Caution: Unlocked")
        self._answer(None)

    def _home(self, room: Room) -> None:
        if self._locked:
            self._unlock(room)
            self._out.pop()
            if self._locked:
                self._out.append(f"error:{Error.NOT_IDLE:d}")
                return
        room.panel.select("jog")
        try:
            carry_out(room, c.Reference())
        except TwinError as error:
            self._tell(str(error))
            self._answer(Error.NOT_IDLE)
            return
        self._homing = True

    def _check_mode(self, room: Room) -> None:
        if self._checking is not None:
            self._answer(None)
            self._tell("Disabled")
            self._reset(room)
            return
        if self._locked:
            self._answer(Error.NOT_IDLE)
            return
        assert self._left is not None
        executor = self._new_control(room)
        memory = self._left.memory
        assert isinstance(memory, GrblMemory)
        executor.control.memory = memory.fork()
        executor.control.modal.restore(self._left.modal)
        self._checking = executor
        self._check_stream = GrblStream(self.serial, room.machine.machine, jogging=False)
        self._tell("Enabled")
        self._answer(None)

    def _check_line(self, executor: Executor) -> None:
        """Interpret the next line, and drive nothing."""
        stream = self._check_stream
        block = stream.next(executor, 0)
        if block is not None:
            try:
                executor.run(block)
            except ProgramError as error:
                stream.refuse(executor, error.diagnostic)
            else:
                stream.accept(executor)
            executor.control.path.columns.take()
        self._out += stream.answers
        stream.answers.clear()
