"""A scripted operator: plays the steps of a scene as fast as the computer can."""

import dataclasses
from collections.abc import Iterable

from twin.errors import TwinError
from twin.training.room.room import Room
from twin.training.scene.scene_file import Scene, StepTable
from twin.training.session.session import SceneSession

PATIENCE_S = 600.0
"""How long a step is waited for, in machine time [s]."""


class ScriptError(TwinError):
    """A step cannot be done, or what it waits for does not come."""


def play(session: SceneSession, steps: Iterable[StepTable], *, hand_in: bool = True) -> None:
    """Play steps to their end.

    Args:
        hand_in: Whether the scene is handed in at the end.

    Raises:
        ScriptError: The machine refuses a command, or the wait is in vain.
    """
    for number, step in enumerate(steps, 1):
        if step.do is not None:
            who = "trainer" if step.do in ("inject", "repair") else "operator"
            if not session.submit(step.command(), who):
                raise ScriptError(f"step {number}, {step.do}: {session.refusal}")
            session.advance()
        else:
            _wait(session, step, number)
    if hand_in:
        session.submit({"do": "finish"})


@dataclasses.dataclass(frozen=True, slots=True)
class Rehearsal:
    """The results of a scene's scripted operators.

    Attributes:
        what: ``solution`` or ``mistake``.
        failed: Numbers of the tasks that failed.
        intended: Whether that is what the scene says it should be.
    """

    what: str
    score: int
    failed: tuple[int, ...]
    intended: bool


def rehearse(scene: Scene) -> list[Rehearsal]:
    """Play a scene's solution and its mistake without a picture.

    Raises:
        ScriptError: A step cannot be done; or the scene has no solution, or no mistake.
    """
    found = []
    expected = (("solution", scene.file.solution, ()),
                ("mistake", scene.file.mistake, scene.file.mistake_fails))  # fmt: skip
    for what, steps, fails in expected:
        if not steps:
            raise ScriptError(
                f"{scene.name}: no {what} to rehearse; write its steps into the scene"
            )
        session = SceneSession(scene)
        play(session, steps)
        judge = session.room.judge
        states = [verdict.state for verdict in judge.verdicts]
        failed = tuple(number for number, state in enumerate(states, 1) if state == "failed")
        full = judge.score == scene.points
        intended = failed == fails and (full if what == "solution" else not full)
        found.append(Rehearsal(what, judge.score, failed, intended))
    return found


def _wait(session: SceneSession, step: StepTable, number: int) -> None:
    room = session.room
    end = room.time_s + (step.value if step.wait == "seconds" else PATIENCE_S)
    while not _has_come(room, step, end):
        session.advance()
        if room.time_s > end + 1.0:
            alarm = "" if room.alarm is None else f"; alarm {room.alarm.code}: {room.alarm.message}"
            raise ScriptError(f"step {number}: waited for {step.wait} in vain{alarm}")
        if step.wait in ("end", "line", "contact") and room.alarm is not None:
            raise ScriptError(
                f"step {number}: while waiting for {step.wait} came the alarm "
                f"{room.alarm.code}: {room.alarm.message}"
            )


def _has_come(room: Room, step: StepTable, end: float) -> bool:
    stands = not room.machine.moving and (room.slot.run is None or room.slot.held)
    return {
        "rest": stands,
        "moving": room.machine.moving,
        "alarm": room.alarm is not None and not room.machine.moving,
        "line": int(room.machine.setpoint.line[0]) == step.value,
        "end": room.slot.run is None and not room.machine.moving,
        "contact": room.setup.touches(room.auxiliaries.spindle),
        "seconds": room.time_s >= end,
    }[step.wait or "rest"]
