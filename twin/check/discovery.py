"""Which programs are meant by paths, folders and globs."""

import glob
import os
import re
import tomllib
from collections.abc import Collection, Iterable
from pathlib import Path

from twin.errors import TwinError, UsageError

NC_SUFFIXES = frozenset(
    {".nc", ".cnc", ".ngc", ".tap", ".mpf", ".spf", ".iso", ".gcode", ".eia", ".min", ".h"}
)
"""What a file must end in to be taken for an NC program when a folder is searched."""
_KLARTEXT = re.compile(rb"^[ \t]*\d*[ \t]*BEGIN[ \t]+PGM\b", re.IGNORECASE | re.MULTILINE)
"""What tells a Klartext program from the headers of C, whose names end in .h as well."""
_HEAD_BYTES = 4096

_FOREIGN_FOLDERS = frozenset({"node_modules", "site-packages", "__pycache__"})


def find_programs(paths: Iterable[str | Path]) -> list[Path]:
    """Find job files and NC programs.

    A file is taken as it is named. A folder is searched with all its subfolders, but for hidden ones,
    virtual environments and what package managers fetch: its job files, and its NC programs that no job file there runs. A glob (``*``, ``?``,
    ``[``, ``**``) is expanded, its matches treated like paths.

    Args:
        paths: What the user gave.

    Returns:
        Job files and programs, each once, in the order given and sorted within a folder.

    Raises:
        UsageError: A path does not exist, or nothing at all was found.
    """
    found: dict[Path, None] = {}
    paths = list(paths)
    for path in _expanded(paths):
        if path.is_dir():
            found.update(dict.fromkeys(_programs_in(path)))
        else:
            found[path] = None
    if not found:
        given = ", ".join(str(path) for path in paths) or "nothing"
        raise UsageError(
            f"no programs in {given}: looked for job files (.toml with a key 'program') and files "
            f"ending in {', '.join(sorted(NC_SUFFIXES))}"
        )
    return list(found)


def checkable(files: Iterable[Path], root: Path = Path()) -> list[Path]:
    """Job files and programs among files of any kind, and jobs that use another one of them.

    A program that one of these jobs runs is left out.

    Args:
        files: What a commit changes, say. Of those that are gone a ``twin.toml`` alone counts.
        root: Where jobs are looked for that share settings, use an STL file, or run on a machine among the files.
    """
    files = list(files)
    there = [path for path in files if path.is_file()]
    run_by = {path: program_of(path) for path in there if path.suffix == ".toml"}
    jobs = [path for path, program in run_by.items() if program is not None]
    programs = [path for path in there if _is_program(path)]
    known = {path.resolve() for path in (*jobs, *programs)}
    used = {path.resolve() for path in files} - known
    if used:
        found = (path for path in _programs_in(root) if path.suffix == ".toml")
        jobs += [path for path in found if path.resolve() not in known and _uses(path, used)]
    taken = {program_of(path) for path in jobs}
    return jobs + [path for path in programs if path.resolve() not in taken]


def _uses(path: Path, files: Collection[Path]) -> bool:
    """Whether a job takes settings from one of some files, or names it as solid or machine."""
    # Most who look for programs need no job to be read.
    from twin.job.load import SHARED_NAME, load_job

    folder = path.resolve().parent
    if any(each.name == SHARED_NAME and folder.is_relative_to(each.parent) for each in files):
        return True
    try:
        job = load_job(path)
    except TwinError:
        return False  # it is told of where it is checked itself
    file, named = job.file, [layer.path for layer in job.layers]
    named.append(job.folder / file.machine)
    named += [
        Path(each.file)
        for each in (file.stock, file.nominal, *file.fixtures)
        if each is not None and each.file
    ]
    return any(each.resolve() in files for each in named)


def _expanded(paths: Iterable[str | Path]) -> Iterable[Path]:
    for path in map(str, paths):
        if Path(path).exists():
            yield Path(path)
        elif glob.has_magic(path):
            # glob, not Path.glob: the pattern may be absolute.
            yield from map(Path, sorted(glob.glob(path, recursive=True)))  # noqa: PTH207
        else:
            raise UsageError(f"{path}: no such file or folder")


def _programs_in(folder: Path) -> list[Path]:
    jobs: list[Path] = []
    programs: list[Path] = []
    for root, folders, files in os.walk(folder):
        folders[:] = [name for name in folders if not _is_foreign(Path(root) / name)]
        for name in files:
            path = Path(root) / name
            if path.suffix == ".toml":
                jobs.append(path)
            elif _is_program(path):
                programs.append(path)
    run_by = {job: program_of(job) for job in jobs}
    taken = {program for program in run_by.values() if program is not None}
    jobs = [job for job in jobs if run_by[job] is not None]
    return sorted([*jobs, *(path for path in programs if path.resolve() not in taken)])


def _is_program(path: Path) -> bool:
    if path.suffix.lower() != ".h":
        return path.suffix.lower() in NC_SUFFIXES
    try:
        with path.open("rb") as file:
            return _KLARTEXT.search(file.read(_HEAD_BYTES)) is not None
    except OSError:
        return False


def without_jobs(programs: Iterable[Path]) -> list[Path]:
    """Programs that no job file runs, so that they run with the defaults."""
    found = []
    for path in programs:
        job = path.with_suffix(".toml")
        runs_it = job.is_file() and program_of(job) == path.resolve()
        if path.suffix != ".toml" and not runs_it:
            found.append(path)
    return found


def baselines_without_programs(folder: Path) -> list[Path]:
    """Baselines in a folder whose job and program are both gone from beside it."""
    left = []
    for baseline in sorted(folder.rglob("*.baseline")):
        place = folder.resolve().parent / baseline.relative_to(folder)
        if not (place.with_suffix(".toml").is_file() or place.with_suffix("").is_file()):
            left.append(baseline)
    return left


def _is_foreign(folder: Path) -> bool:
    if folder.name.startswith(".") or folder.name in _FOREIGN_FOLDERS:
        return True
    return (folder / "pyvenv.cfg").is_file()


def program_of(path: Path) -> Path | None:
    """The program that a job file runs; None for a TOML file that is no job.

    A file that cannot be read is left to the run, which says what is wrong with it, as long as a
    program of its name lies beside it.
    """
    try:
        program = tomllib.loads(path.read_text(encoding="utf-8")).get("program")
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError):
        beside = [path.with_suffix(suffix) for suffix in sorted(NC_SUFFIXES)]
        return next((found.resolve() for found in beside if found.is_file()), None)
    return (path.parent / program).resolve() if isinstance(program, str) else None
