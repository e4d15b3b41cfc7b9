"""A course: the score sheets of many sessions as one list."""

import os
from collections import Counter
from pathlib import Path
from typing import NamedTuple
from urllib.parse import quote

import jinja2
import pydantic

from twin.errors import UsageError
from twin.training.scene.scene_file import read_scene, scene_names, scene_path
from twin.training.scene.vocabulary import LANGUAGES, Language, in_language, vocabulary

SHEET, PAGE = "score.json", "score.html"
_LABELS = (
    "course", "name", "story", "date", "score", "hint", "history", "not_handed_in", "sessions",
    "full_points",
)  # fmt: skip
_TEMPLATE = Path(__file__).with_name("course.html.j2")


class CourseRow(NamedTuple):
    """One session.

    Attributes:
        name: Who was at the panel; empty: nobody said.
        alarms: Codes of the alarms that came, in their order.
        link: To the sheet, from the list's page.
    """

    name: str
    scene: str
    title: str
    language: str
    date: str
    points: int
    of: int
    handed_in: bool
    hints: int
    alarms: tuple[str, ...]
    link: str


class Trainee(NamedTuple):
    """The results of one trainee.

    Attributes:
        name: As signed; empty: nobody said.
        full: Scenes that were handed in with all points at least once.
        points: Sum of the best of each scene that was handed in.
        of: What these scenes are worth.
    """

    name: str
    sessions: int
    full: int
    points: int
    of: int


class _Alarm(pydantic.BaseModel):
    code: str


class _Sheet(pydantic.BaseModel):
    """What a course takes from a score sheet; sheets hold more."""

    name: str = ""
    scene: str
    title: str = ""
    language: str = "en"
    date: str = ""
    points: int
    of: int
    handed_in: bool
    hints: int
    alarms: tuple[_Alarm, ...]


def printable(text: str) -> str:
    """A text without what would make a terminal do anything but print it."""
    return "".join(letter if letter.isprintable() else " " for letter in text)


def _row(sheet: _Sheet, folder: Path) -> CourseRow:
    return CourseRow(
        name=printable(sheet.name),
        scene=printable(sheet.scene),
        title=printable(sheet.title or sheet.scene),
        language=sheet.language,
        date=printable(sheet.date),
        points=sheet.points,
        of=sheet.of,
        handed_in=sheet.handed_in,
        hints=sheet.hints,
        alarms=tuple(printable(alarm.code) for alarm in sheet.alarms),
        link=quote(os.fsencode(folder / PAGE)),
    )


def course_of(folder: Path) -> tuple[list[CourseRow], list[str]]:
    """Read all score sheets below a folder.

    Returns:
        The sessions by name, scene and date; and the sheets that could not be read.

    Raises:
        UsageError: There is no such folder.
    """
    if not folder.is_dir():
        raise UsageError(f"no folder '{folder}'")
    rows: list[CourseRow] = []
    unread: list[str] = []
    for path in sorted(folder.rglob(SHEET)):
        try:
            sheet = _Sheet.model_validate_json(path.read_bytes())
        except (OSError, pydantic.ValidationError):
            unread.append(printable(str(path.relative_to(folder))))
        else:
            rows.append(_row(sheet, path.parent.relative_to(folder)))
    rows.sort(key=lambda row: (row.name.casefold(), row.scene, row.date, row.link))
    return rows, unread


def language_of(rows: list[CourseRow]) -> Language:
    """The language that most of the sheets are in; English where there are none."""
    spoken = Counter(row.language for row in rows)
    return max(LANGUAGES, key=lambda language: spoken[language])


def trainees(rows: list[CourseRow]) -> list[Trainee]:
    """The results of each trainee, by name: of each scene the best sheet that was handed in."""
    found = []
    for name in dict.fromkeys(row.name for row in rows):
        theirs = [row for row in rows if row.name == name]
        best: dict[str, CourseRow] = {}
        for row in sorted(theirs, key=lambda row: row.points):
            if row.handed_in:
                best[row.scene] = row
        found.append(
            Trainee(
                name=name,
                sessions=len(theirs),
                full=sum(row.points == row.of for row in best.values()),
                points=sum(row.points for row in best.values()),
                of=sum(row.of for row in best.values()),
            )
        )
    return found


def scene_title(row: CourseRow, language: Language) -> str:
    """What a scene is called in a language; one that is not shipped as its sheet calls it."""
    if row.scene not in scene_names():
        return row.title
    return in_language(read_scene(scene_path(row.scene)).file.title, language)


def course_page(rows: list[CourseRow], language: Language) -> str:
    """The list as a page in a language: what each trainee has come to, and a link to each sheet."""
    words = vocabulary(language)
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
    template = environment.from_string(_TEMPLATE.read_text(encoding="utf-8"))
    titles = {row.scene: scene_title(row, language) for row in rows}
    return template.render(
        rows=rows,
        trainees=trainees(rows),
        titles=titles,
        words={key: words.labels[key] for key in _LABELS},
        alarms={code: wording.name for code, wording in words.alarms.items()},
        language=language,
    )
