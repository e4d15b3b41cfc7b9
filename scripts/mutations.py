"""What a baseline catches: shipped programs and jobs, changed one thing at a time.

Prints a line for each change: what was found, and whether it is told at the line that was changed.
"""

import itertools
import re
import shutil
import sys
import tempfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from twin.check.settings import CheckSettings
from twin.check.task import check_program
from twin.files.shipped import resource_root

STOCK = """
[stock]
shape = "box"
size = [120.0, 120.0, 30.0]
"""
PROGRAMS = (
    "codesys/semicircle_by_radius",
    "codesys/arc_in_xz_then_xy",
    "fagor8070/bolt_hole_ring",
    "fagor8070/rounded_polygon",
    "fagor8070/three_planes",
    "gost/recalculation_2",
)


class Change(NamedTuple):
    """One change: a pattern and what stands there instead, at its so-manieth place."""

    what: str
    pattern: str
    instead: str | Callable[[re.Match[str]], str]
    count: int = 0


def _scaled(factor: float, more: float = 0.0) -> Callable[[re.Match[str]], str]:
    return lambda word: f"{word[1]}{float(word[2]) * factor + more:g}"


EACH = (3, 2)
"""On how many programs a change is tried: one of code, one of a job."""
NUMBER = r"(-?\d+\.?\d*)"
CODE = (
    Change("a coordinate 0.02 mm off", rf"\b(X){NUMBER}", _scaled(1.0, 0.02)),
    Change("a sign dropped", r"\b([XYZIJ])-(\d+\.?\d*)", lambda word: f"{word[1]}{word[2]}"),
    Change("a decimal shifted", rf"\b(Y){NUMBER}", _scaled(0.1)),
    Change("a feed lost a digit", rf"\b(F){NUMBER}", _scaled(0.1)),
    Change("a feed of half", rf"\b(F){NUMBER}", _scaled(0.5)),
    Change("the arc turns the other way", r"\bG0?2\b", "G03"),
    Change("an arc became a line", r"\bG0?[23]\b", "G01"),
    Change("a rapid for a feed", r"\bG0?1\b", "G00"),
    Change("a line lost", r"(?m)^.*\b[XY]-?\d.*\n", ""),
    Change("a coordinate 1 mm off", rf"\b(X){NUMBER}", _scaled(1.0, 1.0)),
)
JOB = (
    Change(
        "stock 4 mm lower", r"(size = .*)", lambda line: f"{line[1]}\nposition = [0.0, 0.0, -4.0]"
    ),
    Change("tolerance times 100", r"\Z", "\n[tolerance]\ncontour_um = 2000.0\n"),
    Change("drill of 8", r"\Z", '\n[[tools]]\nnumber = 1\nkind = "drill"\ndiameter = 8.0\n'),
    Change(
        "other machine", r"(?m)^(program = .*)$", lambda line: f'{line[1]}\nmachine = "mill4_light"'
    ),
    Change(
        "part zero 20 mm off",
        r"(?m)^(program = .*)$",
        lambda line: f"{line[1]}\npart_zero = {{ X = 20.0 }}",
    ),
    Change(
        "default feed of half",
        r"(?m)^(program = .*)$",
        lambda line: f"{line[1]}\ndefault_feed = 123.0",
    ),
)


def main() -> int:
    """Try each change on as many programs as its kind says; 1 where more than three are missed."""
    missed: list[str] = []
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)
        jobs = [_copy(program, root) for program in PROGRAMS]
        update = CheckSettings(baseline=root / "baselines", update_baseline=True)
        for job in jobs:
            check_program(job, update)
        tried: Counter[Change] = Counter()
        for kind, changes in enumerate((CODE, JOB)):
            for change, job in itertools.product(changes, jobs):
                file = job if kind else job.with_suffix(".nc")
                before = file.read_text(encoding="utf-8")
                found = re.search(change.pattern, before)
                if found is None or tried[change] == EACH[kind]:
                    continue
                after = re.sub(change.pattern, change.instead, before, count=1)
                if after == before:
                    continue
                tried[change] += 1
                file.write_text(after, encoding="utf-8")
                place = before[: found.start() + 1].count("\n") + 1
                length = after.count("\n") - before.count("\n")
                told = _told(job, root, file, range(place - 1, place + 2 + max(length, 0)))
                file.write_text(before, encoding="utf-8")
                print(f"{told:28} {job.stem}: {change.what} (line {place})")
                if told == "MISSED":
                    missed.append(f"{job.stem}: {change.what}")
    print(f"{tried.total() - len(missed)} of {tried.total()} caught")
    return int(len(missed) > 3)


def _copy(program: str, root: Path) -> Path:
    source = resource_root("programs") / f"{program}.nc"
    shutil.copy(source, root / source.name)
    dialect = program.partition("/")[0]
    job = root / f"{source.stem}.toml"
    job.write_text(f'program = "{source.name}"\ndialect = "{dialect}"\n{STOCK}', encoding="utf-8")
    return job


def _told(job: Path, root: Path, file: Path, places: range) -> str:
    outcome = check_program(job, CheckSettings(baseline=root / "baselines"))
    if outcome.passed:
        return "MISSED"
    lines = [finding.line for finding in outcome.findings if Path(finding.file).name == file.name]
    # A lost line is told at the one that stands in its place.
    near = any(line in places for line in lines)
    return f"{outcome.findings[0].code}{'' if near else ' (elsewhere)'}"


if __name__ == "__main__":
    sys.exit(main())
