"""The trainer's side: what the sheet asks for, as Studio's simulation side hears it."""

from typing import Any

import numpy as np
import pytest
from mujoco.studio import messages

from twin.training.panel.request import Request, do
from twin.training.panel.studio import RequestEvent, RoomPlugin, RoomSnapshot
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.scene.vocabulary import Words
from twin.training.session.score import score_sheet
from twin.training.session.session import Session


class Handle:
    """Studio's stand-in: keeps what is sent to the page."""

    def __init__(self) -> None:
        self.sent: list[Any] = []

    def send_to_viewer(self, message: Any) -> None:
        self.sent.append(message)


class Trainer:
    """Somebody at the trainer's sheet."""

    def __init__(self) -> None:
        self.session = Session(read_scene(scene_path("fagor_first_steps")))
        self.changes = 0
        self.driver = RoomPlugin(self.session, plain=True, changed=self._changed)
        self.handle = Handle()
        self.driver.handle = self.handle  # pyright: ignore[reportAttributeAccessIssue] (a stand-in)

    def _changed(self, _session: Session) -> None:
        self.changes += 1

    def ask(self, request: Request) -> None:
        self.driver.on_request(RequestEvent(request))

    def look(self) -> Any:
        """Let Studio take one step, and see what the page is shown."""
        display = self.driver.display
        self.driver.on_step(messages.StepEvent(model=display.model, data=display.data))
        shown = self.handle.sent[-1]
        assert isinstance(shown, RoomSnapshot)
        return shown.now


@pytest.fixture
def trainer() -> Trainer:
    return Trainer()


def run_for(trainer: Trainer, seconds: float) -> None:
    goal = trainer.session.room.time_s + seconds
    while trainer.session.room.time_s < goal:
        trainer.look()


def test_a_frozen_machine_stands_until_it_goes_on(trainer):
    trainer.ask(do("cycle_start"))
    run_for(trainer, 0.3)
    trainer.ask(Request("trainer", change="freeze"))
    before = trainer.look()
    after = trainer.look()
    assert before.frozen
    assert after.time_s == before.time_s
    assert after.position == before.position
    trainer.ask(Request("trainer", change="go_on"))
    run_for(trainer, 0.1)
    assert trainer.look().time_s > before.time_s


def test_going_back_freezes_the_machine_as_it_was(trainer):
    start = trainer.look().machine_position
    run_for(trainer, 0.1)
    trainer.ask(do("cycle_start"))
    run_for(trainer, 1.0)
    trainer.ask(Request("trainer", change="rewind", seconds=3600.0))
    now = trainer.look()
    assert now.frozen
    assert now.time_s == 0.0
    assert now.machine_position == pytest.approx(start, abs=1e-3)
    # What was done later is forgotten.
    assert not trainer.session.log


def test_a_replay_shows_the_session_again_and_comes_back_to_it(trainer):
    trainer.ask(do("cycle_start"))
    # Longer than what a slow computer shows again in one step.
    run_for(trainer, 2.5)
    there = trainer.session.room.time_s
    place = trainer.session.room.machine.position.copy()
    trainer.ask(Request("trainer", change="replay"))
    first = trainer.look()
    assert first.replaying
    assert first.time_s < there
    # The machine itself stands meanwhile, and hears no key.
    trainer.ask(do("reset"))
    while trainer.look().replaying:
        assert trainer.session.room.time_s == there
    assert np.array_equal(trainer.session.room.machine.position, place)
    assert trainer.session.room.running == "program"


def test_only_the_trainer_breaks_things_and_the_sheet_names_who(trainer):
    fault = {"kind": "backlash", "axis": "X", "value": 0.2}
    trainer.ask(do("inject", fault=fault))
    assert "only the trainer" in trainer.look().refusal
    trainer.ask(Request("trainer", command={"do": "inject", "fault": fault}))
    assert trainer.session.room.machine.machine.axis("X").backlash == 0.2
    trainer.ask(Request("trainer", command={"do": "inject", "fault": {"kind": "alarm"}}))
    assert trainer.look().alarm.code == "external"
    trainer.ask(do("reset"))
    assert trainer.look().alarm is None
    sheet = score_sheet(trainer.session, Words("en", "fagor8070"))
    assert sheet["alarms"] == [{"code": "external", "name": "Safety circuit"}]
    actions = sheet["actions"]
    assert [(action["who"], bool(action["refused"])) for action in actions] == [
        ("operator", True), ("trainer", False), ("trainer", False), ("operator", False),
    ]  # fmt: skip
    assert trainer.changes == len(actions)
