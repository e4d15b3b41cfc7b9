"""A kernel that another one calls is compiled again when it has changed, and so is the other one."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.processes

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


def started(package: Path, **changed: str) -> "subprocess.Popen[str]":
    surroundings = {
        **os.environ,
        "NUMBA_CACHE_DIR": str(package.parents[1] / "cache"),
        "XDG_CACHE_HOME": str(package.parents[1] / "user"),
        "PYTHONDONTWRITEBYTECODE": "1",
        **changed,
    }
    return subprocess.Popen(
        [sys.executable, "-c", CALL],
        env=surroundings, cwd=package.parent, stdout=subprocess.PIPE, text=True,
    )  # fmt: skip


def outcome(package: Path, **changed: str) -> list[str]:
    """What the kernel gives, and how often it was found compiled."""
    process = started(package, **changed)
    said = process.communicate()[0]
    assert process.returncode == 0
    return said.split()


def kept(folder: Path, kernel: str) -> list[Path]:
    return sorted(folder.rglob(f"{kernel}-*.kernel"))


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


def test_where_no_cache_can_be_written_to_a_temporary_folder_of_the_user_keeps_kernels(
    package: Path,
) -> None:
    blocked, shared = package.parents[1] / "file", package.parents[1] / "shared"
    blocked.touch()
    shared.mkdir()
    changed = {"NUMBA_CACHE_DIR": str(blocked), "XDG_CACHE_HOME": str(blocked)}
    assert outcome(package, **changed, TMPDIR=str(shared)) == ["21", "0"]
    assert outcome(package, **changed, TMPDIR=str(shared)) == ["21", "1"]


def test_with_nothing_to_write_to_kernels_last_as_long_as_the_process(package: Path) -> None:
    blocked = package.parents[1] / "file"
    blocked.touch()
    nowhere = {name: str(blocked) for name in ("NUMBA_CACHE_DIR", "XDG_CACHE_HOME")}
    nowhere["TMPDIR"] = str(package.parents[1] / "shared")
    foreign = package.parents[1] / "shared" / f"mill-twin-{os.geteuid()}"
    foreign.mkdir(parents=True)
    foreign.chmod(0o777)
    assert outcome(package, **nowhere) == ["21", "0"]
    assert outcome(package, **nowhere) == ["21", "0"]


def test_what_kernels_alone_call_is_kept_within_them(package: Path) -> None:
    assert outcome(package) == ["21", "0"]
    assert len(kept(package.parents[1], "outer")) == 1
    assert kept(package.parents[1], "inner") == []


@pytest.mark.parametrize("damage", ["cut", "emptied", "a bit"])
def test_a_damaged_kernel_is_compiled_again(package: Path, damage: str) -> None:
    assert outcome(package) == ["21", "0"]
    (file,) = kept(package.parents[1], "outer")
    whole = file.read_bytes()
    middle = len(whole) // 2
    file.write_bytes(
        {
            "cut": whole[:middle],
            "emptied": b"",
            "a bit": whole[:middle] + bytes([whole[middle] ^ 1]) + whole[middle + 1 :],
        }[damage]
    )
    assert outcome(package) == ["21", "0"]
    assert outcome(package) == ["21", "1"]


def test_kernels_are_not_loaded_from_where_others_can_put_them(package: Path) -> None:
    assert outcome(package) == ["21", "0"]
    folder = package.parents[1] / "cache" / "mill-twin"
    folder.chmod(0o777)
    assert outcome(package) == ["21", "0"]
    assert len(kept(package.parents[1] / "user", "outer")) == 1


def test_processes_that_begin_together_compile_each_kernel_once(package: Path) -> None:
    runs = [started(package) for _ in range(3)]
    said = sorted(tuple(run.communicate()[0].split()) for run in runs)
    assert said == [("21", "0"), ("21", "1"), ("21", "1")]


def test_kernels_for_every_processor_are_found_in_the_installation(package: Path) -> None:
    generic = {"NUMBA_CPU_NAME": "generic"}
    assert outcome(package, **generic) == ["21", "0"]
    shutil.move(package.parents[1] / "cache" / "mill-twin", package / "_resources" / "kernels")
    assert outcome(package) == ["21", "1"]
    assert not kept(package.parents[1] / "cache", "outer")


def test_kernels_that_nobody_loads_any_more_are_removed(package: Path) -> None:
    assert outcome(package) == ["21", "0"]
    (package / "room" / "inner_kernels.py").write_text(INNER.format(3))
    before = {file.parent for file in kept(package.parents[1], "outer")}
    for folder in before:
        os.utime(folder, (0, 0))
    assert outcome(package) == ["31", "0"]
    assert not any(folder.exists() for folder in before)
