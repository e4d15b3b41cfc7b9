"""Shared by this folder's tests: run a text in a dialect and look at what comes out."""

import dataclasses
from pathlib import Path
from typing import Any

from twin.job.load import load_job
from twin.nc.canonical import Axes, Chunk, Event, Moves, concatenate
from twin.nc.control.settings import ControlSettings, ToolData
from twin.nc.dialects import dialect_named
from twin.nc.interpreter import Interpretation
from twin.nc.jsonl import records
from twin.nc.text.diagnostics.diagnostics import Diagnostic, ProgramError
from twin.nc.text.source import source_from_text
from twin.run.preparing.preparation import prepare_job

ROOT = Path(__file__).resolve().parents[2]
SHIPPED = sorted(
    path for suffix in ("nc", "h", "mpf") for path in (ROOT / "programs").glob(f"*/*.{suffix}")
)
MILL = Axes(("X", "Y", "Z", "C"), ("linear", "linear", "linear", "rotary"))
SETTINGS = ControlSettings(axes=MILL, periodic=frozenset({"C"}))
WITH_TABLES = dataclasses.replace(
    SETTINGS,
    tools={1: ToolData(2.0, 60.0), 2: ToolData(3.0, 72.5)},
    offsets={
        **{f"G{number}": {"X": 10.0 * (number - 53)} for number in range(54, 60)},
        "G54.1 P1": {"Y": 5.0},
    },
    machine_zero={"Z": 300.0},
)
"""With tools, work offsets and machine zero."""


@dataclasses.dataclass(frozen=True)
class Outcome:
    """All of a program at once."""

    moves: Moves
    events: list[Event]
    warnings: list[Diagnostic]
    error: Diagnostic | None
    position: dict[str, float]
    display: dict[str, float]

    @property
    def codes(self) -> list[str]:
        return [warning.code for warning in self.warnings]

    def end(self, row: int) -> dict[str, float]:
        return self.moves.axes.named(self.moves.end[row])

    def delta(self, row: int) -> dict[str, float]:
        return self.moves.axes.named(self.moves.end[row] - self.moves.start[row])


def run(text: str, dialect: str, settings: ControlSettings = SETTINGS, **changes: Any) -> Outcome:
    settings = dataclasses.replace(settings, **changes)
    interpretation = Interpretation(source_from_text(text), dialect_named(dialect), settings)
    chunks: list[Chunk] = []
    error = None
    try:
        chunks.extend(interpretation.chunks())
    except ProgramError as raised:
        error = raised.diagnostic
    events = [event for chunk in chunks for event in chunk.events]
    return Outcome(
        concatenate((chunk.moves for chunk in chunks), settings.axes),
        events,
        list(interpretation.diagnostics),
        error,
        settings.axes.named(interpretation.position),
        settings.axes.named(interpretation.display),
    )


def good(text: str, dialect: str, **changes: Any) -> Outcome:
    outcome = run(text, dialect, **changes)
    assert outcome.error is None, outcome.error
    return outcome


def bad(text: str, dialect: str, **changes: Any) -> Diagnostic:
    outcome = run(text, dialect, **changes)
    assert outcome.error is not None
    return outcome.error


def shipped(path: Path) -> Interpretation:
    """A program with the settings of the job beside it."""
    return prepare_job(load_job(path)).interpretation()


def all_records(interpretation: Interpretation) -> list[dict[str, Any]]:
    """The records of a program, its error included."""
    found = []
    try:
        found.extend(records(interpretation))
    except ProgramError:
        assert found[-1]["severity"] == "error"
    return found
