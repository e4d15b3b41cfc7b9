"""Which jobs and programs have to do with files that a commit changes.

What a run reads is what it depends on: what the loaders of its job and its machine look at, the parts of the machine's
model, its program, and the files beside it that the program calls. Where that is not known without running it, it
counts as dependent.
"""

import contextlib
import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from twin.check.discovery import NC_SUFFIXES, is_program, program_of, programs_in
from twin.errors import TwinError
from twin.files.looked_at import files_looked_at
from twin.job.load import load_job
from twin.machine.load import load_machine

CALLED_SUFFIXES = NC_SUFFIXES | {"", ".prg", ".txt"}
"""What a file may end in that a program calls beside it."""
MODEL_SUFFIXES = frozenset({".xml", ".mjcf", ".stl", ".obj", ".msh", ".png", ".hf"})
"""Of the files that an MJCF model is made of (MuJoCo, "XML reference", include, mesh, texture and hfield)."""
BASELINE_SUFFIX = ".baseline"
_NUMBERED = re.compile(r"O?0*([0-9]{1,8})")
_DECORATION = re.compile(r"^_N_|_[MS]PF$|\s")
"""What SINUMERIK has around a name in its own file system, and blanks, which O words may hold."""


def dependents(
    files: Iterable[Path], root: Path = Path(), *, machine: str | None = None
) -> list[Path]:
    """Jobs and programs among changed files, and those that read one of them.

    A program that one of these jobs runs is left out.

    Args:
        files: What a commit changes or deletes, files of any kind.
        root: Where jobs are looked for that read one of the files.
    """
    files = list(files)
    if not files:
        return []
    there = [path for path in files if path.is_file()]
    callers = _callers(files)
    jobs = [path for path in there if path.suffix == ".toml" and program_of(path) is not None]
    programs = [path for path in (*there, *callers) if is_program(path)]
    changed = {path.resolve() for path in (*files, *callers)}
    baselines = {path.stem for path in files if path.suffix == BASELINE_SUFFIX}
    known = {path.resolve() for path in (*jobs, *programs)}
    for path in programs_in(root):
        is_job = path.suffix == ".toml"
        held_to = path.stem if is_job else path.name
        if path.resolve() in known:
            continue
        if held_to in baselines or _reads(path, changed, machine):
            (jobs if is_job else programs).append(path)
    taken = {program_of(path) for path in jobs}
    return jobs + [path for path in programs if path.resolve() not in taken]


# --- files that programs call


def _callers(files: Iterable[Path]) -> list[Path]:
    """Files that call one of some files beside them, or one that does."""
    found: list[Path] = []
    folders: dict[Path, list[str]] = {}
    for path in files:
        if path.suffix.lower() in CALLED_SUFFIXES:
            folders.setdefault(path.parent, []).append(path.stem)
    for folder, names in folders.items():
        texts = dict(_texts(folder))
        while names:
            called = list(map(_mention, names))
            fresh = [path for path, text in texts.items() if any(each(text) for each in called)]
            found += fresh
            for path in fresh:
                del texts[path]
            names = [path.stem for path in fresh]
    changed = {path.resolve() for path in files}
    return [path for path in found if path.resolve() not in changed]


def _texts(folder: Path) -> Iterator[tuple[Path, bytes]]:
    for path in sorted(folder.iterdir()) if folder.is_dir() else ():
        if path.suffix.lower() in CALLED_SUFFIXES and path.is_file():
            try:
                yield path, path.read_bytes().upper()
            except OSError:
                continue  # it is reported where it is checked itself


def _mention(stem: str) -> Callable[[bytes], bool]:
    """Whether a text in upper case may call the file of a name: it holds the name, or its number behind any digits."""
    name = _DECORATION.sub("", stem.upper())
    if (number := _NUMBERED.fullmatch(name)) is not None:
        pattern = re.compile(rb"%s(?![0-9])" % number[1].encode())
        return lambda text: pattern.search(text) is not None
    if not name.isascii():
        return lambda _: True  # in whichever encoding the text writes it
    return lambda text: name.encode() in re.sub(rb"[ \t]", b"", text)


# --- files that a run reads


def _reads(path: Path, changed: set[Path], machine: str | None) -> bool:
    """Whether the run of a job, or of a program that has none, reads one of some files, there or gone.

    A job that cannot be loaded depends on what loading it has looked at, and on no more.
    """
    with files_looked_at() as files, contextlib.suppress(TwinError):
        load_machine(load_job(path), machine)
    models = [file.parent for file in files if file.suffix in MODEL_SUFFIXES]
    parts = [each for each in changed if each.suffix.lower() in MODEL_SUFFIXES]
    return not files.isdisjoint(changed) or any(
        part.is_relative_to(model) for part in parts for model in models
    )
