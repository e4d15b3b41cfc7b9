"""A kernel that another one calls is compiled anew when it has changed, and so is the other one."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
INNER = """
from twin.compilation.kernel import kernel
from twin.room.shared import FACTOR

@kernel
def inner(x):
    return {} * FACTOR * x
"""
OUTER = """
from twin.compilation.kernel import kernel
from twin.room import inner_kernels
from twin.room.inner_kernels import inner

@kernel
def outer(x):
    return inner(x) + 1
"""
CALL = """
from twin.room.outer_kernels import outer
print(outer(10), sum(outer.stats.cache_hits.values()))
"""


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A package ``twin`` with one room of its own, in a folder where it may be changed."""
    room = tmp_path / "home" / "twin" / "room"
    room.mkdir(parents=True)
    (room.parent / "__init__.py").touch()
    shutil.copytree(ROOT / "twin" / "compilation", room.parent / "compilation")
    (room / "__init__.py").touch()
    (room / "outer_kernels.py").write_text(OUTER)
    (room / "inner_kernels.py").write_text(INNER.format(2))
    (room / "shared.py").write_text("FACTOR = 1\n")
    return room.parent


def outcome(package: Path, **changed: str) -> list[str]:
    """What the kernel gives, and how often it was found compiled."""
    surroundings = {
        **os.environ,
        "NUMBA_CACHE_DIR": str(package.parents[1] / "cache"),
        "PYTHONDONTWRITEBYTECODE": "1",
        **changed,
    }
    done = subprocess.run(
        [sys.executable, "-c", CALL],
        env=surroundings,
        cwd=package.parent,
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.split()


def test_a_changed_kernel_is_seen_through_the_one_that_calls_it(package: Path) -> None:
    assert outcome(package) == ["21", "0"]
    assert outcome(package) == ["21", "1"]
    (package / "room" / "inner_kernels.py").write_text(INNER.format(3))
    assert outcome(package) == ["31", "0"]
    (package / "room" / "inner_kernels.py").write_text(INNER.format(2))
    assert outcome(package) == ["21", "1"]


def test_a_changed_constant_is_seen_and_a_neighbour_without_a_part_in_it_is_not(
    package: Path,
) -> None:
    assert outcome(package) == ["21", "0"]
    (package / "room" / "neighbour.py").write_text("FACTOR = 4\n")
    assert outcome(package) == ["21", "1"]
    (package / "room" / "shared.py").write_text("FACTOR = 3\n")
    assert outcome(package) == ["61", "0"]


def test_times_do_not_count(package: Path) -> None:
    (package / "room" / "inner_kernels.py").write_text(INNER.format(3))
    assert outcome(package) == ["31", "0"]
    changed = package / "room" / "inner_kernels.py"
    before = changed.stat()
    changed.write_text(INNER.format(4))
    os.utime(changed, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert outcome(package) == ["41", "0"]


def test_a_moved_environment_finds_what_was_compiled_before(package: Path) -> None:
    assert outcome(package) == ["21", "0"]
    moved = package.parents[1] / "elsewhere"
    shutil.copytree(package.parent, moved)
    assert outcome(moved / "twin") == ["21", "1"]


def test_with_nothing_to_write_to_kernels_last_as_long_as_the_process(package: Path) -> None:
    blocked = package.parents[1] / "file"
    blocked.touch()
    nowhere = {"NUMBA_CACHE_DIR": str(blocked), "XDG_CACHE_HOME": str(blocked)}
    assert outcome(package, **nowhere) == ["21", "0"]
    assert outcome(package, **nowhere) == ["21", "0"]
