from pathlib import Path

import numpy as np
import pytest

import twin
import twin.compare.result
import twin.run.run
from tests.check.test_check_runs import write_job
from twin import api
from twin.api import functions
from twin.commands.runs.compare import compare_and_print
from twin.commands.runs.export import export_and_print
from twin.errors import ExitCode, UsageError
from twin.nc.text.diagnostics.diagnostics import ProgramError


def test_a_program_from_text_to_difference(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    job = write_job(tmp_path, "part")
    moves = api.interpret(job)
    assert moves.end[-1, :2] == pytest.approx([20.5, -4.25])
    setpoints = api.plan(job)
    done = api.run(job, out=tmp_path / "out")
    assert done.outcome.verdict.outcome == "pass"
    assert done.recording is not None
    assert done.recording == tmp_path / "out" / "recording.h5"
    assert done.outcome.duration_s == pytest.approx(setpoints.time[-1], abs=2e-3)
    assert np.diff(setpoints.time) == pytest.approx(0.001)
    csv = tmp_path / "log.csv"
    assert export_and_print(done.recording, csv, every=5) is ExitCode.OK
    difference = api.compare(done.recording, csv)
    assert max(axis.actual_max for axis in difference.axes.values()) < 0.05
    assert compare_and_print(done.recording, csv, tolerance=0.05) is ExitCode.OK
    assert compare_and_print(done.recording, csv, form="json", tolerance=1e-9) is ExitCode.FAILED
    assert '"offset_s"' in capsys.readouterr().out


def test_what_is_wrong_is_an_error_of_the_twin(tmp_path: Path):
    with pytest.raises(UsageError, match="no such file"):
        api.interpret(tmp_path / "none.nc")
    with pytest.raises(ProgramError):
        api.interpret(write_job(tmp_path, "wrong", "N10 X1 QQ5"))
    with pytest.raises(UsageError, match="every"):
        export_and_print(tmp_path / "a.h5", None, every=0)
    with pytest.raises(UsageError, match="overwrite"):
        export_and_print(tmp_path / "a.csv", None)
    with pytest.raises(UsageError, match="text or json"):
        compare_and_print(tmp_path / "a.h5", tmp_path / "b.h5", form="xml")


def test_functions_stay_what_they_are_when_rooms_of_their_names_are_loaded():
    assert twin.run is api.run
    assert twin.compare is api.compare
    assert {"run", "plan", "interpret", "compare"} <= set(dir(twin))


def test_moves_are_a_table_for_data_frames(tmp_path: Path):
    moves = api.interpret(write_job(tmp_path, "part"))
    table = moves.table()
    assert {len(column) for column in table.values()} == {len(moves)}
    assert table["end_Y"][-1] == pytest.approx(-4.25)
    assert {column.ndim for column in table.values()} == {1}
    rows = list(moves)
    assert (len(rows), rows[-1]["end_Y"]) == (len(moves), table["end_Y"][-1])


def test_setpoints_that_would_fill_the_memory_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(functions, "MOST_SAMPLES", 100)
    with pytest.raises(UsageError, match="twin plan"):
        twin.plan("G1 X20. F300.", dialect="haas")
