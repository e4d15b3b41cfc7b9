"""The realtime component where it cannot be built: what is missing is said, with its package."""

from pathlib import Path

import pytest

from twin.errors import UsageError
from twin.link.component import NAME, install, is_installed, source, stamp


@pytest.fixture
def modules(tmp_path: Path) -> Path:
    folder = tmp_path / "modules"
    folder.mkdir()
    return folder


def test_without_its_compiler_the_package_is_named(
    tmp_path: Path, modules: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(UsageError, match="install Debian's package linuxcnc-uspace-dev"):
        install(tmp_path, modules)
    assert (tmp_path / f"{NAME}.comp").read_text() == source(stamp())


def test_a_compiler_that_fails_is_quoted(
    tmp_path: Path, modules: Path, monkeypatch: pytest.MonkeyPatch
):
    compiler = tmp_path / "halcompile"
    compiler.write_text("#!/bin/sh\necho no such header >&2\nexit 1\n")
    compiler.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(UsageError, match=r"could not build .*mill_twin\.comp:\nno such header"):
        install(tmp_path, modules)


def test_a_component_of_another_version_is_none(modules: Path):
    module = modules / f"{NAME}.so"
    module.write_bytes(b"ELF mill-twin 0123456789")
    assert not is_installed(modules)
    module.write_bytes(b"ELF " + stamp().encode())
    assert is_installed(modules)
