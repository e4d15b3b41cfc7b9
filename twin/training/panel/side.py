"""The side of the screen: tasks and story, tables, view; and the trainer's sheet."""

import dataclasses

from mujoco.studio.dear_imgui import dear_imgui as imgui

from twin.training.panel.kit import BRIGHT_GREEN, CYAN, QUIET, RED, TEXT, YELLOW, Kit
from twin.training.panel.request import Request, do
from twin.training.scene.fault_table import FAULT_KINDS
from twin.training.scene.scene_file import SceneFile
from twin.training.scene.texts import in_language
from twin.training.scene.vocabulary import Words
from twin.training.session.snapshot import Snapshot

_MARKS = {"open": ("○", TEXT), "done": ("●", BRIGHT_GREEN), "failed": ("×", RED)}
_BACK_S = (10.0, 60.0)


@dataclasses.dataclass
class SideState:
    """What is set at the side and concerns nobody else."""

    sheet: str = "tasks"
    readings: dict[str, float] = dataclasses.field(default_factory=dict)
    show_trail: bool = True
    show_stock: bool = True
    show_collision: bool = False
    fault: int = 0
    fault_axis: int = 0
    fault_value: float = 0.05


def sheets(*, trainer: bool) -> list[str]:
    """The side's sheets, in their order."""
    return ["tasks", "offsets", "tools", "display", *["trainer"] * trainer]


def build_tasks(kit: Kit, words: Words, now: Snapshot, scene: SceneFile) -> list[Request]:
    """The story, the tasks with their marks, questions, hints and points."""
    asked: list[Request] = []
    language = words.language
    kit.text(in_language(scene.title, language), CYAN, 1.15)
    kit.wrapped(in_language(scene.story, language), QUIET)
    imgui.Separator()
    answers = dict(now.answers)
    for number, (task, verdict) in enumerate(zip(scene.tasks, now.verdicts, strict=True), 1):
        mark, colour = _MARKS[verdict.state]
        kit.wrapped(f"{mark} {in_language(task.text, language)}  ({task.points})", colour)
        if task.question is not None and number not in answers:
            for choice in task.question.choices:
                if kit.key(f"answer {number} {choice}", choice):
                    asked.append(do("answer", task=number, choice=choice))
                imgui.SameLine()
            imgui.NewLine()
    imgui.Separator()
    for hint in scene.hints[: now.hints]:
        kit.wrapped(in_language(hint, language), YELLOW)
    total = sum(task.points for task in scene.tasks)
    kit.text(f"{words['score']}: {now.score} / {total}", TEXT, 1.2)
    if now.over:
        kit.text(words["over"], BRIGHT_GREEN)
        return asked
    if now.hints < len(scene.hints):
        cost = words["hint_cost"].format(cost=scene.hint_cost)
        if kit.key("hint", f"{words['hint']} ({cost})"):
            asked.append(do("hint"))
        kit.beside(words["finish"])
    if kit.key("finish", words["finish"]):
        asked.append(do("finish"))
    return asked


def build_zero(kit: Kit, words: Words, now: Snapshot, state: SideState) -> list[Request]:
    """Part zero by axis, with a field to preset it by where the axis stands."""
    asked: list[Request] = []
    kit.wrapped(words["preset_help"], QUIET)
    if not imgui.BeginTable("zero", 4, int(imgui.TableFlags.SizingStretchProp)):
        return asked
    for part, weight in enumerate((0.2, 0.9, 1.0, 0.9)):
        imgui.TableSetupColumn(f"{part}", int(imgui.TableColumnFlags.WidthStretch), weight)
    for axis, zero in zip(now.axes, now.zero, strict=True):
        imgui.TableNextRow()
        imgui.TableNextColumn()
        imgui.AlignTextToFramePadding()
        kit.text(axis, CYAN)
        imgui.TableNextColumn()
        kit.right(f"{zero:.3f}")
        imgui.TableNextColumn()
        imgui.SetNextItemWidth(imgui.GetContentRegionAvail().x)
        _, value = imgui.InputDouble(
            f"###reading {axis}", state.readings.get(axis, 0.0), 0.0, 0.0, "%.3f"
        )
        state.readings[axis] = value
        entered = kit.entered(f"reading {axis}")
        imgui.TableNextColumn()
        width = imgui.GetContentRegionAvail().x
        if kit.key(f"preset {axis}", words["preset"], width=width) or entered:
            asked.append(do("set_zero", axis=axis, reading=value))
    imgui.EndTable()
    return asked


def build_tools(kit: Kit, words: Words, now: Snapshot) -> list[Request]:
    """The tool table; the tool in the spindle can be measured by touching Z0."""
    asked: list[Request] = []
    for tool in now.tools:
        here = tool.number == now.tool
        kind = words[f"tool_{tool.kind}"]
        kit.text(f"T{tool.number}  {kind}, {words['diameter']} {tool.diameter:g}",
                 CYAN if here else TEXT)  # fmt: skip
        imgui.AlignTextToFramePadding()
        kit.text(f"   {words['length']} {tool.length:.3f}", TEXT)
        if here:
            kit.beside(words["touch_off"])
            if kit.key("touch off", words["touch_off"]):
                asked += measured_tool(now)
    return asked


def measured_tool(now: Snapshot) -> list[Request]:
    """The tool in the spindle is as long as it must be to touch Z0; nothing where there is none."""
    above = now.position[now.axes.index("Z")]
    return [
        do("set_tool", number=tool.number, length=round(tool.length + above, 4))
        for tool in now.tools
        if tool.number == now.tool
    ]


def build_view(kit: Kit, words: Words, state: SideState) -> None:
    """What is drawn."""
    for name in ("trail", "stock", "collision"):
        _, on = imgui.Checkbox(words[name], getattr(state, f"show_{name}"))
        setattr(state, f"show_{name}", on)
        kit.note(f"show {name}")


def build_trainer(kit: Kit, words: Words, now: Snapshot, state: SideState) -> list[Request]:
    """Faults, freezing, going back, replay."""
    asked: list[Request] = []
    if now.frozen:
        if kit.key("go on", words["go_on"]):
            asked.append(Request("trainer", change="go_on"))
    elif kit.key("freeze", words["freeze"]):
        asked.append(Request("trainer", change="freeze"))
    for seconds in _BACK_S:
        label = words["rewind"].format(seconds=f"{seconds:g}")
        kit.beside(label)
        if kit.key(f"rewind {seconds:g}", label):
            asked.append(Request("trainer", change="rewind", seconds=seconds))
    kit.beside(words["replay"])
    if kit.key("replay", words["replay"]):
        asked.append(Request("trainer", change="replay"))
    imgui.Separator()
    names = [words[f"fault_{kind}"] for kind in FAULT_KINDS]
    imgui.SetNextItemWidth(imgui.GetContentRegionAvail().x)
    _, state.fault = imgui.Combo("###fault", state.fault, names)
    kind = FAULT_KINDS[state.fault]
    fault: dict[str, object] = {"kind": kind}
    if kind != "alarm":
        imgui.SetNextItemWidth(60.0)
        _, state.fault_axis = imgui.Combo("###fault axis", state.fault_axis, list(now.axes))
        imgui.SameLine()
        imgui.SetNextItemWidth(100.0)
        _, state.fault_value = imgui.InputDouble(
            "###fault value", state.fault_value, 0.0, 0.0, "%.3f"
        )
        fault |= {"axis": now.axes[state.fault_axis], "value": state.fault_value}
    if kit.key("inject", words["inject"]):
        asked.append(Request("trainer", command={"do": "inject", "fault": fault}))
    kit.beside(words["repair"])
    if kit.key("repair", words["repair"]):
        asked.append(Request("trainer", command={"do": "repair"}))
    kit.text(f"{now.time_s:.3f} {words['seconds']}", QUIET)
    return asked
