"""The borders between the rooms, as design rules that a machine can check."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parent.parent / "twin"

MAY_IMPORT = {
    "nc": set(),
    "toolpath": {"nc"},
    "motion": {"nc", "toolpath"},
    "machine": {"nc", "toolpath", "motion"},
    "logs": {"nc"},
    "compare": {"nc", "toolpath", "motion", "logs"},
    "cutting": {"nc", "toolpath", "motion"},
    "render": {"nc", "toolpath", "motion", "machine", "compare", "cutting", "logs"},
    "web": set(),
    "training": {
        "nc",
        "toolpath",
        "motion",
        "machine",
        "compare",
        "cutting",
        "render",
        "logs",
        "web",
    },
}
ROOMS = set(MAY_IMPORT)
NO_MUJOCO = ROOMS - {"machine", "render", "training"}


def imported_modules(path: Path) -> set[str]:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found.add(node.module)
    return found


def room_files(room: str) -> list[Path]:
    return sorted((PACKAGE / room).rglob("*.py"))


@pytest.mark.parametrize("room", sorted(ROOMS))
def test_imports_point_left(room: str):
    allowed = MAY_IMPORT[room] | {room}
    for path in room_files(room):
        for module in imported_modules(path):
            parts = module.split(".")
            if parts[0] == "twin" and len(parts) > 1 and parts[1] in ROOMS:
                assert parts[1] in allowed, f"{path.name} imports {module}"
            assert module not in ("twin.cli", "twin.run.run"), f"{path.name} imports {module}"


@pytest.mark.parametrize("room", sorted(NO_MUJOCO))
def test_only_machine_and_render_know_mujoco(room: str):
    for path in room_files(room):
        assert not any(m.split(".")[0] == "mujoco" for m in imported_modules(path)), path


def test_rooms_of_numbers_load_without_mujoco_or_opengl():
    code = (
        "import sys, pkgutil, importlib\n"
        f"for room in {sorted(NO_MUJOCO)}:\n"
        "    package = importlib.import_module('twin.' + room)\n"
        "    for item in pkgutil.walk_packages(package.__path__, package.__name__ + '.'):\n"
        "        importlib.import_module(item.name)\n"
        "assert 'mujoco' not in sys.modules and 'OpenGL' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
