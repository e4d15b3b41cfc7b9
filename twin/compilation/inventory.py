"""Whether all kernels are compiled already."""

import hashlib
import os
import re
from pathlib import Path
from typing import NamedTuple

from twin.compilation.content import PACKAGE, content_key
from twin.compilation.folders import SHIPPED, lasts, trusted_folders, writable_folder

_HAS_KERNELS = re.compile(r"^@\w*kernel$|\bkernel\(program\.", re.MULTILINE)


class Inventory(NamedTuple):
    """What was found.

    Attributes:
        shipped: Whether the installation brings every kernel of this version, compiled.
        own: Whether a folder of the user's holds them all.
        folder: Where the next kernel that is compiled is kept.
        lasts: Whether it is found again by the next process.
    """

    shipped: bool
    own: bool
    folder: Path
    lasts: bool

    @property
    def complete(self) -> bool:
        """Whether nothing is left to be compiled."""
        return self.shipped or self.own

    def __str__(self) -> str:
        """One line for a person."""
        if self.shipped:
            return "compiled, in the installation"
        if self.own:
            return f"compiled, in {self.folder}"
        if not self.lasts:
            return (
                "compiled again by each process, because no folder can keep them: set "
                "NUMBA_CACHE_DIR to a folder that only you can write to"
            )
        return (
            f"compiled when first used, two to three minutes in all, into {self.folder}; "
            "'twin doctor --compile' does it beforehand"
        )


def inventory() -> Inventory:
    """Look for the compiled kernels of this very version; nothing is loaded or compiled."""
    name = _note_name()
    return Inventory(
        # Of folders that this user may not look into there is nothing to be had.
        shipped=os.access(SHIPPED / name, os.R_OK),
        own=any(os.access(root / name, os.R_OK) for root in trusted_folders()),
        folder=writable_folder(),
        lasts=lasts(),
    )


def note_complete(root: Path) -> None:
    """Leave a note in a folder that it holds every kernel of this version."""
    (root / _note_name()).touch()


def _note_name() -> str:
    keys = sorted(
        content_key(file)
        for file in PACKAGE.rglob("*.py")
        if _HAS_KERNELS.search(file.read_text(encoding="utf-8"))
    )
    return f"complete-{hashlib.sha256(' '.join(keys).encode()).hexdigest()[:24]}"
