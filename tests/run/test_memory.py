"""How much memory runs of growing length need; half of the lengths are hours, half are millions of blocks."""

import os
import sys
from pathlib import Path

import pytest
from long_programs import short_lines

HOURS = (0.1, 1.0, 10.0)
MILLION_BLOCKS = (0.1, 1.0, 5.0)
LIMIT_MB = 600.0
SHORT_MM = 0.02
SECONDS_PER_MILLION = 820.0
"""Machine time of a million blocks of that length, about [s]."""


LONG = [pytest.param(3600.0 * hours, 1.0, id=f"{hours:g} h") for hours in HOURS] + [
    pytest.param(millions * SECONDS_PER_MILLION, SHORT_MM, id=f"{millions:g} M blocks")
    for millions in MILLION_BLOCKS
]


@pytest.mark.by_hand("an hour of processor time")
@pytest.mark.parametrize(("seconds", "chord"), LONG)
def test_memory_grows_neither_with_time_nor_with_blocks(
    tmp_path: Path, seconds: float, chord: float
) -> None:
    program = tmp_path / "long.nc"
    machine_s = short_lines(program, seconds, chord)
    megabytes = megabytes_of_run(program, tmp_path / "out")
    print(f"{machine_s:,.0f} s of machine time: {megabytes:.0f} MB")
    assert megabytes <= LIMIT_MB


def megabytes_of_run(program: Path, out: Path) -> float:
    """Run a program in a process of its own; its largest resident size [MB]."""
    command = [sys.executable, "-m", "twin", "run", str(program), "--dialect", "gost"]
    command += ["--out", str(out)]
    with Path(os.devnull).open("wb") as nothing:
        quiet = [
            (os.POSIX_SPAWN_DUP2, nothing.fileno(), 1),
            (os.POSIX_SPAWN_DUP2, nothing.fileno(), 2),
        ]
        child = os.posix_spawn(sys.executable, command, os.environ, file_actions=quiet)
        _, status, used = os.wait4(child, 0)
    assert os.waitstatus_to_exitcode(status) == 0
    return used.ru_maxrss * 1024 / 1e6
