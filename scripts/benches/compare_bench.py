"""What the comparison costs beside the simulation that it watches."""

import tempfile
from collections.abc import Iterator
from pathlib import Path

from benches.row import Row

from twin.run.preparation import prepare
from twin.run.progress import no_progress
from twin.run.run import Run

ROUNDS = 100
"""Of the program below: ten minutes of machine time at the default feeds."""
ROOT = Path(__file__).parents[2]


def _program() -> str:
    """Lines, circles both ways, and the table in step."""
    text = ["N1 X0 Y0 Z0 C0 G00", "N2 G01 F1500"]
    for number in range(ROUNDS):
        x, y = 4 * (number % 6), number % 5
        text += [
            f"N10 G01 X{x + 20} Y{y}",
            f"N11 G02 X{x} Y{y} I-10 J0",
            f"N12 G03 X{x} Y{y} I12 J0",
            f"N13 G01 X{x + 5} Y{-(number % 7) - 3} C{30 * number}",
            f"N14 G01 Z-{number % 4} X{x}",
        ]
    return "\n".join([*text, "N99 M30"]) + "\n"


def rows() -> Iterator[Row]:
    """The share of the comparison, of one run each: both stages of it see the same machine."""
    with tempfile.TemporaryDirectory() as folder:
        long = Path(folder) / "long.nc"
        long.write_text(_program(), encoding="utf-8")
        helix = ROOT / "programs" / "mefi" / "helix.toml"
        _stages(helix, Path(folder))  # compiled code comes off the disk
        for task, path in (("ten minutes of lines, arcs, C", long), ("the mefi helix", helix)):
            minutes, simulate_s, compare_s = _stages(path, Path(folder))
            yield Row(
                "compare",
                f"comparison / simulation, {task} ({minutes:.1f} min)",
                100.0 * compare_s / simulate_s,
                "%",
            )


def _stages(path: Path, folder: Path) -> tuple[float, float, float]:
    run = Run(prepare(path, dialect="mefi"))
    outcome = run.execute(run.dry_run(), folder, no_progress)
    return outcome.duration_s / 60.0, run.clock.seconds["simulate"], run.clock.seconds["compare"]
