"""A course: the score sheets of many sessions as one list."""

import json
from pathlib import Path
from typing import NamedTuple

import jinja2

from twin.errors import UsageError

SHEET = "score.json"


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
        folder: Where the sheet lies.
    """

    name: str
    scene: str
    date: str
    points: int
    of: int
    handed_in: bool
    hints: int
    alarms: tuple[str, ...]
    folder: str


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
            sheet = json.loads(path.read_text(encoding="utf-8"))
            alarms = tuple(str(alarm["code"]) for alarm in sheet["alarms"])
            rows.append(
                CourseRow(
                    str(sheet.get("name", "")), str(sheet["scene"]), str(sheet.get("date", "")),
                    int(sheet["points"]), int(sheet["of"]), bool(sheet["handed_in"]),
                    int(sheet["hints"]), alarms, str(path.parent.relative_to(folder)),
                )
            )  # fmt: skip
        except (OSError, ValueError, KeyError, TypeError, AttributeError):
            unread.append(str(path.relative_to(folder)))
    rows.sort(key=lambda row: (row.name.casefold(), row.scene, row.date, row.folder))
    return rows, unread


def course_page(rows: list[CourseRow]) -> str:
    """The list as a page, with a link to each sheet."""
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
    return environment.from_string(_PAGE).render(rows=rows)


_PAGE = """<!doctype html>
<html lang="en"><meta charset="utf-8"><title>Course</title>
<style>body { font: 15px/1.5 system-ui, sans-serif; margin: 2rem; color: #1c2329; } table { border-collapse: collapse; }
td, th { text-align: left; padding: .35rem .8rem; border-bottom: 1px solid #dde3e8; } th { color: #66727d; }
.number { text-align: right; }</style>
<h1>Course</h1>
<table><tr><th>Name</th><th>Scene</th><th>Date</th><th class="number">Points</th><th>Hints</th><th>Alarms</th></tr>
{% for row in rows %}<tr><td>{{ row.name or "–" }}</td>
<td><a href="{{ row.folder | urlencode }}/score.html">{{ row.scene }}</a></td><td>{{ row.date }}</td>
<td class="number">{{ row.points }} / {{ row.of }}{{ "" if row.handed_in else " (open)" }}</td>
<td class="number">{{ row.hints }}</td><td>{{ row.alarms | join(", ") }}</td></tr>
{% endfor %}</table></html>
"""
