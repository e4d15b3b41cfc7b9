"""An interruption waits while a library is loaded, and goes through the package's own modules."""

import importlib
import sys
from pathlib import Path

import pytest

import twin

PROBE = "import sys\nfrom twin.__main__ import is_loading\nfound = is_loading(sys._getframe())\n"


@pytest.mark.parametrize(("module", "waits"), [("some_library", True), ("twin.some_module", False)])
def test_it_waits_for_libraries_alone(
    module: str, waits: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    (tmp_path / f"{module.rpartition('.')[2]}.py").write_text(PROBE)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(twin, "__path__", [*twin.__path__, str(tmp_path)])
    found = importlib.import_module(module).found
    del sys.modules[module]
    assert found == waits


def test_it_waits_for_a_library_within_an_own_module(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    (tmp_path / "other_library.py").write_text(PROBE)
    (tmp_path / "own_module.py").write_text("from other_library import found\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(twin, "__path__", [*twin.__path__, str(tmp_path)])
    assert importlib.import_module("twin.own_module").found
    del sys.modules["twin.own_module"], sys.modules["other_library"]
