"""A result explains itself: names, figures, the part, pictures."""

from pathlib import Path

import numpy as np
import pytest

import twin
from twin.api.result import NoSuchColumnError
from twin.errors import UsageError
from twin.nc.text.diagnostics.diagnostics import ProgramError

JOB = twin.Job(
    program="G90 G1 X10. Y4. F600.\nG1 Z-1. F300.\nG1 X20.\nM30",
    dialect="fanuc",
    stock=twin.Stock(shape="box", size=(60.0, 40.0, 10.0)),
    tools=(twin.Tool(number=1, diameter=6.0),),
    tolerance=twin.Tolerance(contour_um=50.0),
)


@pytest.fixture(scope="module")
def result() -> twin.Result:
    return twin.run(JOB)


def test_the_figures_stand_first(result: twin.Result):
    assert result.ok
    assert result.verdict == "pass"
    text = repr(result)
    assert text.startswith("<Result ")
    assert "program.nc: pass, contour error" in text
    page = result._repr_html_()
    assert "<table>" in page
    assert "watched" in page


def test_columns_by_name_and_by_axis(result: twin.Result):
    error = result["contour_um"]
    assert error.max() == pytest.approx(result.outcome.figures.contour.max, rel=1e-5)
    joints = result["joint/position"]
    assert joints.shape == (len(error), 4)
    assert np.array_equal(joints[:, 1], result["joint/position/Y"])
    assert np.array_equal(result.column("time"), result["time"])


def test_a_wrong_name_lists_the_names(result: twin.Result):
    with pytest.raises(
        NoSuchColumnError, match=r"did you mean 'contour_um'\? columns: time, line,"
    ):
        result["contour_mm"]
    with pytest.raises(KeyError):
        result["joint/position/W"]


def test_paths_are_in_program_coordinates(result: twin.Result):
    assert result.path[0] == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)
    assert result.path[-1] == pytest.approx([20.0, 4.0, -1.0], abs=1e-9)
    apart = np.linalg.norm(result.path - result.actual_path, axis=1).max()
    assert 0.0 < apart < 0.2


def test_the_part_is_a_mesh_in_program_coordinates(result: twin.Result):
    part = result.part
    assert part is not None
    assert part.is_watertight
    assert part.bounds == pytest.approx(np.array([[-30.0, -20.0, -10.0], [30.0, 20.0, 0.0]]))
    cut = result.outcome.cut
    assert cut is not None
    assert part.volume == pytest.approx(60.0 * 40.0 * 10.0 - cut.removed_mm3, rel=1e-3)


def test_a_plot_shows_the_path_and_every_axis(result: twin.Result, tmp_path: Path):
    figure = result.plot()
    left, right = figure.axes[:2]
    assert [str(line.get_label()) for line in right.lines][-1] == "C [deg]"
    assert left.get_xlabel() == "X [mm]"
    figure.savefig(tmp_path / "plot.png")


def test_files_go_away_with_the_result():
    result = twin.run("G91 G1 X1. F600.\nM30", dialect="haas")
    folder = result.folder
    assert (folder / "result.json").is_file()
    assert result.assumptions
    del result
    assert not folder.exists()


def test_where_nothing_moved_there_is_nothing_to_show(tmp_path: Path):
    still = twin.run("G90 G1 X9000. F600.\nM30", dialect="haas", out=tmp_path)
    assert (still.verdict, still.alarms[0].code) == ("alarm", "soft-limit")
    assert (tmp_path / "program.nc").is_file()
    assert still.columns == ()
    assert still.part is None
    for call in (still.plot, still.show):
        with pytest.raises(UsageError, match="nothing moved"):
            call()
    with pytest.raises(NoSuchColumnError, match="nothing moved"):
        still["time"]


def test_a_run_that_fails_leaves_no_older_verdict(tmp_path: Path):
    assert twin.run(JOB, out=tmp_path).ok
    with pytest.raises(ProgramError):
        twin.run("G1 X1. QQ5\nM30", dialect="haas", out=tmp_path)
    assert not (tmp_path / "result.json").exists()
    assert not (tmp_path / "report.html").exists()
