"""A package of an extra that is missing is said as such, before anything else happens."""

import importlib.util
import tomllib
from pathlib import Path
from typing import Any

import pytest
from command_line import Twin

from twin import extras

ROOT = Path(__file__).parents[1]
COMMANDS: dict[str, list[tuple[object, ...]]] = {
    "calibrate": [("calibrate", "log.csv", "--base", "mill4")],
    "cluster": [("check", ROOT / "programs" / "mefi" / "helix.toml", "--cluster", "local")],
    "opcua": [("serve", "mefi/helix", "--opcua", "48499")],
    "serve": [("serve", "mefi/helix")],
    "train": [
        ("train", "mefi_lead"),
        ("view", ROOT / "programs" / "mefi" / "helix.toml"),
        ("serve", "--scene", "mefi_lead"),
    ],
}
CASES = [
    (extra, package, command)
    for extra, packages in extras.PACKAGES.items()
    for package in packages
    for command in COMMANDS.get(extra, ())
]


def test_packages_are_those_of_the_project_file() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    for extra, packages in extras.PACKAGES.items():
        asked = project["optional-dependencies"][extra]
        assert packages == tuple(each.partition(">=")[0] for each in asked)


@pytest.mark.parametrize(
    ("extra", "package", "command"),
    CASES,
    ids=[f"{command[0]}{len(command)}-{package}" for _, package, command in CASES],
)
def test_a_missing_package_ends_the_command_with_its_name(
    twin: Twin,
    monkeypatch: pytest.MonkeyPatch,
    extra: str,
    package: str,
    command: tuple[object, ...],
) -> None:
    there = importlib.util.find_spec

    def found(name: str) -> Any:
        return None if name == package else there(name)

    monkeypatch.setattr(extras, "find_spec", found)
    # Whatever else of the extra is missing here is named beside it.
    done = twin(*command)
    assert done.code == 2, done.stderr
    assert f" needs {package}" in done.stderr or f"and {package}" in done.stderr
    assert f"its extra '{extra}'" in done.stderr
    assert "Traceback" not in done.stderr
