"""How much memory runs of growing length need: scripts/bench --memory [LARGEST].

Each program is run by a process of its own, whose largest resident size is printed. Half of the
lengths are hours of machine time, half are millions of blocks of 0.02 mm; LARGEST leaves longer
ones out.
"""

import os
import sys
import tempfile
import time
from pathlib import Path

from benches.long_programs import short_lines
from rich.console import Console
from rich.table import Table

HOURS = (0.1, 1.0, 10.0)
MILLION_BLOCKS = (0.1, 1.0, 5.0)
LIMIT_MB = 600.0
SHORT_MM = 0.02
SECONDS_PER_MILLION = 820.0
"""Machine time of a million blocks of that length, about [s]."""


def main(hours: tuple[float, ...], millions: tuple[float, ...]) -> int:
    """Measure; the exit code is 1 when a run needs more than its limit."""
    table = Table("program", "blocks", "machine time", "elapsed", "most memory", "recording")
    worst = 0.0
    lengths = [(f"{each:g} h", each * 3600.0, 1.0) for each in hours]
    lengths += [(f"{m:g} M blocks", m * SECONDS_PER_MILLION, SHORT_MM) for m in millions]
    for name, seconds, chord in lengths:
        with tempfile.TemporaryDirectory() as place:
            program = Path(place, "long.nc")
            machine_s = short_lines(program, seconds, chord)
            with program.open("rb") as file:
                blocks = sum(1 for _ in file)
            begin = time.perf_counter()
            megabytes = run(program, Path(place, "out"))
            elapsed = time.perf_counter() - begin
            size = Path(place, "out", "recording.h5").stat().st_size / 1e6
        worst = max(worst, megabytes)
        table.add_row(
            name, f"{blocks:,}", f"{machine_s:,.0f} s", f"{elapsed:,.0f} s", f"{megabytes:.0f} MB",
            f"{size:.0f} MB",
        )  # fmt: skip
        Console(stderr=True).print(f"{name}: {megabytes:.0f} MB in {elapsed:.0f} s")
    Console(width=120).print(table)
    return int(worst > LIMIT_MB)


def run(program: Path, out: Path) -> float:
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
    code = os.waitstatus_to_exitcode(status)
    if code != 0:
        raise SystemExit(f"the run ended with exit code {code}")
    return used.ru_maxrss * 1024 / 1e6


if __name__ == "__main__":
    largest = float(sys.argv[1]) if len(sys.argv) > 1 else max(HOURS)
    sys.exit(
        main(
            tuple(each for each in HOURS if each <= largest),
            tuple(each for each in MILLION_BLOCKS if each <= largest),
        )
    )
