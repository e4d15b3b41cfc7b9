"""What a compiled kernel was made from, as one hash: the only key of the cache.

Times and paths do not count: a moved, restored or copied environment finds what was compiled before.
"""

import functools
import hashlib
import os
import re
import sys
from pathlib import Path

import llvmlite
import numba
import numpy as np

PACKAGE = Path(__file__).resolve().parents[1]
_DECORATORS = f"{PACKAGE}/compilation/kernel.py"
"""How kernels are compiled and kept; what declares one may import it within a function."""
REQUIREMENTS = "requirements.txt"
"""What of the compilers compiled kernels need, in a folder of them."""


def compilers() -> tuple[str, ...]:
    """Requirements of pip under which kernels that are compiled here are found again.

    Within a minor version NumPy keeps the layout of arrays and the types of results.
    """
    minor = ".".join(np.__version__.split(".")[:2])
    return (
        f"numba=={numba.__version__}",
        f"llvmlite=={llvmlite.__version__}",
        f"numpy=={minor}.*",
    )


_IMPORT = re.compile(
    r"^(?:from (?P<origin>twin[\w.]*) import (?P<names>\([^)]*\)|[^\n]*)|import (?P<module>twin[\w.]+))",
    re.MULTILINE,
)
_NAME = re.compile(r"\w+")


@functools.cache
def content_key(file: Path) -> str:
    """Hash of a file, of all files of the package that it imports, of what compiles it, and of the compilers' versions."""
    digest = hashlib.sha256("\n".join((str(sys.implementation.cache_tag), *compilers())).encode())
    root = len(f"{PACKAGE}/")
    for source in sorted(_closure(str(file))):
        digest.update(source[root:].encode() + b"\0")
        digest.update(_digest(source))
    return digest.hexdigest()[:24]


def _closure(file: str) -> set[str]:
    found: set[str] = set()
    waiting = [file, _DECORATORS]
    while waiting:
        source = waiting.pop()
        if source not in found:
            found.add(source)
            waiting.extend(_imported(source))
    return found


@functools.cache
def _digest(file: str) -> bytes:
    return hashlib.sha256(Path(file).read_bytes()).digest()


@functools.cache
def _imported(file: str) -> tuple[str, ...]:
    """The package's files that a file imports at its head."""
    modules: set[str] = set()
    for match in _IMPORT.finditer(Path(file).read_text(encoding="utf-8")):
        if match["module"]:
            modules.add(match["module"])
            continue
        modules.add(match["origin"])
        modules.update(f"{match['origin']}.{name}" for name in _NAME.findall(match["names"]))
    return tuple(path for module in modules for path in _files(module))


@functools.cache
def _files(module: str) -> tuple[str, ...]:
    """Files of a module or a package of that name; none of what a module holds."""
    place = f"{PACKAGE.parent}/{module.replace('.', '/')}"
    return tuple(filter(os.path.isfile, (f"{place}.py", f"{place}/__init__.py")))
