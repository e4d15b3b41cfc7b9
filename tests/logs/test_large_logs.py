"""A log that does not fit is refused before it fills the memory; a table is read in pieces."""

from pathlib import Path

import pytest

from twin.errors import UsageError
from twin.logs import numbers, text_pieces
from twin.logs.machine_log import read_raw_log

HEADING = "time_s,X_command_mm,X_actual_mm\n"


def test_two_gigabytes_of_a_form_that_is_read_at_once_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "trace.xml"
    with path.open("wb") as file:
        file.write(b"<trace>\n")
        file.truncate(2 << 30)
    with pytest.raises(UsageError, match="has 2147 MB; a log of this form is read up to 268 MB"):
        read_raw_log(path)


def test_a_table_of_too_many_rows_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "long.csv"
    path.write_text(HEADING + "0.0,1.0,1.0\n" * 500, encoding="utf-8")
    monkeypatch.setattr(numbers, "_MOST_ROWS", 400)
    with pytest.raises(UsageError, match="has more than 400 rows: log for a shorter time"):
        read_raw_log(path)


def test_a_table_in_pieces_is_the_one_at_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "log.csv"
    rows = "".join(f"{row / 1000:.3f},{row % 97},{row % 89}.25\n" for row in range(5000))
    path.write_text(HEADING + rows, encoding="utf-8")
    whole = read_raw_log(path)
    monkeypatch.setattr(text_pieces, "_PIECE", 20_011)
    pieces = read_raw_log(path)
    for one, other in zip(whole.channels, pieces.channels, strict=True):
        assert len(one.cells) == 5000
        assert one.numbers(path).tolist() == other.numbers(path).tolist()
