"""What every diagnostic of the interpreter means; ``twin explain CODE`` tells it."""

import functools
import tomllib
from collections.abc import Mapping
from pathlib import Path

import pydantic

_FILE = Path(__file__).with_name("findings.toml")


class Explanation(pydantic.BaseModel):
    """One kind of diagnostic."""

    model_config = pydantic.ConfigDict(extra="forbid", frozen=True)

    dialect: str
    """In which the example is written."""
    example: str
    """A program that causes the diagnostic."""
    text: str
    """What it means."""
    remedy: str
    """What to do."""
    settings: dict[str, bool | dict[str, float]] = {}
    """What the example needs of the control's settings."""


@functools.cache
def findings() -> Mapping[str, Explanation]:
    """Every kind of diagnostic by its code."""
    data = tomllib.loads(_FILE.read_text(encoding="utf-8"))
    return {code: Explanation.model_validate(entry) for code, entry in data.items()}
