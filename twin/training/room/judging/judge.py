"""The judge: which tasks are done, which have failed, and the points."""

import dataclasses

from twin.errors import UsageError
from twin.training.room.judging.conditions import CHECKS, Evidence, State
from twin.training.room.judging.inspection import part_is_right
from twin.training.room.observed import Observed
from twin.training.scene.scene_file import Scene


@dataclasses.dataclass(frozen=True, slots=True)
class TaskState:
    """The state of a task.

    Attributes:
        state: ``open`` until it is done or has failed.
        time_s: When that was decided, in machine time [s]; None while it is open.
    """

    state: State = "open"
    time_s: float | None = None


class Judge:
    """Checks the tasks of a scene while it runs.

    Attributes:
        verdicts: How each task stands, in the order of the scene.
        over: The scene has been handed in, or its time is up.
        evidence: What has happened that tasks ask for.
    """

    def __init__(self, scene: Scene) -> None:
        self._file = scene.file
        self.verdicts: list[TaskState] = [TaskState() for _ in self._file.tasks]
        self.hints = 0
        self.over = False
        self.evidence = Evidence()
        self._trouble = False
        self._hold_line = 0
        self._by_program: dict[tuple[str, ...], tuple[set[int], set[int]]] = {}
        self._trusted = {tuple(scene.preparation.source.lines)}
        self._touched_s: float | None = None

    @property
    def score(self) -> int:
        """Points so far: of what is done, less what the hints cost; never below 0."""
        points = sum(
            task.points
            for task, verdict in zip(self._file.tasks, self.verdicts, strict=True)
            if verdict.state == "done"
        )
        return max(0, points - self.hints * self._file.hint_cost)

    @property
    def touched(self) -> bool:
        """Whether the operator has done anything yet that begins the scene's time, or asked for a hint."""
        return self._touched_s is not None or self.hints > 0 or bool(self.evidence.answers)

    def note_touch(self, room: Observed) -> None:
        """The operator has touched the panel: from the first time on, time counts."""
        if self._touched_s is None:
            self._touched_s = room.time_s

    def time_s(self, room: Observed) -> float:
        """Machine time since the first touch [s]."""
        return 0.0 if self._touched_s is None else room.time_s - self._touched_s

    def note_alarm(self, code: str) -> None:
        """An alarm has come."""
        self.evidence.alarms.append(code)
        self._trouble = True

    def note_cleared(self, code: str) -> None:
        """An alarm has been cleared."""
        self.evidence.cleared.append(code)

    def note_start(self, *, whole: bool) -> None:
        """The program has been started; ``whole``: from its beginning, and to cut."""
        self._trouble = not whole
        self._hold_line = 0
        self.evidence.ended_well = False

    def note_end(self, room: Observed) -> None:
        """The program has run to its end."""
        well = not self._trouble and part_is_right(room)
        self.evidence.ended_well = self.evidence.brought = well
        self.evidence.made |= well
        if well:
            self._trusted.add(room.program.lines)
            self._believe(room)

    def note_blank(self) -> None:
        """A new blank has been clamped."""
        self.evidence.blanks += 1

    def note_singly(self, room: Observed) -> None:
        """Lines of the program were run in single block, from one stop to the next."""
        if room.slot.run is not None and room.slot.running == "program":
            self.noted(room)[0].update(room.slot.run.singly)
            self._believe(room)

    def note_hold(self, room: Observed) -> None:
        """The operator has asked for a feed hold."""
        if room.slot.running == "program":
            self._hold_line = int(room.machine.setpoint.line[0])

    def noted(self, room: Observed) -> tuple[set[int], set[int]]:
        """Lines of the program as it is written now: run in single block, and held in."""
        return self._by_program.setdefault(room.program.lines, (set(), set()))

    def _believe(self, room: Observed) -> None:
        """Lines count of the scene's own program, and of another one that has made the part."""
        if room.program.lines in self._trusted:
            single, held = self.noted(room)
            self.evidence.single |= single
            self.evidence.held |= held

    def answer(self, task: int, choice: str) -> None:
        """Take an answer; the first one counts.

        Raises:
            UsageError: That task asks nothing, or has been answered.
        """
        known = self._file.tasks
        question = known[task - 1].question if 1 <= task <= len(known) else None
        if question is None:
            raise UsageError(f"task {task} asks nothing")
        if task in self.evidence.answers:
            raise UsageError(f"task {task} has been answered")
        if choice not in question.choices:
            raise UsageError(f"the choices are {', '.join(question.choices)}")
        self.evidence.answers[task] = choice

    def ask_hint(self) -> None:
        """Show one hint more.

        Raises:
            UsageError: There are no more.
        """
        if self.hints >= len(self._file.hints):
            raise UsageError("there are no more hints")
        self.hints += 1

    def finish(self, room: Observed) -> None:
        """Judge what holds to the end; what is open fails."""
        if self.over:
            return
        left = [
            (number, task)
            for number, task in enumerate(self._file.tasks)
            if self.verdicts[number].state == "open"
        ]
        for number, task in sorted(left, key=lambda one: one[1].to_end):
            if task.at_end:
                good = CHECKS[task.condition](self.evidence, room, task, number + 1) == "done"
            else:
                # What was only never broken earns nothing where no part was made.
                good = task.to_end and self.evidence.made
            if task.condition == "within_s":
                good = good and self._others_done()
            self.verdicts[number] = TaskState("done" if good else "failed", room.time_s)
        self.over = True

    def _others_done(self) -> bool:
        return all(
            verdict.state == "done"
            for task, verdict in zip(self._file.tasks, self.verdicts, strict=True)
            if not task.to_end
        )

    def look(self, room: Observed) -> None:
        """Check every open task against the machine as it is after a slice."""
        if self.over:
            return
        self.evidence.since_touch_s = self.time_s(room)
        if room.slot.run is not None:
            self.evidence.brought = False
        if room.slot.run is not None and room.slot.running == "program" and room.slot.run.held:
            self.note_singly(room)
            if self._hold_line and not room.machine.moving:
                self.noted(room)[1].add(self._hold_line)
                self._hold_line = 0
                self._believe(room)
        for number, task in enumerate(self._file.tasks):
            if self.verdicts[number].state == "open" and not task.at_end:
                state = CHECKS[task.condition](self.evidence, room, task, number + 1)
                if state != "open":
                    self.verdicts[number] = TaskState(state, room.time_s)
        if self.time_s(room) >= self._file.time_limit_s:
            self.finish(room)
