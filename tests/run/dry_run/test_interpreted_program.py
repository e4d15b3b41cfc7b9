"""A program is interpreted once, whoever reads its moves."""

from pathlib import Path

import numpy as np
import pytest

from twin.nc.canonical import concatenate
from twin.nc.interpreter import Interpretation
from twin.run.dry_run import dry_run as room
from twin.run.dry_run.dry_run import interpreted
from twin.run.preparing.preparation import Preparation, prepare
from twin.run.progress import no_progress
from twin.run.run import Run

HEAD = 'program = "part.nc"\ndialect = "codesys"\nmachine = "mill4"\n'


def prepared(folder: Path, text: str, more: str = "") -> Preparation:
    (folder / "part.nc").write_text(text)
    (folder / "part.toml").write_text(HEAD + more)
    return prepare(folder / "part.toml")


def test_a_run_interprets_its_program_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    passes = list[Interpretation]()
    chunks = Interpretation.chunks

    def counted(self: Interpretation):
        passes.append(self)
        return chunks(self)

    monkeypatch.setattr(Interpretation, "chunks", counted)
    run = Run(prepared(tmp_path, "N10 G1 X1 F600\nN20 G1 X0\n"))
    outcome = run.execute(None, no_progress)
    assert outcome.samples
    assert len(passes) == 1


def test_what_does_not_fit_into_memory_is_the_same_from_a_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    text = "".join(f"N{n} G1 X{n % 7} Y{n % 5} F600\n" for n in range(1, 4300))
    made = prepared(tmp_path, text)
    whole = interpreted(made)
    monkeypatch.setattr(room, "MOVES_IN_MEMORY", 0)
    parted = interpreted(made)
    assert parted.moves == whole.moves
    # Two readers at a time do not disturb each other.
    for one, other, expected in zip(parted.chunks(), parted.chunks(), whole.chunks(), strict=True):
        assert one.events == other.events == expected.events
        for name in ("line", "start", "end", "feed", "motion"):
            assert np.array_equal(getattr(one.moves, name), getattr(expected.moves, name)), name
            assert np.array_equal(getattr(other.moves, name), getattr(expected.moves, name)), name
    assert (
        len(concatenate([chunk.moves for chunk in parted.chunks()], made.machine.axes))
        == whole.moves
    )


def test_the_program_says_where_it_begins_else_the_job(tmp_path: Path):
    start = "[start]\nX = 3.0\n"
    assert interpreted(prepared(tmp_path, "N10 G92 X5 Y6\nN20 G1 X7 F600\n", start)).start[0] == 5.0
    assert interpreted(prepared(tmp_path, "N10 G1 X7 F600\n", start)).start[0] == 3.0
    assert interpreted(prepared(tmp_path, "N10 M5\n", start)).start[0] == 3.0
