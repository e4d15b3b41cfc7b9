"""The keyboard of the panel; silent while someone types into a field."""

from mujoco.studio.dear_imgui import dear_imgui as imgui

from twin.training.commands import FEED_OVERRIDES, MODES
from twin.training.panel.desk import DeskState, jog_key
from twin.training.panel.request import Request, do
from twin.training.snapshot import Snapshot

_PLAIN = (("Space", "cycle_start"), ("H", "feed_hold"), ("R", "reset"))
_MODES = ("F1", "F2", "F3", "F4")
JOG_KEYS = {
    "RightArrow": ("X", 1), "LeftArrow": ("X", -1), "UpArrow": ("Y", 1), "DownArrow": ("Y", -1),
    "PageUp": ("Z", 1), "PageDown": ("Z", -1), "Home": ("C", 1), "End": ("C", -1),
}  # fmt: skip
"""Keys that jog in the mode manual jog."""


def read_keyboard(now: Snapshot, state: DeskState) -> list[Request]:
    """What the keys ask for."""
    if imgui.IsKeyPressed(imgui.Key.Escape, repeat=False):
        return [do("emergency_stop", pressed=not now.pressed)]
    if imgui.GetIO().WantCaptureKeyboard and imgui.IsAnyItemActive():
        return []
    asked: list[Request] = []
    for key, command in _PLAIN:
        if _pressed(key):
            asked.append(do(command))
    for key, mode in zip(_MODES, MODES, strict=True):
        if _pressed(key):
            asked.append(do("mode", mode=mode))
    stands = state.standing("feed", now.feed_override)
    turned = stands + 10 * (
        (_pressed("Equal") or _pressed("KeypadAdd")) - (_pressed("Minus") or _pressed("KeypadSubtract"))
    )  # fmt: skip
    if turned != stands and FEED_OVERRIDES[0] <= turned <= FEED_OVERRIDES[1]:
        asked.append(state.turn("feed", turned))
    return asked + (_jog(now, state) if now.mode == "jog" else [])


def _jog(now: Snapshot, state: DeskState) -> list[Request]:
    asked: list[Request] = []
    for key, (axis, direction) in JOG_KEYS.items():
        if axis in now.axes:
            asked += jog_key(now, state, key, axis, direction, _pressed(key))
            if state.jogging == key and not imgui.IsKeyDown(getattr(imgui.Key, key)):
                state.jogging = ""
                asked.append(do("jog_stop"))
    return asked


def _pressed(key: str) -> bool:
    return imgui.IsKeyPressed(getattr(imgui.Key, key), repeat=False)
