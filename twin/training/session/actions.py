"""What each command does at the machine, and why it may be refused."""

from collections.abc import Callable
from typing import Any

import numpy as np

from twin.errors import UsageError
from twin.nc.functions import SpindleState
from twin.nc.iso.base import jog_block
from twin.nc.text.source import source_from_text
from twin.training.session import commands as c
from twin.training.session.faults import forget_offset, inject, repair
from twin.training.session.room import Room
from twin.units import SECONDS_PER_MINUTE

RESOLUTION = 1e-3
"""Way that counts as none when an axis is jogged [mm or deg]."""


def carry_out(room: Room, command: c.Command) -> None:
    """Do what a command asks for.

    Raises:
        TwinError: The machine refuses; the message says why. Nothing has changed then.
    """
    _ACTIONS[type(command)](room, command)


def _mode(room: Room, command: c.SelectMode) -> None:
    within = {"auto", "single"}
    if room.run is not None and not {room.mode, command.mode} <= within:
        raise UsageError("the mode cannot change while something runs: reset first")
    room.mode = command.mode


def _cycle_start(room: Room, _command: c.CycleStart) -> None:
    _require_no_alarm(room)
    if room.waiting:
        room.go_on()
    elif room.run is not None:
        room.run.start()
    elif room.mode == "jog":
        raise UsageError("cycle start does nothing in manual jog")
    elif room.mode == "mdi":
        if not room.entered.strip():
            raise UsageError("the MDI line is empty")
        room.start_run(source_from_text(room.entered, "MDI"), "mdi")
    else:
        room.judge.note_start()
        room.start_run(room.program, "program")


def _feed_hold(room: Room, _command: c.FeedHold) -> None:
    if room.run is None:
        raise UsageError("nothing runs")
    room.run.hold()
    room.judge.note_hold(room)


def _reset(room: Room, _command: c.Reset) -> None:
    if room.run is not None and not room.waiting:
        room.run.drop()
    elif room.run is not None:
        room.drop_run()
    if room.alarm is not None:
        room.clear()
    room.running_down = room.spindle.turns and room.moving
    room.spindle = room.spindle.stopped()


def _emergency_stop(room: Room, command: c.EmergencyStop) -> None:
    room.pressed = command.pressed
    if command.pressed:
        room.stop_all("emergency-stop", "the emergency stop button was pressed")
        room.coolant = False


def _override(room: Room, command: c.Override) -> None:
    if command.dial == "feed":
        room.feed_override = command.percent
    else:
        room.rapid_override = command.percent


def _jog(room: Room, command: c.Jog) -> None:
    _require_no_alarm(room)
    if room.mode != "jog":
        raise UsageError("jogging needs the mode manual jog")
    if room.run is not None:
        raise UsageError("an axis is being jogged already")
    machine = room.machine.machine
    column = _column(room, command.axis)
    distance = _within_travel(room, column, command)
    if abs(distance) < RESOLUTION:
        raise UsageError(f"{command.axis} stands at the end of its travel")
    feed = min(command.feed, SECONDS_PER_MINUTE * machine.axis(command.axis).velocity)
    block = jog_block(room.scene.preparation.dialect, command.axis, distance, feed)
    room.start_run(source_from_text(block, "jog"), "jog")


def _within_travel(room: Room, column: int, command: c.Jog) -> float:
    """How far a jog goes: its step, or to the end of the travel; never further out."""
    machine = room.machine.machine
    axis = machine.axis(command.axis)
    place = float(room.standing_setpoint[column])
    low, high = axis.travel or (-np.inf, np.inf)
    free = max(0.0, high - place) if command.direction > 0 else max(0.0, place - low)
    endless = 3600.0
    wanted = command.step if command.step is not None else endless
    return command.direction * min(wanted, free)


def _jog_stop(room: Room, _command: c.JogStop) -> None:
    if room.running == "jog" and room.run is not None:
        room.run.drop()


def _enter(room: Room, command: c.Enter) -> None:
    if room.mode != "mdi":
        raise UsageError("a block is typed in the mode MDI")
    room.entered = command.text


def _edit(room: Room, command: c.Edit) -> None:
    if room.run is not None:
        raise UsageError("a program cannot be edited while something runs: reset first")
    lines = list(room.lines)
    if command.line > len(lines) + 1:
        raise UsageError(f"the program has {len(lines)} lines")
    new = [] if command.text is None else command.text.split("\n")
    lines[command.line - 1 : command.line] = new
    room.program = source_from_text("\n".join(lines), room.program.name)
    room.lines = tuple(lines)


def _spindle(room: Room, command: c.Spindle) -> None:
    if command.on:
        _require_no_alarm(room)
    speed = room.spindle.speed if command.speed is None else command.speed
    room.spindle = SpindleState(started=command.on, speed=speed)


def _coolant(room: Room, command: c.Coolant) -> None:
    room.coolant = command.on


def _set_zero(room: Room, command: c.SetZero) -> None:
    column = _column(room, command.axis)
    _require_no_run(room)
    stands = float(room.machine.position[column])
    longer = float((room.tables.program_zero - room.tables.zero)[column])
    room.tables.zero[column] = stands - command.reading - longer
    forget_offset(room, command.axis)


def _set_offset(room: Room, command: c.SetOffset) -> None:
    _require_no_run(room)
    room.tables.zero[_column(room, command.axis)] = command.value
    forget_offset(room, command.axis)


def _set_tool(room: Room, command: c.SetTool) -> None:
    _require_no_run(room)
    room.tables.set_length(command.number, command.length)


def _answer(room: Room, command: c.Answer) -> None:
    room.judge.answer(command.task, command.choice)


def _hint(room: Room, _command: c.Hint) -> None:
    room.judge.ask_hint()


def _finish(room: Room, _command: c.Finish) -> None:
    room.judge.finish(room)


def _inject(room: Room, command: c.Inject) -> None:
    inject(room, command.fault)


def _repair(room: Room, _command: c.Repair) -> None:
    repair(room)


def _require_no_alarm(room: Room) -> None:
    if room.alarm is not None:
        raise UsageError(f"an alarm stands ({room.alarm.code}): reset first")


def _require_no_run(room: Room) -> None:
    if room.run is not None:
        raise UsageError("the tables cannot change while something runs: reset first")


def _column(room: Room, axis: str) -> int:
    names = room.machine.machine.axes.names
    if axis not in names:
        raise UsageError(f"no axis '{axis}': the machine has {', '.join(names)}")
    return names.index(axis)


_ACTIONS: dict[type, Callable[[Room, Any], None]] = {
    c.SelectMode: _mode,
    c.CycleStart: _cycle_start,
    c.FeedHold: _feed_hold,
    c.Reset: _reset,
    c.EmergencyStop: _emergency_stop,
    c.Override: _override,
    c.Jog: _jog,
    c.JogStop: _jog_stop,
    c.Enter: _enter,
    c.Edit: _edit,
    c.Spindle: _spindle,
    c.Coolant: _coolant,
    c.SetZero: _set_zero,
    c.SetOffset: _set_offset,
    c.SetTool: _set_tool,
    c.Answer: _answer,
    c.Hint: _hint,
    c.Finish: _finish,
    c.Inject: _inject,
    c.Repair: _repair,
}
