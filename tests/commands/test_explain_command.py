"""Every code that a message may bear is explained, whichever room says it."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import get_args

import pytest

import twin.commands.explain
from twin.commands.explain import codes, explain, overview
from twin.cutting.forces.materials import materials
from twin.errors import UsageError
from twin.job.tolerance import ToleranceTable
from twin.nc.text.diagnostics.explain import findings
from twin.recording.alarms import AlarmCode

PACKAGE = Path(twin.commands.explain.__file__).parents[1]
ROOMS = ("check", "commands", "compare", "run", "machine")
CODE = re.compile(r"[a-z]+(-[a-z]+)*")


def codes_in_the_source() -> Iterator[str]:
    """Codes of all reasons, findings and near misses that are made outside the interpreter."""
    for path in (path for room in ROOMS for path in (PACKAGE / room).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("Reason", "Finding"):
                first = node.args[0] if node.args else None
                if isinstance(first, ast.Constant):
                    yield str(first.value)
            # Differences of blocks are pairs of a code and a sentence.
            elif isinstance(node, ast.Constant) and str(node.value).startswith("baseline-"):
                yield str(node.value)


def test_every_code_of_the_source_is_explained():
    said = {code for code in codes_in_the_source() if CODE.fullmatch(code)}
    assert {"baseline-path", "cannot-run", "crash"} <= said
    assert said <= {*codes(), *findings()}


def test_alarms_and_tolerances_are_explained():
    groups = {name: code.group for name, code in codes().items()}
    assert {name for name, group in groups.items() if group == "alarm"} == set(get_args(AlarmCode))
    tolerances = {name for name, group in groups.items() if group == "tolerance"}
    assert tolerances == {*ToleranceTable.model_fields, "gouge_um"}
    assert not set(groups) & set(findings())


def test_explain_shows_text_and_example():
    text = explain("no-lead")
    assert "Z1.05 G10" in text
    assert "N5 G09 G02 X0 I100 F100" in text
    assert "hit the column" in explain("collision")
    assert "range of lines" in explain("blocks[0].contour_um")


def test_an_unknown_code_names_the_nearest():
    with pytest.raises(UsageError, match="no-lead"):
        explain("nolead")
    with pytest.raises(UsageError, match="collision"):
        explain("colision")


def test_the_overview_names_every_code_once():
    names = [line.split()[0] for line in overview().splitlines() if line.startswith("  ")]
    assert sorted(names) == sorted((*findings(), *codes()))


@pytest.mark.parametrize("name", sorted(materials()))
def test_a_material_is_told_with_its_source(name: str):
    text = explain(name)
    assert materials()[name].source
    assert f"Source: {materials()[name].source}" in text
