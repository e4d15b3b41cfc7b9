"""Bad days of a run, again and again at random moments; prints what each of them left.

``scripts/faults [DAY...] [--times N] [--seed N]``: see ``DAYS`` below. A run must end with an exit
code and a sentence, and whatever lies under its own name in its folder must be whole.
"""

import argparse
import itertools
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from tests.left_behind import complaints

ROOT = Path(__file__).resolve().parents[1]
JOB = ROOT / "programs" / "fagor8070" / "bolt_hole_ring.toml"
CODES = {0, 1, 2, 3, 4, 130}
"""The exit codes of the contract."""
LONGEST_S = 300.0

Before = Callable[[], None] | None
"""Run in the new process, before the program."""


class Bench:
    """A folder in which runs have bad days.

    Attributes:
        chance: Where moments and sizes come from.
        times: How often each bad day is tried.
        place: A folder for whatever is needed.
        whole_s: How long a run takes that nothing happens to [s].
    """

    def __init__(self, place: Path, times: int, seed: int) -> None:
        self.place, self.times = place, times
        self.chance = random.Random(seed)  # noqa: S311 (moments need no cryptography)
        self.whole_s = 0.0
        for _ in range(2):  # the first one compiles what is not compiled yet
            begin = time.perf_counter()
            run(place / "whole")
            self.whole_s = time.perf_counter() - begin

    def moment_s(self) -> float:
        """A moment of a run: its start and its writing of results are as likely as the rest."""
        return self.chance.uniform(0.0, self.whole_s)


def start(folder: Path, before: Before = None) -> "subprocess.Popen[str]":
    """Begin a run into a folder."""
    command = [sys.executable, "-m", "twin", "run", str(JOB), "--out", str(folder)]
    return subprocess.Popen(
        command,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=before,  # noqa: PLW1509 (limits can be set nowhere else)
    )


def run(folder: Path, before: Before = None) -> tuple[int, str]:
    """Run to the end; exit code and what was said."""
    process = start(folder, before)
    _, said = process.communicate(timeout=LONGEST_S)
    return process.returncode, said


def faults(folder: Path, code: int, said: str) -> Iterator[str]:
    """What is wrong with a run's end and with what it left; nothing after a good end.

    A signal that comes while Python itself is being loaded ends it without a word of ours.
    """
    ours = "twin/__main__.py" in said or (said and "KeyboardInterrupt" not in said)
    if code in (-signal.SIGINT, -signal.SIGTERM) and not ours and not folder.exists():
        return
    yield from complaints(folder)
    if code not in CODES:
        yield f"exit code {code}, said {said[:150]!r} ... {said[-300:]!r}"
    if "Traceback" in said or (code != 0 and not said.strip()):
        yield f"said {said[:150]!r} ... {said[-300:]!r}"
    if list(folder.glob(".*")):
        yield f"left {[path.name for path in folder.glob('.*')]}"


def kill(bench: Bench) -> Iterator[str]:
    """Killed at random moments, in one folder; the run after the last kill cleans up."""
    folder = bench.place / "kill"
    for number in range(bench.times):
        process = start(folder)
        time.sleep(bench.moment_s())
        process.kill()
        process.communicate()
        yield from (f"kill {number}: {torn}" for torn in complaints(folder))
    yield from (f"afterwards: {each}" for each in faults(folder, *run(folder)))


def _stop(bench: Bench, how: signal.Signals) -> Iterator[str]:
    for number in range(bench.times):
        folder = bench.place / f"{how.name}{number}"
        process = start(folder)
        moment = bench.moment_s()
        time.sleep(moment)
        process.send_signal(how)
        _, said = process.communicate(timeout=LONGEST_S)
        for each in faults(folder, process.returncode, said):
            yield f"{how.name} {number} after {moment:.2f} s: {each}"


def interrupt(bench: Bench) -> Iterator[str]:
    """Ctrl-C at random moments."""
    return _stop(bench, signal.SIGINT)


def terminate(bench: Bench) -> Iterator[str]:
    """Asked to end, as a batch system does, at random moments."""
    return _stop(bench, signal.SIGTERM)


def _limited(bench: Bench, what: int, least: float, most: float) -> Iterator[str]:
    for number in range(bench.times):
        limit = int(least * (most / least) ** bench.chance.random())

        def before(limit: int = limit) -> None:
            resource.setrlimit(what, (limit, limit))

        folder = bench.place / f"limit{number}"
        for each in faults(folder, *run(folder, before)):
            yield f"limit of {limit} bytes: {each}"


def large_file(bench: Bench) -> Iterator[str]:
    """Files may not grow beyond a random size."""
    return _limited(bench, resource.RLIMIT_FSIZE, 1e3, 2e7)


def memory(bench: Bench) -> Iterator[str]:
    """Memory is limited to a random size."""
    return _limited(bench, resource.RLIMIT_AS, 1e8, 4e9)


def full_disk(bench: Bench) -> Iterator[str]:
    """A disk of a random size; needs the right to mount."""
    disk = bench.place / "disk"
    disk.mkdir()
    for _ in range(bench.times):
        size = int(4096 * 5000 ** bench.chance.random())
        with mounted(disk, f"size={size}"):
            for each in faults(disk / "out", *run(disk / "out")):
                yield f"disk of {size} bytes: {each}"


def read_only(bench: Bench) -> Iterator[str]:
    """A folder that cannot be written to; needs the right to mount."""
    disk = bench.place / "read_only"
    disk.mkdir()
    with mounted(disk, "ro"):
        for folder in (disk, disk / "out"):
            code, said = run(folder)
            yield from faults(folder, code, said)
            if code != 2 or str(disk) not in said:
                yield f"exit code {code}, said {said!r}"


class mounted:  # noqa: N801 (reads as what it does)
    """A small disk of its own at a folder."""

    def __init__(self, folder: Path, options: str) -> None:
        self._folder, self._options = str(folder), options

    def __enter__(self) -> None:
        mount = shutil.which("mount") or "mount"
        command = [mount, "-t", "tmpfs", "-o", self._options, "tmpfs", self._folder]
        subprocess.run(command, check=True)

    def __exit__(self, *_: object) -> None:
        subprocess.run([shutil.which("umount") or "umount", self._folder], check=True)


def two_runs(bench: Bench) -> Iterator[str]:
    """Two runs into one folder, the second a random moment later."""
    folder = bench.place / "two"
    for number in range(max(1, bench.times // 4)):
        first = start(folder)
        time.sleep(bench.moment_s())
        second = run(folder)
        _, said = first.communicate(timeout=LONGEST_S)
        ends = [(first.returncode, said), second]
        for code, words in ends:
            yield from (f"pair {number}: {each}" for each in faults(folder, code, words))
        if not any(code == 0 for code, _ in ends):
            yield f"pair {number}: none of the two came to its end: {ends}"


def cgroup(bench: Bench) -> Iterator[str]:
    """A control group with too little memory, whose processes the kernel kills."""
    group = Path("/sys/fs/cgroup/memory/twin_faults")
    limit, members = group / "memory.limit_in_bytes", group / "cgroup.procs"
    if not group.parent.is_dir():
        group = Path("/sys/fs/cgroup/twin_faults")
        limit, members = group / "memory.max", group / "cgroup.procs"
    group.mkdir()
    try:
        for number in range(bench.times):
            size = int(5e7 * 10 ** bench.chance.random())
            limit.write_text(str(size))
            folder = bench.place / f"group{number}"

            def join() -> None:
                members.write_text(str(os.getpid()))

            code, said = run(folder, join)
            killed = code == -signal.SIGKILL
            found = complaints(folder) if killed else faults(folder, code, said)
            yield from (f"group of {size} bytes: {each}" for each in found)
    finally:
        group.rmdir()


def broken_recording(bench: Bench) -> Iterator[str]:
    """A recording that is cut short or damaged somewhere is refused, or read as it stands."""
    whole = (bench.place / "whole" / "recording.h5").read_bytes()
    file = bench.place / "broken" / "recording.h5"
    file.parent.mkdir()
    for number in range(bench.times):
        data = bytearray(whole)
        at = bench.chance.randrange(len(data))
        if number % 2:
            del data[at:]
        else:
            data[at : at + 8] = bench.chance.randbytes(8)
        file.write_bytes(data)
        command = [sys.executable, "-m", "twin", "export", str(file)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        told = "Traceback" not in done.stderr and (done.returncode == 0 or done.stderr.strip())
        if done.returncode not in (0, 2) or not told or (number % 2 and done.returncode == 0):
            yield f"damage {number} at {at}: exit code {done.returncode}, {done.stderr[-300:]!r}"


def training_room(bench: Bench) -> Iterator[str]:
    """Strangers, floods, pages that do not read, a folder that vanishes, in one training room."""
    del bench
    from tests.training import room_attacks

    return room_attacks.complaints()


def agent(bench: Bench) -> Iterator[str]:
    """Fifty streams, clients that do not read and nonsense, all at once, for ``twin serve``."""
    del bench
    from tests.serve import agent_attacks

    return agent_attacks.complaints()


DAYS: Mapping[str, Callable[[Bench], Iterator[str]]] = {
    day.__name__.replace("_", "-"): day
    for day in (
        kill, interrupt, terminate, large_file, full_disk, read_only, memory, cgroup, two_runs,
        broken_recording, training_room, agent,
    )
}  # fmt: skip


def main() -> int:
    """Live through the days that were asked for; the exit code."""
    reader = argparse.ArgumentParser(description=__doc__)
    reader.add_argument("days", nargs="*", metavar="DAY", help=", ".join(DAYS))
    reader.add_argument("--times", type=int, default=100)
    reader.add_argument("--seed", type=int, default=1)
    asked = reader.parse_args()
    unknown = set(asked.days) - set(DAYS)
    if unknown:
        reader.error(f"no day {', '.join(sorted(unknown))}; there are: {', '.join(DAYS)}")
    worst = 0
    with tempfile.TemporaryDirectory() as place:
        bench = Bench(Path(place), asked.times, asked.seed)
        print(f"a run takes {bench.whole_s:.1f} s; {asked.times} times each, seed {asked.seed}")
        for name in asked.days or DAYS:
            begin = time.perf_counter()
            found = list(itertools.islice(DAYS[name](bench), 20))
            seconds = time.perf_counter() - begin
            print(f"{name}: {len(found) or 'no'} faults in {seconds:.0f} s", flush=True)
            for fault in found:
                print(f"  {fault}")
            worst = max(worst, len(found))
    return 1 if worst else 0


if __name__ == "__main__":
    sys.exit(main())
