"""The judge: which tasks are done, which have failed, and what that is worth."""

import dataclasses
from collections.abc import Callable
from typing import TYPE_CHECKING, Literal

import numpy as np

from twin.errors import UsageError
from twin.training.tasks import TaskTable

if TYPE_CHECKING:
    from twin.training.room import Room

State = Literal["open", "done", "failed"]


@dataclasses.dataclass(frozen=True, slots=True)
class Verdict:
    """How a task stands.

    Attributes:
        state: ``open`` until it is done or has failed.
        time_s: When that was decided, in machine time [s]; None while it is open.
    """

    state: State = "open"
    time_s: float | None = None


class Judge:
    """Looks after the tasks of a scene while it runs.

    Attributes:
        verdicts: How each task stands, in the order of the scene.
        hints: How many hints have been asked for.
        over: The scene has been handed in, or its time is up.
        answers: What was answered, by number of the task.
    """

    def __init__(self, room: "Room") -> None:
        self._file = room.scene.file
        self.verdicts: list[Verdict] = [Verdict() for _ in self._file.tasks]
        self.hints = 0
        self.over = False
        self.answers: dict[int, str] = {}
        self._alarms: list[str] = []
        self._cleared: list[str] = []
        self._ended_well = False
        self._trouble = False
        self._single: set[int] = set()
        self._held: set[int] = set()
        self._hold_line = 0

    @property
    def score(self) -> int:
        """Points so far: of what is done, less what the hints cost; never below 0."""
        points = sum(
            task.points
            for task, verdict in zip(self._file.tasks, self.verdicts, strict=True)
            if verdict.state == "done"
        )
        return max(0, points - self.hints * self._file.hint_cost)

    def note_alarm(self, code: str) -> None:
        """An alarm has come."""
        self._alarms.append(code)
        self._trouble = True

    def note_cleared(self, code: str) -> None:
        """An alarm has been cleared."""
        self._cleared.append(code)

    def note_start(self) -> None:
        """The program has been started from its beginning."""
        self._trouble = self._ended_well = False

    def note_end(self, room: "Room") -> None:
        """The program has run to its end."""
        self._ended_well = not self._trouble
        self._note_single(room)

    def note_hold(self, room: "Room") -> None:
        """The operator has asked for a feed hold."""
        self._hold_line = int(room.machine.setpoint.line[0])

    def answer(self, task: int, choice: str) -> None:
        """Take an answer; the first one counts.

        Raises:
            UsageError: That task asks nothing, or has been answered.
        """
        known = self._file.tasks
        question = known[task - 1].question if 1 <= task <= len(known) else None
        if question is None:
            raise UsageError(f"task {task} asks nothing")
        if task in self.answers:
            raise UsageError(f"task {task} has been answered")
        if choice not in question.choices:
            raise UsageError(f"the choices are {', '.join(question.choices)}")
        self.answers[task] = choice

    def ask_hint(self) -> None:
        """Show one hint more.

        Raises:
            UsageError: There are no more.
        """
        if self.hints >= len(self._file.hints):
            raise UsageError("there are no more hints")
        self.hints += 1

    def finish(self, room: "Room") -> None:
        """Judge what holds to the end; what is open fails."""
        if self.over:
            return
        for number, task in enumerate(self._file.tasks):
            if self.verdicts[number].state != "open":
                continue
            kept = task.to_end and (task.condition != "within_s" or self._others_done())
            self.verdicts[number] = Verdict("done" if kept else "failed", room.time_s)
        self.over = True

    def _others_done(self) -> bool:
        return all(
            verdict.state == "done"
            for task, verdict in zip(self._file.tasks, self.verdicts, strict=True)
            if not task.to_end
        )

    def look(self, room: "Room") -> None:
        """Check every open task against the machine as it stands after a slice."""
        if self.over:
            return
        if room.run is not None and room.running == "program" and room.run.motion.held:
            self._note_single(room)
            if self._hold_line and not room.moving:
                self._held.add(self._hold_line)
                self._hold_line = 0
        for number, task in enumerate(self._file.tasks):
            if self.verdicts[number].state == "open":
                state = _CHECKS[task.condition](self, room, task, number + 1)
                if state != "open":
                    self.verdicts[number] = Verdict(state, room.time_s)
        if room.time_s >= self._file.time_limit_s:
            self.finish(room)

    def _note_single(self, room: "Room") -> None:
        if room.mode == "single":
            self._single.add(int(room.machine.setpoint.line[0]))

    # --- conditions

    def _reached(self, room: "Room", task: TaskTable, _number: int) -> State:
        goal = task.reached
        assert goal is not None
        if room.moving:
            return "open"
        zero = room.tables.tip_zero if goal.frame == "part" else np.zeros(len(room.label))
        names = room.machine.machine.axes.names
        stands = room.machine.position - zero
        off = [abs(stands[names.index(axis)] - value) for axis, value in goal.at.items()]
        return "done" if max(off) <= goal.tolerance else "open"

    def _stayed(self, room: "Room", task: TaskTable, _number: int) -> State:
        limits = task.stayed
        assert limits is not None
        column = room.machine.machine.axes.names.index(limits.axis)
        places = room.samples.joint_position[:, column] - room.tables.tip_zero[column]
        inside = bool(((places >= limits.low) & (places <= limits.high)).all())
        return "open" if inside else "failed"

    def _zero(self, room: "Room", task: TaskTable, _number: int) -> State:
        goal = task.zero
        assert goal is not None
        names = room.machine.machine.axes.names
        off = np.abs(room.tables.zero - room.tables.true_zero)
        worst = max(float(off[names.index(axis)]) for axis in goal.axes)
        return "done" if worst <= goal.tolerance else "open"

    def _tool_length(self, room: "Room", task: TaskTable, _number: int) -> State:
        tables = room.tables
        off = abs(tables.lengths[tables.spindle] - tables.tool.length)
        return "done" if task.tool_length and off <= task.tool_length else "open"

    def _finished(self, _room: "Room", _task: TaskTable, _number: int) -> State:
        return "done" if self._ended_well else "open"

    def _single_block(self, _room: "Room", task: TaskTable, _number: int) -> State:
        return "done" if self._single.issuperset(task.single_block) else "open"

    def _held_in(self, _room: "Room", task: TaskTable, _number: int) -> State:
        return "done" if self._held.intersection(task.held) else "open"

    def _alarm_cleared(self, room: "Room", task: TaskTable, _number: int) -> State:
        return "done" if task.cleared in self._cleared and room.alarm is None else "open"

    def _no_alarm(self, _room: "Room", task: TaskTable, _number: int) -> State:
        forbidden = "any" in task.no_alarm or set(task.no_alarm).intersection(self._alarms)
        return "failed" if forbidden and self._alarms else "open"

    def _within(self, room: "Room", task: TaskTable, _number: int) -> State:
        assert task.within_s is not None
        return "failed" if room.time_s > task.within_s else "open"

    def _removed(self, room: "Room", task: TaskTable, _number: int) -> State:
        assert task.removed_mm3 is not None
        if not self._ended_well or room.work is None:
            return "open"
        low, high = task.removed_mm3
        return "done" if low <= room.work.removed <= high else "failed"

    def _question(self, _room: "Room", task: TaskTable, number: int) -> State:
        assert task.question is not None
        if number not in self.answers:
            return "open"
        return "done" if self.answers[number] == task.question.right else "failed"


_CHECKS: dict[str, Callable[[Judge, "Room", TaskTable, int], State]] = {
    "reached": Judge._reached,
    "stayed": Judge._stayed,
    "zero": Judge._zero,
    "tool_length": Judge._tool_length,
    "finished": Judge._finished,
    "single_block": Judge._single_block,
    "held": Judge._held_in,
    "cleared": Judge._alarm_cleared,
    "no_alarm": Judge._no_alarm,
    "within_s": Judge._within,
    "removed_mm3": Judge._removed,
    "question": Judge._question,
}
