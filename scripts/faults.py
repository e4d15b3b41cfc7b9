"""Kills a run at random moments, again and again, in one folder; prints what was ever torn.

The moments are spread over the whole run, its start and its writing of results among them.
"""

import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from left_behind import complaints

PROGRAM = Path(__file__).resolve().parents[1] / "programs" / "mefi" / "helix.toml"


def start(folder: Path) -> "subprocess.Popen[bytes]":
    """A run into a folder."""
    command = [sys.executable, "-m", "twin", "run", str(PROGRAM), "--out", str(folder)]
    return subprocess.Popen(  # noqa: S603 (this project's own command)
        command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )


def main(times: int, seed: int) -> int:
    """Kill as many runs; the exit code."""
    chance = random.Random(seed)  # noqa: S311 (moments need no cryptography)
    torn = ended = 0
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place, "out")
        start(folder).wait()  # compiles what is not compiled yet
        begin = time.perf_counter()
        start(folder).wait()
        whole_s = time.perf_counter() - begin
        for number in range(times):
            run = start(folder)
            time.sleep(chance.uniform(0.0, whole_s))
            ended += run.poll() is not None
            run.kill()
            run.wait()
            for complaint in complaints(folder):
                torn += 1
                print(f"kill {number}: {complaint}")
        start(folder).wait()
        leftovers = [path.name for path in folder.glob(".*")]
        if leftovers or complaints(folder):
            torn += 1
            print(f"the run after the last kill left {leftovers}, {complaints(folder)}")
    print(f"{times} kills over {whole_s:.1f} s, {ended} after the end: {torn} files torn")
    return 1 if torn else 0


if __name__ == "__main__":
    given = [int(argument) for argument in sys.argv[1:3]]
    sys.exit(main(*[*given, *(100, 1)[len(given) :]]))
