"""The desk below the screen: mode, start and stop, dials, jog keys, spindle, MDI, line editor."""

import dataclasses

from mujoco.studio.dear_imgui import dear_imgui as imgui

from twin.training.commands import FEED_OVERRIDES, MODES, RAPID_OVERRIDES
from twin.training.panel.kit import BLUE, GREEN, RED, YELLOW, Kit
from twin.training.panel.request import Request, do
from twin.training.snapshot import Snapshot
from twin.training.vocabulary import Words

JOG_STEPS = (0.01, 0.1, 1.0, 10.0, None)
"""Steps of the jog keys [mm or deg]; None: as long as the key is held."""
JOG_FEED = {"mm": 2000.0, "deg": 1800.0}
"""Feed of the jog keys at 100 % [mm/min or deg/min]."""
SPINDLE_SPEED = 3000.0
"""What the spindle key starts [1/min]."""

_KEY = 34.0


@dataclasses.dataclass
class DeskState:
    """What is set at the desk and concerns nobody else."""

    step: float | None = 1.0
    entry: str = ""
    chosen: int = 0
    """Line of the program that is being edited; 0: none."""
    edited: str = ""
    jogging: str = ""
    """Key that is being held down."""


def build_modes(kit: Kit, words: Words, now: Snapshot, width: float) -> list[Request]:
    """The mode switch."""
    asked: list[Request] = []
    for number, mode in enumerate(MODES):
        if number % 2:
            imgui.SameLine()
        lit = BLUE if mode == now.mode else None
        if kit.key(
            f"mode {mode}", words[f"mode_{mode}"], lit=lit, width=width / 2 - 4, height=_KEY
        ):
            asked.append(do("mode", mode=mode))
    return asked


def build_cycle(kit: Kit, words: Words, now: Snapshot, width: float) -> list[Request]:
    """Cycle start, feed hold, reset."""
    asked: list[Request] = []
    running = bool(now.running) and not now.held
    if kit.key(
        "cycle start", words["cycle_start"], lit=GREEN if running else None,
        width=width, height=_KEY,
    ):  # fmt: skip
        asked.append(do("cycle_start"))
    if kit.key(
        "feed hold", words["feed_hold"], lit=YELLOW if now.held else None,
        width=width / 2 - 4, height=_KEY, at_once=True,
    ):  # fmt: skip
        asked.append(do("feed_hold"))
    imgui.SameLine()
    if kit.key("reset", words["reset"], width=width / 2 - 4, height=_KEY):
        asked.append(do("reset"))
    return asked


def build_emergency(kit: Kit, words: Words, now: Snapshot, width: float) -> list[Request]:
    """The mushroom button."""
    label = words["release"] if now.pressed else words["emergency"].replace(" ", "\n", 1)
    lit = YELLOW if now.pressed else RED
    if kit.key("emergency", label, lit=lit, width=width, height=2 * _KEY + 6, at_once=True):
        return [do("emergency_stop", pressed=not now.pressed)]
    return []


def build_dials(kit: Kit, words: Words, now: Snapshot) -> list[Request]:
    """Feed and rapid override."""
    asked: list[Request] = []
    feed = kit.dial(
        "feed override", words["feed_override"], now.feed_override, FEED_OVERRIDES[1], 62.0
    )
    if feed != now.feed_override:
        asked.append(do("override", dial="feed", percent=feed))
    rapid = kit.dial(
        "rapid override", words["rapid_override"], now.rapid_override, RAPID_OVERRIDES[1], 62.0
    )
    if rapid != now.rapid_override:
        asked.append(do("override", dial="rapid", percent=rapid))
    return asked


def build_jog(kit: Kit, words: Words, now: Snapshot, state: DeskState) -> list[Request]:
    """Jog keys, two per axis, and their step."""
    asked: list[Request] = []
    for number, axis in enumerate(now.axes):
        for direction, sign in ((1, "+"), (-1, "-")):
            if number or direction < 0:
                imgui.SameLine()
            name = f"jog {axis}{sign}"
            lit = BLUE if now.running == "jog" and state.jogging == name else None
            pressed = kit.key(name, f"{axis}{sign}", lit=lit, width=36, height=_KEY, at_once=True)
            asked += jog_key(now, state, name, axis, direction, pressed)
            if state.jogging == name and not imgui.IsItemActive():
                state.jogging = ""
                asked.append(do("jog_stop"))
    for number, step in enumerate(JOG_STEPS):
        if number:
            imgui.SameLine()
        label = words["continuous"] if step is None else f"{step:g}"
        if kit.key(f"step {step}", label, lit=BLUE if step == state.step else None, height=26.0):
            state.step = step
    return asked


def jog_key(
    now: Snapshot, state: DeskState, name: str, axis: str, direction: int, pressed: bool
) -> list[Request]:
    """What pressing a jog key asks for."""
    if not pressed:
        return []
    unit = now.units[now.axes.index(axis)]
    feed = JOG_FEED[unit]
    if state.step is not None:
        return [do("jog", axis=axis, direction=direction, step=state.step, feed=feed)]
    state.jogging = name
    return [do("jog", axis=axis, direction=direction, feed=feed)]


def build_supplies(kit: Kit, words: Words, now: Snapshot, width: float) -> list[Request]:
    """Spindle and coolant."""
    asked: list[Request] = []
    lit = GREEN if now.spindle else None
    if kit.key("spindle", words["spindle"], lit=lit, width=width, height=_KEY):
        asked.append(do("spindle", on=not now.spindle, speed=SPINDLE_SPEED))
    lit = BLUE if now.coolant else None
    if kit.key("coolant", words["coolant"], lit=lit, width=width, height=_KEY):
        asked.append(do("coolant", on=not now.coolant))
    return asked


def build_entry(kit: Kit, words: Words, now: Snapshot, state: DeskState) -> list[Request]:
    """The MDI line, or in the other modes the editor of a chosen line."""
    asked: list[Request] = []
    imgui.SetNextItemWidth(imgui.GetContentRegionAvail().x)
    if now.mode == "mdi":
        _, state.entry = imgui.InputTextWithHint("###entry", "G91 G1 X10 F500", state.entry)
        kit.note("entry")
        if kit.key("enter", words["enter"], lit=GREEN if state.entry == now.entered else None):
            asked.append(do("mdi", text=state.entry))
        return asked
    if not 1 <= state.chosen <= len(now.program):
        state.chosen = 0
        return asked
    _, state.edited = imgui.InputText("###edited", state.edited)
    kit.note("edited")
    if kit.key("write", words["edit"]):
        asked.append(do("edit", line=state.chosen, text=state.edited))
    imgui.SameLine()
    if kit.key("insert", words["insert"]):
        text = f"{now.program[state.chosen - 1]}\n{state.edited}"
        asked.append(do("edit", line=state.chosen, text=text))
    imgui.SameLine()
    if kit.key("delete", words["delete"]):
        asked.append(do("edit", line=state.chosen))
        state.chosen = 0
    return asked
