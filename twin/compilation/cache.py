"""Where compiled kernels are kept: by the content of everything that they were compiled from.

Numba keeps what it compiled for as long as the file that a kernel stands in stays as it is; it does
not see that a function or a constant of another file, compiled into this one, has become a different
one. Here a kernel's folder is named after a hash of its own file and of all files of the package
that it imports, directly or through others, and of the versions of Python, NumPy, Numba and LLVM.
Times and paths do not count: a moved, restored or copied environment finds what was compiled before.
"""

import functools
import hashlib
import os
import platform
import re
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import llvmlite
import numba
import numpy as np
from numba.core.caching import CompileResultCacheImpl, _CacheLocator

_PACKAGE = Path(__file__).parent.parent
_VERSIONS = (platform.python_version(), np.__version__, numba.__version__, llvmlite.__version__)
_IMPORT = re.compile(
    r"^(?:from (?P<origin>twin[\w.]*) import (?P<names>\([^)]*\)|[^\n]*)|import (?P<module>twin[\w.]+))",
    re.MULTILINE,
)


class ContentCacheLocator(_CacheLocator):
    """Tells Numba where the compiled form of one kernel is kept.

    Attributes:
        _py_file: The kernel's file; Numba names it in its warnings.
    """

    def __init__(self, file: Path, folder: Path) -> None:
        self._py_file = str(file)
        self._folder = folder

    def get_cache_path(self) -> Any:
        """The folder of all kernels of the file."""
        return str(self._folder)

    def get_source_stamp(self) -> Any:
        """What tells a fresh kernel from a stale one; the folder's name says it already."""
        return self._folder.name

    def get_disambiguator(self) -> Any:
        """Kernels of one file differ by their names."""
        return "kernel"

    @classmethod
    def from_function(
        cls,
        py_func: Callable[..., Any],  # noqa: ARG003 (Numba passes it)
        py_file: str,
    ) -> Any:
        """A locator for a kernel of this package, None for another's function."""
        file = Path(py_file)
        if not file.is_relative_to(_PACKAGE):
            return None
        return cls(file, cache_root() / content_key(file))


def keep_kernels_by_content() -> None:
    """Let Numba keep this package's kernels here; what others compile stays as it is."""
    classes = CompileResultCacheImpl._locator_classes  # noqa: SLF001 - Numba has no public place for it
    if ContentCacheLocator not in classes:
        CompileResultCacheImpl._locator_classes = [ContentCacheLocator, *classes]  # noqa: SLF001


@functools.cache
def cache_root() -> Path:
    """The first folder that can be written to.

    ``NUMBA_CACHE_DIR`` where it is set, the user's cache folder, else a temporary folder of this
    process, whose kernels last as long as it does.
    """
    for folder in _candidates():
        try:
            folder.mkdir(parents=True, exist_ok=True)
            tempfile.TemporaryFile(dir=folder).close()
        except OSError:
            continue
        return folder
    return Path(_temporary().name)


@functools.cache
def content_key(file: Path) -> str:
    """Hash of a file, of all files of the package that it imports, and of the compilers' versions."""
    digest = hashlib.sha256("\n".join(_VERSIONS).encode())
    for source in sorted(_closure(file)):
        digest.update(source.relative_to(_PACKAGE).as_posix().encode() + b"\0")
        digest.update(source.read_bytes() + b"\0")
    return digest.hexdigest()[:24]


def _candidates() -> Iterator[Path]:
    if chosen := os.environ.get("NUMBA_CACHE_DIR"):
        yield Path(chosen) / "mill-twin"
    user_cache = os.environ.get("XDG_CACHE_HOME")
    try:
        yield (Path(user_cache) if user_cache else Path.home() / ".cache") / "mill-twin" / "kernels"
    except RuntimeError:
        return  # a user without a home folder


@functools.cache
def _temporary() -> "tempfile.TemporaryDirectory[str]":
    return tempfile.TemporaryDirectory(prefix="mill-twin-kernels-")


def _closure(file: Path) -> set[Path]:
    found: set[Path] = set()
    waiting = [file]
    while waiting:
        source = waiting.pop()
        if source not in found:
            found.add(source)
            waiting.extend(_imported(source))
    return found


@functools.cache
def _imported(file: Path) -> tuple[Path, ...]:
    """The package's files that a file imports at its head."""
    modules: list[str] = []
    for match in _IMPORT.finditer(file.read_text(encoding="utf-8")):
        if match["module"]:
            modules.append(match["module"])
            continue
        modules.append(match["origin"])
        modules += [f"{match['origin']}.{name}" for name in re.findall(r"\w+", match["names"])]
    places = {_PACKAGE.parent.joinpath(*module.split(".")) for module in modules}
    files = {place.with_suffix(".py") for place in places}
    files |= {place / "__init__.py" for place in places}
    return tuple(sorted(each for each in files if each.is_file()))
