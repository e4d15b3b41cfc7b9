"""The first minute: what commands cost where no kernel is compiled yet, and where all are.

Processor time of the command and of its workers: with an empty folder for kernels, and with one that holds
them. An installation from a wheel has its kernels from the beginning, and costs what the second figure says.
"""

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from benches.row import Row, processor_seconds

from twin.files.shipped import resource_root

LINES = 1000
TEN = ("codesys", "fagor8070/omitted_words.toml", "fagor8070/full_circles.toml",
       "fagor8070/three_planes.toml", "mefi")  # fmt: skip
"""Ten small programs."""


def rows() -> Iterator[Row]:
    """The two commands that people begin with on a fresh folder for kernels; then each, with kernels."""
    programs = resource_root("programs")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        long = folder / "long.nc"
        long.write_text(
            "".join(f"N{n} G1 X{n % 97} Y{n % 13} F1000\n" for n in range(1, LINES + 1))
        )
        ten = [str(programs / each) for each in TEN]
        helix = ["run", str(programs / "mefi/helix.toml"), "--out", str(folder / "o")]
        tasks = {
            f"interpret, {LINES} lines": ["interpret", str(long), "--dialect", "gost"],
            "check of ten programs, two workers": ["check", *ten, "--jobs", "2"],
            "check of ten programs, one worker": ["check", *ten, "--jobs", "1"],
            "run of a helix": helix,
            "rehearsal of a training scene": ["train", "codesys_opening_angle", "--rehearse"],
        }
        commands = {task: ["-m", "twin", *command] for task, command in tasks.items()}
        cold, kernels = {}, folder / "kernels"
        for number, task in enumerate(tuple(tasks)[:2]):
            kernels = folder / f"kernels{number}"
            cold[task] = _seconds(commands[task], kernels)
        for task, command in commands.items():
            _seconds(command, kernels)  # what it alone needs is compiled now
            warm = _seconds(command, kernels)
            if task in cold:
                yield Row("first", f"{task}, without kernels", cold[task], "s")
            yield Row("first", f"{task}, with kernels", warm, "s")


def _seconds(command: list[str], kernels: Path) -> float:
    began = processor_seconds()
    subprocess.run(  # noqa: S603 (this project's own command)
        [sys.executable, *command],
        env=os.environ | {"XDG_CACHE_HOME": str(kernels), "NUMBA_CACHE_DIR": str(kernels)},
        check=True, capture_output=True,
    )  # fmt: skip
    return processor_seconds() - began
