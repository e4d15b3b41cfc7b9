"""The borders between the rooms, as design rules that a machine can check."""

import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from scripts.import_picture import (
    Arrow,
    arrows,
    arrows_up,
    circles,
    modules,
    rooms_without_floor,
)

MODULES = modules()
ARROWS = arrows(MODULES)
WITHOUT_MUJOCO = ("nc", "toolpath", "motion", "compare", "cutting")


def test_no_import_leads_up() -> None:
    up = arrows_up(ARROWS)
    assert not up, "\n".join(f"{a} imports {b}, which lies above or beside it" for a, b in up)


def test_no_circle_closes() -> None:
    closed = circles(ARROWS)
    assert not closed, "\n".join("a circle: " + " <-> ".join(group) for group in closed)


def test_every_room_stands_on_a_floor() -> None:
    assert rooms_without_floor(MODULES) == []


def test_a_wrong_import_is_named_with_both_files() -> None:
    wrong = Arrow("twin.nc.text.lexer", "twin.nc.control.dialect")
    assert arrows_up([*ARROWS, wrong]) == [wrong]
    assert arrows_up([Arrow("twin.machine.model.model", "twin.compare.report")])
    assert arrows_up([Arrow("twin.nc.interpreter", "twin.run.run")])
    back = Arrow("twin.errors", "twin.api")
    assert any({"twin.api", "twin.errors"} <= set(group) for group in circles([*ARROWS, back]))


def test_imports_inside_functions_and_for_types_only_count(tmp_path: Path) -> None:
    file = tmp_path / "late.py"
    file.write_text(
        "from typing import TYPE_CHECKING\n"
        "if TYPE_CHECKING:\n    from twin.nc import canonical\n"
        "def f():\n    import twin.errors\n    from twin.files.toml import read_toml\n"
    )
    found = arrows({**MODULES, "twin.late": file})
    assert {target for source, target in found if source == "twin.late"} == {
        "twin.nc.canonical",
        "twin.errors",
        "twin.files.toml",
    }


@pytest.mark.parametrize("room", WITHOUT_MUJOCO)
def test_rooms_of_numbers_do_not_name_mujoco(room: str) -> None:
    for path in sorted(MODULES[f"twin.{room}"].parent.rglob("*.py")):
        assert "import mujoco" not in path.read_text(encoding="utf-8"), path


def test_rooms_of_numbers_load_without_mujoco_or_opengl() -> None:
    code = (
        "import sys, pkgutil, importlib\n"
        f"for room in {sorted(WITHOUT_MUJOCO)}:\n"
        "    package = importlib.import_module('twin.' + room)\n"
        "    for item in pkgutil.walk_packages(package.__path__, package.__name__ + '.'):\n"
        "        importlib.import_module(item.name)\n"
        "assert 'mujoco' not in sys.modules and 'OpenGL' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_folder_is_seen_at_a_glance() -> None:
    folders = {path.parent for path in MODULES.values()}
    crowded = {folder.name: n for folder in folders if (n := len(list(folder.glob("*.py")))) > 22}
    assert not crowded, f"folders that want rooms of their own: {crowded}"


def test_no_two_files_of_tests_have_one_name():
    # Tests are no packages, so that pytest knows their files by name alone.
    names = Counter(path.name for path in Path(__file__).parent.rglob("test_*.py"))
    assert [name for name, count in names.items() if count > 1] == []
