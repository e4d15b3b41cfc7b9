"""What must hold before a command is carried out; each raises ``UsageError`` with what would help."""

from twin.errors import UsageError
from twin.training.room.room import Room


def require_no_alarm(room: Room) -> None:
    """No alarm is active."""
    if room.alarm is not None:
        raise UsageError(f"an alarm is active ({room.alarm.code}): reset first")


def require_no_run(
    room: Room, why: str = "the tables cannot change while something runs: reset first"
) -> None:
    """Nothing runs, nor is a program interrupted."""
    if not room.slot.empty:
        raise UsageError(why)


def require_jog(room: Room, axis: str) -> None:
    """An axis may be jogged; off its limit switch also while that alarm is active."""
    if room.panel.mode != "jog":
        raise UsageError("jogging needs the mode manual jog")
    column_of(room, axis)
    if room.alarm is None or room.alarm.code != "hard-limit" or room.panel.stop_pressed:
        require_no_alarm(room)
    elif room.machine.on_limit_switch not in ("", axis):
        raise UsageError(
            f"{room.machine.on_limit_switch} is on its limit switch: jog it back first"
        )


def require_still(room: Room) -> None:
    """Nothing runs, and no alarm is active."""
    require_no_alarm(room)
    if room.panel.mode != "jog":
        raise UsageError("that is done in the mode manual jog")
    if room.slot.run is not None or room.machine.moving:
        raise UsageError("the axes still move")


def column_of(room: Room, axis: str) -> int:
    """The column of an axis; the machine has it."""
    names = room.machine.machine.axes.names
    if axis not in names:
        raise UsageError(f"no axis '{axis}': the machine has {', '.join(names)}")
    return names.index(axis)
