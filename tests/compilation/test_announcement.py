"""The first compilation is reported, once, and a cached kernel is not."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from twin.compilation.announcement import MESSAGE

KERNELS = """
import numba

@numba.njit(cache=True)
def double(x):
    return 2 * x

@numba.njit(cache=True)
def triple(x):
    return 3 * x
"""
CALLS = """
from twin.compilation.announcement import announce_compilation
announce_compilation()
import kernels
kernels.double(1), kernels.triple(1)
"""


@pytest.mark.seconds("two processes load the compiler")
def test_the_first_compilation_is_told_of_once(tmp_path: Path) -> None:
    (tmp_path / "kernels.py").write_text(KERNELS)
    root = Path(__file__).parents[2]
    surroundings = {**os.environ, "PYTHONPATH": f"{root}{os.pathsep}{tmp_path}"}
    surroundings.pop("NUMBA_DISABLE_JIT", None)
    said = [
        subprocess.run(
            [sys.executable, "-c", CALLS],
            env=surroundings, cwd=tmp_path, capture_output=True, text=True, check=True,
        ).stderr
        for _ in range(2)
    ]  # fmt: skip
    assert said == [MESSAGE, ""]
