"""Every shipped scene is whole and told in every language; ``test_played_scenes.py`` plays them."""

import re

import pytest

from twin.errors import ConfigError
from twin.training.scene.scene_file import Scene, read_scene, scene_names, scene_path
from twin.training.scene.vocabulary import LANGUAGES
from twin.training.session.script import ScriptError, rehearse

CONTROLS = ("gost", "codesys", "fagor8070", "mefi")


def scene(name: str) -> Scene:
    return read_scene(scene_path(name))


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


def test_a_blank_under_a_tool_that_swivels_is_refused(tmp_path):
    shipped = scene_path("fanuc_second_side")
    text = shipped.read_text(encoding="utf-8").replace('machine = "mill5"', 'machine = "mill5h"')
    text = text.replace("part_zero = { X = 0.0, Y = 0.0, Z = -440.0 }\n", "")
    (tmp_path / shipped.name).write_text(text, encoding="utf-8")
    (tmp_path / f"{shipped.stem}.nc").write_text(shipped.with_suffix(".nc").read_text())
    with pytest.raises(ConfigError, match="where the tool does not swivel"):
        rehearse(read_scene(tmp_path / shipped.name))


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


@pytest.mark.parametrize("name", scene_names())
def test_a_program_says_nothing_in_one_language_alone(name):
    """A pupil reads the scene in his own; what a TNC writes beside its Q parameters is the control's."""
    preparation = scene(name).preparation
    if preparation.dialect.name != "heidenhain":
        for line in preparation.source.lines:
            assert not re.search(r"[(;$].*[^\W\d_]{3,}", line), line
