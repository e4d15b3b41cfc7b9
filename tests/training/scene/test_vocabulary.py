"""What the panel says, in four languages."""

import typing

import pytest

from twin.nc.dialects import DIALECTS
from twin.recording.alarms import AlarmCode
from twin.training.scene.vocabulary import LANGUAGES, Vocabulary, vocabulary

OWN_ALARMS = ("program", "external")


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_language_says_the_same_things(language):
    english, other = vocabulary("en"), vocabulary(language)
    assert set(other.labels) == set(english.labels)
    assert set(other.alarms) == set(english.alarms)
    for words in other.controls.values():
        assert set(words) <= set(english.labels) | {"title"}
    for key, text in other.labels.items():
        assert text.strip()
        assert text.count("{") == english.labels[key].count("{")


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_alarm_is_explained(language):
    for code in (*typing.get_args(AlarmCode), *OWN_ALARMS):
        words = vocabulary(language).alarms[code]
        assert words.name
        assert words.advice


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("control", sorted(DIALECTS))
def test_every_control_has_its_title(language, control):
    assert Vocabulary(language, control)["title"]


def test_controls_have_words_of_their_own():
    assert Vocabulary("cs", "mefi")["mode_auto"] != Vocabulary("cs", "gost")["mode_auto"]
    assert Vocabulary("it", "fagor8070")["cycle_start"] == "MARCIA"
