"""What may be given as a program: text, paths, names, jobs."""

from pathlib import Path

import pytest

import twin
from twin.api.program import is_text
from twin.errors import UsageError


@pytest.mark.parametrize(
    ("given", "text"),
    [
        ("G1 X10 F100", True),
        ("N10 G1 X1.", True),
        ("M30\n", True),
        ("mefi/helix", False),
        ("part.nc", False),
        ("my parts/part 1.nc", False),
        ("M30", False),
    ],
)
def test_text_is_told_from_paths(given: str, text: bool):
    assert is_text(given) is text


def test_a_file_whose_name_looks_like_text_is_a_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.chdir(tmp_path)
    Path("G1 X10").write_text("N10 G1 X3 F100\n")
    assert twin.interpret("G1 X10", dialect="mefi").end[-1, 0] == 3.0


def test_text_and_jobs_make_the_moves_of_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)
    Path("part.nc").write_text("G91 G1 X10. F100.\n")
    ways = (
        "G91 G1 X10. F100.",
        "part.nc",
        Path("part.nc"),
        twin.Job(program="part.nc"),
        twin.Job(program="G91 G1 X10. F100.", start={"X": 5.0}),
    )
    ends = [twin.interpret(way, dialect="haas").end[-1, 0] for way in ways]
    assert ends == [10.0, 10.0, 10.0, 10.0, 15.0]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["part.nc"]


def test_what_is_neither_text_nor_a_file_is_refused():
    with pytest.raises(UsageError, match="no such file"):
        twin.interpret("M30", dialect="haas")
