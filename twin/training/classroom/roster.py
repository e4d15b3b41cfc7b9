"""Who is in a class: read from a file, or seats that are only counted."""

import csv
import io
import unicodedata
from pathlib import Path
from typing import NamedTuple

from twin.errors import ConfigError, UsageError
from twin.training.scene.scene_file import scene_path

MOST_PUPILS = 60
"""In a class."""
LONGEST_NAME = 80
"""As on a score sheet."""
_COLUMNS = ("name", "scene")
_DELIMITERS = (",", ";", "\t")
"""Between columns: what spreadsheets write."""


class Pupil(NamedTuple):
    """Somebody in a class.

    Attributes:
        name: As the roster says it; by it marks are known again.
        scene: What is handed out first; empty: what the class begins with.
    """

    name: str
    scene: str = ""


def counted_seats(count: int) -> tuple[Pupil, ...]:
    """Pupils without names.

    Raises:
        UsageError: There are too many.
    """
    if not 0 < count <= MOST_PUPILS:
        raise UsageError(f"--seats {count}: a class has 1 to {MOST_PUPILS} seats")
    return tuple(Pupil(f"Seat {number}") for number in range(1, count + 1))


def read_roster(path: Path) -> tuple[Pupil, ...]:
    """Read a roster: CSV with a column ``name``, and one ``scene`` for who begins with another one.

    A file of one column needs no head.

    Raises:
        UsageError: There is no such file.
        ConfigError: A line cannot be used; the message says which and why.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise ConfigError(f"{path}: no text in UTF-8: byte {error.start + 1}") from error
    except OSError as error:
        raise UsageError(f"{path}: {error.strerror or error}") from error
    head = text.lstrip().partition("\n")[0]
    delimiter = next((one for one in _DELIMITERS if one in head), ",")
    try:
        reader = csv.reader(io.StringIO(text), delimiter=delimiter, strict=True)
        rows = [(reader.line_num, [cell.strip() for cell in row]) for row in reader]
    except csv.Error as error:
        raise ConfigError(f"{path}: no CSV: {error}") from error
    rows = [(line, row) for line, row in rows if any(row)]
    columns, rows = _columns(path, rows)
    pupils: dict[str, int] = {}
    found: list[Pupil] = []
    for line, row in rows:
        if len(row) > len(columns):
            raise ConfigError(f"{path}, line {line}: {len(row)} cells in {len(columns)} columns")
        cells = dict(zip(columns, row, strict=False))
        pupil = Pupil(cells.get("name", ""), cells.get("scene", ""))
        _check(path, line, pupil)
        same = unicodedata.normalize("NFKC", pupil.name).casefold()
        if same in pupils:
            raise ConfigError(
                f"{path}, line {line}: '{pupil.name}' is in line {pupils[same]} already: "
                "give each pupil a name of his own"
            )
        pupils[same] = line
        found.append(pupil)
    if not 0 < len(found) <= MOST_PUPILS:
        raise ConfigError(f"{path}: {len(found)} pupils: a class has 1 to {MOST_PUPILS}")
    return tuple(found)


def _columns(
    path: Path, rows: list[tuple[int, list[str]]]
) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """The columns' names, and the rows below them."""
    head = [cell.lower() for cell in rows[0][1]] if rows else []
    if "name" in head:
        unknown = [name for name in head if name not in _COLUMNS]
        if unknown or len(set(head)) < len(head):
            problem = f"no column '{unknown[0]}'" if unknown else "a column occurs twice"
            raise ConfigError(
                f"{path}, line {rows[0][0]}: {problem}: a roster has {' and '.join(_COLUMNS)}"
            )
        return head, rows[1:]
    wide = next((line for line, row in rows if len(row) > 1), None)
    if wide is not None:
        raise ConfigError(
            f"{path}, line {wide}: several columns, and none is called 'name': "
            "begin the file with the line 'name,scene'"
        )
    return ["name"], rows


def _check(path: Path, line: int, pupil: Pupil) -> None:
    """Refuse a pupil who cannot be shown or distinguished."""
    where = f"{path}, line {line}"
    if not pupil.name:
        raise ConfigError(f"{where}: no name")
    if len(pupil.name) > LONGEST_NAME:
        raise ConfigError(f"{where}: a name of {len(pupil.name)} letters: {LONGEST_NAME} at most")
    if not pupil.name.isprintable():
        raise ConfigError(f"{where}: a name with a letter that cannot be shown")
    if pupil.scene:
        try:
            scene_path(pupil.scene)
        except UsageError as error:
            raise ConfigError(f"{where}: {error}") from error
