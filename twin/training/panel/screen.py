"""The control's screen: axes, program with the running block, what is in force."""

from mujoco.studio.dear_imgui import dear_imgui as imgui

from twin.training.panel.kit import BLUE, BRIGHT_GREEN, CYAN, QUIET, RED, TEXT, YELLOW, Kit
from twin.training.snapshot import Snapshot
from twin.training.vocabulary import Words

_LAG_SHOWN = {"mm": 1.0, "deg": 1.0}
"""Following error at the end of its bar."""
_BAR = 62.0
_CODES_IN_A_LINE = 11


def build_head(kit: Kit, words: Words, now: Snapshot) -> None:
    """Control, mode, state; the alarm line below."""
    state, colour = _state(words, now)
    kit.text(words["title"], QUIET)
    imgui.SameLine()
    kit.text(f"  {words['mode_' + now.mode]}", CYAN)
    imgui.SameLine()
    kit.text(f"  {state}", colour)
    imgui.SameLine()
    kit.text(f"   {now.time_s:7.1f} {words['seconds']}   {words['speed']} x{now.speed:.2f}", QUIET)
    if now.alarm is not None:
        alarm = words.alarm(now.alarm.code)
        where = f" [N {now.alarm.line}]" if now.alarm.line else ""
        kit.text(f"{words['alarm']}: {alarm.name}{where}.", RED)
        imgui.SameLine()
        kit.text(f"{now.alarm.message}.", TEXT)
        kit.text(alarm.advice, YELLOW)
    elif now.refusal:
        kit.text(f"{words['refused']}: {now.refusal}", YELLOW)
    else:
        kit.text(words["keys"], QUIET)


def _state(words: Words, now: Snapshot) -> tuple[str, tuple[float, float, float, float]]:
    if now.replaying:
        return words["replaying"], CYAN
    if now.frozen:
        return words["frozen"], CYAN
    if now.alarm is not None:
        return words["alarm"], RED
    if now.held:
        return words["held"], YELLOW
    return (words["running"], BRIGHT_GREEN) if now.running else (words["ready"], TEXT)


def build_axes(kit: Kit, words: Words, now: Snapshot) -> None:
    """One row per axis: as the screen shows it, distance to go, machine, lag and load."""
    if not imgui.BeginTable("axes", 6, int(imgui.TableFlags.SizingStretchProp)):
        return
    heads = ("axis", "position", "to_go", "machine", "following_error", "load")
    weights = (0.5, 2.3, 1.3, 1.3, 1.1, 1.1)
    for head, weight in zip(heads, weights, strict=True):
        imgui.TableSetupColumn(head, int(imgui.TableColumnFlags.WidthStretch), weight)
    imgui.TableNextRow()
    for head in heads:
        imgui.TableNextColumn()
        kit.text(words[head] if head != "axis" else "", QUIET)
    for number, axis in enumerate(now.axes):
        imgui.TableNextRow()
        imgui.TableNextColumn()
        kit.text(axis, CYAN, 1.55)
        imgui.TableNextColumn()
        kit.right(f"{now.position[number]:10.3f}", TEXT, 1.55)
        imgui.TableNextColumn()
        kit.right(f"{now.distance_to_go[number]:9.3f}", QUIET)
        imgui.TableNextColumn()
        kit.right(f"{now.machine_position[number]:9.3f}", QUIET)
        imgui.TableNextColumn()
        kit.bar(abs(now.following_error[number]) / _LAG_SHOWN[now.units[number]], _BAR)
        imgui.TableNextColumn()
        kit.bar(now.load[number], _BAR)
    imgui.EndTable()


def build_speeds(kit: Kit, words: Words, now: Snapshot) -> None:
    """Feed, spindle, tool, and the codes in force."""
    programmed = "-" if now.modal is None or now.modal.feed is None else f"{now.modal.feed:g}"
    kit.text(f"F {now.feed:7.0f}", TEXT, 1.3)
    imgui.SameLine()
    kit.text(f"({programmed})", QUIET)
    imgui.SameLine()
    kit.text(f"  S {now.spindle:.0f}", BRIGHT_GREEN if now.spindle else QUIET, 1.3)
    imgui.SameLine()
    kit.text(f"  T {now.tool}", TEXT, 1.3)
    if now.coolant:
        imgui.SameLine()
        kit.text(f"  {words['coolant']}", CYAN)
    if now.touches:
        imgui.SameLine()
        kit.text(f"  ● {words['contact']}", YELLOW)
    codes = () if now.modal is None else now.modal.codes
    for first in range(0, max(len(codes), 1), _CODES_IN_A_LINE):
        kit.text("  ".join(codes[first : first + _CODES_IN_A_LINE]), CYAN)


def build_program(kit: Kit, now: Snapshot, chosen: int) -> int:
    """The program with the running block marked.

    Args:
        kit: Draws.
        now: The machine.
        chosen: The line that is being edited, 0 for none.

    Returns:
        The line that is chosen now.
    """
    imgui.BeginChild("program", imgui.Vec2(0.0, 0.0))
    clipper = imgui.ListClipper()
    clipper.Begin(len(now.program))
    height = imgui.GetTextLineHeightWithSpacing()
    while clipper.Step():
        for index in range(clipper.DisplayStart, clipper.DisplayEnd):
            line = index + 1
            runs = line == now.line
            if runs:
                imgui.PushStyleColor(int(imgui.Col.Header), imgui.Vec4(*BLUE))
            label = f"{'▶' if runs else ' '}{line:4d}  {now.program[index]}###line{line}"
            if imgui.Selectable(label, runs or line == chosen):
                chosen = line
            if runs:
                imgui.PopStyleColor()
            kit.note(f"line {line}")
    if now.line:
        middle = (now.line - 1) * height - 0.4 * imgui.GetWindowHeight()
        imgui.SetScrollY(max(0.0, middle))
    imgui.EndChild()
    return chosen
