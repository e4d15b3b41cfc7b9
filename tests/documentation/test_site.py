"""The documentation site: built without a warning, and its reference as the source is."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from documentation.code_pages import codes_page, exit_codes
from documentation.command_pages import commands, commands_page
from documentation.key_tables import job_page, machine_page, scene_page
from documentation.recording_page import recording_page
from documentation.repository_pages import PAGES, with_links

from twin.recording.reader import open_recording
from twin.run.preparing.preparation import prepare
from twin.run.progress import no_progress
from twin.run.run import Run

pytestmark = pytest.mark.documentation

ROOT = Path(__file__).parents[2]


def test_the_site_is_built_without_a_warning_and_fetches_nothing(tmp_path: Path):
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--quiet", "--site-dir", str(tmp_path)],
        cwd=ROOT, env=os.environ | {"NO_MKDOCS_2_WARNING": "1", "PYTHONPATH": str(ROOT)},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    pages = {
        page.relative_to(tmp_path).as_posix(): page.read_text("utf-8")
        for page in tmp_path.rglob("*.html")
    }
    assert {address.replace(".md", ".html") for address in PAGES.values()} <= set(pages)
    for name, page in pages.items():
        assert '<script src="http' not in page, name
        assert "fonts.googleapis" not in page, name
        assert "```" not in page, f"{name}: a block of code that was not understood"


def test_every_room_and_machine_has_its_page():
    written = {*ROOT.glob("twin/*/README.md"), *ROOT.glob("models/*/README.md")}
    assert {page.relative_to(ROOT).as_posix() for page in written} <= set(PAGES)


def test_a_link_that_leads_nowhere_is_refused():
    with pytest.raises(ValueError, match=r"twin/nc/README\.md: link to gone\.md"):
        with_links("see [that](gone.md)", "twin/nc/README.md")


def test_links_of_the_repository_become_the_site_s():
    source = "twin/check/README.md"
    assert with_links("[logs](../logs/README.md#the-map)", source) == "[logs](logs.md#the-map)"
    assert with_links("[whole file](examples/gitlab-ci.yml)", source) == "whole file"
    assert (
        with_links("[out](https://mujoco.org) `[a](b)`", source)
        == "[out](https://mujoco.org) `[a](b)`"
    )


def test_every_command_option_and_exit_code_is_in_the_reference():
    page = commands_page()
    for path, command in commands():
        assert f"## `{path}`" in page
        assert "```sh\ntwin" in page.split(f"## `{path}`\n")[1].split("\n## ")[0], path
        for parameter in command.params:
            assert parameter.help, (path, parameter.name)
            assert all(f"`{option}`" in page for option in parameter.opts if option.startswith("-"))
    assert [code for code, _ in exit_codes()] == [0, 1, 2, 3, 4, 70, 130, 141]
    assert "### `rapid-into-stock`" in codes_page()


def test_every_key_of_every_file_has_a_meaning_in_the_reference():
    for page in (job_page(), machine_page(), scene_page()):
        rows = [line.replace("\\|", "") for line in page.splitlines() if line.startswith("| `")]
        for row in rows:
            *_, meaning, _ = row.split("|")
            assert meaning.strip(), row
    assert "| `contour_um` | number above 0 | `20.0` |" in job_page()
    assert "## `[axes.NAME]`" in machine_page()
    assert "## `[[tasks]]`" in scene_page()


def test_every_column_and_attribute_of_a_recording_is_in_the_reference(tmp_path: Path):
    run = Run(prepare(Path("mefi/helix")))
    run.execute(tmp_path, no_progress)
    page = recording_page()
    import h5py

    with h5py.File(tmp_path / "recording.h5") as file:
        names: list[str] = []
        file.visititems(
            lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None
        )
        for name in (*names, *file.attrs):
            assert f"| `{name}` |" in page or name in ("program_text", "seal"), name
    assert open_recording
