"""Real-time commands of Grbl 1.1: single bytes that are carried out before the buffer."""

from typing import Literal

from twin.errors import TwinError
from twin.training.room.room import Room
from twin.training.scene.scene_file import FEED_OVERRIDES, SPINDLE_OVERRIDES
from twin.training.session import commands as c
from twin.training.session.actions import carry_out

STATUS, HOLD, START, RESET = b"?!~\x18"
DOOR, CANCEL_JOG = 0x84, 0x85
_SPINDLE_STOP, _FLOOD, _MIST = 0x9E, 0xA0, 0xA1
_Dial = Literal["feed", "rapid", "spindle"]
_FULL = 100
_SET: dict[int, tuple[_Dial, int]] = {
    0x90: ("feed", _FULL),
    0x95: ("rapid", _FULL),
    0x96: ("rapid", 50),
    0x97: ("rapid", 25),
    0x99: ("spindle", _FULL),
}
_CHANGE: dict[int, tuple[_Dial, int]] = {
    0x91: ("feed", 10),
    0x92: ("feed", -10),
    0x93: ("feed", 1),
    0x94: ("feed", -1),
    0x9A: ("spindle", 10),
    0x9B: ("spindle", -10),
    0x9C: ("spindle", 1),
    0x9D: ("spindle", -1),
}
_LEAST_FEED = 10
"""``MIN_FEED_RATE_OVERRIDE`` [%]; the greatest is that of the twin's own dials."""


def obey(room: Room, command: int, *, jogging: bool) -> None:
    """Carry out a real-time command; one that does not apply now is ignored, as in Grbl."""
    try:
        if command in (HOLD, DOOR, CANCEL_JOG):
            _hold(room, command, jogging=jogging)
        elif command == START:
            _start(room)
        elif command in _SET:
            dial, percent = _SET[command]
            carry_out(room, c.Override(dial=dial, percent=percent))
        elif command in _CHANGE:
            _change(room, *_CHANGE[command])
        elif command == _SPINDLE_STOP and room.slot.held and not room.machine.moving:
            room.turn_spindle(room.auxiliaries.spindle.stopped())
        elif command in (_FLOOD, _MIST) and room.alarm is None:
            room.auxiliaries.switch_coolant(on=not room.auxiliaries.coolant)
    except TwinError:
        return


def stop_all(room: Room) -> None:
    """What a reset does to spindle, coolant and overrides."""
    room.turn_spindle(room.auxiliaries.spindle.stopped())
    room.auxiliaries.switch_coolant(on=False)
    room.panel.reset_dials()


def _hold(room: Room, command: int, *, jogging: bool) -> None:
    """Hold a program; a jog is cancelled."""
    if room.slot.run is None:
        return
    if jogging:
        room.slot.run.drop()
    elif command != CANCEL_JOG:
        carry_out(room, c.FeedHold())


def _start(room: Room) -> None:
    if room.slot.run is not None and room.slot.held:
        carry_out(room, c.CycleStart())


def _change(room: Room, dial: _Dial, change: int) -> None:
    now = room.panel.feed_override if dial == "feed" else room.panel.spindle_override
    least, most = (_LEAST_FEED, FEED_OVERRIDES[1]) if dial == "feed" else SPINDLE_OVERRIDES
    carry_out(room, c.Override(dial=dial, percent=min(max(now + change, least), most)))
