"""Wrong programs: each file of ``tests/bad`` with the diagnostic that it must earn.

Those in a folder ``strict`` earn a warning, which counts as an error there.

``python -m tests.nc.test_bad`` writes the expected diagnostics again; look at the difference.
"""

import dataclasses
from pathlib import Path

import pytest

from tests.nc.running import ROOT, SETTINGS
from twin.nc.control.settings import ToolData
from twin.nc.dialects import dialect_named
from twin.nc.interpreter import Interpretation
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.nc.text.diagnostics.explain import findings
from twin.nc.text.diagnostics.reporter import NOTICE
from twin.nc.text.source import source_from_pieces

WITH_TOOL = dataclasses.replace(SETTINGS, tools={1: ToolData(5.0, 60.0)})
BAD = sorted((ROOT / "tests" / "bad").rglob("*.nc"))
MADE_ELSEWHERE = {"line-too-long", NOTICE}
"""Too large for a file here; ``test_hostile`` makes it. A notice refuses nothing."""


def diagnostic_of(path: Path) -> str:
    strict = path.parent.name == "strict"
    dialect = dialect_named(path.parent.parent.name if strict else path.parent.name)
    code = path.stem.split(".")[0]
    settings = dataclasses.replace(WITH_TOOL, strict=strict, **findings()[code].settings)
    source = source_from_pieces([path.read_bytes()], path.name, dialect)
    with pytest.raises(ProgramError) as raised:
        for _ in Interpretation(source, dialect, settings).chunks():
            pass
    return f"{raised.value}\n"


@pytest.mark.parametrize("path", BAD, ids=lambda path: f"{path.parts[-2]}/{path.stem}")
def test_diagnostic(path: Path) -> None:
    made = diagnostic_of(path)
    assert made == path.with_suffix(".expected").read_text(encoding="utf-8")
    assert f" {path.stem.split('.')[0]}: " in made


def test_every_code_has_its_wrong_program() -> None:
    codes = {path.stem.split(".")[0] for path in BAD}
    assert codes | MADE_ELSEWHERE == set(findings())


def write_all() -> None:
    for path in BAD:
        path.with_suffix(".expected").write_text(diagnostic_of(path), encoding="utf-8")


if __name__ == "__main__":
    write_all()
