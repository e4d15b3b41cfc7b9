"""The whole panel: where its parts stand, and what they ask for in one frame."""

from mujoco.studio.dear_imgui import dear_imgui as imgui

from twin.training.panel.desk import (
    DeskState,
    build_cycle,
    build_dials,
    build_emergency,
    build_entry,
    build_jog,
    build_modes,
    build_supplies,
)
from twin.training.panel.keyboard import read_keyboard
from twin.training.panel.kit import BLUE, Kit
from twin.training.panel.request import Request
from twin.training.panel.screen import build_axes, build_head, build_program, build_speeds
from twin.training.panel.side import (
    SideState,
    build_tasks,
    build_tools,
    build_trainer,
    build_view,
    build_zero,
    sheets,
)
from twin.training.scene.scene_file import SceneFile
from twin.training.scene.vocabulary import Words
from twin.training.session.snapshot import Snapshot

HEAD = 88.0
"""Height of the head [px]."""
DESK = 178.0
"""Height of the desk [px]."""
ENTRY = 62.0
"""Height of the MDI line or the line editor below the program [px]."""
SCREEN = 484.0
"""Width of the screen [px]."""
SIDE = 316.0
"""Width of the side [px]."""
GAP = 4.0


class Panel:
    """A panel for one scene in one language.

    Attributes:
        kit: Knows where each part was drawn.
        desk: What is set at the desk.
        side: What is set at the side.
        width: Of the page in the last frame [px].
    """

    def __init__(self, scene: SceneFile, words: Words, example: str) -> None:
        """Prepare it.

        Args:
            scene: The scene.
            words: What stands on it.
            example: A block in the control's language, for the empty MDI line.
        """
        self._scene = scene
        self._words = words
        self.kit = Kit()
        self.desk = DeskState(example=example)
        self.side = SideState()
        self.width = 0.0

    def build(self, now: Snapshot, *, trainer: bool) -> list[Request]:
        """Build the panel of one frame.

        Args:
            now: The machine.
            trainer: Whether it is the trainer who sees it.

        Returns:
            What was asked for.
        """
        size = imgui.GetIO().DisplaySize
        self.width = size.x
        kit, words = self.kit, self._words
        asked = read_keyboard(now, self.desk, self.side, trainer=trainer)
        middle = size.y - HEAD - DESK - 4 * GAP
        with kit.dressed():
            with kit.window("head", GAP, GAP, size.x - 2 * GAP, HEAD):
                build_head(kit, words, now)
            with kit.window("screen", GAP, HEAD + 2 * GAP, SCREEN, middle):
                build_axes(kit, words, now)
                build_speeds(kit, words, now)
                below = ENTRY if now.mode == "mdi" or self.desk.chosen else 0.0
                self._choose(now, build_program(kit, now, self.desk.chosen, below))
                asked += build_entry(kit, words, now, self.desk)
            with kit.window("side", size.x - SIDE - GAP, HEAD + 2 * GAP, SIDE, middle):
                asked += self._build_side(now, trainer=trainer)
            with kit.window("desk", GAP, size.y - DESK - GAP, size.x - 2 * GAP, DESK):
                asked += self._build_desk(now)
        return asked

    def _choose(self, now: Snapshot, line: int) -> None:
        if line != self.desk.chosen:
            self.desk.chosen, self.desk.edited = line, now.program[line - 1]

    def _build_desk(self, now: Snapshot) -> list[Request]:
        kit, words = self.kit, self._words
        asked: list[Request] = []
        tall = DESK - 24.0
        with kit.group(words["mode"], tall):
            asked += build_modes(kit, words, now)
        with kit.group(words["cycle"], tall):
            asked += build_cycle(kit, words, now)
        with kit.group(words["jog"], tall):
            asked += build_jog(kit, words, now, self.desk)
        with kit.group(words["override"], tall):
            asked += build_dials(kit, words, now, self.desk)
        with kit.group("", tall):
            asked += build_supplies(kit, words, now)
        return asked + build_emergency(kit, words, now)

    def _build_side(self, now: Snapshot, *, trainer: bool) -> list[Request]:
        kit, words = self.kit, self._words
        asked: list[Request] = []
        side = self.side
        names = sheets(trainer=trainer)
        if side.sheet not in names:
            side.sheet = "tasks"
        for number, sheet in enumerate(names):
            if number:
                kit.beside(words[sheet])
            if kit.key(f"tab {sheet}", words[sheet], lit=BLUE if sheet == side.sheet else None):
                side.sheet = sheet
        imgui.Separator()
        if side.sheet == "tasks":
            asked += build_tasks(kit, words, now, self._scene)
        elif side.sheet == "offsets":
            asked += build_zero(kit, words, now, side)
        elif side.sheet == "tools":
            asked += build_tools(kit, words, now)
        elif side.sheet == "display":
            build_view(kit, words, side)
        else:
            asked += build_trainer(kit, words, now, side)
        return asked
