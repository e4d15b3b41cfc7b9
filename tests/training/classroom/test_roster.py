"""Rosters: names as people have them, and lines that cannot be used."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from twin.errors import ConfigError, TwinError, UsageError
from twin.training.classroom.roster import MOST_PUPILS, Pupil, counted_seats, read_roster


def written(folder, text: str, encoding: str = "utf-8"):
    path = folder / "roster.csv"
    path.write_bytes(text.encode(encoding))
    return path


@pytest.mark.parametrize(
    "text",
    [
        'name,scene\n"O\'Brien, Pat",mefi_lead\nДмитрий,\n',
        '\ufeffName;Scene\r\n"O\'Brien, Pat";mefi_lead\r\nДмитрий;\r\n',
        'scene\tname\nmefi_lead\t"O\'Brien, Pat"\n\n\tДмитрий\n',
    ],
)
def test_spreadsheets_write_a_roster_in_their_own_ways(tmp_path, text):
    pupils = read_roster(written(tmp_path, text))
    assert pupils == (Pupil("O'Brien, Pat", "mefi_lead"), Pupil("Дмитрий"))


def test_one_column_needs_no_head_and_names_are_what_they_are(tmp_path):
    names = ["<b>Bob</b>", "=1+1", "../../etc", "'; DROP TABLE marks;--", "名無し"]
    assert [one.name for one in read_roster(written(tmp_path, "\n".join(names)))] == names


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "0 pupils"),
        ("name\n", "0 pupils"),
        ("Anna,first\nBob,second\n", "line 1: several columns, and none is called 'name'"),
        ("name,grade\nAnna,1\n", "line 1: no column 'grade'"),
        ("name,name\nAnna,1\n", "twice"),
        ("name,scene\nAnna\n,mefi_lead\n", "line 3: no name"),
        ("name\nAnna,mefi_lead\n", "line 2: 2 cells in 1 columns"),
        ("Anna\nBob\nANNA\n", "line 3: 'ANNA' is in line 1 already"),
        (f"{'a' * 81}\n", "line 1: a name of 81 letters"),
        ("An\x07na\n", "line 1: a name with a letter that cannot be shown"),
        ("name,scene\nAnna,mefi_leed\n", "line 2: no scene 'mefi_leed'"),
        ('name\n"Anna\n', "no CSV"),
        ("\n".join(map(str, range(MOST_PUPILS + 1))), "61 pupils"),
    ],
)
def test_what_cannot_be_used_is_refused_with_its_line(tmp_path, text, told):
    with pytest.raises(ConfigError, match=told.replace("(", "\\(")):
        read_roster(written(tmp_path, text))


def test_other_files_are_no_roster(tmp_path):
    with pytest.raises(ConfigError, match="no text in UTF-8: byte 5"):
        read_roster(written(tmp_path, "Zoë\nNováková", "utf-16-le"))
    with pytest.raises(UsageError, match="No such file"):
        read_roster(tmp_path / "nowhere.csv")
    with pytest.raises(UsageError, match="Is a directory"):
        read_roster(tmp_path)


@given(st.binary(max_size=200))
def test_any_bytes_are_a_roster_or_refused(tmp_path_factory, content):
    path = tmp_path_factory.mktemp("roster") / "roster.csv"
    path.write_bytes(content)
    try:
        pupils = read_roster(path)
    except TwinError:
        return
    assert all(one.name.isprintable() and one.name for one in pupils)


@pytest.mark.parametrize("count", [0, -1, MOST_PUPILS + 1])
def test_a_class_has_some_seats_and_not_too_many(count):
    with pytest.raises(UsageError, match="1 to 60 seats"):
        counted_seats(count)
