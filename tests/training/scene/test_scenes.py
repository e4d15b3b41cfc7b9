"""Every shipped scene, played headless: its solution reaches full points, its mistake fails."""

import functools
import re
from typing import Literal, NamedTuple

import pytest

from twin.errors import ConfigError
from twin.training.room.observed import Notice
from twin.training.scene.phrases import translated
from twin.training.scene.scene_file import Scene, read_scene, scene_names, scene_path
from twin.training.scene.vocabulary import LANGUAGES
from twin.training.session.script import ScriptError, play, rehearse
from twin.training.session.session import Session

CONTROLS = ("gost", "codesys", "fagor8070", "mefi")


def scene(name: str) -> Scene:
    return read_scene(scene_path(name))


class Played(NamedTuple):
    """What came of one of a scene's scripts: its tasks' states, its score, messages of alarms."""

    states: tuple[str, ...]
    score: int
    said: tuple[str, ...]


@functools.cache
def played(name: str, script: Literal["solution", "mistake"]) -> Played:
    """A script, played once for all tests: that takes seconds."""
    session = Session(scene(name))
    said: list[str] = []
    raise_alarm = session.room.raise_alarm

    def note(notice: Notice) -> None:
        said.append(notice.message)
        raise_alarm(notice)

    session.room.raise_alarm = note
    play(session, getattr(session.scene.file, script))
    judge = session.room.judge
    return Played(tuple(verdict.state for verdict in judge.verdicts), judge.score, tuple(said))


def test_there_are_at_least_eight_two_per_control():
    dialects = [scene(name).preparation.dialect.name for name in scene_names()]
    assert len(dialects) >= 8
    assert all(dialects.count(control) >= 2 for control in CONTROLS)


@pytest.mark.parametrize("name", scene_names())
def test_every_text_is_told_in_every_language(name):
    file = scene(name).file
    texts = [file.title, file.story, *(task.text for task in file.tasks), *file.hints]
    assert file.lesson is not None, "the sheet must say what the trap was"
    texts += file.lesson.texts
    for text in texts:
        assert set(text) == set(LANGUAGES)
        figures = {language: re.findall(r"[A-Z]?-?\d+", told) for language, told in text.items()}
        for language, told in text.items():
            assert told.strip() == told
            # Blocks and places are the same in every language; nothing was left untranslated.
            named = {word for word in figures["en"] if word[0].isalpha()}
            assert named <= set(figures[language]), (language, told)
            assert language == "en" or told != text["en"]
        assert re.search("[А-Яа-я]", text["ru"])


@pytest.mark.played
@pytest.mark.parametrize("name", scene_names())
def test_the_solution_reaches_full_points(name):
    done = played(name, "solution")
    assert done.states == ("done",) * len(scene(name).file.tasks)
    assert done.score == scene(name).points


@pytest.mark.played
@pytest.mark.parametrize("name", scene_names())
def test_the_mistake_fails_as_intended(name):
    done = played(name, "mistake")
    failed = tuple(number for number, state in enumerate(done.states, 1) if state == "failed")
    assert failed == scene(name).file.mistake_fails
    assert failed
    assert done.score < scene(name).points


@pytest.mark.played
@pytest.mark.parametrize("name", scene_names())
def test_every_alarm_of_a_scenes_scripts_is_translated(name):
    for script in ("solution", "mistake"):
        for message in played(name, script).said:
            for language in LANGUAGES:
                assert (translated(message, language) == message) == (language == "en"), message


@pytest.mark.seconds("scripts are played")
def test_a_script_that_ends_otherwise_is_told(tmp_path):
    shipped = scene_path("fagor_full_circle")
    text = shipped.read_text(encoding="utf-8").replace(
        "mistake_fails = [1, 2]", "mistake_fails = [2]"
    )
    (tmp_path / shipped.name).write_text(text, encoding="utf-8")
    program = shipped.with_suffix(".nc").read_text(encoding="utf-8")
    (tmp_path / f"{shipped.stem}.nc").write_text(program, encoding="utf-8")
    solution, mistake = rehearse(read_scene(tmp_path / shipped.name))
    assert solution.intended
    assert (mistake.failed, mistake.intended) == ((1, 2), False)
    assert mistake.score < 10


@pytest.mark.parametrize("name", scene_names())
def test_texts_are_there_in_the_scene_s_language_and_in_english(name):
    file = scene(name).file
    texts = [file.title, file.story, *file.hints, *(task.text for task in file.tasks)]
    for text in texts:
        assert text.get("en")
        assert text.get(file.language)


MINIMAL = """
schema = 1
title = { en = "t" }
story = { en = "s" }
[job]
program = "p.nc"
dialect = "fagor8070"
[[tasks]]
text = { en = "x" }
finished = true
"""


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("finished = true", "finnished = true", "did you mean 'finished'"),
        ("finished = true", "", "exactly one condition"),
        ("finished = true", 'finished = true\ncleared = "x"', "exactly one condition"),
        ('"p.nc"', '"../p.nc"', "leaves the scene's folder"),
        ('"p.nc"', '"/etc/passwd"', "leaves the scene's folder"),
        ('"p.nc"', '"q.nc"', "no NC program"),
        ("[job]", "[start]\nposition = { Q = 1.0 }\n[job]", "no axis 'Q'"),
        ("schema = 1", "schema = 2", "schema"),
        ('title = { en = "t" }', 'title = { xx = "t" }', "title"),
    ],
)
def test_a_wrong_scene_is_refused_with_what_is_wrong(tmp_path, old, new, message):
    (tmp_path / "p.nc").write_text("M30\n")
    path = tmp_path / "scene.toml"
    path.write_text(MINIMAL)
    read_scene(path)
    path.write_text(MINIMAL.replace(old, new))
    with pytest.raises(ConfigError, match=message):
        read_scene(path)


def test_a_link_out_of_the_folder_is_refused(tmp_path):
    (tmp_path / "scene").mkdir()
    (tmp_path / "p.nc").write_text("M30\n")
    (tmp_path / "scene" / "p.nc").symlink_to(tmp_path / "p.nc")
    (tmp_path / "scene" / "scene.toml").write_text(MINIMAL)
    with pytest.raises(ConfigError, match="leads out of the scene's folder"):
        read_scene(tmp_path / "scene" / "scene.toml")


def test_a_scene_without_scripts_cannot_be_rehearsed(tmp_path):
    (tmp_path / "p.nc").write_text("M30\n")
    (tmp_path / "scene.toml").write_text(MINIMAL)
    with pytest.raises(ScriptError, match="no solution to rehearse"):
        rehearse(read_scene(tmp_path / "scene.toml"))
