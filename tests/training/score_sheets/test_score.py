"""The score sheet: who, when, what went wrong at which block, and how it looked."""

import html
import io

import pytest
from PIL import Image

from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.scene.vocabulary import LANGUAGES, Vocabulary, vocabulary
from twin.training.score_sheets.course import (
    CourseRow,
    Trainee,
    course_of,
    course_page,
    language_of,
    trainees,
)
from twin.training.score_sheets.score import ScoreSheetWriter, score_page, score_sheet
from twin.training.session.session import SceneSession


@pytest.fixture(scope="module")
def wrecked() -> SceneSession:
    """A rapid through the blank, twenty millimetres deep."""
    session = SceneSession(read_scene(scene_path("fagor_first_steps")))
    session.submit({"do": "sign", "name": " Jan Novák "})
    text = "%X\nN10 G90 S3000 M3\nN20 G0 X0 Y0 Z-5\nN30 M30"
    session.room.program.load(text)
    session.submit({"do": "cycle_start"})
    while session.room.alarm is None:
        session.advance()
    return session


@pytest.mark.parametrize("language", LANGUAGES)
def test_what_went_wrong_is_told_with_its_block(wrecked, language):
    words = Vocabulary(language, "fagor8070")
    sheet = score_sheet(wrecked, words, "2026-01-02 03:04")
    assert (sheet["name"], sheet["date"]) == ("Jan Novák", "2026-01-02 03:04")
    wrong, broken = sheet["wrong"]
    assert broken["code"] == "tool-broken"
    assert (wrong["code"], wrong["block"], wrong["text"]) == (
        "rapid-into-stock", "N20", "N20 G0 X0 Y0 Z-5",
    )  # fmt: skip
    told = words.alarm("rapid-into-stock")
    assert (wrong["why"], wrong["right"]) == (told.why, told.advice)
    page = score_page(sheet, words, [one.picture() for one in wrecked.room.alarms.moments])
    assert told.why in html.unescape(page)
    assert "data:image/png;base64," in page


def test_the_picture_shows_tool_and_part(wrecked):
    png = wrecked.room.alarms.moments[0].picture()
    assert png is not None
    picture = Image.open(io.BytesIO(png)).convert("RGB")
    colours = {colour for _, colour in picture.getcolors(1 << 20) or ()}
    assert (214, 50, 47) in colours
    assert (176, 187, 197) in colours


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_alarm_says_why_it_matters(language):
    assert all(alarm.why for alarm in vocabulary(language).alarms.values())


def test_a_program_that_only_ends_has_finished_nothing():
    session = SceneSession(read_scene(scene_path("fagor_first_steps")))
    session.submit({"do": "edit", "line": 2, "text": "N90 M30"})
    session.submit({"do": "cycle_start"})
    session.advance(50)
    assert session.room.slot.run is None
    assert not session.room.judge.evidence.ended_well


def test_a_course_lists_the_sheets_of_a_folder(tmp_path, wrecked):
    writer = ScoreSheetWriter(wrecked, Vocabulary("en", "fagor8070"), tmp_path)
    writer.close()
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "score.json").write_text("{", encoding="utf-8")
    rows, unread = course_of(tmp_path)
    assert [(row.name, row.scene, row.points, row.alarms) for row in rows] == [
        ("Jan Novák", "fagor_first_steps", 0, ("rapid-into-stock", "tool-broken"))
    ]
    assert unread == ["other/score.json"]
    for language in LANGUAGES:
        page = html.unescape(course_page(rows, language))
        shown = ("Jan Novák", vocabulary(language).alarms["tool-broken"].name, f'lang="{language}"')
        assert all(each in page for each in shown)
        assert read_scene(scene_path("fagor_first_steps")).file.title[language] in page


def test_a_course_is_in_the_language_of_most_sheets_and_counts_the_best_of_each_scene():
    row = CourseRow("Eva", "a", "A", "cs", "", 3, 10, True, 0, (), "")
    rows = [
        row, row._replace(points=10), row._replace(scene="b", points=4, handed_in=False),
        row._replace(name="Jan", language="en", points=6),
    ]  # fmt: skip
    assert language_of(rows) == "cs"
    assert language_of([]) == "en"
    assert trainees(rows) == [Trainee("Eva", 3, 1, 10, 10), Trainee("Jan", 1, 0, 6, 10)]


def test_a_sheet_that_was_handed_in_is_kept_when_a_trainer_goes_back(tmp_path):
    session = SceneSession(read_scene(scene_path("fagor_first_steps")))
    writer = ScoreSheetWriter(session, Vocabulary("en", "fagor8070"), tmp_path)
    session.submit({"do": "sign", "name": "Eva"})
    session.advance(20)
    session.submit({"do": "finish"})
    session.advance(1)
    writer._write()
    first = writer.folder
    session.submit({"do": "rewind", "seconds": 0.1}, "trainer")
    session.submit({"do": "go_on"}, "trainer")
    session.advance(1)
    writer.close()
    assert writer.folder != first
    rows, unread = course_of(tmp_path)
    assert not unread
    assert sorted(row.handed_in for row in rows) == [False, True]


@pytest.mark.parametrize(
    "wrong", ['"points": 1e999', '"points": 1e400, "of": NaN', '"alarms": ' + "[" * 100_000, '"name": "\\ud800"', "\xff"]
)  # fmt: skip
def test_a_course_is_not_ended_by_a_sheet_that_is_none(tmp_path, wrong):
    good = '"scene": "a", "points": 1, "of": 2, "handed_in": true, "hints": 0, "alarms": []'
    for folder, text in (
        ("bad", f"{{{good}, {wrong}"),
        ("good", f'{{{good}, "name": "\\u001b[2J"}}'),
    ):
        (tmp_path / folder).mkdir()
        closed = text if text.endswith("}") else text + "}"
        (tmp_path / folder / "score.json").write_text(closed, encoding="latin-1")
    rows, unread = course_of(tmp_path)
    assert unread == ["bad/score.json"]
    assert [(row.name, row.points) for row in rows] == [(" [2J", 1)]
    assert "score.html" in course_page(rows, "en")
