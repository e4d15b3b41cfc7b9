"""Golden files: the canonical moves of every shipped program and of every rule.

``python -m tests.nc.test_golden`` writes them again; look at the difference before committing.
"""

import json
import math
import re
from pathlib import Path
from typing import Any

import pytest

from tests.five_axes import on_machine, settings, trunnion
from tests.nc.running import ROOT, SHIPPED, WITH_TABLES, all_records, shipped
from twin.nc.dialects import DIALECTS, dialect_named, recognise
from twin.nc.interpreter import Interpretation
from twin.nc.text.source import read_source

GOLDEN = ROOT / "tests" / "golden"
RULES = sorted(GOLDEN.glob("*/*/*.nc"))
NEEDS_FIVE_AXES = (
    "G43.4",
    "G43.5",
    "G53.1",
    "G53.6",
    "G68.2",
    "G234",
    "G254",
    "G255",
    *("G253", "G268", "G269"),
    "TRAORI",
    *("ORIWKS", "ORIMKS", "ORIVECT", "ORIPLANE", "ORIAXES"),
    *("tip_led_by_kinematics", "coordinate_systems", "tool_orientation", "offset_in_a_plane"),
)
"""Programs that lead the tip, or tilt the plane."""
ON_FIVE_AXES = settings(on_machine(trunnion()))


def interpretation_of(path: Path) -> Interpretation:
    if path in SHIPPED:
        return shipped(path)
    dialect = dialect_named(path.parent.parent.name)
    settings = ON_FIVE_AXES if path.stem in NEEDS_FIVE_AXES else WITH_TABLES
    return Interpretation(read_source(path, dialect), dialect, settings)


def golden_of(path: Path) -> Path:
    if path in SHIPPED:
        return GOLDEN / path.parent.name / "programs" / f"{path.stem}.jsonl"
    return path.with_suffix(".jsonl")


def golden_records(path: Path) -> list[dict[str, Any]]:
    """The records of a program without what ``tests/nc/test_jsonl.py`` holds: what the screen shows."""
    left_out = {"display", "tool_center"}
    return [
        {key: value for key, value in each.items() if each["type"] != "move" or key not in left_out}
        for each in all_records(interpretation_of(path))
    ]


def assert_same(made: Any, wanted: Any, where: str) -> None:
    if isinstance(wanted, float):
        assert math.isclose(made, wanted, rel_tol=1e-9, abs_tol=1e-9), where
    elif isinstance(wanted, dict):
        assert made.keys() == wanted.keys(), where
        for key, value in wanted.items():
            assert_same(made[key], value, f"{where}.{key}")
    elif isinstance(wanted, list):
        assert len(made) == len(wanted), where
        for index, value in enumerate(wanted):
            assert_same(made[index], value, f"{where}[{index}]")
    else:
        assert made == wanted, where


@pytest.mark.parametrize(
    "path", [*SHIPPED, *RULES], ids=lambda path: f"{path.parts[-2]}/{path.stem}"
)
def test_moves_are_those_of_the_golden_file(path: Path) -> None:
    made = golden_records(path)
    lines = golden_of(path).read_text(encoding="utf-8").splitlines()
    assert_same(made, [json.loads(line) for line in lines], path.name)


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: f"{path.parts[-2]}/{path.stem}")
def test_shipped_programs_are_recognised(path: Path) -> None:
    assert recognise(read_source(path)).name == path.parent.name


def test_every_golden_file_has_its_program() -> None:
    known = {golden_of(path) for path in [*SHIPPED, *RULES]}
    assert known == set(GOLDEN.glob("*/*/*.jsonl"))
    assert {path.parent.name for path in SHIPPED} == set(DIALECTS)


@pytest.mark.parametrize("name", DIALECTS)
def test_every_followed_code_has_its_golden_file(name: str) -> None:
    followed = {number for number, code in DIALECTS[name].codes.g.items() if not code.refused}
    named = DIALECTS[name].syntax.codes
    files = list((GOLDEN / name / "codes").glob("*.nc"))
    paths = {named[path.stem]: path for path in files if path.stem in named}
    paths |= {float(path.stem[1:]): path for path in files if path.stem[0] == "G"}
    assert followed == set(paths)
    for number, path in paths.items():
        written = path.stem if path.stem in named else rf"G0*{re.escape(f'{number:g}')}"
        assert re.search(rf"{written}(?![0-9])", path.read_text(encoding="utf-8")), path


@pytest.mark.parametrize("name", DIALECTS)
def test_every_decision_has_its_golden_file(name: str) -> None:
    shown = sorted(decision.example for decision in DIALECTS[name].decisions)
    assert shown == sorted(path.stem for path in (GOLDEN / name / "decisions").glob("*.nc"))


@pytest.mark.parametrize("path", RULES, ids=lambda path: f"{path.parts[-3]}/{path.stem}")
def test_only_decisions_are_shown_by_refusals(path: Path) -> None:
    text = golden_of(path).read_text(encoding="utf-8")
    assert path.parent.name == "decisions" or '"severity": "error"' not in text


def write_all() -> None:
    for path in [*SHIPPED, *RULES]:
        golden = golden_of(path)
        golden.parent.mkdir(parents=True, exist_ok=True)
        lines = (json.dumps(each, ensure_ascii=False) for each in golden_records(path))
        golden.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    write_all()
