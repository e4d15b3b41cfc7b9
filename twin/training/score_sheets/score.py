"""The score sheet: what was reached and when, with every action; for a course to keep."""

import base64
import datetime as dt
import itertools
import json
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import jinja2

from twin.files.atomic import write_text
from twin.training.room.judging.inspection import AlarmMoment, PartInspection
from twin.training.scene.phrases import finding_in, translated
from twin.training.scene.scene_file import Scene
from twin.training.scene.vocabulary import Vocabulary, in_language
from twin.training.session.session import SceneSession
from twin.version import __version__

LOG_FILE = "log.jsonl"
WRITTEN_EVERY_S = 1.0
"""Shortest time between two writings [s]."""

_LABELS = (
    "tasks", "score", "alarm", "hint", "seconds", "name", "date", "wrong", "why", "right", "line",
    "section", "from_above", "trap", "cause", "consequence", "measured", "should_be", "is", "removed",
)  # fmt: skip
_TEMPLATE = Path(__file__).with_name("score.html.j2")


def score_sheet(session: SceneSession, words: Vocabulary, date: str = "") -> dict[str, Any]:
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
        "name": session.signature,
        "date": date,
        "machine_time_s": round(room.time_s, 3),
        "handed_in": room.judge.over,
        "points": room.judge.score,
        "of": scene.points,
        "hints": room.judge.hints,
        "alarms": [
            {"code": code, "name": words.alarm(code).name} for code in room.judge.evidence.alarms
        ],
        "wrong": [_wrong(moment, words) for moment in tuple(room.alarms.moments)],
        "lesson": _lesson(scene, words) if _fell_into_it(session) else None,
        "measured": None if room.handed_in is None else _measured(room.handed_in),
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
            for entry in tuple(session.log)
        ],
    }


def _wrong(moment: AlarmMoment, words: Vocabulary) -> dict[str, Any]:
    """What went wrong: at which block, why it matters, and what would have been right."""
    alarm, wording = moment.alarm, words.alarm(moment.alarm.code)
    finding = alarm.finding
    said = (
        finding_in(finding, words.language)
        if finding
        else translated(alarm.message, words.language)
    )
    return {
        "code": alarm.code,
        "name": wording.name,
        "time_s": round(alarm.time_s, 3),
        "line": alarm.line,
        "block": alarm.block,
        "text": moment.text,
        "message": said,
        "why": wording.why,
        "right": wording.advice,
    }


def _fell_into_it(session: SceneSession) -> bool:
    """Whether the scene was handed in with a task that failed."""
    judge = session.room.judge
    return judge.over and any(verdict.state == "failed" for verdict in judge.verdicts)


def _lesson(scene: Scene, words: Vocabulary) -> dict[str, str] | None:
    """The scene's trap: what went wrong, what it does, and what would have been right."""
    lesson = scene.file.lesson
    if lesson is None:
        return None
    cause, consequence, right = (in_language(text, words.language) for text in lesson.texts)
    return {"cause": cause, "consequence": consequence, "right": right}


def _measured(part: PartInspection) -> dict[str, Any]:
    """What was measured at the part that was handed in [mm, mm³]."""
    return {
        "places": [
            {
                **place._asdict(),
                "found": None if place.found is None else round(place.found, 3),
            }
            for place in part.places
        ],
        "removed_mm3": None if part.removed is None else round(part.removed, 1),
        "wanted_removed_mm3": part.wanted_removed,
    }


def score_page(
    sheet: dict[str, Any],
    words: Vocabulary,
    pictures: Sequence[bytes | None] = (),
    part: bytes | None = None,
) -> str:
    """The score sheet as one self-contained page.

    Args:
        sheet: As ``score_sheet`` gives it.
        pictures: Of what went wrong, as PNG, in the sheet's order.
        part: Picture of the part that was handed in, as PNG.
    """
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
    template = environment.from_string(_TEMPLATE.read_text(encoding="utf-8"))
    labels = {key: words[key] for key in _LABELS}
    shown = [one and base64.b64encode(one).decode("ascii") for one in (*pictures, part)]
    return template.render(sheet=sheet, words=labels, pictures=shown[:-1], part=shown[-1])


class ScoreSheetWriter:
    """Keeps the log and the score sheet of a session on disk, on a thread of its own."""

    def __init__(self, session: SceneSession, words: Vocabulary, out: Path | None) -> None:
        """Choose a folder of its own for the session.

        Args:
            out: Where sessions are kept; None: nothing is written.
        """
        self._session = session
        self._words = words
        self._out = out
        self._logged = 0
        self._trouble = ""
        self._handed_in = False
        self._date = ""
        self._pictures: dict[float, bytes | None] = {}
        self._part: bytes | None = None
        self.folder: Path | None = None
        self._begin_folder()
        if out is None:
            return
        self._due = threading.Event()
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._keep_writing, daemon=True, name="sheet")
        self._thread.start()

    def _begin_folder(self) -> None:
        """Choose a folder that no other sheet has."""
        now = dt.datetime.now().astimezone()
        self._date = now.strftime("%Y-%m-%d %H:%M")
        self._logged, self._handed_in, self._part = 0, False, None
        if self._out is not None:
            name = f"{self._session.scene.name}_{now.strftime('%Y-%m-%d_%H%M%S')}"
            names = (f"{name}_{number}" if number else name for number in itertools.count())
            self.folder = next(each for each in map(self._out.joinpath, names) if not each.exists())

    def page(self, words: Vocabulary) -> str:
        """The sheet as it is now, as a page in a language, with its pictures."""
        sheet = score_sheet(self._session, words, self._date)
        room = self._session.room
        part = None if room.handed_in is None else room.handed_in.moment.picture()
        return score_page(sheet, words, [one.picture() for one in tuple(room.alarms.moments)], part)

    def changed(self) -> None:
        """Note a change: the files are written soon."""
        if self.folder is not None:
            self._due.set()

    def trouble(self) -> str:
        """Why the files could not be written the last time; empty where they were."""
        return self._trouble

    def close(self) -> None:
        """Write the last state.

        Raises:
            OSError: It could not be written.
        """
        if self.folder is not None:
            self._over.set()
            self._due.set()
            self._thread.join()
            self._write()

    def _keep_writing(self) -> None:
        while not self._over.is_set():
            self._due.wait()
            self._due.clear()
            if not self._over.is_set():
                try:
                    self._write()
                    self._trouble = ""
                except OSError as error:
                    self._trouble = f"{self.folder}: {error.strerror or error}"
                    self._logged = 0
                    self._due.set()
                self._over.wait(WRITTEN_EVERY_S)

    def _write(self) -> None:
        """Write what there is by now: lines are added to the log, the sheet is written again.

        A sheet that was handed in is final: where a trainer goes back behind the hand-in, what
        follows has a folder of its own.
        """
        sheet = score_sheet(self._session, self._words, self._date)
        if self._handed_in and not sheet["handed_in"]:
            self._begin_folder()
        folder = self.folder
        assert folder is not None
        moments = tuple(self._session.room.alarms.moments)
        known = self._pictures
        self._pictures = {
            round(one.alarm.time_s, 3): known.get(round(one.alarm.time_s, 3)) or one.picture()
            for one in moments
        }
        actions = sheet["actions"]
        log = folder / LOG_FILE
        lines = [f"{json.dumps(one, ensure_ascii=False)}\n" for one in actions]
        if self._logged == 0 or not log.is_file():
            write_text(log, "".join(lines))
        elif len(lines) > self._logged:
            with log.open("a", encoding="utf-8") as file:
                file.writelines(lines[self._logged :])
        self._logged = len(lines)
        pictures = [self._pictures.get(one["time_s"]) for one in sheet["wrong"]]
        handed_in = self._session.room.handed_in
        if handed_in is None:
            self._part = None
        elif self._part is None:
            self._part = handed_in.moment.picture()
        write_text(folder / "score.json", json.dumps(sheet, ensure_ascii=False, indent=1))
        write_text(folder / "score.html", score_page(sheet, self._words, pictures, self._part))
        self._handed_in = bool(sheet["handed_in"])
