"""What README and the pages print, run in its order, with what it is said to print.

A block that no test runs says why in the line above it: ``<!-- not run by a test: REASON -->``.
"""

import contextlib
import io
import os
import re
import subprocess
import sys
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from typer.main import get_command

from twin.cli import app

pytestmark = pytest.mark.documentation

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = ["../README.md", *sorted(path.relative_to(DOCS).as_posix() for path in DOCS.rglob("*.md"))]


class Block(NamedTuple):
    """A fenced block of a page.

    Attributes:
        reason: Why it is not run; empty for what is.
        language: ``sh`` is run.
        title: The file that it is; empty for what is none.
        exit_code: Of a command, as its comment says.
        text: Its lines.
    """

    reason: str
    language: str
    title: str
    exit_code: int
    text: str


def blocks(page: str) -> Iterator[Block]:
    found = re.finditer(
        r"^(?: *<!-- not run by a test: (.+?) -->\n)?( *)```(\w+)([^\n]*)\n(.*?)^\2```$",
        (DOCS / page).read_text("utf-8"),
        re.MULTILINE | re.DOTALL,
    )
    for reason, _, language, about, text in (block.groups() for block in found):
        title = re.search(r'title="(.*?)"', about)
        code = re.search(r"# ends with exit code (\d+)$", text)
        yield Block(
            reason or "",
            language,
            title[1] if title else "",
            int(code[1]) if code else 0,
            textwrap.dedent(text),
        )


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder in which ``twin`` and ``pytest`` are this checkout's, and ``pip`` has nothing to do."""
    tools = tmp_path / ".tools"
    tools.mkdir()
    plugin = "-p mill_twin_pytest " * (not _plugin_is_installed())
    runs = {
        "twin": "-m twin",
        "pytest": f"-m pytest {plugin}-p no:cacheprovider -c /dev/null --rootdir .",
        "pip": "-c 0",
    }
    for name, what in runs.items():
        (tools / name).write_text(f'#!/bin/sh\nexec "{sys.executable}" {what} "$@"\n')
        (tools / name).chmod(0o755)
    monkeypatch.setenv("PATH", f"{tools}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    monkeypatch.setenv("MPLBACKEND", "agg")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def _plugin_is_installed() -> bool:
    from importlib.metadata import entry_points

    return "mill-twin" in entry_points(group="pytest11").names


def shows(said: str, shown: str) -> bool:
    """Whether each line that a page shows was said; dots stand for what changes."""
    lines = [line.rstrip() for line in shown.splitlines() if line.strip()]
    patterns = [re.escape(line).replace(r"\.\.\.", ".*") for line in lines]
    return all(re.search(rf"^\s*{pattern}$", said, re.MULTILINE) for pattern in patterns)


@pytest.mark.parametrize("page", PAGES)
def test_a_page_does_what_it_says(desk: Path, page: str):
    said, names = "", {}
    for block in blocks(page):
        if block.reason:
            continue
        assert block.language != "console", f"neither run nor said why: {block.text}"
        if block.title:
            file = desk / block.title
            file.parent.mkdir(exist_ok=True)
            file.write_text(block.text, encoding="utf-8")
        elif block.language == "sh":
            done = subprocess.run(
                ["sh", "-ec", block.text],
                capture_output=True,
                text=True,
                check=False,
                encoding="utf-8",
            )
            said = done.stdout + done.stderr
            assert done.returncode == block.exit_code, block.text + said
        elif block.language == "text" and said:
            assert shows(said, block.text), block.text + said
        elif block.language == "python":
            with contextlib.redirect_stdout(io.StringIO()) as printed:
                exec(compile(block.text, page, "exec"), names)  # noqa: S102 (our own page)
            said = printed.getvalue()
    if page == "tutorials/python.md":
        assert (desk / "contour_error.png").stat().st_size > 10_000
        assert {"start_X", "end_C", "corner"} <= set(names["frame"].columns)


def unknown_options(call: str) -> set[str]:
    """Options behind ``twin`` in a line that the command does not have."""
    command: Any = get_command(app)
    for word in call.split():
        command = getattr(command, "commands", {}).get(word, command)
    known = {option for parameter in command.params for option in parameter.opts}
    return set(re.findall(r"--[a-z][a-z-]*", call)) - known - {"--help"}


@pytest.mark.parametrize("page", PAGES)
def test_commands_of_the_pages_and_their_options_exist(page: str):
    for block in blocks(page):
        commands = block.text if block.language in ("sh", "console") else ""
        for call in re.findall(r"^(?:\$ )?twin (.*)", commands, re.MULTILINE):
            assert not unknown_options(call), call


def test_options_in_the_table_of_commands_exist():
    calls = re.findall(r"`twin ([^`]+)`", (ROOT / "README.md").read_text("utf-8"))
    assert len(calls) > 15
    for call in calls:
        assert not unknown_options(call), call
