"""The marks of a class: an SQLite file that outlives its server, exported as CSV and as xAPI statements."""

import contextlib
import csv
import dataclasses
import datetime as dt
import io
import os
import sqlite3
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, cast

from twin.errors import UsageError

FILE = "class.sqlite"
MADE_SCENES = "scenes"
"""Folder beside it, of the scenes that the teacher makes in a room."""
_WAIT_S = 10.0
"""For another process that writes."""
_TABLES = """
CREATE TABLE IF NOT EXISTS tokens (role TEXT PRIMARY KEY, token TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS numbers (name TEXT PRIMARY KEY, value INTEGER NOT NULL);
CREATE TABLE IF NOT EXISTS seats (number INTEGER PRIMARY KEY, pupil TEXT UNIQUE NOT NULL);
CREATE TABLE IF NOT EXISTS scenes (pupil TEXT PRIMARY KEY, scene TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS marks (
  attempt TEXT PRIMARY KEY, pupil TEXT NOT NULL, scene TEXT NOT NULL, title TEXT NOT NULL,
  began TEXT NOT NULL, changed TEXT NOT NULL, points INTEGER NOT NULL, points_of INTEGER NOT NULL,
  handed_in INTEGER NOT NULL, hints INTEGER NOT NULL, alarms TEXT NOT NULL, seconds REAL NOT NULL,
  sheet TEXT NOT NULL
);
"""


@dataclasses.dataclass(frozen=True, slots=True)
class AttemptResult:
    """The result of one attempt at a scene.

    Attributes:
        title: What it is called, in English where it is.
        began: When, in ISO 8601.
        changed: When this was written last, in ISO 8601.
        handed_in: Whether it was handed in: it is final then.
        alarms: Codes of those that came, with spaces between.
        seconds: Machine time from the beginning [s].
        sheet: Folder of its log and score sheet.
    """

    attempt: str
    pupil: str
    scene: str
    title: str
    began: str
    changed: str
    points: int
    points_of: int
    handed_in: bool
    hints: int
    alarms: str
    seconds: float
    sheet: str


_COLUMNS = tuple(field.name for field in dataclasses.fields(AttemptResult))


class ClassFile:
    """What a class keeps: marks, who has which scene, tokens of the links, the port.

    It is opened again for each question, so that any thread and any process may ask.
    """

    def __init__(self, folder: Path) -> None:
        """Open or make the file; only its owner may read it, as the links' tokens stand in it.

        Raises:
            UsageError: It cannot be made, or is something else.
        """
        self.folder = folder
        self.path = folder / FILE
        try:
            folder.mkdir(parents=True, exist_ok=True)
            os.close(os.open(self.path, os.O_RDWR | os.O_CREAT, 0o600))
            with self._open() as file:
                file.execute("PRAGMA journal_mode = WAL")
                file.executescript(_TABLES)
        except (OSError, sqlite3.Error) as error:
            raise UsageError(f"{self.path}: not the file of a class: {error}") from error

    @contextlib.contextmanager
    def _open(self) -> Iterator[sqlite3.Connection]:
        with contextlib.closing(sqlite3.connect(self.path, timeout=_WAIT_S)) as file, file:
            yield file

    def seats(self, pupils: Iterable[str]) -> dict[str, int]:
        """Numbers of pupils' seats by name: a pupil keeps his, whatever becomes of the roster."""
        names = list(pupils)
        with self._open() as file:
            file.executemany(
                "INSERT OR IGNORE INTO seats (pupil) VALUES (?)", [(name,) for name in names]
            )
            kept = dict(file.execute("SELECT pupil, number FROM seats"))
        return {name: int(kept[name]) for name in names}

    def tokens(self, wanted: Mapping[str, str]) -> dict[str, str]:
        """Tokens by role: those that are kept, else the wanted ones, which are kept from now on."""
        with self._open() as file:
            file.executemany("INSERT OR IGNORE INTO tokens VALUES (?, ?)", wanted.items())
            kept = dict(file.execute("SELECT role, token FROM tokens"))
        return {role: str(kept[role]) for role in wanted}

    def number(self, name: str) -> int:
        """A number that was kept; 0: none was."""
        with self._open() as file:
            row = file.execute("SELECT value FROM numbers WHERE name = ?", (name,)).fetchone()
        return 0 if row is None else int(row[0])

    def keep_number(self, name: str, value: int) -> None:
        """Keep a number."""
        with self._open() as file:
            file.execute("INSERT OR REPLACE INTO numbers VALUES (?, ?)", (name, value))

    def scenes(self) -> dict[str, str]:
        """What was handed out last, by pupil."""
        with self._open() as file:
            return dict(file.execute("SELECT pupil, scene FROM scenes"))

    def hand_out(self, pupil: str, scene: str) -> None:
        """Remember what a pupil has been given."""
        with self._open() as file:
            file.execute("INSERT OR REPLACE INTO scenes VALUES (?, ?)", (pupil, scene))

    def record(self, mark: AttemptResult) -> None:
        """Write a mark; of the same attempt the newest counts, and none after it was handed in."""
        places = ", ".join("?" * len(_COLUMNS))
        fresh = ", ".join(f"{name} = excluded.{name}" for name in _COLUMNS[1:])
        with self._open() as file:
            file.execute(
                f"INSERT INTO marks ({', '.join(_COLUMNS)}) VALUES ({places}) "  # noqa: S608 (our own names)
                f"ON CONFLICT (attempt) DO UPDATE SET {fresh} WHERE handed_in = 0",
                dataclasses.astuple(mark),
            )

    def marks(self) -> list[AttemptResult]:
        """All marks, by pupil and time."""
        with self._open() as file:
            rows = cast(
                "list[tuple[Any, ...]]",
                file.execute(
                    f"SELECT {', '.join(_COLUMNS)} FROM marks ORDER BY pupil, began"  # noqa: S608 (our own names)
                ).fetchall(),
            )
        marks = (AttemptResult(*row) for row in rows)
        return [dataclasses.replace(mark, handed_in=bool(mark.handed_in)) for mark in marks]


def now_text() -> str:
    """The present time in ISO 8601, with its zone."""
    return dt.datetime.now().astimezone().isoformat(timespec="milliseconds")


_FORMULA_BEGINS = tuple("=+-@\t\r")
"""Spreadsheets calculate a cell that begins so (OWASP, CSV injection); an apostrophe makes it text."""


def as_csv(marks: list[AttemptResult]) -> str:
    """Marks as a table for spreadsheets, with their columns' names above; no text is a formula."""
    text = io.StringIO()
    table = csv.writer(text)
    table.writerow(_COLUMNS)
    table.writerows([_no_formula(value) for value in dataclasses.astuple(mark)] for mark in marks)
    return text.getvalue()


def _no_formula(value: object) -> object:
    dangerous = isinstance(value, str) and value.startswith(_FORMULA_BEGINS)
    return f"'{value}" if dangerous else value


def as_statements(marks: list[AttemptResult], home: str) -> list[dict[str, Any]]:
    """Marks that were handed in as statements of the Experience API (IEEE 9274.1.1, xAPI 1.0.3).

    Args:
        home: Address of the class, beside which its pupils' names are accounts.
    """
    return [
        {
            "id": mark.attempt,
            "actor": {
                "objectType": "Agent",
                "account": {"homePage": home, "name": mark.pupil},
            },
            "verb": {
                "id": f"http://adlnet.gov/expapi/verbs/{verb}",
                "display": {"en": verb},
            },
            "object": {
                "objectType": "Activity",
                "id": f"{home}/scenes/{mark.scene}",
                "definition": {
                    "name": {"en": mark.title},
                    "type": "http://adlnet.gov/expapi/activities/simulation",
                },
            },
            "result": {
                "score": {
                    "raw": mark.points,
                    "min": 0,
                    "max": mark.points_of,
                    "scaled": mark.points / mark.points_of,
                },
                "success": mark.points == mark.points_of,
                "completion": True,
                "duration": f"PT{mark.seconds:.2f}S",
            },
            "timestamp": mark.changed,
        }
        for mark in marks
        if mark.handed_in
        for verb in ("passed" if mark.points == mark.points_of else "failed",)
    ]
