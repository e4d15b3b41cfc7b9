"""The file of a class: what is kept, what is final, what is exported."""

import csv
import dataclasses
import io
import stat
import uuid

import pytest

from twin.errors import UsageError
from twin.training.classroom.marks import AttemptResult, ClassFile, as_csv, as_statements
from twin.training.classroom.recorder import Recorder
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.session.session import SceneSession

MARK = AttemptResult(
    str(uuid.UUID(int=1)), "Anna", "mefi_lead", "The lead", "2026-01-01T08:00:00+01:00",
    "2026-01-01T08:09:00+01:00", 7, 10, True, 1, "collision", 540.0, "out",
)  # fmt: skip


def test_what_was_handed_in_is_final_and_outlives_the_server(tmp_path):
    file = ClassFile(tmp_path)
    open_mark = dataclasses.replace(MARK, points=3, handed_in=False)
    for mark in (open_mark, MARK, dataclasses.replace(MARK, points=0, handed_in=False)):
        file.record(mark)
    assert ClassFile(tmp_path).marks() == [MARK]
    assert stat.S_IMODE(file.path.stat().st_mode) == 0o600


def test_links_seats_and_scenes_stay_whatever_becomes_of_the_roster(tmp_path):
    file = ClassFile(tmp_path)
    seats = file.seats(["Anna", "Bob"])
    tokens = file.tokens({"seat-1": "one", "seat-2": "two"})
    file.hand_out("Anna", "mefi_lead")
    again = ClassFile(tmp_path)
    assert again.seats(["Zoë", "Bob", "Anna"]) == {**seats, "Zoë": 3}
    assert again.tokens({"seat-2": "other", "seat-3": "three"}) == {
        "seat-2": tokens["seat-2"],
        "seat-3": "three",
    }
    assert again.scenes() == {"Anna": "mefi_lead"}


def test_another_file_is_no_class(tmp_path):
    (tmp_path / "class.sqlite").write_text("something else that is no database at all" * 9)
    with pytest.raises(UsageError, match="not the file of a class"):
        ClassFile(tmp_path)
    (tmp_path / "file").touch()
    with pytest.raises(UsageError, match="not the file of a class"):
        ClassFile(tmp_path / "file")


def test_marks_are_a_table_and_statements():
    strange = dataclasses.replace(
        MARK, attempt=str(uuid.UUID(int=2)), pupil='O"Brien,\nPat', points=10
    )
    unfinished = dataclasses.replace(MARK, handed_in=False)
    rows = list(csv.DictReader(io.StringIO(as_csv([MARK, strange]))))
    assert [(row["pupil"], row["points"]) for row in rows] == [
        ("Anna", "7"),
        ('O"Brien,\nPat', "10"),
    ]
    formulas = ["=1+2", "+1", "-1", "@SUM(A1)", "Eva=1"]
    table = as_csv([dataclasses.replace(MARK, pupil=name) for name in formulas])
    shown = [row["pupil"] for row in csv.DictReader(io.StringIO(table))]
    assert shown == ["'=1+2", "'+1", "'-1", "'@SUM(A1)", "Eva=1"]
    statements = as_statements([MARK, strange, unfinished], "https://school.example")
    verbs = [one["verb"]["id"].rsplit("/", 1)[1] for one in statements]
    assert verbs == ["failed", "passed"]
    result = statements[0]["result"]
    assert result["score"] == {"raw": 7, "min": 0, "max": 10, "scaled": 0.7}
    assert (result["success"], result["completion"], result["duration"]) == (
        False,
        True,
        "PT540.00S",
    )
    assert statements[0]["actor"]["account"] == {
        "homePage": "https://school.example",
        "name": "Anna",
    }


@pytest.mark.seconds("a scene is begun")
def test_a_mark_is_written_when_it_changes_and_a_session_behind_a_hand_in_is_another_one(tmp_path):
    file = ClassFile(tmp_path)
    recorder = Recorder(file, "Anna", lambda: None)
    session = SceneSession(read_scene(scene_path("fagor_first_steps")))
    session.submit({"do": "sign", "name": "Anna"})
    assert recorder.note(session) == ""
    session.advance(100)
    assert not file.marks()
    session.submit({"do": "hint"})
    recorder.note(session)
    session.submit({"do": "finish"})
    recorder.note(session)
    assert [(one.hints, one.handed_in) for one in file.marks()] == [(1, True)]
    session.advance(100)
    session.submit({"do": "rewind", "seconds": 60.0}, "trainer")
    session.submit({"do": "go_on"}, "trainer")
    session.submit({"do": "mode", "mode": "jog"})
    recorder.note(session)
    assert [(one.hints, one.handed_in) for one in file.marks()] == [(1, True), (0, False)]
    file.path.unlink()
    file.path.mkdir()
    session.submit({"do": "hint"})
    assert str(file.path) in recorder.note(session)
