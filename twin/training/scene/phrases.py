"""The machine's own sentences in the operator's language.

The rooms to the left speak English, with numbers in their sentences. Here a sentence is known again
by its form, and what the interpreter finds by its code. What nobody has translated is shown as the
control says it.
"""

import functools
import re
from pathlib import Path

from twin.files.toml import Table, read_toml
from twin.nc.text.diagnostics.diagnostics import Diagnostic
from twin.training.scene.vocabulary import Language, Text, vocabulary

_FOLDER = Path(__file__).resolve().parent / "vocabularies"
_FILE = _FOLDER / "phrases.toml"
_PLACE = re.compile(r"\{(\w+)\}")


class PhrasesFile(Table):
    """The file of sentences."""

    phrases: list[Text]


def _part(name: str, part: str, language: Language) -> str:
    alarms = vocabulary(language).alarms
    return alarms[part].name if name == "code" and part in alarms else translated(part, language)


class FindingsFile(Table):
    """The file of what the interpreter finds, by code."""

    findings: dict[str, Text]


def translated(message: str, language: Language) -> str:
    """A sentence of the machine in a language, or as it is."""
    if language == "en":
        return message
    for form, phrase in _forms():
        found = form.fullmatch(message)
        if found is not None:
            parts = {name: _part(name, part, language) for name, part in found.groupdict().items()}
            return phrase[language].format(**parts)
    return message


def finding_in(finding: Diagnostic, language: Language) -> str:
    """What the interpreter found, in a language: the words in question, and what is wrong with them."""
    said = _findings().get(finding.code, {}).get(language)
    if said is None:
        return f"{finding.code}: {finding.message}"
    begin = finding.column - 1
    words = finding.source[begin : begin + finding.width].strip()
    return f"«{words}» - {said}" if words else said


@functools.cache
def _findings() -> dict[str, Text]:
    return read_toml(_FOLDER / "findings.toml", FindingsFile).findings


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
