"""What the panel says: labels and alarms by language, with the words that one control has alone.

Scenes carry texts in the same languages.
"""

import functools
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field

from twin.files.toml import Table, read_toml

Language = Literal["en", "ru", "it", "cs"]

LANGUAGES: tuple[Language, ...] = ("en", "ru", "it", "cs")

Text = Annotated[dict[Language, str], Field(min_length=1)]
"""A text by language; where one is missing, English is in, else whichever there is."""

_FOLDER = Path(__file__).resolve().parent / "vocabularies"


class AlarmWords(Table):
    """What an alarm is called and what to do about it."""

    name: str
    why: str = ""
    """Its cause, and what it would have done to a real machine."""
    advice: str


class VocabularyFile(Table):
    """A vocabulary file."""

    labels: dict[str, str]
    alarms: dict[str, AlarmWords]
    controls: dict[str, dict[str, str]]


class Vocabulary:
    """The words of one control in one language."""

    def __init__(self, language: Language, control: str) -> None:
        file = vocabulary(language)
        self.language: Language = language
        self.control = control
        self._labels = file.labels | file.controls.get(control, {})
        self._alarms = file.alarms

    def __getitem__(self, key: str) -> str:
        """A label."""
        return self._labels[key]

    def as_data(self) -> dict[str, Any]:
        """Labels and alarms as plain data, for a page."""
        alarms = {code: words.model_dump() for code, words in self._alarms.items()}
        return {"labels": self._labels, "alarms": alarms}

    def alarm(self, code: str) -> AlarmWords:
        """What an alarm is called; one without words is called by its code."""
        return self._alarms.get(code) or AlarmWords(name=code, advice="")


@functools.cache
def vocabulary(language: Language) -> VocabularyFile:
    """Read the words of a language.

    Raises:
        ConfigError: The file is damaged.
    """
    return read_toml(_FOLDER / f"{language}.toml", VocabularyFile)


def in_language(text: dict[Language, str], language: Language) -> str:
    """A text in a language, or in the nearest that there is."""
    return text.get(language) or text.get("en") or next(iter(text.values()))
