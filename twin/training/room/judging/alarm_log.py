"""The alarms of a room: the active one, those that came, and what the score sheet shows of them."""

import dataclasses
from collections import deque

from twin.training.room.judging.inspection import AlarmMoment, moment_of
from twin.training.room.observed import Observed, RoomAlarm, block_number

ALARMS_KEPT = 50
"""Alarms that the history shows."""
MOMENTS_KEPT = 12
"""Alarms that the score sheet has pictures of."""

LEFT_IN_ALARM = "the machine was left in this state"


class AlarmLog:
    """Alarms and broken tools; other files read it and call its methods.

    Attributes:
        active: The alarm that has not been cleared; None: there is none.
        history: Those that came, the newest last.
        moments: How the tool was in the part at each of them.
        broken: Tools that have lost their edge, by number, with the alarm of each.
    """

    def __init__(self) -> None:
        self.active: RoomAlarm | None = None
        self.history: deque[RoomAlarm] = deque(maxlen=ALARMS_KEPT)
        self.moments: deque[AlarmMoment] = deque(maxlen=MOMENTS_KEPT)
        self.broken: dict[int, RoomAlarm] = {}

    def begin_with(self, code: str) -> RoomAlarm:
        """The last shift has left the machine with an alarm."""
        on_switch = code == "hard-limit"
        message = "an axis is on its limit switch" if on_switch else LEFT_IN_ALARM
        self.active = RoomAlarm(code, message)
        self.history.append(self.active)
        return self.active

    def enter(self, room: Observed, notice: RoomAlarm) -> RoomAlarm:
        """Enter what went wrong into the history, for score sheet and judge too.

        Returns:
            The notice with its time, its block and its place.
        """
        notice = _located(room, notice)
        moment = moment_of(room, notice)
        notice = dataclasses.replace(notice, place=tuple(moment.tip.tolist()))
        self.history.append(notice)
        self.moments.append(moment)
        room.judge.note_alarm(notice.code)
        return notice

    def activate(self, room: Observed, notice: RoomAlarm) -> None:
        """An alarm that has to be cleared; the first one counts."""
        if self.active is None:
            self.active = self.enter(room, notice)

    def warn(self, room: Observed, notice: RoomAlarm) -> None:
        """Enter what stops nothing."""
        self.history.append(_located(room, notice))

    def note_break(self, room: Observed, tool: int, notice: RoomAlarm) -> None:
        """A tool has lost its edge: the machine does not measure it, and goes on without."""
        self.broken[tool] = self.enter(room, notice)

    def note_broken(self, tool: int) -> None:
        """The active alarm is about a tool that has broken."""
        if self.active is not None:
            self.broken.setdefault(tool, self.active)

    def renew_tool(self, number: int) -> None:
        """A new tool has come into the place of one that may have lost its edge."""
        self.broken.pop(number, None)

    def clear(self) -> None:
        """The active alarm is cleared."""
        self.active = None


def _located(room: Observed, notice: RoomAlarm) -> RoomAlarm:
    """A notice with the time and the block at which it comes."""
    running = room.slot.running
    of_program = running == "program" or (running == "" and notice.line > 0)
    dialect = room.scene.preparation.dialect
    block = block_number(dialect, room.program.source, notice.line) if of_program else ""
    return dataclasses.replace(notice, time_s=room.time_s, block=block)
