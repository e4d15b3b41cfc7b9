"""Writes the marks of a room into the class's file, as soon as they change."""

import sqlite3
import uuid
from collections.abc import Callable
from pathlib import Path

from twin.training.classroom.marks import AttemptResult, ClassFile, now_text
from twin.training.scene.vocabulary import in_language
from twin.training.session.session import SceneSession


class Recorder:
    """Keeps the marks of one pupil."""

    def __init__(self, file: ClassFile, pupil: str, sheet: Callable[[], Path | None]) -> None:
        """Prepare it.

        Args:
            sheet: Says where the score sheet of the present attempt is written.
        """
        self._file, self._pupil, self._sheet = file, pupil, sheet
        self._session: SceneSession | None = None
        self._mark: tuple[int, bool, int, tuple[str, ...]] | None = None
        self._attempt = self._began = ""

    def note(self, session: SceneSession) -> str:
        """Write the mark of a session where it has changed.

        A session that nobody has touched has none. What goes on behind a hand-in, as where a teacher
        takes it back, is another attempt: what was handed in stays.

        Returns:
            Why it could not be written; empty: it was.
        """
        judge = session.room.judge
        mark = (judge.score, judge.over, judge.hints, tuple(judge.evidence.alarms))
        reopened = self._mark is not None and self._mark[1] and not judge.over
        if session is not self._session or reopened:
            self._session, self._mark = session, None
            self._attempt, self._began = str(uuid.uuid4()), now_text()
        if mark == self._mark or not judge.touched:
            return ""
        try:
            self._file.record(self._described(session, *mark))
        except sqlite3.Error as error:
            return f"{self._file.path}: {error}"
        self._mark = mark
        return ""

    def _described(
        self, session: SceneSession, points: int, over: bool, hints: int, alarms: tuple[str, ...]
    ) -> AttemptResult:
        scene, sheet = session.scene, self._sheet()
        return AttemptResult(
            attempt=self._attempt,
            pupil=self._pupil,
            scene=scene.name,
            title=in_language(scene.file.title, "en"),
            began=self._began,
            changed=now_text(),
            points=points,
            points_of=scene.points,
            handed_in=over,
            hints=hints,
            alarms=" ".join(alarms),
            seconds=session.room.time_s,
            sheet="" if sheet is None else str(sheet),
        )
