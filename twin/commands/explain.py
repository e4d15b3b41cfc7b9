"""``twin explain``: every code that a message may have, whichever package reports it."""

import difflib
import functools
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from twin.cutting.forces.materials import materials
from twin.errors import UsageError
from twin.nc.text.diagnostics.explain import Explanation, findings

_FILE = Path(__file__).with_name("codes.toml")


class Code(NamedTuple):
    """A code that is not the interpreter's.

    Attributes:
        group: ``alarm``, ``warning``, ``tolerance``, ``baseline`` or ``check``.
    """

    group: str
    text: str
    remedy: str


@functools.cache
def codes() -> Mapping[str, Code]:
    """Every code that is not the interpreter's, by its name."""
    groups = tomllib.loads(_FILE.read_text(encoding="utf-8"))
    return {
        name: Code(group, **entry)
        for group, entries in groups.items()
        for name, entry in entries.items()
    }


def overview() -> str:
    """Every code with the first sentence of its meaning, one a line, by group."""
    groups: dict[str, dict[str, str]] = {"program": {}}
    groups["program"] = {name: found.text for name, found in sorted(findings().items())}
    for name, code in codes().items():
        groups.setdefault(code.group, {})[name] = code.text
    width = max(map(len, (*findings(), *codes())))
    return "\n\n".join(
        "\n".join(
            (f"{group}:", *(f"  {name:{width}}  {_first(text)}" for name, text in texts.items()))
        )
        for group, texts in groups.items()
    )


def _first(text: str) -> str:
    return text.split(". ", maxsplit=1)[0].rstrip(".")


def explain(code: str) -> str:
    """Explanation of one code, or of a material of a job.

    Raises:
        UsageError: There is no such code; the message names the nearest.
    """
    # A tolerance of a range of lines has the range in its code: blocks[0].contour_um.
    finding, other = findings().get(code), codes().get(code.partition("[")[0])
    if finding is not None:
        return _program_text(code, finding)
    if other is not None:
        return f"{code} ({other.group})\n\n{other.text}\n{other.remedy}"
    material = materials().get(code)
    if material is not None:
        return (
            f"{code} (stock.material)\n\nA chip of 1 mm by 1 mm takes {material.kc:g} N/mm²; the specific "
            f"force falls with its thickness to the power of {material.mc:g} (Kienzle). "
            f"{material.density:g} g/cm³.\nSource: {material.source}"
        )
    known = (*findings(), *codes(), *materials())
    near = difflib.get_close_matches(code, known, n=3)
    hint = f"did you mean {', '.join(near)}?" if near else "'twin explain' lists all codes"
    raise UsageError(f"no code '{code}': {hint}")


def _program_text(code: str, finding: Explanation) -> str:
    example = "\n".join(f"    {line}" for line in finding.example.splitlines())
    return (
        f"{code}\n\n{finding.text}\n{finding.remedy}\n\n"
        f"Example of a program that causes it ({finding.dialect}):\n\n{example}\n"
    )
