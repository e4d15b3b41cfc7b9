"""A finished run as a machine that makes one part after the other, for the agent to observe.

The job is deterministic: each part is made by the same motion, so that it is simulated once and
its recording is gone through again and again. Nobody who reads can change a bit of it.
"""

import asyncio
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from twin.cutting.program_summary import ProgramSummary, Steps
from twin.machine.description.config import MachineConfig
from twin.nc.canonical import Chunk, FloatArray, Function
from twin.nc.functions import COOLANT_OFF, COOLANT_ON, PROGRAM_ENDS
from twin.recording.alarms import Alarm
from twin.recording.form import Samples
from twin.recording.reader import Recording, open_recording
from twin.serve.agent import Agent
from twin.serve.buffer import NORMAL, Condition, Value
from twin.serve.device import DOOR_CLOSED
from twin.toolpath.part_frame import PartFrame

TICK_S = 0.01
"""Machine time between two observations of the axes [s]."""
BEFORE_START_S = 1.0
"""How long the machine stays ready before each part [s]."""
STANDSTILL_S = 5.0
"""How long an alarm stays active before it is reset [s]."""
_WAKE_S = 0.02
"""Pause between two looks at the clock [s]."""
_TICKS_AT_ONCE = 100
"""Ticks that are due and are observed before clients are answered again: many clients slow the
machine's clock down by nothing as long as one round of answers takes less than this machine time."""
_PERCENT = 100.0
_AT_REST = {"path_feedrate": "0", "coolant_state": "INACTIVE"}
"""Behind a program's end, and behind an alarm, which closes the coolant too."""


class Production(NamedTuple):
    """What is made, and how a run of it went.

    Attributes:
        summary: What is in the spindle when, and how fast it turns.
        recording: Of the run; None where nothing moved.
        alarms: Of the run, in order.
        coolant: Whether it flows, by the number of the move.
    """

    machine: MachineConfig
    program: str
    source: Sequence[str]
    summary: ProgramSummary
    recording: Path | None
    alarms: tuple[Alarm, ...]
    coolant: Steps[bool] = Steps((0,), (False,))


class Tick(NamedTuple):
    """What is to be observed at a moment.

    Attributes:
        elapsed_s: Since the start [s].
        values: By data item.
        run_s: Where in the run of the part the machine is [s]; None: it does not run.
    """

    elapsed_s: float
    values: Mapping[str, Value]
    run_s: float | None = None


class Playhead:
    """Where in the run of its part the machine is.

    Attributes:
        time_s: The time [s].
    """

    def __init__(self) -> None:
        self.time_s = 0.0

    def move(self, tick: Tick) -> None:
        """The machine has come to another moment."""
        if tick.run_s is not None:
            self.time_s = tick.run_s


def coolant_of(chunks: Iterable[Chunk]) -> Steps[bool]:
    """Whether coolant flows, by the number of the move; it ends with the program."""
    first_move, flows, moves = [0], [False], 0
    for chunk in chunks:
        for event in chunk.events:
            if (
                isinstance(event, Function)
                and event.word in COOLANT_ON | COOLANT_OFF | PROGRAM_ENDS
            ):
                first_move.append(moves + event.before)
                flows.append(event.word in COOLANT_ON)
        moves += len(chunk.moves)
    return Steps(tuple(first_move), tuple(flows))


def ticks(production: Production) -> Iterator[Tick]:
    """The machine, part after part, without an end."""
    if production.recording is None:
        yield from _parts(production, None)
        return
    # It stays open: clients may have taken all the files that a process may open.
    with open_recording(production.recording) as recording:
        yield from _parts(production, recording)


def _parts(production: Production, recording: Recording | None) -> Iterator[Tick]:
    now, parts = 0.0, 0
    yield Tick(
        now,
        {
            "availability": "AVAILABLE",
            "coolant_state": "INACTIVE",
            "door_state": DOOR_CLOSED,
            "emergency_stop": "ARMED",
            "mode": "AUTOMATIC",
            # Nobody turns them in a job.
            "feed_override": "100",
            "rapid_override": "100",
            "spindle_override": "100",
            "program": production.program,
            "tool_number": str(production.summary.tools.at(0).number),
        },
    )
    while True:
        ready = {"execution": "READY", "system": NORMAL, "part_count": str(parts)}
        yield Tick(now, ready)
        now += BEFORE_START_S
        yield Tick(now, {"execution": "ACTIVE"})
        began = now
        for tick in _motion(production, recording):
            now = began + tick.elapsed_s
            yield Tick(now, tick.values, tick.elapsed_s)
        if production.alarms:
            alarm = production.alarms[0]
            now = max(now, began + alarm.time_s)
            fault = Condition("Fault", alarm.code, alarm.message)
            yield Tick(now, {"system": fault, "execution": "STOPPED", **_AT_REST})
            now += STANDSTILL_S
        else:
            parts += 1
            now += TICK_S
            yield Tick(now, {"execution": "PROGRAM_COMPLETED", **_AT_REST})
            now += TICK_S


def _motion(production: Production, recording: Recording | None) -> Iterator[Tick]:
    if recording is None:
        return
    every = max(1, round(TICK_S / recording.header.period_s))
    frame, before, seen = recording.header.part_frame, None, 0
    for samples in recording.chunks():
        thin = samples[slice(-seen % every, None, every)]
        seen += len(samples)
        if len(thin):
            yield from _ticks_of(production, thin, frame, before)
            before = thin[slice(-1, None)]


def _ticks_of(
    production: Production, samples: Samples, frame: PartFrame, before: Samples | None
) -> Iterator[Tick]:
    setpoint = samples.setpoint
    feed = _path_feed(samples, frame, before)
    axes = production.machine.axes.names
    limits = [production.machine.axis(name).force_limit for name in axes]
    for row in range(len(samples)):
        values: dict[str, Value] = {"path_feedrate": f"{feed[row]:.4f}"}
        for column, name in enumerate(axes):
            values[f"{name}_position"] = f"{samples.joint_position[row, column]:.6f}"
            values[f"{name}_position_commanded"] = f"{setpoint.position[row, column]:.6f}"
            if limits[column] > 0.0:
                load = _PERCENT * abs(samples.drive_force[row, column]) / limits[column]
                values[f"{name}_load"] = f"{load:.2f}"
        move, line = int(setpoint.move[row]), int(setpoint.line[row])
        values["line"] = str(line)
        if 0 < line <= len(production.source):
            values["block"] = production.source[line - 1].strip()
        values["tool_number"] = str(production.summary.tools.at(move).number)
        values["coolant_state"] = "ACTIVE" if production.coolant.at(move) else "INACTIVE"
        if samples.tool is not None:
            values["spindle_load"] = f"{_PERCENT * samples.tool.spindle_load[row]:.2f}"
        spindle = production.summary.spindle.at(move)
        if spindle is not None:
            values["spindle_speed"] = f"{spindle:g}"
        yield Tick(float(setpoint.time[row]), values)


def _path_feed(samples: Samples, frame: PartFrame, before: Samples | None) -> FloatArray:
    """How fast the tool moves over the part, from tick to tick, shape (n,) [mm/s]."""
    first = samples[slice(0, 1)] if before is None else before
    point = np.concatenate([frame.position(each.joint_position) for each in (first, samples)])
    distance = np.linalg.norm(np.diff(point, axis=0), axis=1)
    time = np.diff(samples.setpoint.time, prepend=first.setpoint.time)
    return np.divide(distance, time, out=np.zeros(len(distance)), where=time > 0.0)


async def feed(agent: Agent, machine: Iterator[Tick], playhead: Playhead | None = None) -> None:
    """Let an agent observe a machine, as the twin's clock goes on; ends when it is cancelled.

    Args:
        machine: What is to be observed, in order of time.
        playhead: Moves with it; None: nobody looks on.
    """
    for number, tick in enumerate(machine):
        while tick.elapsed_s > agent.clock.elapsed_s():
            await asyncio.sleep(_WAKE_S)
        if number % _TICKS_AT_ONCE == 0:
            await asyncio.sleep(0)
        agent.observe(tick.elapsed_s, tick.values)
        if playhead is not None:
            playhead.move(tick)
