"""Texts in the languages of the trade: in scene files and in the panel's vocabularies."""

from typing import Annotated, Literal

from pydantic import Field

Language = Literal["en", "ru", "it", "cs"]

LANGUAGES: tuple[Language, ...] = ("en", "ru", "it", "cs")

Text = Annotated[dict[Language, str], Field(min_length=1)]
"""A text by language; where one is missing, English stands in, else whichever there is."""


def in_language(text: dict[Language, str], language: Language) -> str:
    """A text in a language, or in the nearest that there is."""
    return text.get(language) or text.get("en") or next(iter(text.values()))
