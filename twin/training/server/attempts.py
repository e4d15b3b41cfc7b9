"""Attempts at scenes: each has a session of its own and a score sheet of its own."""

import dataclasses
from pathlib import Path
from typing import NamedTuple

from twin.training.scene.scene_file import Scene, read_scene, scene_names, scene_path
from twin.training.scene.vocabulary import Language, Vocabulary
from twin.training.score_sheets.score import ScoreSheetWriter
from twin.training.session.session import SceneSession

CELLS_ACROSS = 400
"""Cells of the live stock along its shorter side, at least: a step of 0.2 mm can be seen."""


class Attempt(NamedTuple):
    """One attempt at a scene.

    Attributes:
        number: 1 for the first one in a room.
        session: Its machine, and what is done to it.
    """

    number: int
    scene: Scene
    session: SceneSession
    writer: ScoreSheetWriter


class Attempts:
    """Begins attempts.

    Attributes:
        language: Of sheets, and of pages that choose no other.
        scenes: Folder for scenes that a trainer makes; None: there is none.
    """

    def __init__(self, language: Language, out: Path | None, scenes: Path | None = None) -> None:
        """Prepare nothing yet.

        Args:
            out: Folder for logs and score sheets; None: none are written.
            scenes: Folder for scenes that a trainer makes; None: one within ``out``.
        """
        self.language: Language = language
        self._out = out
        self.scenes = scenes or (out and out / "scenes")

    @staticmethod
    def prepared(scene: Scene) -> Scene:
        """A scene whose stock is as fine as a page shows it."""
        return dataclasses.replace(scene, cells_across=CELLS_ACROSS)

    def begin(self, scene: Scene, number: int = 1) -> Attempt:
        """Begin an attempt.

        Raises:
            ConfigError: The scene does not fit its machine.
        """
        session = SceneSession(self.prepared(scene))
        words = Vocabulary(self.language, scene.preparation.dialect.name)
        return Attempt(number, scene, session, ScoreSheetWriter(session, words, self._out))

    def after(self, attempt: Attempt, name: str) -> Attempt:
        """Begin the next attempt.

        Args:
            name: Of a shipped scene; empty: the same scene again.

        Raises:
            UsageError: There is no such scene.
        """
        scene = read_scene(scene_path(name)) if name else attempt.scene
        return self.begin(scene, attempt.number + 1)


def next_scene(name: str) -> str:
    """The shipped scene after one; empty: it is the last one, or none that is shipped."""
    names = scene_names()
    place = names.index(name) + 1 if name in names else len(names)
    return names[place] if place < len(names) else ""
