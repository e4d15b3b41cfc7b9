"""The files that build servers and editors read: valid, and calling commands that exist."""

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest
import yaml
from typer.main import get_command

from twin.cli import app

ROOT = Path(__file__).parents[2]
YAML = (
    ".github/workflows/release.yml", "action.yml", "templates/check/template.yml",
    ".pre-commit-hooks.yaml", "twin/check/examples/github-actions.yml",
    "twin/check/examples/gitlab-ci.yml",
)  # fmt: skip
CALLING = (*YAML, "Dockerfile", "scripts/fresh", "scripts/demo")


def options_of(command: str) -> set[str]:
    group: Any = get_command(app)
    found = group.commands[command]
    return {
        name for parameter in found.params for name in (*parameter.opts, *parameter.secondary_opts)
    }


@pytest.mark.parametrize("name", YAML)
def test_files_for_build_servers_are_yaml(name: str):
    documents = list(yaml.safe_load_all((ROOT / name).read_text(encoding="utf-8")))
    assert all(isinstance(each, dict | list) for each in documents)


@pytest.mark.parametrize("name", CALLING)
def test_they_call_commands_and_options_that_exist(name: str):
    text = (ROOT / name).read_text(encoding="utf-8").replace("\\\n", " ")
    calls = re.findall(r"(?:/|\b0 |exec |entry: )twin\"? (\w+)([^\n]*)", text)
    group: Any = get_command(app)
    for command, rest in calls:
        if command in group.commands and command != "machine":
            given = set(re.findall(r"(?<=\s)--[a-z-]+", rest))
            assert given <= options_of(command) | {"--help"}, (name, command)


def test_the_container_has_no_rights_and_brings_the_kernels():
    text = (ROOT / "Dockerfile").read_text(encoding="utf-8")
    assert text.count("FROM ") == 2
    assert re.search(r"^USER (?!0|root)", text, re.MULTILINE)
    assert "MILL_TWIN_KERNELS=0" not in text
    json.loads((ROOT / ".devcontainer" / "devcontainer.json").read_text(encoding="utf-8"))


def test_the_wheel_holds_what_is_needed_beside_the_package():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    included = project["tool"]["hatch"]["build"]["targets"]["wheel"]["force-include"]
    assert set(included) == {"models", "programs", "mill_twin_pytest.py"}
    module = project["project"]["entry-points"]["pytest11"]["mill-twin"]
    assert (ROOT / f"{module}.py").is_file()
