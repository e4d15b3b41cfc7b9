"""The keyboard of the panel; silent while someone types into a field."""

from mujoco.studio.dear_imgui import dear_imgui as imgui

from twin.training.panel.desk import JOG_STEPS, DeskState, jog_key
from twin.training.panel.request import Request, do
from twin.training.panel.side import SideState, measured_tool, sheets
from twin.training.scene.modes import FEED_OVERRIDES, MODES, RAPID_OVERRIDES
from twin.training.session.snapshot import Snapshot

_PLAIN = (("Space", "cycle_start"), ("H", "feed_hold"), ("R", "reset"))
_MODES = ("F1", "F2", "F3", "F4")
_STEPS = ("N1", "N2", "N3", "N4", "N5")
_DIALS = (
    ("feed", FEED_OVERRIDES, ("Equal", "KeypadAdd"), ("Minus", "KeypadSubtract")),
    ("rapid", RAPID_OVERRIDES, ("Period",), ("Comma",)),
)
"""Name and range of each dial, and the keys that turn it up and down."""
_SHOWN = (("W", "trail"), ("P", "stock"), ("B", "collision"))
JOG_KEYS = {
    "RightArrow": ("X", 1), "LeftArrow": ("X", -1), "UpArrow": ("Y", 1), "DownArrow": ("Y", -1),
    "PageUp": ("Z", 1), "PageDown": ("Z", -1), "Home": ("C", 1), "End": ("C", -1),
}  # fmt: skip
"""Keys that jog in the mode manual jog."""


def read_keyboard(
    now: Snapshot, desk: DeskState, side: SideState, *, trainer: bool
) -> list[Request]:
    """What the keys ask for; what they set at the panel itself is set.

    Args:
        now: The machine.
        desk: What is set at the desk.
        side: What is set at the side.
        trainer: Whether the trainer's sheet is there.
    """
    if _pressed("Escape"):
        return [do("emergency_stop", pressed=not now.pressed)]
    if imgui.GetIO().WantCaptureKeyboard and imgui.IsAnyItemActive():
        return []
    asked = [do(command) for key, command in _PLAIN if _pressed(key)]
    asked += [
        do("mode", mode=mode) for key, mode in zip(_MODES, MODES, strict=True) if _pressed(key)
    ]
    if _pressed("S"):
        asked.append(do("spindle", on=not now.spindle.turns))
    if _pressed("C"):
        asked.append(do("coolant", on=not now.coolant))
    if _pressed("M"):
        asked += measured_tool(now)
    _set_panel(now, desk, side, trainer=trainer)
    return asked + _dials(now, desk) + (_jog(now, desk) if now.mode == "jog" else [])


def _set_panel(now: Snapshot, desk: DeskState, side: SideState, *, trainer: bool) -> None:
    """What the keys change at the panel: step, line to write in, sheet, what is drawn."""
    for key, step in zip(_STEPS, JOG_STEPS, strict=True):
        if _pressed(key):
            desk.step = step
    if now.mode == "mdi" and (_pressed("Enter") or _pressed("KeypadEnter")):
        desk.wanted = True
    if _pressed("T"):
        names = sheets(trainer=trainer)
        here = names.index(side.sheet) if side.sheet in names else -1
        side.sheet = names[(here + 1) % len(names)]
    for key, name in _SHOWN:
        if _pressed(key):
            setattr(side, f"show_{name}", not getattr(side, f"show_{name}"))


def _dials(now: Snapshot, desk: DeskState) -> list[Request]:
    asked: list[Request] = []
    for name, (lowest, highest), ups, downs in _DIALS:
        stands = desk.standing(name, getattr(now, f"{name}_override"))
        turned = stands + 10 * (any(map(_pressed, ups)) - any(map(_pressed, downs)))
        if turned != stands and lowest <= turned <= highest:
            asked.append(desk.turn(name, turned))
    return asked


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
