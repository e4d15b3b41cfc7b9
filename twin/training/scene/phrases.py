"""The machine's own sentences in the operator's language.

The rooms to the left speak English, with numbers in their sentences. Here a sentence is known again
by its form. One that nobody has translated is shown as the control says it.
"""

import functools
import re
from pathlib import Path

from twin.files.toml import Table, read_toml
from twin.training.scene.texts import Language, Text

_FILE = Path(__file__).resolve().parent / "vocabularies" / "phrases.toml"
_PLACE = re.compile(r"\{(\w+)\}")


class PhrasesFile(Table):
    """The file of sentences."""

    phrases: list[Text]


def translated(message: str, language: Language) -> str:
    """A sentence of the machine in a language, or as it is.

    Args:
        message: In English.
        language: Wanted.
    """
    if language == "en":
        return message
    for form, phrase in _forms():
        found = form.fullmatch(message)
        if found is not None:
            parts = {name: translated(part, language) for name, part in found.groupdict().items()}
            return phrase[language].format(**parts)
    return message


@functools.cache
def _forms() -> tuple[tuple[re.Pattern[str], Text], ...]:
    """Each sentence's form, those that fix the most words first."""
    phrases = read_toml(_FILE, PhrasesFile).phrases
    phrases.sort(key=lambda phrase: -len(_PLACE.sub("", phrase["en"])))
    return tuple((_form(phrase["en"]), phrase) for phrase in phrases)


def _form(english: str) -> re.Pattern[str]:
    pieces = _PLACE.split(english)
    fixed, names = pieces[::2], pieces[1::2]
    places = [f"(?P<{name}>.+?)" for name in names] + [""]
    return re.compile("".join(re.escape(a) + b for a, b in zip(fixed, places, strict=True)))
