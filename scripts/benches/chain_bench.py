"""Whole runs from the command line: machine time and processor time, start-up, memory.

Times are the processor's, of one core, the start of Python and the loading of kernels in them.
"""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from benches.row import Row, median_cpu_seconds
from long_programs import short_lines

HOUR_S = 3600.0
"""Machine time of the program that is run [s]."""
TEN_LINES = "G90 G17 G71\nF1000\nG1 X10\nY10\nX0\nY0\nG2 X10 Y0 R5\nG0 Z5\nM5\nM30\n"


def rows() -> Iterator[Row]:
    """A run's rate, and how long small commands take."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        program, out = folder / "surface.nc", folder / "out"
        short_lines(program, HOUR_S)
        seconds = median_cpu_seconds(
            lambda: _twin("run", program, "--dialect", "gost", "--out", out)
        )
        result = json.loads((out / "result.json").read_text())
        hours = result["duration_s"] / HOUR_S
        yield Row("chain", "one hour of short lines, twin run", seconds / hours, "s")
        yield Row("chain", "  times real time", hours * HOUR_S / seconds, "x")
        stages = result["stages"]
        other = max(stages[name] for name in stages if name != "simulate_s")
        yield Row(
            "chain", "  busiest other package, of the simulation", other / stages["simulate_s"], "x"
        )
        share = stages["compare_s"] / stages["simulate_s"]
        yield Row("chain", "  comparison, of the simulation", share, "x")
        size = (out / "recording.h5").stat().st_size
        yield Row("chain", "  recording", size / hours / 1e6, "MB")
        small = folder / "ten.nc"
        small.write_text(TEN_LINES)
        yield Row("chain", "twin --help", median_cpu_seconds(lambda: _twin("--help")), "s")
        interpreting = median_cpu_seconds(lambda: _twin("interpret", small, "--dialect", "gost"))
        yield Row("chain", "twin interpret, ten lines", interpreting, "s")


def _twin(*arguments: object) -> None:
    command: Sequence[str] = [sys.executable, "-m", "twin", *map(str, arguments)]
    surroundings = {**os.environ, "OMP_NUM_THREADS": "1"}
    subprocess.run(  # noqa: S603 (this project's own command)
        command, env=surroundings, check=True, capture_output=True
    )
