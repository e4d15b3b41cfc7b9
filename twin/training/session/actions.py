"""What each command does at the machine, and why it may be refused."""

import dataclasses
from collections.abc import Callable, Iterable
from typing import Any

from twin.errors import UsageError
from twin.nc.text.source import source_from_text
from twin.training.session import commands as c
from twin.training.session.faults import forget_offset, inject, repair
from twin.training.session.program_run import RunOptions
from twin.training.session.room import SHORTEST_WAY, Leg, Room
from twin.units import SECONDS_PER_MINUTE

DRY_RUN_FEED = 3000.0
"""What all feeds are replaced by in a dry run [mm/min]."""
HAND_FEED = 2000.0
"""Of the handwheel, of the way to the reference point and back to the path [mm/min or deg/min]."""
_NO_TOUCH = (c.Sign, c.Answer, c.Hint, c.Inject, c.Repair)
"""What does not begin a scene's time."""
ENDLESS = 3600.0
"""How far a jog goes at most that lasts while its key is held [mm or deg]."""
REFERENCE = 0.0
"""Machine coordinate of the reference point of every axis."""
EDITS_KEPT = 100
"""Changes of the program that can be taken back."""


def carry_out(room: Room, command: c.Command) -> None:
    """Do what a command asks for.

    Raises:
        TwinError: The machine refuses; the message says why. Nothing has changed then.
    """
    _ACTIONS[type(command)](room, command)
    room.rest.wake()
    if not isinstance(command, _NO_TOUCH):
        room.judge.note_touch(room)


def _mode(room: Room, command: c.SelectMode) -> None:
    within = {"auto", "single"}
    if room.run is not None and not {room.mode, command.mode} <= within:
        held = room.running == "program" and (room.run.held or room.waiting) and not room.moving
        if command.mode != "jog" or not held:
            raise UsageError("the mode cannot change while something runs: reset first")
        room.suspend()
    if room.suspended is not None and command.mode == "mdi":
        raise UsageError("a program is held: reset first")
    room.mode = command.mode


def _cycle_start(room: Room, _command: c.CycleStart) -> None:
    _require_no_alarm(room)
    if room.suspended is not None and room.run is None and room.mode != "jog":
        room.resume()
    if room.waiting:
        room.go_on()
    elif room.run is not None and room.running != "jog":
        room.run.start()
    elif room.mode == "jog":
        raise UsageError("cycle start does nothing in manual jog")
    elif room.mode == "mdi":
        if not room.entered.strip():
            raise UsageError("the MDI line is empty")
        options = RunOptions(inherited=room.inherited)
        room.start_run(source_from_text(room.entered, "MDI"), "mdi", options)
    else:
        _start_program(room)


def _start_program(room: Room) -> None:
    dry = DRY_RUN_FEED if room.switches.dry_run else None
    # Where the part tells, it is no matter from which block on it was made.
    whole = dry is None and (room.searched == 0 or room.scene.file.part is not None)
    options = RunOptions(dry_feed=dry, search=room.searched)
    room.start_run(room.program, "program", options)
    if room.run is not None:
        room.judge.note_start(whole=whole)
    room.searched = 0


def _search(room: Room, command: c.Search) -> None:
    _require_no_run(room, "a search begins while nothing runs: reset first")
    if command.line > len(room.lines):
        raise UsageError(f"the program has {len(room.lines)} lines")
    room.searched = command.line


def _switch(room: Room, command: c.Switch) -> None:
    # A program is read ahead of the axes: what changes how it is read cannot change any more.
    if command.name != "optional_stop":
        _require_no_run(room, "that switch cannot change while something runs: reset first")
    setattr(room.switches, command.name, command.on)


def _feed_hold(room: Room, _command: c.FeedHold) -> None:
    if room.run is None:
        raise UsageError("nothing runs")
    if room.running == "jog":
        room.stop_driving_by_hand()
        return
    room.run.hold()
    room.judge.note_hold(room)


def _reset(room: Room, _command: c.Reset) -> None:
    if room.run is None and room.alarm is not None:
        room.clear()
    room.legs.clear()
    room.suspended = None
    room.searched = 0
    room.inherited = None
    if room.waiting:
        room.drop_run()
    elif room.run is not None:
        room.run.drop()
    room.running_down = room.spindle.turns and room.moving
    room.spindle = room.spindle.stopped()
    # LinuxCNC closes the coolant with every abort (iocontrol, EMC_TOOL_ABORT).
    room.coolant = False


def _emergency_stop(room: Room, command: c.EmergencyStop) -> None:
    room.pressed = command.pressed
    if command.pressed:
        room.stop_all("emergency-stop", "the emergency stop button was pressed")
        room.coolant = False


def _override(room: Room, command: c.Override) -> None:
    if command.dial == "feed":
        room.feed_override = command.percent
    elif command.dial == "spindle":
        room.spindle_override = command.percent
    else:
        room.rapid_override = command.percent


def _jog(room: Room, command: c.Jog) -> None:
    _require_jog(room, command.axis)
    if room.run is not None:
        raise UsageError("an axis is being jogged already")
    place = _stands(room, command.axis)
    way = command.direction * (command.step if command.step is not None else ENDLESS)
    target = room.within_travel(command.axis, place + way)
    if abs(target - place) < SHORTEST_WAY:
        raise UsageError(f"{command.axis} stands at the end of its travel")
    room.drive_by_hand([Leg(command.axis, target, _feed(room, command.axis, command.feed))])


def _handwheel(room: Room, command: c.Handwheel) -> None:
    _require_jog(room, command.axis)
    axis, follows = command.axis, bool(room.legs) and room.legs[-1].wheel
    if room.run is not None and not (follows and room.legs[-1].axis == axis):
        raise UsageError("an axis is being jogged already")
    begin = room.legs[-1].target if follows else _stands(room, axis)
    target = room.within_travel(axis, begin + command.clicks * command.step)
    leg = Leg(axis, target, _feed(room, axis, HAND_FEED), wheel=True)
    if follows:
        room.follow_wheel(leg)
    else:
        room.drive_by_hand([leg])


def _reference(room: Room, _command: c.Reference) -> None:
    _require_still(room)
    names = room.machine.machine.axes.names
    order = sorted(names, key=lambda name: name != "Z")
    room.drive_by_hand(
        Leg(name, room.within_travel(name, REFERENCE), _feed(room, name, HAND_FEED))
        for name in order
    )


def _return_to_path(room: Room, _command: c.ReturnToPath) -> None:
    if room.suspended is None:
        raise UsageError("no program is held")
    _require_still(room)
    names = room.machine.machine.axes.names
    goal = room.suspended.place
    # Up first, down last: the tool goes over what it may meet.
    up = goal[names.index("Z")] > _stands(room, "Z")
    order = sorted(names, key=lambda name: (name == "Z") != up)
    room.drive_by_hand(
        Leg(name, float(goal[names.index(name)]), _feed(room, name, HAND_FEED)) for name in order
    )


def _stands(room: Room, axis: str) -> float:
    return float(room.standing_setpoint[_column(room, axis)])


def _feed(room: Room, axis: str, feed: float) -> float:
    return min(feed, SECONDS_PER_MINUTE * room.machine.machine.axis(axis).velocity)


def _jog_stop(room: Room, _command: c.JogStop) -> None:
    room.stop_driving_by_hand()


def _enter(room: Room, command: c.Enter) -> None:
    if room.mode != "mdi":
        raise UsageError("a block is typed in the mode MDI")
    room.entered = command.text


def _edit(room: Room, command: c.Edit) -> None:
    _require_no_run(room, "a program cannot be edited while something runs: reset first")
    lines = list(room.lines)
    if command.line > len(lines) + 1:
        raise UsageError(f"the program has {len(lines)} lines")
    new = [] if command.text is None else command.text.split("\n")
    lines[command.line - 1 : command.line] = new
    room.edits = [*room.edits, room.lines][-EDITS_KEPT:]
    _load(room, lines)


def _load_program(room: Room, command: c.Load) -> None:
    _require_no_run(room, "a program cannot be edited while something runs: reset first")
    room.edits = [*room.edits, room.lines][-EDITS_KEPT:]
    _load(room, command.text.rstrip("\n").split("\n"))


def _undo(room: Room, _command: c.Undo) -> None:
    _require_no_run(room, "a program cannot be edited while something runs: reset first")
    if not room.edits:
        raise UsageError("the program has not been changed")
    *room.edits, lines = room.edits
    _load(room, lines)


def _reload(room: Room, _command: c.Reload) -> None:
    _require_no_run(room, "a program cannot be edited while something runs: reset first")
    room.edits = [*room.edits, room.lines][-EDITS_KEPT:]
    _load(room, room.scene.preparation.source.lines)


def _load(room: Room, lines: Iterable[str]) -> None:
    room.lines = tuple(lines)
    room.program = source_from_text("\n".join(room.lines), room.program.name)
    room.searched = 0


def _spindle(room: Room, command: c.Spindle) -> None:
    state = dataclasses.replace(room.spindle, started=command.on)
    if command.speed is not None:
        state = dataclasses.replace(state, speed=command.speed)
    if command.on:
        _require_no_alarm(room)
        if room.run is not None and room.running != "jog" and not room.held:
            # AXIS: the spindle is started by hand only where nothing runs; stopped, always.
            raise UsageError("a program runs: hold it before the spindle is started by hand")
        if not state.asked:
            raise UsageError("no spindle speed is set: type S first")
        state = dataclasses.replace(state, counter_clockwise=command.counter_clockwise)
    room.turn_spindle(state)


def _coolant(room: Room, command: c.Coolant) -> None:
    if command.on:
        _require_no_alarm(room)
    room.coolant = command.on


def _change_tool(room: Room, command: c.ChangeTool) -> None:
    _require_no_run(room, "the tool cannot change while something runs: reset first")
    _require_still(room)
    if room.spindle.turns:
        raise UsageError("the spindle turns: stop it before the tool is changed")
    room.mount(command.number)
    room.renew_tool(command.number)


def _new_blank(room: Room, _command: c.NewBlank) -> None:
    _require_no_run(room, "the blank cannot change while something runs: reset first")
    _require_still(room)
    if room.spindle.turns:
        raise UsageError("the spindle turns: stop it before the blank is changed")
    room.new_blank()


def _set_zero(room: Room, command: c.SetZero) -> None:
    column = _column(room, command.axis)
    _require_no_run(room)
    stands = float(room.machine.position[column])
    longer = float((room.tables.program_zero - room.tables.zero)[column])
    room.tables.zero[column] = stands - command.reading - longer
    forget_offset(room, command.axis)


def _set_offset(room: Room, command: c.SetOffset) -> None:
    _require_no_run(room)
    column = _column(room, command.axis)
    if command.name is not None:
        moved = room.tables.set_offset(command.name, command.axis, command.value)
        if room.inherited is not None:
            room.inherited = room.inherited.after_offset(command.name, column, moved)
        return
    room.tables.zero[column] = command.value
    forget_offset(room, command.axis)


def _set_tool(room: Room, command: c.SetTool) -> None:
    _require_no_run(room)
    room.tables.set_tool(command.number, command.length, command.radius)


def _sign(_room: Room, _command: c.Sign) -> None:
    """Only the sheet wants to know."""


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


def _require_no_run(
    room: Room, why: str = "the tables cannot change while something runs: reset first"
) -> None:
    if room.run is not None or room.suspended is not None:
        raise UsageError(why)


def _require_jog(room: Room, axis: str) -> None:
    """An axis may be jogged; off its limit switch also while that alarm stands."""
    if room.mode != "jog":
        raise UsageError("jogging needs the mode manual jog")
    _column(room, axis)
    if room.alarm is None or room.alarm.code != "hard-limit" or room.pressed:
        _require_no_alarm(room)
    elif room.on_switch not in ("", axis):
        raise UsageError(f"{room.on_switch} stands on its limit switch: jog it back first")


def _require_still(room: Room) -> None:
    """Nothing runs, and no alarm stands."""
    _require_no_alarm(room)
    if room.mode != "jog":
        raise UsageError("that is done in the mode manual jog")
    if room.run is not None or room.moving:
        raise UsageError("the axes still move")


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
    c.Sign: _sign,
    c.Answer: _answer,
    c.Hint: _hint,
    c.Finish: _finish,
    c.Inject: _inject,
    c.Repair: _repair,
}
