"""What was meant by a line that cannot be read, by ``slips.toml``, and which names are like one that is unknown."""

import difflib
import re
import tomllib
from collections.abc import Collection, Iterable
from functools import cache
from pathlib import Path

import pydantic

_ABOUT = 200
"""Characters before and behind a place that are looked at: a line may have any length."""
_MOST_NEAR = 3
_LONGEST_NAME = 40
_NEARLY = 0.7
"""Likeness of two names, of 1, of which one may be a slip for the other."""


class Slip(pydantic.BaseModel):
    """One slip."""

    model_config = pydantic.ConfigDict(extra="forbid", frozen=True)

    pattern: re.Pattern[str]
    hint: str
    dialects: frozenset[str] = frozenset()


@cache
def slips() -> tuple[Slip, ...]:
    """All of them, in the order in which they are looked for."""
    file = Path(__file__).with_name("slips.toml")
    entries = tomllib.loads(file.read_text(encoding="utf-8"))["slip"]
    return tuple(
        Slip.model_validate({**each, "pattern": re.compile(each["pattern"], re.IGNORECASE)})
        for each in entries
    )


def slip_at(line: str, at: int, dialect: str) -> str | None:
    """What to write in place of what is at a place of a line, from 0; None: no known slip."""
    for slip in slips():
        if slip.dialects and dialect not in slip.dialects:
            continue
        matches = slip.pattern.finditer(line, max(0, at - _ABOUT), at + _ABOUT)
        if any(found.start() <= at <= found.end() for found in matches):
            return slip.hint
    return None


def near(name: str, known: Iterable[str]) -> list[str]:
    """Known names for which a name may be a slip, the most alike first."""
    if len(name) > _LONGEST_NAME:
        return []
    return difflib.get_close_matches(name.upper(), list(known), _MOST_NEAR, _NEARLY)


def near_or_listed(name: str, known: Collection[str], dialect: str) -> str:
    """Names that are like one that is unknown, and where all of them are listed."""
    alike, listed = near(name, known), f"all of them: twin dialects {dialect}"
    return f"near it: {', '.join(alike)}; {listed}" if alike else listed
