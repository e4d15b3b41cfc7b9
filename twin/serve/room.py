"""An open training room as a machine for the agent to observe, read-only."""

import asyncio
import math
from collections.abc import Callable, Mapping
from typing import Literal

from twin.serve.agent import Agent
from twin.serve.buffer import NORMAL, Condition, Value
from twin.serve.device import DOOR_CLOSED
from twin.training.scene.scene_file import FaultTable
from twin.training.session.snapshot import Snapshot
from twin.units import SECONDS_PER_MINUTE

LOOK_S = 0.03
"""Time between two looks at the room, which takes its pages' pictures as often [s]."""
_PERCENT = 100.0
Execution = Literal["READY", "ACTIVE", "FEED_HOLD", "STOPPED"]
_MODES = {
    "auto": "AUTOMATIC",
    "single": "SEMI_AUTOMATIC",
    "jog": "MANUAL",
    "mdi": "MANUAL_DATA_INPUT",
}


class RoomObserver:
    """Turns looks at the room into values of data items, and counts the parts."""

    def __init__(self, program: str) -> None:
        self._program = program
        self._parts = 0
        self._was_running = False

    def values(self, now: Snapshot) -> Mapping[str, Value]:
        """Values by identifier of the data item."""
        running = now.running == "program"
        if self._was_running and not running and now.alarm is None:
            self._parts += 1
        self._was_running = running
        values: dict[str, Value] = {
            "availability": "AVAILABLE",
            "coolant_state": "ACTIVE" if now.coolant else "INACTIVE",
            "door_state": DOOR_CLOSED,
            "emergency_stop": "TRIGGERED" if now.pressed else "ARMED",
            "execution": _execution(now),
            "feed_override": str(now.feed_override),
            "rapid_override": str(now.rapid_override),
            "spindle_override": str(now.spindle_override),
            "line": str(now.line),
            "mode": _MODES[now.mode],
            "part_count": str(self._parts),
            "path_feedrate": f"{now.feed / SECONDS_PER_MINUTE:.4f}",
            "program": self._program,
            "spindle_speed": f"{abs(now.spindle.turning or 0.0):g}",
            "system": _condition(now),
            "tool_number": str(now.tool),
        }
        if math.isfinite(now.loads.spindle):
            values["spindle_load"] = f"{_PERCENT * now.loads.spindle:.2f}"
        if 0 < now.line <= len(now.program):
            values["block"] = now.program[now.line - 1].strip()
        rows = zip(now.axes, now.machine_position, now.following_error, now.load, strict=True)
        for name, position, behind, load in rows:
            values[f"{name}_position"] = f"{position:.6f}"
            values[f"{name}_position_commanded"] = f"{position + behind:.6f}"
            values[f"{name}_load"] = f"{_PERCENT * load:.2f}"
        return values


async def observe_room(agent: Agent, observer: RoomObserver, look: Callable[[], Snapshot]) -> None:
    """Let an agent observe a room until it is cancelled.

    Args:
        look: The last look at the room; taken on another thread, and never changed.
    """
    while True:
        agent.observe(agent.clock.elapsed_s(), observer.values(look()))
        await asyncio.sleep(LOOK_S)


def _execution(now: Snapshot) -> Execution:
    if now.alarm is not None:
        return "STOPPED"
    if now.running not in ("program", "mdi"):
        return "READY"
    return "FEED_HOLD" if now.held else "ACTIVE"


def _condition(now: Snapshot) -> Condition:
    """The alarm that is active, or else a fault that the trainer has put in, or nothing."""
    if now.alarm is not None:
        return Condition("Fault", now.alarm.code, now.alarm.message)
    if now.faults:
        return Condition("Warning", now.faults[-1].kind, _text_of(now.faults[-1]))
    return NORMAL


def _text_of(fault: FaultTable) -> str:
    where = f" of {fault.axis}" if fault.axis else ""
    return f"the trainer's fault: {fault.kind}{where}, {fault.value:g}"
