"""MkDocs asks here for the pages that are not written by hand: packages, machines and the reference."""

import sys
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

# MkDocs loads a hook by its path.
sys.path[:0] = [str(Path(__file__).parents[1])]

from documentation.code_pages import codes_page
from documentation.command_pages import commands_page
from documentation.key_tables import job_page, machine_page, scene_page
from documentation.recording_page import recording_page
from documentation.repository_pages import pictures, repository_pages

GENERATED = {
    "reference/job.md": job_page,
    "reference/machine.md": machine_page,
    "reference/scene.md": scene_page,
    "reference/recording.md": recording_page,
    "reference/commands.md": commands_page,
    "reference/codes.md": codes_page,
}
"""Pages made from the source, by their addresses."""


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages of the repository, those made from the source, and the pictures."""
    made = {address: page() for address, page in GENERATED.items()}
    for address, text in {**repository_pages(), **made}.items():
        files.append(File.generated(config, address, content=text))
    for address, path in pictures().items():
        files.append(File.generated(config, address, abs_src_path=str(path)))
    return files
