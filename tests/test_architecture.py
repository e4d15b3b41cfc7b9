"""The package's form; the layers of its imports stand in ``pyproject.toml``, under ``tool.importlinter``."""

import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest
from importlinter.cli import EXIT_STATUS_SUCCESS, lint_imports

TESTS = Path(__file__).parent
PACKAGE = TESTS.parent / "twin"


@pytest.mark.seconds("reads every file of the package")
def test_imports_keep_to_their_layers_and_close_no_circle(
    capsys: pytest.CaptureFixture[str],
) -> None:
    kept = lint_imports(str(TESTS.parent / "pyproject.toml"), no_cache=True)
    assert kept == EXIT_STATUS_SUCCESS, capsys.readouterr().out


@pytest.mark.seconds("imports half of the package in a process of its own")
def test_what_computes_loads_without_mujoco_or_opengl() -> None:
    code = (
        "import sys, pkgutil, importlib\n"
        "for name in ['nc', 'toolpath', 'motion', 'compare', 'cutting']:\n"
        "    package = importlib.import_module('twin.' + name)\n"
        "    for item in pkgutil.walk_packages(package.__path__, package.__name__ + '.'):\n"
        "        importlib.import_module(item.name)\n"
        "assert 'mujoco' not in sys.modules and 'OpenGL' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_folder_is_seen_at_a_glance() -> None:
    modules = Counter(path.parent for path in PACKAGE.rglob("*.py"))
    crowded = {folder.name: count for folder, count in modules.items() if count > 16}
    assert not crowded, f"folders that should be split: {crowded}"


def test_a_class_name_means_one_thing() -> None:
    texts = (path.read_text(encoding="utf-8") for path in PACKAGE.rglob("*.py"))
    names = Counter(
        name for text in texts for name in re.findall(r"^ *class (\w+)", text, re.MULTILINE)
    )
    twice = sorted(name for name, count in names.items() if count > 1)
    assert not twice, f"classes of one name in several files: {twice}"


def test_no_two_files_of_tests_have_one_name() -> None:
    # Tests are no packages, so that pytest knows their files by name alone.
    names = Counter(path.name for path in TESTS.rglob("test_*.py"))
    assert [name for name, count in names.items() if count > 1] == []
