"""The documentation's examples, run as they stand."""

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml
from typer.main import get_command

from tests.check.test_check_runs import PROGRAM, write_job
from twin.check.runner import check_program
from twin.check.task import CheckSettings
from twin.cli import app
from twin.commands.runs.export import export_and_print
from twin.files.toml import read_toml
from twin.job.tolerance import BaselineTable, ToleranceTable
from twin.version import __version__

pytestmark = pytest.mark.documentation

ROOT = Path(__file__).parents[2]
CHECK, COMPARE = ROOT / "twin" / "check" / "README.md", ROOT / "twin" / "compare" / "README.md"
EXAMPLES = CHECK.parent / "examples"


def blocks(document: Path, language: str) -> list[str]:
    text = document.read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


@pytest.fixture
def shop(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A repository with a program, a ``.venv`` that a build server has kept, and the same tools outside.

    ``pip`` has nothing to do, for all is installed.
    """
    (tmp_path / "programs").mkdir()
    write_job(tmp_path / "programs", "part")
    write_job(tmp_path, "part")
    tools = tmp_path / ".venv" / "bin"
    tools.mkdir(parents=True)
    runs = {
        "twin": "-m twin",
        "pytest": "-m pytest -p no:cacheprovider -c /dev/null",
        "pip": "-c 0",
    }
    for name, what in runs.items():
        (tools / name).write_text(f'#!/bin/sh\nexec "{sys.executable}" {what} "$@"\n')
        (tools / name).chmod(0o755)
    monkeypatch.setenv("PATH", f"{tools}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    plugin = "" if _installed() else "-p mill_twin_pytest"
    monkeypatch.setenv("PYTEST_ADDOPTS", plugin)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def _installed() -> bool:
    """Whether pytest knows the plugin by the package's entry point."""
    code = "from importlib.metadata import entry_points as e; print(e(group='pytest11').names)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return "'mill-twin'" in done.stdout


def shell(command: str, *, code: int = 0) -> str:
    done = subprocess.run(
        ["sh", "-ec", command], capture_output=True, text=True, check=False, encoding="utf-8"
    )
    assert done.returncode == code, done.stdout + done.stderr
    return done.stdout + done.stderr


def test_the_commands_of_the_documents(shop: Path):
    for document in (COMPARE, CHECK):
        for block in blocks(document, "sh"):
            shell(block)
    assert (shop / "baselines" / "programs" / "part.baseline").is_file()
    assert (shop / "reports" / "programs" / "part.html").is_file()
    assert (shop / "twin.json").is_file()


def test_the_python_of_the_documents(shop: Path):
    import twin

    done = twin.run("part.nc", out="out/part")
    assert done.recording is not None
    export_and_print(done.recording, shop / "log.csv")
    code = "\n".join(blocks(COMPARE, "python"))
    names: dict[str, Any] = {}
    exec(compile(code, str(COMPARE), "exec"), names)  # noqa: S102 (our own document)
    assert names["moves"].end[-1, :2] == pytest.approx([20.5, -4.25])
    assert names["speed"][0] > 0.0
    assert names["lag"].shape[1] == len(names["moves"].axes)
    assert names["difference"].axes["X"].actual_max < 1e-3


def store_baselines(*jobs: Path) -> None:
    for job in jobs:
        settings = CheckSettings(baseline=Path("baselines"), update_baseline=True)
        assert check_program(job, settings).passed


def test_the_mistake_of_the_document_is_told_in_its_words(shop: Path):
    store_baselines(Path("part.toml"))
    write_job(shop, "part", PROGRAM.replace("Y-4.25", "Y-4.27"))
    held = CheckSettings(baseline=Path("baselines"))
    told = "\n".join(map(str, check_program(Path("part.toml"), held).findings))
    shown = re.search(
        r"^    part\.nc:4:1: .*?(?=\n\n)", CHECK.read_text("utf-8"), re.MULTILINE | re.DOTALL
    )
    assert shown is not None
    for line in shown[0].splitlines():
        assert line.removeprefix("    ") in told


def steps(example: str) -> list[str]:
    """The commands of a build server's file."""
    content = yaml.safe_load((EXAMPLES / example).read_text(encoding="utf-8"))
    if example.startswith("gitlab"):
        return content["nc-programs"]["script"]
    return [step["run"] for step in content["jobs"]["twin"]["steps"] if "run" in step]


SERVERS = {
    "github-actions.yml": {"GITHUB_ACTIONS": "true", "GITHUB_STEP_SUMMARY": "summary.md"},
    "gitlab-ci.yml": {"GITLAB_CI": "true"},
}


@pytest.mark.parametrize("example", SERVERS)
def test_a_build_server_runs_its_example(shop: Path, monkeypatch: pytest.MonkeyPatch, example: str):
    for name, value in SERVERS[example].items():
        monkeypatch.setenv(name, value)
    store_baselines(Path("programs/part.toml"))
    write_job(shop / "programs", "part", PROGRAM.replace("G02", "G03"))
    install, check = steps(example)
    assert 'pip install "$MILL_TWIN"' in install
    assert f"mill-twin=={__version__} after publication" in (EXAMPLES / example).read_text("utf-8")
    shell(install)
    told = shell(check, code=1)
    assert "part.nc:3:1: error baseline-path: arc counter-clockwise by 180 degrees" in told
    text = (EXAMPLES / example).read_text(encoding="utf-8")
    for kept in ("twin.xml", "reports"):
        assert (shop / kept).exists()
        assert kept in text
    if example.startswith("gitlab"):
        assert (shop / "gl-code-quality-report.json").is_file()
        assert "gl-code-quality-report.json" in text
    else:
        assert "::error file=programs/part.nc,line=3," in told
        assert "| programs/part.toml | fail |" in (shop / "summary.md").read_text("utf-8")


def keys_in(document: Path, heading: str) -> set[str]:
    table = document.read_text(encoding="utf-8").split(f"key of `[{heading}]`")[1].split("\n\n")[0]
    return set(re.findall(r"^\| `(\w+)`", table, re.MULTILINE))


def test_every_key_is_documented_with_its_default(tmp_path: Path):
    assert keys_in(COMPARE, "tolerance") == set(ToleranceTable.model_fields)
    assert keys_in(CHECK, "baseline") == set(BaselineTable.model_fields)
    text = CHECK.read_text(encoding="utf-8")
    for name, field in BaselineTable.model_fields.items():
        assert f"| `{name}` | {field.default} |" in text
    assert f"| `contour_um` | {ToleranceTable().contour_um:g} |" in COMPARE.read_text("utf-8")
    (example,) = blocks(COMPARE, "toml")
    (tmp_path / "tolerance.toml").write_text(
        example.replace("[tolerance]\n", "").replace("[[tolerance.blocks]]", "[[blocks]]"),
        encoding="utf-8",
    )
    assert read_toml(tmp_path / "tolerance.toml", ToleranceTable).blocks[0].lines == (4, 4)


def test_every_option_that_the_documents_name_exists():
    known = {
        option
        for command in get_command(app).commands.values()  # type: ignore[attr-defined]
        for parameter in command.params
        for option in parameter.opts
    }
    for document in (CHECK, COMPARE):
        named = set(re.findall(r"(?<![\w-])--[a-z][a-z-]+", document.read_text(encoding="utf-8")))
        own = {option for option in named if not option.startswith("--twin-")}
        assert own - {"--junitxml"} <= known
