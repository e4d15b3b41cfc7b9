"""Many programs: what ``twin check`` gains by working on several at a time.

Times are elapsed ones, so that they mean something only where nothing else runs.
"""

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from benches.long_programs import short_lines
from benches.row import Row, median_seconds

PROGRAMS = 64
"""So many that the start of each process, some two seconds, is not what is measured."""
SECONDS = 30.0
"""Machine time of each program [s]."""
REPEATS = 3


def rows() -> Iterator[Row]:
    """One at a time, and as many at a time as there are cores."""
    cores = len(os.sched_getaffinity(0))
    with tempfile.TemporaryDirectory() as name:
        for number in range(PROGRAMS):
            program = Path(name, f"surface{number}.nc")
            short_lines(program, SECONDS)
            job = f'program = "{program.name}"\ndialect = "gost"\n'
            program.with_suffix(".toml").write_text(job)
        alone, together = (
            median_seconds(lambda jobs=jobs: _check(name, jobs), REPEATS) for jobs in (1, cores)
        )
    task = f"check, {PROGRAMS} programs of {SECONDS:g} s, --jobs"
    yield Row("check", f"{task} 1", alone, "s")
    yield Row("check", f"{task} {cores}", together, "s")
    yield Row("check", f"gain on {cores} cores", alone / together, "x")


def _check(folder: str, jobs: int) -> None:
    command = [sys.executable, "-m", "twin", "check", folder, "--jobs", str(jobs)]
    subprocess.run(command, check=True, capture_output=True)  # noqa: S603 (this project's own command)
