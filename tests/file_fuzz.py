"""Throws damaged files at their readers: they must take them or refuse them with a sentence.

``scripts/fuzz KIND TRIES SEED`` runs as many tries and keeps the first file that fails. Each try
has a chance of its own, so that it can be had again.
"""

import collections
import contextlib
import random
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from tests.fuzz_kinds import KINDS, Kind
from twin.errors import TwinError

LONGEST_SECONDS = 20.0
"""Processor time that one file may take; a loop without an end takes longer."""
TAKEN = "taken"


def attempt(kind: Kind, data: bytes, folder: Path) -> str:
    """Read one file; ``TAKEN``, or the kind of refusal.

    Raises:
        AssertionError: It took too long.
    """
    begin = time.process_time()
    try:
        kind.read(data, folder)
        outcome = TAKEN
    except TwinError as error:
        if not str(error).strip():
            raise AssertionError("refused without a word") from error
        outcome = type(error).__name__
    assert time.process_time() - begin < LONGEST_SECONDS, "too slow"
    return outcome


@contextlib.contextmanager
def workplace(kind: Kind) -> Iterator[Path]:
    """A folder for damaged files."""
    with tempfile.TemporaryDirectory() as folder:
        if kind.beside is not None:
            kind.beside(Path(folder))
        yield Path(folder)


def damaged(name: str, seed: int, number: int) -> bytes:
    """The file of one try."""
    chance = random.Random(f"{name} {seed} {number}")  # noqa: S311 (no cryptography)
    return KINDS[name].change(chance, chance.choice(KINDS[name].wholes()))


def main(name: str, tries: int, seed: int = 1, first: int = 0) -> dict[str, int]:
    """Run as many tries.

    Returns:
        How many files were taken, and how many were refused with each kind of error.

    Raises:
        BaseException: A try failed; its number is printed.
    """
    outcomes: collections.Counter[str] = collections.Counter()
    with workplace(KINDS[name]) as folder:
        for number in range(first, first + tries):
            try:
                outcomes[attempt(KINDS[name], damaged(name, seed, number), folder)] += 1
            except BaseException:
                sys.stderr.write(f"try {number} of {name}, seed {seed}\n")
                raise
    return dict(outcomes.most_common())


if __name__ == "__main__":
    import faulthandler

    faulthandler.enable()
    kind, *numbers = sys.argv[1:]
    tries, seed, first = [int(n) for n in numbers] + [10_000, 1, 0][len(numbers) :]
    begin = time.perf_counter()
    found = main(kind, tries, seed, first)
    sys.stdout.write(
        f"{tries} {kind} in {time.perf_counter() - begin:.0f} s, seed {seed}: {found}\n"
    )
