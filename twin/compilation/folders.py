"""Where compiled kernels lie: in the installation, and in a folder of the user's.

A compiled kernel is code. It is loaded from the installation itself and from folders that nobody
but the user and root can write to, and from nowhere else.
"""

import contextlib
import functools
import os
import shutil
import stat
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from twin.compilation.content import PACKAGE

SHIPPED = PACKAGE / "_resources" / "kernels"
"""Kernels for every processor of an architecture, as a wheel brings them."""

_DAY_S = 86_400.0
_FORGOTTEN_AFTER_S = 60 * _DAY_S
"""Kernels that were not loaded for so long belong to a version that is no longer installed."""


_chosen: list[Path] = []


def keep_in(folder: Path) -> None:
    """Keep what this process compiles in a folder of the caller's choice, and look there first."""
    _chosen[:] = [folder]
    for remembered in (trusted_folders, writable_folder):
        remembered.cache_clear()


@functools.cache
def trusted_folders() -> tuple[Path, ...]:
    """The user's folders that kernels may be loaded from, the first choice first."""
    writable_folder()  # makes the first choice where it is missing
    return tuple(folder for folder in _candidates() if is_trusted(folder))


@functools.cache
def writable_folder() -> Path:
    """Where kernels are kept: the first folder that can be written to and that nobody else writes to.

    ``NUMBA_CACHE_DIR`` where it is set, the user's cache folder, a folder of the user's among the
    temporary ones, else a folder of this process, whose kernels last as long as it does.
    """
    for folder in _candidates():
        try:
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            if is_trusted(folder):
                tempfile.TemporaryFile(dir=folder).close()
                return folder
        except OSError:
            continue
    return Path(_temporary().name)


def lasts() -> bool:
    """Whether what is compiled here is found again by the next process."""
    return writable_folder() in list(_candidates())


def is_trusted(folder: Path) -> bool:
    """Whether nobody but this user and root can put files there or put another folder in its place."""
    try:
        folder = folder.resolve(strict=True)
        return _is_own(folder.stat()) and all(map(_is_kept_in_place, folder.parents))
    except OSError:
        return False


def _is_own(found: os.stat_result) -> bool:
    return found.st_uid in (os.geteuid(), 0) and not found.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


def _is_kept_in_place(parent: Path) -> bool:
    """A folder whose entries others cannot rename: their write bit is off, or the sticky bit on."""
    found = parent.stat()
    if found.st_uid not in (os.geteuid(), 0):
        return False
    # A group of one's own may write, as where umask is 002.
    others = stat.S_IWOTH | (0 if found.st_gid == os.getegid() else stat.S_IWGRP)
    return bool(found.st_mode & stat.S_ISVTX) or not found.st_mode & others


def touch(folder: Path) -> None:
    """Note that kernels of this folder are in use, at most once a day."""
    with contextlib.suppress(OSError):
        if time.time() - folder.stat().st_mtime > _DAY_S:
            os.utime(folder)


@functools.cache
def remove_forgotten(root: Path) -> None:
    """Remove the folders of kernels that nobody has loaded for two months; once in a process."""
    for folder in root.iterdir():
        with contextlib.suppress(OSError):
            if folder.is_dir() and time.time() - folder.stat().st_mtime > _FORGOTTEN_AFTER_S:
                shutil.rmtree(folder)


def _candidates() -> Iterator[Path]:
    yield from _chosen
    if chosen := os.environ.get("NUMBA_CACHE_DIR"):
        yield Path(chosen) / "mill-twin"
    user_cache = os.environ.get("XDG_CACHE_HOME")
    with contextlib.suppress(RuntimeError):  # a user without a home folder
        yield (Path(user_cache) if user_cache else Path.home() / ".cache") / "mill-twin" / "kernels"
    # Where nothing else can be trusted or written to, a home of mode 777 say, as build servers make it.
    yield Path(tempfile.gettempdir()) / f"mill-twin-{os.geteuid()}" / "kernels"


@functools.cache
def _temporary() -> "tempfile.TemporaryDirectory[str]":
    return tempfile.TemporaryDirectory(prefix="mill-twin-kernels-")
