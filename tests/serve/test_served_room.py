"""A training room seen by a monitor: what is done in it is reported, and nothing can be done to it."""

import asyncio

import pytest

from twin.serve.agent import Agent, Clock
from twin.serve.buffer import NORMAL, Condition
from twin.serve.device import device_of
from twin.serve.room import RoomObserver, observe_room
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.session.session import SceneSession


@pytest.fixture
def session() -> SceneSession:
    return SceneSession(read_scene(scene_path("fagor_first_steps")))


def test_every_value_has_a_data_item(session: SceneSession):
    axes = session.room.machine.machine.axes
    items = {item.id for component in device_of("mill", axes).walk() for item in component.items}
    values = RoomObserver("part.nc").values(session.snapshot())
    assert set(values) <= items
    assert {"X_position", "X_position_commanded", "X_load", "mode", "execution"} <= set(values)
    assert (values["execution"], values["system"], values["part_count"]) == ("READY", NORMAL, "0")


def test_the_emergency_stop_is_a_fault_and_its_reset_ends_it(session: SceneSession):
    observer = RoomObserver("part.nc")
    session.submit({"do": "emergency_stop"})
    session.advance(5)
    values = observer.values(session.snapshot())
    assert values["emergency_stop"] == "TRIGGERED"
    assert values["execution"] == "STOPPED"
    assert isinstance(values["system"], Condition)
    assert (values["system"].level, values["system"].code) == ("Fault", "emergency-stop")


def test_a_trainers_fault_is_a_warning(session: SceneSession):
    fault = {"kind": "friction", "axis": "X", "value": 900.0}
    assert session.submit({"do": "inject", "fault": fault}, "trainer"), session.refusal
    told = RoomObserver("part.nc").values(session.snapshot())["system"]
    assert isinstance(told, Condition)
    assert (told.level, told.code) == ("Warning", "friction")
    assert "X" in told.text


def test_reading_changes_nothing_of_the_motion(session: SceneSession):
    alone = SceneSession(session.scene)
    observer = RoomObserver("part.nc")
    agent = Agent(device_of("mill", session.room.machine.machine.axes), Clock(), "made up")
    for each in (session, alone):
        each.submit({"do": "cycle_start"})
    for _ in range(30):
        session.advance(2)
        alone.advance(2)
        agent.observe(agent.clock.elapsed_s(), observer.values(session.snapshot()))
    assert session.snapshot().machine_position == alone.snapshot().machine_position
    found, _ = agent.buffer.sample({"X_position", "execution"}, None, 1000)
    assert len(found) > 2


def test_the_agent_looks_until_it_is_cancelled(session: SceneSession):
    agent = Agent(device_of("mill", session.room.machine.machine.axes), Clock(), "made up")

    async def for_a_while() -> None:
        watching = asyncio.create_task(
            observe_room(agent, RoomObserver("part.nc"), session.snapshot)
        )
        await asyncio.sleep(0.1)
        watching.cancel()

    asyncio.run(for_a_while())
    assert agent.buffer.current({"mode"})[0].value == "AUTOMATIC"
