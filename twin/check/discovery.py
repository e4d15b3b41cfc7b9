"""Which programs are meant by paths, folders and globs."""

import glob
import os
import re
import tomllib
from collections.abc import Iterable
from pathlib import Path

from twin.errors import UsageError

NC_SUFFIXES = frozenset(
    {".nc", ".cnc", ".ngc", ".tap", ".mpf", ".spf", ".iso", ".gcode", ".eia", ".min", ".h"}
)
"""What a file must end in to be taken for an NC program when a folder is searched."""
_KLARTEXT = re.compile(rb"^[ \t]*\d*[ \t]*BEGIN[ \t]+PGM\b", re.IGNORECASE | re.MULTILINE)
"""What distinguishes a Klartext program from the headers of C, whose names end in .h as well."""
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
        UsageError: A path does not exist, or there is nothing to run in one of them.
    """
    found: dict[Path, None] = {}
    empty: list[str] = []
    for given in map(str, paths):
        programs = _programs_of(given)
        found.update(dict.fromkeys(programs))
        empty += [] if programs else [given]
    if empty or not found:
        raise UsageError(
            f"no programs in {', '.join(empty) or 'nothing'}: looked for job files (.toml with a key 'program') and files "
            f"ending in {', '.join(sorted(NC_SUFFIXES))}"
        )
    return list(found)


def _programs_of(given: str) -> list[Path]:
    """What a path, a folder or a glob stands for."""
    found: list[Path] = []
    for path in _expanded(given):
        found += programs_in(path) if path.is_dir() else [path]
    return found


def _expanded(given: str) -> list[Path]:
    if Path(given).exists():
        return [Path(given)]
    if not glob.has_magic(given):
        raise UsageError(f"{given}: no such file or folder")
    # glob, not Path.glob: the pattern may be absolute.
    return [Path(match) for match in sorted(glob.glob(given, recursive=True))]  # noqa: PTH207


def programs_in(folder: Path) -> list[Path]:
    """Job files in a folder and those below it, and programs that none of them runs."""
    jobs: list[Path] = []
    programs: list[Path] = []
    for root, folders, files in os.walk(folder):
        folders[:] = [name for name in folders if not _is_foreign(Path(root) / name)]
        for name in files:
            path = Path(root) / name
            if path.suffix == ".toml":
                jobs.append(path)
            elif is_program(path):
                programs.append(path)
    run_by = {job: program_of(job) for job in jobs}
    taken = {program for program in run_by.values() if program is not None}
    jobs = [job for job in jobs if run_by[job] is not None]
    return sorted([*jobs, *(path for path in programs if path.resolve() not in taken)])


def is_program(path: Path) -> bool:
    """Whether a file is an NC program by its name, or by its head where others end so too."""
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
    """Baselines in a folder whose job and program are both gone."""
    left = []
    for baseline in sorted(folder.rglob("*.baseline")):
        places = [anchor / baseline.relative_to(folder) for anchor in _anchors(folder)]
        ends = (".toml", "")
        if not any(place.with_suffix(end).is_file() for place in places for end in ends):
            left.append(baseline)
    return left


def file_of(folder: Path, path: Path, suffix: str) -> Path:
    """Where a job's baseline or report lies: in the folder, under the job's own path.

    Args:
        path: The job, or a program without one, which keeps its whole name, so that two of the same stem do not
            share a file.
    """
    resolved = path.resolve()
    anchor = next(each for each in _anchors(folder) if resolved.is_relative_to(each))
    parts = resolved.relative_to(anchor)
    name = parts.stem if parts.suffix == ".toml" else parts.name
    return folder / parts.with_name(name + suffix)


def _anchors(folder: Path) -> tuple[Path, ...]:
    """From where the paths in a folder of baselines or reports count: the first that a program lies below.

    It is the folder that this folder lies in, so that programs are found again from another checkout and from
    another working folder, else the working folder.
    """
    return folder.resolve().parent, Path.cwd().resolve(), Path("/")


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
