"""The action of each command, and the reasons to refuse it."""

import dataclasses
from collections.abc import Callable
from typing import Any

from twin.errors import UsageError
from twin.job.job_file import ToolTable
from twin.nc.text.source import source_from_text
from twin.training.program.run_options import RunOptions
from twin.training.room.control.manual_motion import SHORTEST_MOVE, JogMove, within_travel
from twin.training.room.room import Room
from twin.training.session import commands as c
from twin.training.session.requirements import (
    column_of,
    require_jog,
    require_no_alarm,
    require_no_run,
    require_still,
)
from twin.units import SECONDS_PER_MINUTE

DRY_RUN_FEED = 3000.0
"""What all feeds are replaced by in a dry run [mm/min]."""
HAND_FEED = 2000.0
"""Of the handwheel, of the moves to the reference point and back to the path [mm/min or deg/min]."""
_NO_TOUCH = (c.Sign, c.AnswerQuestion, c.Hint, c.Inject, c.Repair)
"""What does not begin a scene's time."""
ENDLESS = 3600.0
"""How far a jog goes at most that lasts while its key is held [mm or deg]."""
LONGEST_FLUTE = 25.0
"""Cutting part of a tool that is added [mm]; of a short one half its length."""
REFERENCE = 0.0
"""Machine coordinate of the reference point of every axis."""


def carry_out(room: Room, command: c.Command) -> None:
    """Carry out a command.

    Raises:
        TwinError: The machine refuses, for the reason in the message. Nothing has changed then.
    """
    _ACTIONS[type(command)](room, command)
    room.rest.wake()
    if not isinstance(command, _NO_TOUCH):
        room.judge.note_touch(room)


def _mode(room: Room, command: c.SelectMode) -> None:
    within, slot = {"auto", "single"}, room.slot
    if slot.run is not None and not {room.panel.mode, command.mode} <= within:
        held = slot.running == "program" and (slot.run.held or slot.waiting)
        if command.mode != "jog" or not held or room.machine.moving:
            raise UsageError("the mode cannot change while something runs: reset first")
        slot.suspend(room.machine.setpoint)
    if slot.suspended is not None and command.mode == "mdi":
        raise UsageError("a program is held: reset first")
    room.panel.select(command.mode)


def _cycle_start(room: Room, _command: c.CycleStart) -> None:
    require_no_alarm(room)
    slot, mode = room.slot, room.panel.mode
    if slot.suspended is not None and slot.run is None and mode != "jog":
        slot.resume(room.machine.setpoint)
    if slot.waiting:
        room.go_on()
    elif slot.run is not None and slot.running != "jog":
        slot.run.start()
    elif mode == "jog":
        raise UsageError("cycle start does nothing in manual jog")
    elif mode == "mdi":
        if not room.panel.entered.strip():
            raise UsageError("the MDI line is empty")
        options = RunOptions(inherited=slot.inherited, typed=True)
        room.start_run(source_from_text(room.panel.entered, "MDI"), "mdi", options)
    else:
        _start_program(room)


def _start_program(room: Room) -> None:
    dry = DRY_RUN_FEED if room.panel.dry_run else None
    searched = room.program.searched
    # Where the part tells, it is no matter from which block on it was made.
    whole = dry is None and (searched == 0 or room.scene.file.part is not None)
    options = RunOptions(dry_feed=dry, search=searched)
    room.start_run(room.program.source, "program", options)
    if room.slot.run is not None:
        room.judge.note_start(whole=whole)
    room.program.begin_at(0)


def _search(room: Room, command: c.Search) -> None:
    require_no_run(room, "a search begins while nothing runs: reset first")
    room.program.begin_at(command.line)


def _switch(room: Room, command: c.Switch) -> None:
    # A program is read ahead of the axes: what changes how it is read cannot change any more.
    if command.name != "optional_stop":
        require_no_run(room, "that switch cannot change while something runs: reset first")
    room.panel.turn_switch(command.name, on=command.on)


def _feed_hold(room: Room, _command: c.FeedHold) -> None:
    if room.slot.run is None:
        raise UsageError("nothing runs")
    if room.slot.running == "jog":
        _stop_jog(room)
        return
    room.slot.run.hold()
    room.judge.note_hold(room)


def _reset(room: Room, _command: c.Reset) -> None:
    slot = room.slot
    if slot.run is None and room.alarm is not None:
        room.clear()
    room.manual.clear()
    slot.forget_suspended()
    room.program.begin_at(0)
    slot.forget_inherited()
    if slot.waiting:
        slot.drop(room.machine.setpoint)
    elif slot.run is not None:
        slot.run.drop()
    room.auxiliaries.reset(axes_move=room.machine.moving)


def _emergency_stop(room: Room, command: c.EmergencyStop) -> None:
    room.panel.press_stop(pressed=command.pressed)
    if command.pressed:
        room.stop_all("emergency-stop", "the emergency stop button was pressed")
        room.auxiliaries.switch_coolant(on=False)


def _override(room: Room, command: c.Override) -> None:
    room.panel.turn_dial(command.dial, command.percent)


def _jog(room: Room, command: c.Jog) -> None:
    require_jog(room, command.axis)
    if room.slot.run is not None:
        raise UsageError("an axis is being jogged already")
    place = _position(room, command.axis)
    distance = command.direction * (command.step if command.step is not None else ENDLESS)
    move = _jog_move(room, command.axis, place + distance, command.feed)
    if abs(move.target - place) < SHORTEST_MOVE:
        raise UsageError(f"{command.axis} is at the end of its travel")
    room.drive_by_hand([move])


def _handwheel(room: Room, command: c.Handwheel) -> None:
    require_jog(room, command.axis)
    axis, last, run = command.axis, room.manual.wheel_move, room.slot.run
    if run is not None and not (last is not None and last.axis == axis):
        raise UsageError("an axis is being jogged already")
    place = _position(room, axis)
    begin = place if last is None else last.target
    move = _jog_move(room, axis, begin + command.clicks * command.step)._replace(wheel=True)
    if run is not None:
        room.manual.follow_wheel(move, run, place)
    else:
        room.drive_by_hand([move])


def _reference(room: Room, _command: c.Reference) -> None:
    require_still(room)
    names = room.machine.machine.axes.names
    order = sorted(names, key=lambda name: name != "Z")
    room.drive_by_hand(_jog_move(room, name, REFERENCE) for name in order)


def _return_to_path(room: Room, _command: c.ReturnToPath) -> None:
    suspended = room.slot.suspended
    if suspended is None:
        raise UsageError("no program is held")
    require_still(room)
    names = room.machine.machine.axes.names
    goal = dict(zip(names, map(float, suspended.place), strict=True))
    # Up first, down last: the tool goes over what it may meet.
    up = goal["Z"] > _position(room, "Z")
    order = sorted(names, key=lambda name: (name == "Z") != up)
    room.drive_by_hand(JogMove(name, goal[name], _feed(room, name)) for name in order)


def _position(room: Room, axis: str) -> float:
    return float(room.standing_setpoint[column_of(room, axis)])


def _jog_move(room: Room, axis: str, target: float, feed: float = HAND_FEED) -> JogMove:
    """A move by hand that ends within the travel, no faster than the axis goes."""
    within = within_travel(room.machine.machine, axis, _position(room, axis), target)
    return JogMove(axis, within, _feed(room, axis, feed))


def _feed(room: Room, axis: str, feed: float = HAND_FEED) -> float:
    return min(feed, SECONDS_PER_MINUTE * room.machine.machine.axis(axis).velocity)


def _jog_stop(room: Room, _command: c.JogStop) -> None:
    _stop_jog(room)


def _stop_jog(room: Room) -> None:
    """Come to rest on a move by hand, and forget the others."""
    room.manual.clear()
    room.slot.stop_jog()


def _enter(room: Room, command: c.Enter) -> None:
    if room.panel.mode != "mdi":
        raise UsageError("a block is typed in the mode MDI")
    room.panel.enter(command.text)


def _edit(room: Room, command: c.Edit) -> None:
    _require_editable(room)
    room.program.edit(command.line, command.text)


def _load_program(room: Room, command: c.Load) -> None:
    _require_editable(room)
    room.program.load(command.text)


def _undo(room: Room, _command: c.Undo) -> None:
    _require_editable(room)
    room.program.undo()


def _reload(room: Room, _command: c.Reload) -> None:
    _require_editable(room)
    room.program.reload()


def _require_editable(room: Room) -> None:
    require_no_run(room, "a program cannot be edited while something runs: reset first")


def _spindle(room: Room, command: c.Spindle) -> None:
    state = dataclasses.replace(room.auxiliaries.spindle, started=command.on)
    if command.speed is not None:
        state = dataclasses.replace(state, speed=command.speed)
    if command.on:
        require_no_alarm(room)
        slot = room.slot
        if slot.run is not None and slot.running != "jog" and not slot.held:
            # AXIS: the spindle is started by hand only where nothing runs; stopped, always.
            raise UsageError("a program runs: hold it before the spindle is started by hand")
        if not state.asked:
            raise UsageError("no spindle speed is set: type S first")
        state = dataclasses.replace(state, counter_clockwise=command.counter_clockwise)
    room.turn_spindle(state)


def _coolant(room: Room, command: c.Coolant) -> None:
    if command.on:
        require_no_alarm(room)
    room.auxiliaries.switch_coolant(on=command.on)


def _change_tool(room: Room, command: c.ChangeTool) -> None:
    require_no_run(room, "the tool cannot change while something runs: reset first")
    require_still(room)
    if room.auxiliaries.spindle.turns:
        raise UsageError("the spindle turns: stop it before the tool is changed")
    room.mount(command.number)
    room.setup.renew(command.number)
    room.alarms.renew_tool(command.number)


def _new_blank(room: Room, _command: c.NewBlank) -> None:
    require_no_run(room, "the blank cannot change while something runs: reset first")
    require_still(room)
    if room.auxiliaries.spindle.turns:
        raise UsageError("the spindle turns: stop it before the blank is changed")
    room.judge.note_blank()
    room.setup.new_blank()


def _set_zero(room: Room, command: c.SetZero) -> None:
    column = column_of(room, command.axis)
    require_no_run(room)
    tables = room.setup.tables
    place = float(room.machine.position[column])
    length_difference = float((tables.program_zero - tables.zero)[column])
    tables.set_zero(column, place - command.reading - length_difference)
    room.faults.forget_offset(command.axis)


def _set_offset(room: Room, command: c.SetOffset) -> None:
    require_no_run(room)
    column, tables = column_of(room, command.axis), room.setup.tables
    if command.name is not None:
        moved = tables.set_offset(command.name, command.axis, command.value)
        room.slot.shift_offset(command.name, column, moved)
        return
    tables.set_zero(column, command.value)
    room.faults.forget_offset(command.axis)


def _set_tool(room: Room, command: c.SetTool) -> None:
    require_no_run(room)
    room.setup.tables.set_tool(command.number, command.length, command.radius)


def _add_tool(room: Room, command: c.AddTool) -> None:
    require_no_run(room)
    flute = min(LONGEST_FLUTE, 0.5 * command.length)
    tool = ToolTable(
        number=command.number,
        kind=command.kind,
        diameter=command.diameter,
        length=command.length,
        flute=flute,
    )
    room.setup.tables.add_tool(tool)


def _sign(_room: Room, _command: c.Sign) -> None:
    """Only the score sheet needs it."""


def _answer(room: Room, command: c.AnswerQuestion) -> None:
    room.judge.answer(command.task, command.choice)


def _hint(room: Room, _command: c.Hint) -> None:
    room.judge.ask_hint()


def _finish(room: Room, _command: c.Finish) -> None:
    room.judge.finish(room)


def _inject(room: Room, command: c.Inject) -> None:
    room.faults.inject(room, command.fault)


def _repair(room: Room, _command: c.Repair) -> None:
    room.faults.repair(room)


_ACTIONS: dict[type, Callable[[Room, Any], None]] = {
    c.SelectMode: _mode,
    c.CycleStart: _cycle_start,
    c.FeedHold: _feed_hold,
    c.Reset: _reset,
    c.EmergencyStop: _emergency_stop,
    c.Override: _override,
    c.Jog: _jog,
    c.JogStop: _jog_stop,
    c.Handwheel: _handwheel,
    c.Reference: _reference,
    c.ReturnToPath: _return_to_path,
    c.Search: _search,
    c.Switch: _switch,
    c.Enter: _enter,
    c.Edit: _edit,
    c.Load: _load_program,
    c.Undo: _undo,
    c.Reload: _reload,
    c.Spindle: _spindle,
    c.Coolant: _coolant,
    c.ChangeTool: _change_tool,
    c.NewBlank: _new_blank,
    c.SetZero: _set_zero,
    c.SetOffset: _set_offset,
    c.SetTool: _set_tool,
    c.AddTool: _add_tool,
    c.Sign: _sign,
    c.AnswerQuestion: _answer,
    c.Hint: _hint,
    c.Finish: _finish,
    c.Inject: _inject,
    c.Repair: _repair,
}
