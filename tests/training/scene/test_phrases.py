"""The machine's sentences in the operator's language: all that it can say in a scene."""

import ast
import dataclasses
import string
from pathlib import Path

import pytest

from twin import training
from twin.files.toml import read_toml
from twin.nc.text.diagnostics.diagnostics import Diagnostic
from twin.nc.text.diagnostics.explain import findings
from twin.training.scene import phrases
from twin.training.scene.phrases import PhrasesFile, finding_in, translated
from twin.training.scene.vocabulary import LANGUAGES, Language
from twin.training.session.commands import WRONG

SPEAKERS = [
    path
    for folder in ("room", "session")
    for path in sorted((Path(training.__file__).parent / folder).rglob("*.py"))
    if path.name not in ("commands.py", "script.py")
]
RAISED = ("UsageError", "TwinError", "AlarmStandsError")
OTHERS: list[Language] = [lang for lang in LANGUAGES if lang != "en"]
UNITS = ("mm", "deg", "N", "N m", "text")
"""Words that are the same in several languages."""
ALL = read_toml(phrases._FILE, PhrasesFile).phrases


def places(text: str) -> list[str]:
    return sorted(name for _, name, _, _ in string.Formatter().parse(text) if name)


def sample(node: ast.expr) -> str | None:
    """A sentence as it would be said, with something in each of its places."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    if isinstance(node, ast.JoinedStr):
        return "".join(
            str(part.value) if isinstance(part, ast.Constant) else "1.5" for part in node.values
        )
    return None


def refusals() -> set[str]:
    """What actions, rooms and sessions say no with, read from their source."""
    found = set()
    for path in SPEAKERS:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Name):
                continue
            if node.func.id in RAISED and node.args:
                found.add(sample(node.args[0]))
    return {text for text in found if text}


@pytest.mark.parametrize("phrase", ALL, ids=lambda phrase: phrase["en"][:40])
def test_a_sentence_is_told_in_every_language_with_its_figures(phrase):
    assert set(phrase) == set(LANGUAGES)
    if phrase["en"] not in UNITS:
        assert len({text.strip() for text in phrase.values()}) == len(LANGUAGES)
    for text in phrase.values():
        assert places(text) == places(phrase["en"])
    said = phrase["en"].format(**{name: f"{name}7" for name in places(phrase["en"])})
    for language in OTHERS:
        expected = phrase[language].format(**{name: f"{name}7" for name in places(phrase["en"])})
        assert translated(said, language) == expected


@pytest.mark.parametrize("text", sorted(refusals()))
def test_every_refusal_is_translated(text):
    assert translated(text, "en") == text
    for language in OTHERS:
        assert translated(text, language) != text


@pytest.mark.parametrize("kind", WRONG)
def test_what_is_wrong_with_a_typed_value_is_translated(kind):
    limits = dict.fromkeys(("gt", "ge", "le", "max_length"), 5)
    message = f"reading: {WRONG[kind].format(**limits)}"
    for language in OTHERS:
        assert "5" in translated(message, language) or "5" not in message
        assert translated(message, language).split(":")[0] != "reading"


def test_whatever_the_interpreter_finds_is_told_in_every_language():
    known = phrases._findings()
    assert set(known) == set(findings())
    for code, said in known.items():
        assert set(said) == set(OTHERS), code
        assert len(set(said.values())) == len(OTHERS), code


def test_a_finding_names_the_words_in_question():
    found = Diagnostic("error", "unknown-g", "G77 is unknown", "MDI", 1, 4, 3, "G0 G77 X1")
    assert finding_in(found, "ru").startswith("«G77» - ")
    assert finding_in(found, "en") == "unknown-g: G77 is unknown"
    new = dataclasses.replace(found, code="never-heard-of")
    assert finding_in(new, "cs") == "never-heard-of: G77 is unknown"


def test_names_within_a_sentence_are_translated_and_unknown_ones_are_kept():
    message = "the holder's nut meets the clamp (0.08 mm deep)"
    assert translated(message, "cs") == "náraz: matice držáku a upínka (0.08 mm hluboko)"
    assert translated("the gadget meets the table (1.00 mm deep)", "it") == (
        "urto: gadget e tavola (per 1.00 mm)"
    )


@pytest.mark.parametrize("language", LANGUAGES)
def test_what_nobody_has_translated_stays_as_the_control_says_it(language):
    message = "arc-radius: the radius does not reach {over} the chord"
    assert translated(message, language) == message
    assert translated("", language) == ""
