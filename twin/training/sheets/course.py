"""A course: the score sheets of many sessions as one list."""

import os
from pathlib import Path
from typing import NamedTuple
from urllib.parse import quote

import jinja2
import pydantic

from twin.errors import UsageError

SHEET, PAGE = "score.json", "score.html"


class CourseRow(NamedTuple):
    """One session.

    Attributes:
        name: Who was at the panel; empty: nobody said.
        scene: Name of the scene.
        date: When it began.
        points: Reached.
        of: What all tasks are worth.
        handed_in: Whether it was handed in.
        hints: Asked for.
        alarms: Codes of the alarms that came, in their order.
        link: To the sheet, from the list's page.
    """

    name: str
    scene: str
    date: str
    points: int
    of: int
    handed_in: bool
    hints: int
    alarms: tuple[str, ...]
    link: str


class _Alarm(pydantic.BaseModel):
    code: str


class _Sheet(pydantic.BaseModel):
    """What a course takes from a score sheet; sheets hold more."""

    name: str = ""
    scene: str
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


def course_page(rows: list[CourseRow]) -> str:
    """The list as a page, with a link to each sheet."""
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
    return environment.from_string(_LIST).render(rows=rows)


_LIST = """<!doctype html>
<html lang="en"><meta charset="utf-8"><title>Course</title>
<style>body { font: 15px/1.5 system-ui, sans-serif; margin: 2rem; color: #1c2329; } table { border-collapse: collapse; }
td, th { text-align: left; padding: .35rem .8rem; border-bottom: 1px solid #dde3e8; } th { color: #66727d; }
.number { text-align: right; }</style>
<h1>Course</h1>
<table><tr><th>Name</th><th>Scene</th><th>Date</th><th class="number">Points</th><th>Hints</th><th>Alarms</th></tr>
{% for row in rows %}<tr><td>{{ row.name or "–" }}</td>
<td><a href="{{ row.link }}">{{ row.scene }}</a></td><td>{{ row.date }}</td>
<td class="number">{{ row.points }} / {{ row.of }}{{ "" if row.handed_in else " (open)" }}</td>
<td class="number">{{ row.hints }}</td><td>{{ row.alarms | join(", ") }}</td></tr>
{% endfor %}</table></html>
"""
