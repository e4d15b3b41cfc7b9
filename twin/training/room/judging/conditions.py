"""Whether the condition of a task holds."""

import dataclasses
from collections.abc import Callable
from typing import Literal

import numpy as np

from twin.training.room.observed import Observed
from twin.training.scene.tasks import TaskTable

State = Literal["open", "done", "failed"]


@dataclasses.dataclass(slots=True)
class Evidence:
    """What has happened that tasks ask for.

    Attributes:
        ended_well: The program has run to its end without an alarm, and the part is what it should be.
        single: Lines that were run in single block, from one stop to the next.
        held: Lines in which the axes were held to a stand.
        answers: What was answered, by number of the task.
        since_touch_s: Machine time since the panel was touched first [s].
        made: The program has finished the part at least once.
        brought: The axes are where a program has brought them that finished the part.
        blanks: How many have been clamped.
    """

    alarms: list[str] = dataclasses.field(default_factory=list)
    cleared: list[str] = dataclasses.field(default_factory=list)
    ended_well: bool = False
    single: set[int] = dataclasses.field(default_factory=set)
    held: set[int] = dataclasses.field(default_factory=set)
    answers: dict[int, str] = dataclasses.field(default_factory=dict)
    since_touch_s: float = 0.0
    made: bool = False
    brought: bool = False
    blanks: int = 1


def _reached(evidence: Evidence, room: Observed, task: TaskTable, _number: int) -> State:
    goal = task.reached
    assert goal is not None
    if room.machine.moving or (goal.by_program and not evidence.brought):
        return "open"
    zero = (
        room.setup.tables.tip_zero
        if goal.frame == "part"
        else np.zeros(len(room.setup.tables.zero))
    )
    names = room.machine.machine.axes.names
    stands = room.machine.position - zero
    off = [abs(stands[names.index(axis)] - value) for axis, value in goal.at.items()]
    return "done" if max(off) <= goal.tolerance else "open"


def _stayed(_evidence: Evidence, room: Observed, task: TaskTable, _number: int) -> State:
    limits = task.stayed
    assert limits is not None
    column = room.machine.machine.axes.names.index(limits.axis)
    places = room.samples.joint_position[:, column] - room.setup.tables.tip_zero[column]
    inside = bool(((places >= limits.low) & (places <= limits.high)).all())
    return "open" if inside else "failed"


def _zero(_evidence: Evidence, room: Observed, task: TaskTable, _number: int) -> State:
    goal = task.zero
    assert goal is not None
    names = room.machine.machine.axes.names
    off = np.abs(room.setup.tables.zero - room.setup.tables.true_zero)
    worst = max(float(off[names.index(axis)]) for axis in goal.axes)
    return "done" if worst <= goal.tolerance else "open"


def _tool_length(_evidence: Evidence, room: Observed, task: TaskTable, _number: int) -> State:
    tables = room.setup.tables
    # Of another one, put in by hand, the table's length may be right by itself.
    off = abs(tables.lengths[tables.first] - tables.tools[tables.first].length)
    return "done" if task.tool_length and off <= task.tool_length else "open"


def _finished(evidence: Evidence, _room: Observed, _task: TaskTable, _number: int) -> State:
    return "done" if evidence.ended_well else "open"


def _single_block(evidence: Evidence, _room: Observed, task: TaskTable, _number: int) -> State:
    return "done" if evidence.single.issuperset(task.single_block) else "open"


def _held_in(evidence: Evidence, _room: Observed, task: TaskTable, _number: int) -> State:
    return "done" if evidence.held.intersection(task.held) else "open"


def _alarm_cleared(evidence: Evidence, room: Observed, task: TaskTable, _number: int) -> State:
    return "done" if task.cleared in evidence.cleared and room.alarm is None else "open"


def _no_alarm(evidence: Evidence, _room: Observed, task: TaskTable, _number: int) -> State:
    forbidden = "any" in task.no_alarm or set(task.no_alarm).intersection(evidence.alarms)
    return "failed" if forbidden and evidence.alarms else "open"


def _within(evidence: Evidence, _room: Observed, task: TaskTable, _number: int) -> State:
    assert task.within_s is not None
    return "failed" if evidence.since_touch_s > task.within_s else "open"


def _blanks(evidence: Evidence, _room: Observed, task: TaskTable, _number: int) -> State:
    assert task.blanks is not None
    return "failed" if evidence.blanks > task.blanks else "open"


def _removed(evidence: Evidence, room: Observed, task: TaskTable, _number: int) -> State:
    assert task.removed_mm3 is not None
    if not evidence.ended_well or room.setup.work is None:
        return "open"
    low, high = task.removed_mm3
    return "done" if low <= room.setup.work.removed <= high else "failed"


def _question(evidence: Evidence, _room: Observed, task: TaskTable, number: int) -> State:
    assert task.question is not None
    if number not in evidence.answers:
        return "open"
    return "done" if evidence.answers[number] == task.question.right else "failed"


CHECKS: dict[str, Callable[[Evidence, Observed, TaskTable, int], State]] = {
    "reached": _reached,
    "stayed": _stayed,
    "zero": _zero,
    "tool_length": _tool_length,
    "finished": _finished,
    "single_block": _single_block,
    "held": _held_in,
    "cleared": _alarm_cleared,
    "no_alarm": _no_alarm,
    "within_s": _within,
    "blanks": _blanks,
    "removed_mm3": _removed,
    "question": _question,
}
"""By the task's condition."""
