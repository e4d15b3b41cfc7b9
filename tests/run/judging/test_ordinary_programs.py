"""Warnings that are wrong: 200 ordinary programs, which were not there when they were made, draw none."""

from pathlib import Path

import pytest

from tests.run.judging.ordinary_programs import ordinary
from tests.run.judging.test_verdict_scope import codes
from twin.files.shipped import resource_root
from twin.machine.model.clamping import what_carries
from twin.run.preparing.preparation import prepare
from twin.run.progress import no_progress
from twin.run.run import Run

A_FEW, BATCH = 2, 10
_AS_MANY_AGAIN = pytest.mark.by_hand(
    "a hundred more programs take a minute, and show what the first do"
)


def drawn(folder: Path, seed: int) -> dict[str, int]:
    """What a program draws, by code; none of it is right."""
    program, job, _ = ordinary(seed)
    (folder / "p.nc").write_text(program)
    (folder / "p.toml").write_text(job)
    chain = Run(prepare(folder / "p.toml"))
    return codes(chain.execute(None, no_progress))


@pytest.mark.seconds("programs are run whole")
def test_a_few_ordinary_programs_draw_nothing(tmp_path: Path) -> None:
    assert {seed: found for seed in range(A_FEW) if (found := drawn(tmp_path, seed))} == {}


@pytest.mark.thorough
@pytest.mark.parametrize(
    "first",
    [
        *range(0, 100, BATCH),
        *(pytest.param(first, marks=_AS_MANY_AGAIN) for first in range(100, 200, BATCH)),
    ],
)
def test_ordinary_programs_draw_nothing(first: int, tmp_path: Path) -> None:
    seeds = range(first, first + BATCH)
    assert {seed: found for seed in seeds if (found := drawn(tmp_path, seed))} == {}


@pytest.mark.seconds("every shipped job is laid out on its machine")
def test_the_stock_of_every_shipped_job_is_carried() -> None:
    jobs = [job for job in resource_root("programs").rglob("*.toml") if "alarms" not in job.parts]
    floating = {job.stem: why for job in jobs if (why := what_carries(Run(prepare(job)).model))}
    assert len(jobs) > 40
    assert floating == {}
