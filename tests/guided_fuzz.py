"""Damaged files again, led by coverage: a file that reaches new lines is damaged further.

``python -m tests.guided_fuzz KIND TRIES [SEED]``, or ``scripts/fuzz KIND TRIES --guided``. It needs
the extra ``fuzz`` (atheris, with LLVM's libFuzzer). What reached new lines is kept under
``.fuzz/KIND``, from which the next run goes on; what failed, under ``.fuzz/found``.
"""

import collections
import importlib
import os
import random
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
LONGEST_FILE = 1 << 16
"""No damaged file is larger [bytes]."""
SLOWER = 10.0
"""Times that a reader takes longer while its lines are watched."""
STUCK_S = 60
"""A file that is still being read after so long is kept as one that failed [s]."""
MEMORY_MB = 3000


def compiled_modules() -> list[str]:
    """Modules of kernels: Numba compiles what they hold, and cannot read what atheris puts in."""
    paths = [path.relative_to(ROOT) for path in (ROOT / "twin").rglob("*_kernels.py")]
    return [".".join(path.with_suffix("").parts) for path in paths]


def changer(
    atheris: Any, change: Callable[[random.Random, bytes], bytes], wholes: Sequence[bytes]
) -> Callable[[bytes, int, int], bytes]:
    """What libFuzzer thinks of, in turn with the damage that is known to hurt.

    A third of the latter is done to a whole file: what leads to new lines becomes small and broken.
    """

    def changed(data: bytes, longest: int, seed: int) -> bytes:
        chance = random.Random(seed)  # noqa: S311 (no cryptography)
        way = chance.randrange(3)
        if way == 0:
            return atheris.Mutate(data, longest)
        return change(chance, data if way == 1 else chance.choice(wholes))[:longest]

    return changed


def main(name: str, tries: int, seed: int = 1) -> None:
    """Run as many tries, then end the process."""
    try:
        atheris: Any = importlib.import_module("atheris")
    except ModuleNotFoundError:
        sys.exit("atheris is missing: python -m pip install -e '.[fuzz]'")
    with atheris.instrument_imports(
        include=["twin", "tomllib", "trimesh"], exclude=compiled_modules()
    ):
        from tests import file_fuzz, fuzz_kinds
        from tests.nc import fuzz
    fuzz.LONGEST_SECONDS *= SLOWER
    kind = fuzz_kinds.KINDS[name]
    corpus, found = ROOT / ".fuzz" / name, ROOT / ".fuzz" / "found"
    for folder in (corpus, found):
        folder.mkdir(parents=True, exist_ok=True)
    wholes = kind.wholes()
    for number, whole in enumerate(wholes):
        (corpus / f"whole-{number}").write_bytes(whole)
    outcomes: collections.Counter[str] = collections.Counter()
    with file_fuzz.workplace(kind) as place:

        def read(data: bytes) -> None:
            outcomes[file_fuzz.attempt(kind, data, place)] += 1
            if outcomes.total() == tries:
                print(
                    f"{tries} {name}, guided, seed {seed}: {dict(outcomes.most_common())}",
                    flush=True,
                )
                os._exit(0)  # libFuzzer would go on.

        atheris.Setup(
            [
                sys.argv[0],
                str(corpus),
                f"-seed={seed}",
                f"-max_len={LONGEST_FILE}",
                "-reduce_inputs=0",
                f"-timeout={STUCK_S}",
                f"-rss_limit_mb={MEMORY_MB}",
                f"-artifact_prefix={found}/{name}-",
            ],
            read,
            custom_mutator=changer(atheris, kind.change, wholes),
        )
        atheris.Fuzz()


if __name__ == "__main__":
    name, *numbers = sys.argv[1:]
    main(name, *[int(number) for number in numbers])
