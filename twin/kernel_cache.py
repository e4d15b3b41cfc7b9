"""Compiled kernels are forgotten when one of their sources has changed.

Numba keeps what it compiled for as long as the file that a kernel stands in stays as it is; it does
not see that a function or a constant of another file, compiled into this one, has become a different
one.
"""

import ast
from collections.abc import Iterable, Iterator
from pathlib import Path

_STATE = "kernels.state"
"""Where a package notes, among its compiled files, of which sources they were made."""


def forget_stale(package: Path) -> None:
    """Remove Numba's indices from a package unless all sources of its kernels are as they were.

    An installation that cannot be written to keeps what it has: its sources do not change either.

    Args:
        package: Its folder, in whose own folders the files ``*_kernels.py`` are.
    """
    folders = [folder for folder in package.iterdir() if folder.is_dir()]
    kernels = [file for folder in folders for file in _files(folder, "_kernels.py")]
    near = {file for folder in {each.parent for each in kernels} for file in _files(folder, ".py")}
    note = package / "__pycache__" / _STATE
    try:
        noted = note.read_text(encoding="utf-8").split("\n\n") if note.is_file() else []
        now = _state(near)
        # What stands beside the kernels is as it was: who imports what need not be read.
        if noted[:1] == [now]:
            return
        sources = _state(_sources(package, kernels))
        if noted[1:] != [sources]:
            for folder in folders:
                for index in _files(folder / "__pycache__", ".nbi"):
                    index.unlink(missing_ok=True)
        note.parent.mkdir(exist_ok=True)
        note.write_text(f"{now}\n\n{sources}", encoding="utf-8")
    except (OSError, SyntaxError):
        return


def _state(files: Iterable[Path]) -> str:
    return "\n".join(sorted(f"{file} {file.stat().st_mtime_ns}" for file in files))


def _sources(package: Path, kernels: list[Path]) -> set[Path]:
    """The files of kernels, and all of the package that they import."""
    found: set[Path] = set()
    waiting = list(kernels)
    while waiting:
        file = waiting.pop()
        if file not in found:
            found.add(file)
            waiting.extend(_imported(package, file))
    return found


def _imported(package: Path, file: Path) -> Iterator[Path]:
    for statement in ast.parse(file.read_bytes()).body:
        if not isinstance(statement, ast.ImportFrom):
            continue
        first, *rest = (statement.module or "").split(".")
        if first != package.name:
            continue
        place = package.joinpath(*rest)
        modules = [
            place.with_suffix(".py"),
            *(place / f"{each.name}.py" for each in statement.names),
        ]
        yield from (each for each in modules if each.is_file())


def _files(folder: Path, suffix: str) -> list[Path]:
    if not folder.is_dir():
        return []
    return [file for file in folder.iterdir() if file.name.endswith(suffix)]
