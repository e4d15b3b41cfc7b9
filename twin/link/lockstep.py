"""The twin under a control that asks for a position every servo period and waits for the answer.

Time stands still while nobody asks, so that a stall on either side delays both and is none of the
machine's. The drives are sent positions only: velocity and acceleration are backward
differences of them. Commands are rounded as a recording rounds them before they are used, so that
a recording, played back, gives the joints of the run bit for bit.
"""

import dataclasses
import enum
import socket
import time
from collections.abc import Callable, Iterator
from typing import Self

import numpy as np

from twin.columns import join
from twin.link.packet import (
    ANSWER_LAYOUT,
    ANSWER_STATES,
    JOINTS,
    REASON_BYTES,
    REQUEST_LAYOUT,
    REQUEST_STATES,
    Answer,
    Request,
    read_request,
    write_answer,
)
from twin.link.place import Places
from twin.machine.simulation.live import LiveMachine
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray
from twin.recording.alarms import Alarm, AlarmStandsError, NearMiss
from twin.recording.form import STEPS, Samples
from twin.run.pipeline import MachineMotion


class SampleLog:
    """Remembers samples.

    Attributes:
        ticks: How many came in all.
        standing: For how many of the last ones nothing was to move.
    """

    def __init__(self, period_s: float) -> None:
        """Begin with none.

        Args:
            period_s: Time between two samples, the first of which is at 0 [s].
        """
        self.ticks = 0
        self.standing = 0
        self._period = period_s
        self._kept: list[Samples] = []

    def __len__(self) -> int:
        return len(self._kept)

    def add(self, sample: Samples) -> None:
        """Remember one sample."""
        self._kept.append(sample)
        self.ticks += 1
        self.standing = 0 if any(sample.setpoint.velocity[0].tolist()) else self.standing + 1

    def take(self, count: int) -> Samples:
        """Hand the first samples on, and forget them; of no move yet."""
        first = self.ticks - len(self._kept)
        samples = join(self._kept[:count])
        del self._kept[:count]
        time = np.arange(first, first + count) * np.float64(self._period)
        return dataclasses.replace(
            samples, setpoint=dataclasses.replace(samples.setpoint, time=time)
        )


_POSITION, _VELOCITY, _ACCELERATION = (
    STEPS[f"setpoint/{name}"] for name in ("position", "velocity", "acceleration")
)


class Commands:
    """Turns commanded positions into setpoints, with the velocities that a drive can know from them.

    Attributes:
        position: The last one, shape (k,) [mm or deg].
        velocity: Backward difference of the positions, shape (k,) [mm/s or deg/s].
        acceleration: Backward difference of the velocities, shape (k,) [mm/s² or deg/s²].
    """

    def __init__(self, period_s: float, position: FloatArray) -> None:
        """Begin at rest.

        Args:
            period_s: Time between two positions [s].
            position: Where, shape (k,) [mm or deg].
        """
        self._period = period_s
        self.rest_at(position)

    def rest_at(self, position: FloatArray) -> None:
        """Stand at a position."""
        self.position = rounded(position, _POSITION)
        self.velocity = np.zeros(len(position))
        self.acceleration = np.zeros(len(position))

    def go_to(self, position: FloatArray) -> None:
        """Take the next position, one period later."""
        goal = rounded(position, _POSITION)
        velocity = rounded((goal - self.position) / self._period, _VELOCITY)
        self.acceleration = rounded((velocity - self.velocity) / self._period, _ACCELERATION)
        self.position, self.velocity = goal, velocity


def rounded(values: FloatArray, step: float) -> FloatArray:
    """To multiples of a step, as a recording keeps them."""
    return np.rint(values / step) * step


TICKS_PER_CHUNK = 500
"""Samples that are handed on at once."""
SETTLING_S = 0.25
"""How long the end of a program is kept after its last motion [s]."""
LONGEST_SILENCE_S = 15.0
"""A control that is silent for so long after a request is gone [s]."""
_ASKED_S = 0.5
"""How often the control is looked after while it asks [s]."""
_WAKE_S = 0.2
"""Period at which the twin looks for the control while no request comes [s]."""
_LOOPBACK = "127.0.0.1"


class _Phase(enum.Enum):
    BEFORE = enum.auto()
    RUNNING = enum.auto()
    OVER = enum.auto()


class LockstepMotion(MachineMotion):
    """A machine that a control commands; iterate it for the samples of the control's program.

    The samples begin with the program, at rest at its start, and end a moment after its last
    motion, or with an alarm. The control is answered until it leaves.

    Attributes:
        alarm: What stopped the machine, None while nothing did.
        port: UDP port on this computer at which the twin answers.
        missed: How many questions never came, by their numbers.
        greatest_disagreement: Largest difference between the following error that the control saw
            and the one that is recorded for the same instant [mm or deg].
        left: Whether the control disconnected; it is no longer answered then.
        goes_on: Asked while nothing comes: whether the control is still there.
        last_word: Asked when the control has left, with the time [s] and the line at which the samples
            ended: the alarm that it raised itself.
    """

    def __init__(
        self, live: LiveMachine, places: Places, part_zero: FloatArray, *, session: bool = False
    ) -> None:
        """Listen.

        Args:
            live: The machine, at rest where the program starts.
            part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].
            session: Keep everything from the first question to the last, and not one program.

        Raises:
            OSError: There is no port.
        """
        self.alarm: Alarm | None = None
        self.answered, self.missed = 0, 0
        self.greatest_disagreement = 0.0
        self.goes_on: Callable[[], bool] = lambda: True
        self.last_word: Callable[[float, int], Alarm | None] = lambda _time, _line: None
        self._live = live
        self._places = places
        self._part_zero = part_zero
        self._period = live.machine.file.servo_period_s
        self._settled = round(SETTLING_S / self._period)
        self._count = len(live.machine.axes)
        self._no_joints = [0.0] * (JOINTS - self._count)
        self._everyone = (1 << self._count) - 1
        self._commands = Commands(self._period, live.position)
        self._session = session
        self._phase = _Phase.RUNNING if session else _Phase.BEFORE
        self._enabled, self.left = False, False
        self._log = SampleLog(self._period)
        self._line = self._source_line = 0
        self._sequence = 0
        self._reason, self._reason_number = b"", 0
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind((_LOOPBACK, 0))
        self._socket.settimeout(_WAKE_S)
        self.port = int(self._socket.getsockname()[1])

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._socket.close()

    @property
    def moment(self) -> tuple[float, int, FloatArray]:
        """Time [s], source line and machine coordinates (k,) of the machine now; read from any thread."""
        return self._log.ticks * self._period, self._source_line, self._live.position

    @property
    def near_miss(self) -> NearMiss | None:
        """The closest that the tool's side and the part's came without touching."""
        collided = self.alarm is not None and self.alarm.code == "collision"
        return None if collided else self._live.near_miss

    def __iter__(self) -> Iterator[Samples]:
        """Yield chunks of samples until the control has left."""
        question, answer = bytearray(REQUEST_LAYOUT.size + 1), bytearray(ANSWER_LAYOUT.size)
        view = memoryview(question)
        silent_s, control = 0.0, None
        looked = time.monotonic()
        while not self.left:
            if time.monotonic() - looked > _ASKED_S:
                looked = time.monotonic()
                if not self.goes_on():
                    break
            try:
                size, sender = self._socket.recvfrom_into(question)
            except TimeoutError:
                silent_s += _WAKE_S
                if not self.goes_on() or (self.answered and silent_s > LONGEST_SILENCE_S):
                    break
                continue
            request = read_request(view[:size])
            if request is None or sender != (control or sender):
                continue
            silent_s = 0.0
            control = sender  # The first that asks is the control; nobody else drives the machine.
            self._hear(request)
            write_answer(self._answer(), request.sequence, answer)
            self._socket.sendto(answer, sender)
            self.answered += 1
            if len(self._log) >= TICKS_PER_CHUNK and (self._session or not self._log.standing):
                yield self._handed_on(len(self._log))
        kept = len(self._log)
        if not self._session:
            kept -= max(0, self._log.standing - self._settled)
        if kept:
            yield self._handed_on(kept)
        self.alarm = self.alarm or self._live.alarm
        if self.alarm is None:
            self.alarm = self.last_word(self._log.ticks * self._period, self._source_line)
        else:
            self.alarm = dataclasses.replace(self.alarm, line=self._source_line)

    def stop(self, alarm: Alarm) -> None:
        """Stop for a reason from outside, such as the stock."""
        self._live.raise_alarm(alarm.code, alarm.message, axis=alarm.axis)
        self._tell(alarm)

    def _hear(self, request: Request) -> None:
        """Go one servo period on as the control asks."""
        self.left = bool(request.state & REQUEST_STATES["leaving"])
        self.missed += max(0, request.sequence - self._sequence - 1) if self._sequence else 0
        self._sequence = request.sequence
        position = np.array(request.command[: self._count])
        wanted = request.amplifiers & self._everyone == self._everyone
        wanted = wanted and bool(request.state & REQUEST_STATES["may_run"])
        if self._live.alarm is not None and request.state & REQUEST_STATES["reset"]:
            self._clear()
        self._enabled = self._enabled and wanted and self._live.alarm is None
        if self._enabled:
            self._follow(position, request)
            return
        if self._phase is _Phase.RUNNING and not self._session:
            self._end_program()
        if wanted and self._live.alarm is None:
            self._enabled = self._clear()
            self._commands.rest_at(position)
        samples = self._live.brake(1)
        if self._session:
            self._log.add(samples)

    def _clear(self) -> bool:
        """Switch the drives on where the axes are; returns whether they are at rest."""
        try:
            self._live.clear()
        except AlarmStandsError:
            return False
        self._reason = b""
        return True

    def _follow(self, position: FloatArray, request: Request) -> None:
        commands = self._commands
        if self._phase is _Phase.BEFORE and request.motion > 0 and request.line > 0:
            # As every run it begins at rest, so that it can be played back bit for bit.
            self._log.add(self._live.stand_at(commands.position))
            self._phase = _Phase.RUNNING
        running = self._phase is _Phase.RUNNING
        if self._line:
            asked, stood = commands.position.tolist(), self._live.position.tolist()
            for seen, command, place in zip(
                request.following_error[: self._count], asked, stood, strict=True
            ):
                differs = abs(seen - (command - place))
                self.greatest_disagreement = max(self.greatest_disagreement, differs)
        self._line = request.line if running else 0
        samples = self._step_to(position)
        if running:
            self._log.add(samples)
        if self._live.alarm is not None:
            self._tell(self._live.alarm)
            if running and not self._session:
                self.alarm, self._phase = self._live.alarm, _Phase.OVER

    def _end_program(self) -> None:
        """The drives were switched off; what stood by then is held until it has come to rest."""
        self._phase = _Phase.OVER
        if not self._log.standing or self._live.alarm is not None:
            return
        for _ in range(self._settled - self._log.standing):
            self._log.add(self._step_to(self._commands.position))
            if self._live.alarm is not None:
                self.alarm = self._live.alarm
                return

    def _step_to(self, position: FloatArray) -> Samples:
        """One servo period towards a commanded position."""
        commands = self._commands
        commands.go_to(position)
        setpoint = Setpoints(
            np.array([self._log.ticks * self._period]),
            np.array([self._line]),
            np.array([-1]),
            np.zeros(1),
            commands.position[None],
            commands.velocity[None],
            commands.acceleration[None],
        )
        return self._live.follow(setpoint)

    def _tell(self, alarm: Alarm) -> None:
        self._reason = str(alarm).encode()[: REASON_BYTES - 1]
        self._reason_number += 1

    def _answer(self) -> Answer:
        alarm = self._live.alarm
        feedback = [*self._live.position.tolist(), *self._no_joints]
        if alarm is None:
            state, faults = ANSWER_STATES["may_run"], 0
        else:
            names = self._live.machine.axes.names
            axis = names.index(alarm.axis) if alarm.axis in names else None
            state, faults = 0, self._everyone if axis is None else 1 << axis
        return Answer(state, faults, self._reason_number, self._reason, feedback)

    def _handed_on(self, count: int) -> Samples:
        """The first samples that nobody has yet, with their places in the program."""
        samples = self._log.take(count)
        setpoint = samples.setpoint
        place = setpoint.position - self._part_zero
        move, fraction, line = self._places.find(setpoint.line, place)
        self._source_line = int(line[-1])
        return dataclasses.replace(
            samples,
            setpoint=dataclasses.replace(setpoint, move=move, fraction=fraction, line=line),
        )
