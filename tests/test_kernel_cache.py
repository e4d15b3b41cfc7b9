"""A kernel that another one calls is compiled anew when it has changed, and so is the other one."""

import os
import subprocess
import sys
from pathlib import Path

from twin.kernel_cache import forget_stale

INNER = "import numba\n@numba.njit(cache=True)\ndef inner(x):\n    return {} * x\n"
OUTER = """
import numba
from shop.room.inner_kernels import inner

@numba.njit(cache=True)
def outer(x):
    return inner(x) + 1
"""
CALL = """
import pathlib, sys
from twin.kernel_cache import forget_stale
forget_stale(pathlib.Path(sys.argv[1]))
from shop.room.outer_kernels import outer
print(outer(10), sum(outer.stats.cache_hits.values()))
"""


def outcome(folder: Path) -> list[str]:
    root = Path(__file__).parents[1]
    surroundings = {**os.environ, "PYTHONPATH": f"{root}{os.pathsep}{folder}"}
    surroundings.pop("NUMBA_CACHE_DIR", None)
    command = [sys.executable, "-c", CALL, str(folder / "shop")]
    done = subprocess.run(command, env=surroundings, capture_output=True, text=True, check=True)
    return done.stdout.split()


def test_a_changed_kernel_is_seen_through_the_one_that_calls_it(tmp_path: Path) -> None:
    room = tmp_path / "shop" / "room"
    room.mkdir(parents=True)
    (room / "outer_kernels.py").write_text(OUTER)
    (room / "inner_kernels.py").write_text(INNER.format(2))
    assert outcome(tmp_path) == ["21", "0"]
    assert outcome(tmp_path) == ["21", "1"]
    (room / "inner_kernels.py").write_text(INNER.format(3))
    assert outcome(tmp_path) == ["31", "0"]


def test_a_changed_constant_is_seen_and_a_neighbour_without_a_part_in_it_is_not(
    tmp_path: Path,
) -> None:
    room = tmp_path / "shop" / "room"
    room.mkdir(parents=True)
    (room / "outer_kernels.py").write_text(
        OUTER.replace("room.inner_kernels", "room.shared").replace("inner(x)", "FACTOR * x")
        .replace("inner", "FACTOR")
    )  # fmt: skip
    (room / "shared.py").write_text("FACTOR = 2\n")
    assert outcome(tmp_path) == ["21", "0"]
    (room / "neighbour.py").write_text("FACTOR = 4\n")
    assert outcome(tmp_path) == ["21", "1"]
    assert outcome(tmp_path) == ["21", "1"]
    (room / "shared.py").write_text("FACTOR = 3\n")
    assert outcome(tmp_path) == ["31", "0"]


def test_where_nothing_can_be_noted_nothing_is_said(tmp_path: Path) -> None:
    (tmp_path / "room").mkdir()
    (tmp_path / "__pycache__").write_text("no folder")
    forget_stale(tmp_path)
