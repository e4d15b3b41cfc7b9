"""A vise or a chuck in every scene: it touches the part, reaches into nothing, and is met."""

import pytest

from twin.machine.model.clamping import refuse_overlaps
from twin.machine.model.model import MachineModel
from twin.run.preparing.layout import lay_out
from twin.training.scene.scene_file import Scene, read_scene, scene_names, scene_path
from twin.training.session.session import SceneSession


def scene(name: str) -> Scene:
    return read_scene(scene_path(name))


@pytest.mark.parametrize("name", scene_names())
def test_every_part_is_held_and_nothing_is_in_two_places(name):
    preparation = scene(name).preparation
    job, machine = preparation.job.file, preparation.machine
    assert machine.file.fixtures
    blank = lay_out(job, machine).blank
    refuse_overlaps(MachineModel(machine, job.tools[0], blank))
    if job.stock is None or not job.fixtures:
        return  # What stands for it, or holds it, is a fixture of its own.
    names = {fixture.name for fixture in job.fixtures}
    assert ({"chuck"} if job.stock.shape == "cylinder" else {"vise bed", "fixed jaw"}) <= names
    assert all(fixture.mass > 0.0 for fixture in job.fixtures)


@pytest.mark.seconds("a room is stepped")
def test_a_jaw_is_met():
    session = SceneSession(scene("fagor_first_steps"))
    for command in (
        {"do": "mode", "mode": "jog"},
        {"do": "jog", "axis": "Y", "direction": -1, "step": 52.0, "feed": 6000.0},
        {"do": "jog", "axis": "Z", "direction": -1, "step": 90.0, "feed": 6000.0},
    ):
        assert session.submit(command), session.refusal
        for _ in range(1000):
            session.advance()
            if session.room.slot.run is None and not session.room.machine.moving:
                break
    alarm = session.room.alarm
    assert alarm is not None
    assert (alarm.code, alarm.between) == ("collision", ("cutter", "moving jaw"))
