"""The control's screen: axes, program with the running block, what is in force."""

from mujoco.studio.dear_imgui import dear_imgui as imgui

from twin.training.panel.instruments import bar
from twin.training.panel.kit import (
    BLUE,
    BRIGHT_GREEN,
    CYAN,
    GREEN,
    KEY,
    QUIET,
    RED,
    TEXT,
    YELLOW,
    Kit,
)
from twin.training.scene.phrases import translated
from twin.training.scene.vocabulary import Words
from twin.training.session.snapshot import Snapshot

_LAG_SHOWN = 1.0
"""Following error at the end of its bar [mm or deg]."""
_THOUSANDTH = {"mm": "µm", "deg": "m°"}
"""Unit of a following error."""
_BIG = 1.9
"""How much larger the axes' positions are than other texts."""
_CODES_IN_A_LINE = 11


def build_head(kit: Kit, words: Words, now: Snapshot) -> None:
    """Control, mode, state, clock; the alarm line below."""
    state, colour = _state(words, now)
    kit.chip(words["mode_" + now.mode], KEY, 1.25)
    imgui.SameLine()
    kit.chip(state, colour, 1.25)
    imgui.SameLine()
    kit.text(f"  {words['title']}", TEXT, 1.25)
    imgui.SameLine()
    clock = f"{now.time_s:.1f} {words['seconds']}    {words['speed']} x{now.speed:.2f}"
    kit.right(clock, QUIET)
    if now.alarm is not None:
        alarm = words.alarm(now.alarm.code)
        where = f"  N {now.alarm.line}" if now.alarm.line else ""
        kit.chip(f"{alarm.name}{where}", RED)
        imgui.SameLine()
        kit.fitting(f" {translated(now.alarm.message, words.language)}", TEXT)
        kit.text(alarm.advice, YELLOW)
    elif now.refusal:
        refusal = translated(now.refusal, words.language)
        kit.fitting(f"{words['refused']}: {refusal}", YELLOW)
    else:
        kit.wrapped(words["keys"], QUIET)


def _state(words: Words, now: Snapshot) -> tuple[str, tuple[float, float, float, float]]:
    if now.replaying:
        return words["replaying"], BLUE
    if now.frozen:
        return words["frozen"], BLUE
    if now.alarm is not None:
        return words["alarm"], RED
    if now.held:
        return words["held"], YELLOW
    return (words["running"], GREEN) if now.running else (words["ready"], KEY)


def build_axes(kit: Kit, words: Words, now: Snapshot) -> None:
    """One row per axis: as the screen shows it, distance to go, machine, lag and load."""
    if not imgui.BeginTable("axes", 6, int(imgui.TableFlags.SizingStretchProp)):
        return
    heads = ("axis", "position", "to_go", "machine", "following_error", "load")
    weights = (0.45, 2.15, 1.25, 1.35, 1.3, 1.15)
    for head, weight in zip(heads, weights, strict=True):
        imgui.TableSetupColumn(head, int(imgui.TableColumnFlags.WidthStretch), weight)
    imgui.TableNextRow()
    for head in heads:
        imgui.TableNextColumn()
        kit.fitting(words[head] if head != "axis" else "", QUIET)
    for number, axis in enumerate(now.axes):
        imgui.TableNextRow()
        imgui.TableNextColumn()
        kit.text(axis, CYAN, _BIG)
        imgui.TableNextColumn()
        kit.right(_figure(now.position[number]), BRIGHT_GREEN, _BIG)
        imgui.TableNextColumn()
        _down()
        kit.right(_figure(now.distance_to_go[number]), TEXT)
        imgui.TableNextColumn()
        _down()
        kit.right(_figure(now.machine_position[number]), QUIET)
        imgui.TableNextColumn()
        _down()
        lag = now.following_error[number]
        told = f"{abs(1000.0 * lag):.0f} {_THOUSANDTH[now.units[number]]}"
        bar(abs(lag) / _LAG_SHOWN, told, imgui.GetContentRegionAvail().x)
        imgui.TableNextColumn()
        _down()
        told = f"{100.0 * now.load[number]:.0f} %"
        bar(now.load[number], told, imgui.GetContentRegionAvail().x)
    imgui.EndTable()


def _speed(now: Snapshot) -> str:
    """What the spindle turns; a dash where it turns and nobody has said how fast."""
    if not now.spindle.turns:
        return "0"
    return "-" if now.spindle.speed is None else f"{now.spindle.speed:.0f}"


def _figure(value: float) -> str:
    """A position with three decimals, without a sign before nothing."""
    return f"{round(value, 3) + 0.0:.3f}"


def _down() -> None:
    """Go down to the middle of a row of large figures."""
    imgui.SetCursorPosY(imgui.GetCursorPosY() + 0.5 * (_BIG - 1.0) * imgui.GetTextLineHeight())


def build_speeds(kit: Kit, words: Words, now: Snapshot) -> None:
    """Feed, spindle, tool, and the codes in force."""
    programmed = "-" if now.modal is None or now.modal.feed is None else f"{now.modal.feed:g}"
    kit.text(f"F {now.feed:7.0f}", TEXT, 1.3)
    imgui.SameLine()
    kit.text(f"({programmed})", QUIET, 1.3)
    imgui.SameLine()
    kit.text(f"  S {_speed(now)}", BRIGHT_GREEN if now.spindle.turns else QUIET, 1.3)
    imgui.SameLine()
    kit.text(f"  T {now.tool}", TEXT, 1.3)
    if now.coolant:
        imgui.SameLine()
        kit.text(f"  {words['coolant']}", CYAN, 1.15)
    if now.touches:
        imgui.SameLine()
        kit.text(f"  ● {words['contact']}", YELLOW, 1.15)
    codes = () if now.modal is None else now.modal.codes
    for first in range(0, max(len(codes), 1), _CODES_IN_A_LINE):
        kit.text("  ".join(codes[first : first + _CODES_IN_A_LINE]), CYAN)


def build_program(kit: Kit, now: Snapshot, chosen: int, below: float) -> int:
    """The program with the running block marked.

    Args:
        kit: Draws.
        now: The machine.
        chosen: The line that is being edited, 0 for none.
        below: Room to leave below it [px].

    Returns:
        The line that is chosen now.
    """
    imgui.BeginChild("program", imgui.Vec2(0.0, -below))
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
