"""Compiled kernels are forgotten when one of their sources has changed.

Numba keeps what it compiled for as long as the file that a kernel stands in stays as it is; it does
not see that a kernel of another file, compiled into this one, has become a different one.
"""

from pathlib import Path

_STATE = "kernels.state"
"""Where a package notes, among its compiled files, of which sources they were made."""


def forget_stale(package: Path) -> None:
    """Remove Numba's indices from a package unless all files of kernels are as they were.

    An installation that cannot be written to keeps what it has: its sources do not change either.

    Args:
        package: Its folder, in whose own folders the files ``*_kernels.py`` are.
    """
    folders = [folder for folder in package.iterdir() if folder.is_dir()]
    sources = [file for folder in folders for file in _files(folder, "_kernels.py")]
    state = "".join(sorted(f"{file} {file.stat().st_mtime_ns}\n" for file in sources))
    note = package / "__pycache__" / _STATE
    try:
        if note.is_file() and note.read_text(encoding="utf-8") == state:
            return
        for folder in folders:
            for index in _files(folder / "__pycache__", ".nbi"):
                index.unlink(missing_ok=True)
        note.parent.mkdir(exist_ok=True)
        note.write_text(state, encoding="utf-8")
    except OSError:
        return


def _files(folder: Path, suffix: str) -> list[Path]:
    if not folder.is_dir():
        return []
    return [file for file in folder.iterdir() if file.name.endswith(suffix)]
