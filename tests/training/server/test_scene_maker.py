"""A scene that is made of a room is one that can be played, and what is typed is read before it is loaded."""

import asyncio
import threading
from pathlib import Path

import pytest

from twin.errors import UsageError
from twin.training.room.room import Room
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.scene.vocabulary import Language
from twin.training.server.driver import Driver
from twin.training.server.program_check import ProgramCheck
from twin.training.server.scene_maker import scene_of, write_scene
from twin.training.session.session import SceneSession

GROOVE = "N10 G0 X0 Y0 Z10\nN20 M3 S1000\nN30 G1 Z-1 F200\nN40 G1 X-5\nN50 G0 Z20\nN60 M30\n"


def made(room: Room, language: Language, title: str, folder: Path) -> Path:
    """The file of a scene that was made of a room."""
    return write_scene(scene_of(room, language, title, ""), folder)


@pytest.fixture
def session():
    return SceneSession(read_scene(scene_path("fagor_first_steps")))


@pytest.mark.seconds("a program is run twice")
def test_what_the_teacher_has_cut_is_what_the_pupil_must_cut(session, tmp_path):
    session.submit({"do": "load", "text": GROOVE.replace("\n", "\r\n")})
    session.submit({"do": "set_offset", "axis": "Y", "value": 0.25})
    session.submit({"do": "override", "dial": "feed", "percent": 80})
    session.submit({"do": "cycle_start"})
    session.advance(900)
    assert session.room.slot.running == ""
    path = made(session.room, "cs", 'Drážka: "5 mm"', tmp_path / "scenes")
    again = made(session.room, "cs", 'Drážka: "5 mm"', tmp_path / "scenes")
    assert (path.name, again.name) == ("drazka_5_mm.toml", "drazka_5_mm_2.toml")
    scene = read_scene(path)
    assert scene.file.title == {"cs": 'Drážka: "5 mm"'}
    assert scene.file.part is not None
    assert scene.file.part.points
    played = SceneSession(scene)
    assert played.room.program.lines == tuple(GROOVE.splitlines())
    assert played.room.setup.tables.zero.tolist() == pytest.approx(
        session.room.setup.tables.zero.tolist()
    )
    assert played.room.panel.feed_override == 80
    played.submit({"do": "cycle_start"})
    played.advance(1200)
    played.submit({"do": "finish"})
    assert played.room.judge.score == scene.points
    lazy = SceneSession(scene)
    lazy.submit({"do": "load", "text": GROOVE.replace("X-5", "X-2")})
    lazy.submit({"do": "cycle_start"})
    lazy.advance(1200)
    lazy.submit({"do": "finish"})
    assert lazy.room.judge.score == 0


def test_a_room_that_is_no_scene_of_its_own_is_refused_and_leaves_nothing(session, tmp_path):
    with pytest.raises(UsageError, match="a title"):
        made(session.room, "en", " ", tmp_path)
    own = SceneSession(read_scene(scene_path("fagor_climb")))
    with pytest.raises(UsageError, match="not a complete scene by itself"):
        made(own.room, "en", "With a machine of its own", tmp_path)
    (tmp_path / "file").touch()
    with pytest.raises(UsageError, match="not a complete scene by itself"):
        made(session.room, "en", "Nowhere", tmp_path / "file")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_a_program_with_what_cannot_be_seen_is_refused(session):
    for wrong in ("N10 G0\x00", "N10\x1b[2J", "N10\rN20", "N10\u2028N20"):
        assert not session.submit({"do": "load", "text": wrong})
        assert not session.submit({"do": "edit", "line": 1, "text": wrong})
        assert "is no letter of a program" in session.refusal
    assert not session.submit({"do": "load", "text": "x" * 60_001})
    assert session.submit({"do": "load", "text": "N10 G0\tX1 (žluťoučký)\n"})
    session.submit({"do": "undo"})
    assert session.room.program.lines == tuple(session.scene.preparation.source.lines)


def test_what_is_typed_is_read_as_the_control_reads_it(session):
    driver = Driver(session)
    thread = threading.Thread(target=driver.serve)
    thread.start()
    check = ProgramCheck(driver)
    try:
        assert asyncio.run(check.of(GROOVE)) == {"moves": 4}
        found = asyncio.run(check.of("N10 G0 X0\nN20 G1 XO F100\n"))
        assert found["line"] == 2
        assert found["message"].keys() == {"en", "ru", "it", "cs"}
        endless = asyncio.run(check.of("N10 G0 X1\nN20 G0 X0\n$GOTO N10\n"))
        assert endless["line"] > 0 or "moves" in endless
    finally:
        driver.stop()
        thread.join()
    assert session.room.program.lines == tuple(session.scene.preparation.source.lines)
