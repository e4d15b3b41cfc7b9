"""What every diagnostic of the interpreter means, for ``twin explain CODE``."""

import difflib
import functools
import tomllib
from collections.abc import Mapping
from pathlib import Path

import pydantic

from twin.errors import UsageError

_FILE = Path(__file__).with_name("findings.toml")


class Finding(pydantic.BaseModel):
    """One kind of diagnostic."""

    model_config = pydantic.ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)

    dialect: str
    """In which the example is written."""
    example: str
    """A program that earns the diagnostic."""
    text: str
    """What it means."""
    remedy: str
    """What to do."""
    settings: dict[str, bool] = {}
    """What the example needs of the control's settings."""


@functools.cache
def findings() -> Mapping[str, Finding]:
    """Every kind of diagnostic by its code."""
    data = tomllib.loads(_FILE.read_text(encoding="utf-8"))
    return {code: Finding.model_validate(entry) for code, entry in data.items()}


def overview() -> str:
    """Every code with the first sentence of its meaning, one a line."""
    width = max(map(len, findings()))
    return "\n".join(
        f"{code:{width}}  {finding.text.split('. ')[0].rstrip('.')}"
        for code, finding in sorted(findings().items())
    )


def explain(code: str) -> str:
    """Text for a person about one code.

    Raises:
        UsageError: There is no such code; the message names the nearest.
    """
    finding = findings().get(code)
    if finding is None:
        near = difflib.get_close_matches(code, findings(), n=3)
        hint = f"did you mean {', '.join(near)}?" if near else f"codes: {', '.join(findings())}"
        raise UsageError(f"no diagnostic '{code}': {hint}")
    example = "\n".join(f"    {line}" for line in finding.example.splitlines())
    return (
        f"{code}\n\n{finding.text}\n{finding.remedy}\n\n"
        f"Earned by this program ({finding.dialect}):\n\n{example}\n"
    )
