"""The desk below the screen: mode, start and stop, dials, jog keys, spindle; MDI and line editor."""

import dataclasses

from mujoco.studio.dear_imgui import dear_imgui as imgui

from twin.training.panel.instruments import dial, mushroom
from twin.training.panel.kit import BLUE, BRIGHT_GREEN, CYAN, GREEN, RED, YELLOW, Kit
from twin.training.panel.request import Request, do
from twin.training.scene.modes import FEED_OVERRIDES, MODES, RAPID_OVERRIDES
from twin.training.scene.vocabulary import Words
from twin.training.session.snapshot import Snapshot

JOG_STEPS = (0.01, 0.1, 1.0, 10.0, None)
"""Steps of the jog keys [mm or deg]; None: as long as the key is held."""
JOG_FEED = {"mm": 2000.0, "deg": 1800.0}
"""Feed of the jog keys at 100 % [mm/min or deg/min]."""

_KEY, _WIDE, _NARROW = 56.0, 116.0, 100.0
"""Height of a key, and its widths [px]."""
_JOG, _JOG_HEIGHT, _STEP = 46.0, 42.0, 24.0
_DIAL = 96.0
_UNHEARD_S = 0.5
"""How long the machine takes at most to hear of a turned dial [s]."""
_MUSHROOM = 128.0


@dataclasses.dataclass
class DeskState:
    """What is set at the desk and concerns nobody else."""

    example: str = ""
    """What the empty MDI line shows."""
    step: float | None = 1.0
    entry: str = ""
    wanted: bool = False
    """Whether the MDI line shall take the keys."""
    chosen: int = 0
    """Line of the program that is being edited; 0: none."""
    edited: str = ""
    jogging: str = ""
    """Key that is being held down."""
    turned: dict[str, tuple[int, float]] = dataclasses.field(default_factory=dict)
    """Where a dial has been turned to [%], and until when the machine may still not show it [s]."""

    def standing(self, name: str, shown: int) -> int:
        """Where a dial stands: what the machine shows may be older than the last turn."""
        percent, end = self.turned.get(name, (shown, 0.0))
        if percent == shown or imgui.GetTime() > end:
            self.turned.pop(name, None)
            return shown
        return percent

    def turn(self, name: str, percent: int) -> Request:
        """Turn a dial."""
        self.turned[name] = (percent, imgui.GetTime() + _UNHEARD_S)
        return do("override", dial=name, percent=percent)


def build_modes(kit: Kit, words: Words, now: Snapshot) -> list[Request]:
    """The mode switch, two keys by two."""
    asked: list[Request] = []
    for number, mode in enumerate(MODES):
        if number % 2:
            imgui.SameLine()
        if kit.hard_key(
            f"mode {mode}", words[f"mode_{mode}"], _WIDE, _KEY, lamp=CYAN, lit=mode == now.mode
        ):
            asked.append(do("mode", mode=mode))
    return asked


def build_cycle(kit: Kit, words: Words, now: Snapshot) -> list[Request]:
    """Cycle start and feed hold above each other, reset beside them."""
    asked: list[Request] = []
    running = bool(now.running) and not now.held
    imgui.BeginGroup()
    if kit.hard_key(
        "cycle start", words["cycle_start"], _WIDE, _KEY, lamp=BRIGHT_GREEN, lit=running
    ):
        asked.append(do("cycle_start"))
    if kit.hard_key(
        "feed hold", words["feed_hold"], _WIDE, _KEY, lamp=YELLOW, lit=now.held, at_once=True
    ):
        asked.append(do("feed_hold"))
    imgui.EndGroup()
    imgui.SameLine()
    alarm = now.alarm is not None
    if kit.hard_key("reset", words["reset"], _NARROW, 2.0 * _KEY + 4.0, lamp=RED, lit=alarm):
        asked.append(do("reset"))
    return asked


def build_emergency(kit: Kit, words: Words, now: Snapshot) -> list[Request]:
    """The mushroom button."""
    label = words["release"] if now.pressed else words["emergency"]
    if mushroom(kit, "emergency", label, pressed=now.pressed, size=_MUSHROOM):
        return [do("emergency_stop", pressed=not now.pressed)]
    return []


def build_dials(kit: Kit, words: Words, now: Snapshot, state: DeskState) -> list[Request]:
    """Feed and rapid override."""
    asked: list[Request] = []
    for name, shown, highest in (
        ("feed", now.feed_override, FEED_OVERRIDES[1]),
        ("rapid", now.rapid_override, RAPID_OVERRIDES[1]),
    ):
        label = words[f"{name}_override"]
        percent = state.standing(name, shown)
        turned = dial(kit, f"{name} override", label, percent, highest, _DIAL)
        if turned != percent:
            asked.append(state.turn(name, turned))
        imgui.SameLine()
    imgui.NewLine()
    return asked


def build_jog(kit: Kit, words: Words, now: Snapshot, state: DeskState) -> list[Request]:
    """Jog keys, two per axis, and their step."""
    asked: list[Request] = []
    for direction, sign in ((1, "+"), (-1, "-")):
        for number, axis in enumerate(now.axes):
            if number:
                imgui.SameLine()
            name = f"jog {axis}{sign}"
            lit = now.running == "jog" and state.jogging in (name, "")
            pressed = kit.hard_key(
                name, f"{axis}{sign}", _JOG, _JOG_HEIGHT, lamp=CYAN,
                lit=lit and bool(now.distance_to_go[number] * direction > 0.0), at_once=True,
            )  # fmt: skip
            asked += jog_key(now, state, name, axis, direction, pressed)
            if state.jogging == name and not imgui.IsItemActive():
                state.jogging = ""
                asked.append(do("jog_stop"))
    for number, step in enumerate(JOG_STEPS):
        if number:
            imgui.SameLine(0.0, 4.0)
        label = words["continuous"] if step is None else f"{step:g}"
        if kit.key(f"step {step}", label, lit=BLUE if step == state.step else None, height=_STEP):
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


def build_supplies(kit: Kit, words: Words, now: Snapshot) -> list[Request]:
    """Spindle and coolant."""
    asked: list[Request] = []
    if kit.hard_key(
        "spindle", words["spindle"], _NARROW, _KEY, lamp=BRIGHT_GREEN, lit=now.spindle.turns
    ):
        asked.append(do("spindle", on=not now.spindle.turns))
    if kit.hard_key("coolant", words["coolant"], _NARROW, _KEY, lamp=CYAN, lit=now.coolant):
        asked.append(do("coolant", on=not now.coolant))
    return asked


def build_entry(kit: Kit, words: Words, now: Snapshot, state: DeskState) -> list[Request]:
    """The MDI line, or in the other modes the editor of a chosen line."""
    asked: list[Request] = []
    imgui.SetNextItemWidth(imgui.GetContentRegionAvail().x)
    if now.mode == "mdi":
        if state.wanted:
            imgui.SetKeyboardFocusHere()
            state.wanted = False
        _, state.entry = imgui.InputTextWithHint("###entry", state.example, state.entry)
        entered = kit.entered("entry")
        lit = GREEN if state.entry == now.entered else None
        if kit.key("enter", words["enter"], lit=lit) or entered:
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
