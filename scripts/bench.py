"""Measures the packages and their peers side by side and prints one table.

Each file ``scripts/benches/<package>_bench.py`` has a function ``rows()`` that yields its lines. A figure
and that of a peer are taken in turns, so that other load slows both, and many are no times: pytest-benchmark times one
function in a test, and asv compares commits of a project, each in an environment that it builds.
"""

import importlib
import os
import platform
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import cast

from benches.row import Row
from rich.console import Console
from rich.table import Table

from twin.nc.line_kernel.plain_state import VARIABLE

BENCHES = Path(__file__).parent / "benches"


def packages() -> list[str]:
    """The packages that have a bench."""
    return sorted(p.stem.removesuffix("_bench") for p in BENCHES.glob("*_bench.py"))


def rows(package: str) -> Iterator[Row]:
    """The lines of one package, as they are measured."""
    return cast(Iterator[Row], importlib.import_module(f"benches.{package}_bench").rows())


def machine() -> str:
    """The machine that the figures belong to."""
    model = next(
        (
            line.partition(":")[2].strip()
            for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
            if line.startswith("model name")
        ),
        platform.processor(),
    )
    return f"{model}, {os.cpu_count()} cores, Python {platform.python_version()}"


def main(chosen: list[str]) -> int:
    """Measure the packages named, or all; the exit code."""
    unknown = set(chosen) - set(packages())
    if unknown:
        print(f"no bench for {', '.join(sorted(unknown))}; there are: {', '.join(packages())}")
        return 2
    os.environ[VARIABLE] = "wait"
    table = Table("package", "task", "this project", "peer", "its figure", "ratio", title=machine())
    for package in chosen or packages():
        for row in rows(package):
            theirs = "absent" if row.peer and row.peer_figure is None else ""
            ratio = ""
            if row.peer_figure is not None:
                theirs, ratio = f"{row.peer_figure:,.4g}", f"{row.figure / row.peer_figure:.2f}"
            table.add_row(
                row.package, row.task, f"{row.figure:,.4g} {row.unit}", row.peer, theirs, ratio
            )
    Console(width=140).print(table)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
