"""The drawn path of a program against the way that the room then drives."""

import numpy as np
import pytest

from tests.training.session.commanding import do
from twin.nc.canonical import FloatArray
from twin.training.program import preview as module
from twin.training.program.preview import Preview
from twin.training.room.run_settings import path_to_come
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.session.session import SceneSession


@pytest.fixture
def session() -> SceneSession:
    return SceneSession(read_scene(scene_path("fagor_first_steps")))


def load(session: SceneSession, text: str) -> None:
    session.room.program.load(text)


def drawn(session: SceneSession) -> Preview:
    return path_to_come(session.room).drawn()


def driven(session: SceneSession) -> FloatArray:
    """Every tenth setpoint of the tip while the program runs, in the part's frame."""
    room, found = session.room, []
    do(session, "cycle_start")
    for _ in range(6000):
        session.advance()
        found.append(room.standing_setpoint - room.setup.tables.length_difference)
        if room.slot.run is None:
            return room.setup.part_frame.position(np.array(found))
        if room.slot.held:
            do(session, "cycle_start")
    raise AssertionError(f"it never ended: {room.alarm}")


def off(path: Preview, points: FloatArray) -> float:
    """How far the farthest of some points is from the drawn lines [mm]."""
    start, way = path.points[:-1].astype(float), np.diff(path.points.astype(float), axis=0)
    length = np.maximum((way**2).sum(axis=1), 1e-12)
    share = np.clip(((points[:, None] - start) * way).sum(axis=2) / length, 0.0, 1.0)
    nearest = start + share[..., None] * way
    return float(np.linalg.norm(points[:, None] - nearest, axis=2).min(axis=1).max())


TEXT = """N10 G90 G71 S3000 M3
N20 G0 X10 Y5
N30 G1 Z5 F2000
N40 G3 X20 Y15 I0 J10
N50 M0
N60 G1 X0 C60 F3000
N70 G0 Z30
N80 M30"""


def test_the_way_that_is_drawn_is_the_way_that_is_driven(session):
    load(session, TEXT)
    path = drawn(session)
    assert (path.complete, path.message, path.moves) == (True, "", 5)
    points = driven(session)
    # A piece of 5 degrees leaves an arc of R10 by 10 um, and a way across the turning table by 54 um.
    assert off(path, points) < 0.06
    assert np.abs(path.points[-1] - points[-1]).max() < 0.01
    assert np.abs(path.points[0] - path.origin - (0.0, 0.0, 50.0)).max() < 1e-3
    first, last = path.rapid[1], path.rapid[-1]
    assert first
    assert last
    assert not path.rapid[2:-1].any()


def test_behind_a_search_it_begins_with_the_way_to_the_block(session):
    load(session, TEXT)
    do(session, "search", line=6)
    path = drawn(session)
    points = driven(session)
    assert path.complete
    assert off(path, points) < 0.06
    assert np.abs(path.points[0] - points[0]).max() < 0.5


def test_a_program_that_is_wrong_is_not_drawn_and_says_why(session):
    load(session, "N10 G90\nN20 G0 X5\nN30 G2 X10 Y0 R1\nN40 M30")
    path = drawn(session)
    assert path.finding is not None
    assert (path.line, len(path.points), path.complete) == (3, 0, False)


def test_a_way_out_of_the_travel_is_drawn_up_to_there(session):
    load(session, "N10 G90\nN20 G0 X5\nN30 G0 X9000\nN40 M30")
    path = drawn(session)
    assert (path.line, path.moves, path.complete) == (3, 1, False)
    assert "X" in path.message


def test_a_tool_that_is_not_there_is_told(session):
    load(session, "N10 G90\nN20 G0 X5\nN30 T98 M6\nN40 G0 X0\nN50 M30")
    path = drawn(session)
    assert not path.complete
    assert path.message


@pytest.mark.parametrize(
    "text", ["N10 G91\nN20 G1 X1 F500\nN30 G1 X-1\n$GOTO N20\nN50 M30", "N10 G90\n$GOTO N10\nM30"]
)
def test_a_program_without_an_end_is_drawn_in_part(session, monkeypatch, text):
    monkeypatch.setattr(module, "MOST_MOVES", 500)
    monkeypatch.setattr(module, "MOST_BLOCKS", 2000)
    load(session, text)
    path = drawn(session)
    assert not path.complete
    assert path.moves <= 500


def test_drawing_changes_nothing_of_the_machine(session):
    load(session, TEXT)
    session.advance(10)
    before = session.snapshot()
    drawn(session)
    assert session.snapshot() == before
