"""What is compiled beside the planner is what the run calls behind it."""

import subprocess
import sys
from pathlib import Path

import pytest

from tests.loaded_kernels import loaded
from twin.commands import compilation
from twin.files.shipped import resource_root
from twin.run.judging.outcome import Outcome
from twin.run.preparing.preparation import prepare
from twin.run.progress import no_progress
from twin.run.run import Run

LATER = ("twin.machine", "twin.cutting", "twin.compare", "twin.coupling")
"""Packages behind the planner."""
FEW = 3
"""Kernels of circles and of a program's end, which a piece of one move may not come to."""
JOBS = (pytest.param("gallery/fagor8070/medallion", marks=pytest.mark.thorough), "mefi/helix")


def gone_through(job: Path) -> Outcome:
    """What comes of a run whose motion needs no planner."""
    run = Run(prepare(job))
    return run.execute(None, no_progress, compilation.later_motion(run))


def left_for_the_run(job: Path) -> set[str]:
    """Kernels behind the planner that a run calls and its rehearsal did not."""
    outcome = gone_through(job)
    assert outcome.samples > 0
    assert outcome.cut is not None
    assert outcome.cut.removed_mm3 > 0.0
    before = loaded()
    run = Run(prepare(job))
    run.execute(None, no_progress)
    return {name for name, _ in loaded() - before if name.startswith(LATER)}


@pytest.mark.seconds(
    "a process of its own: what other tests have loaded would hide what is missing"
)
@pytest.mark.parametrize("job", JOBS)
def test_nearly_all_kernels_behind_the_planner_are_called(job: str) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "tests.commands.test_compilation_ahead", job],
        capture_output=True, text=True, check=True, cwd=Path(__file__).parents[2],
    )  # fmt: skip
    assert len(done.stdout.split()) <= FEW, done.stdout


def test_a_program_without_a_cut_needs_none(tmp_path: Path) -> None:
    program = tmp_path / "a.nc"
    program.write_text("%A\nG90 G00 X1\nM30\n")
    (tmp_path / "a.toml").write_text('program = "a.nc"\ndialect = "fagor8070"\n')
    assert gone_through(tmp_path / "a.toml").samples == 0


@pytest.mark.parametrize(("cores", "is_kept"), [(1, True), (2, False)])
def test_nothing_is_begun_where_it_would_not_pay(
    monkeypatch: pytest.MonkeyPatch, cores: int, is_kept: bool
) -> None:
    monkeypatch.setattr(compilation, "available_cores", lambda: cores)
    monkeypatch.setattr(compilation, "lasts", lambda: is_kept)
    monkeypatch.setattr(compilation.multiprocessing, "get_context", None)
    compilation.start_compiling(Path("nothing.toml"), None, None)


if __name__ == "__main__":
    print(*left_for_the_run(resource_root("programs") / f"{sys.argv[1]}.toml"))
