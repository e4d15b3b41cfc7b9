"""The slips that are made most, as programs of a line or two, each with the diagnostic that it earns.

A file of ``tests/bad/slips`` holds those of a dialect: the program, its diagnostic set in behind it, a blank line.
``python -m tests.nc.text.diagnostics.test_slips`` writes the diagnostics again; read them as a beginner would.
"""

from pathlib import Path
from typing import NamedTuple

import pytest

from tests.nc.running import ROOT
from tests.nc.test_bad import WITH_TOOL
from twin.nc.dialects import dialect_named
from twin.nc.interpreter import Interpretation
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.nc.text.diagnostics.slips import slips
from twin.nc.text.source import source_from_text

FILES = sorted((ROOT / "tests" / "bad" / "slips").glob("*.txt"))
_SET_IN = "    "


class Slip(NamedTuple):
    dialect: str
    program: str
    diagnostic: str


def slips_of(path: Path) -> list[Slip]:
    made = []
    for part in path.read_text(encoding="utf-8").strip("\n").split("\n\n"):
        lines = part.splitlines()
        program = [line for line in lines if not line.startswith(_SET_IN)]
        told = [line.removeprefix(_SET_IN) for line in lines if line.startswith(_SET_IN)]
        made.append(Slip(path.stem, "\n".join(program), "\n".join(told)))
    return made


def diagnostic_of(slip: Slip) -> str:
    source = source_from_text(f"{slip.program}\nM30\n", "slip")
    with pytest.raises(ProgramError) as raised:
        list(Interpretation(source, dialect_named(slip.dialect), WITH_TOOL).chunks())
    found = raised.value.diagnostic
    hint = f"\nhint: {found.hint}" if found.hint else ""
    return f"{found.line}:{found.column} {found.code}: {found.message}{hint}"


SLIPS = [slip for path in FILES for slip in slips_of(path)]


@pytest.mark.parametrize("slip", SLIPS, ids=lambda slip: f"{slip.dialect}/{slip.program[:30]}")
def test_a_slip_earns_its_diagnostic(slip: Slip) -> None:
    assert diagnostic_of(slip) == slip.diagnostic


@pytest.mark.parametrize("slip", SLIPS, ids=lambda slip: f"{slip.dialect}/{slip.program[:30]}")
def test_a_slip_is_told_what_would_have_worked(slip: Slip) -> None:
    assert "\nhint: " in slip.diagnostic


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_control_has_its_twenty(path: Path) -> None:
    assert len({slip.program for slip in slips_of(path)}) >= 20


def test_no_hint_is_a_list() -> None:
    assert not [slip for slip in SLIPS if slip.diagnostic.count(",") > 12]


def test_every_hint_of_the_list_is_shown_by_a_slip() -> None:
    shown = "".join(path.read_text(encoding="utf-8") for path in FILES)
    assert not [slip.hint for slip in slips() if slip.hint not in shown]


def write_all() -> None:
    for path in FILES:
        parts = []
        for slip in slips_of(path):
            told = diagnostic_of(slip).replace("\n", f"\n{_SET_IN}")
            parts.append(f"{slip.program}\n{_SET_IN}{told}\n")
        path.write_text("\n".join(parts), encoding="utf-8")


if __name__ == "__main__":
    write_all()
