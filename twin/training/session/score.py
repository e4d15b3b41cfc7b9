"""The score sheet: what was reached and when, with every action; for a course to keep."""

import datetime as dt
import json
from pathlib import Path
from typing import Any

import jinja2

from twin.files.atomic import write_text
from twin.training.scene.texts import in_language
from twin.training.scene.vocabulary import Words
from twin.training.session.session import Session
from twin.version import __version__

LOG_FILE = "log.jsonl"
SHEET_FILES = ("score.json", "score.html")

_TEMPLATE = Path(__file__).with_name("score.html.j2")


def score_sheet(session: Session, words: Words) -> dict[str, Any]:
    """The score sheet as plain data."""
    scene, room = session.scene, session.room
    period = room.machine.machine.file.servo_period_s
    language = words.language
    return {
        "schema": 1,
        "scene": scene.name,
        "title": in_language(scene.file.title, language),
        "language": language,
        "control": words["title"],
        "machine": room.machine.machine.file.name,
        "twin_version": __version__,
        "machine_time_s": round(room.time_s, 3),
        "handed_in": room.judge.over,
        "points": room.judge.score,
        "of": scene.points,
        "hints": room.judge.hints,
        "alarms": [
            {"code": code, "name": words.alarm(code).name} for code in room.judge.evidence.alarms
        ],
        "tasks": [
            {
                "text": in_language(task.text, language),
                "points": task.points,
                "state": verdict.state,
                "time_s": verdict.time_s,
            }
            for task, verdict in zip(scene.file.tasks, room.judge.verdicts, strict=True)
        ],
        "actions": [
            {
                "time_s": round(entry.tick * period, 3),
                "who": entry.who,
                "command": entry.command,
                "refused": entry.refusal,
            }
            for entry in session.log
        ],
    }


def score_page(sheet: dict[str, Any], words: Words) -> str:
    """The score sheet as one self-contained page."""
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
    template = environment.from_string(_TEMPLATE.read_text(encoding="utf-8"))
    labels = {key: words[key] for key in ("tasks", "score", "alarm", "hint", "seconds")}
    return template.render(sheet=sheet, words=labels)


class SheetWriter:
    """Keeps the log and the score sheet of a session on disk."""

    def __init__(self, session: Session, words: Words, out: Path | None) -> None:
        """Choose a folder of its own for the session.

        Args:
            session: The session.
            words: Language and control.
            out: Where sessions are kept; None: nothing is written.
        """
        self._words = words
        self._folder: Path | None = None
        if out is not None:
            now = dt.datetime.now().astimezone().strftime("%Y-%m-%d_%H%M%S")
            self._folder = out / f"{session.scene.name}_{now}"

    @property
    def folder(self) -> Path | None:
        """Where the files lie."""
        return self._folder

    def write(self, session: Session) -> None:
        """Write what there is by now; each file is complete or not there."""
        if self._folder is None:
            return
        sheet = score_sheet(session, self._words)
        lines = (json.dumps(action, ensure_ascii=False) for action in sheet["actions"])
        write_text(self._folder / LOG_FILE, "".join(f"{line}\n" for line in lines))
        write_text(self._folder / "score.json", json.dumps(sheet, ensure_ascii=False, indent=1))
        write_text(self._folder / "score.html", score_page(sheet, self._words))
