"""What the words of the SINUMERIK do in addition to its G codes: feeds, tools, offsets, roundings of corners."""

import math
import re

from twin.nc.control.codes import Action
from twin.nc.control.compensation import compensate, tool_named, tool_numbered
from twin.nc.control.control import Control
from twin.nc.control.tools import LENGTH_ENDED
from twin.nc.dialects.sinumerik import frames, orientation
from twin.nc.dialects.sinumerik.flow.calls import call_after_motion
from twin.nc.dialects.sinumerik.leads import is_led
from twin.nc.dialects.sinumerik.memory import memory_of
from twin.nc.dialects.sinumerik.targets import (
    forget_polar,
    frame_changed,
    frame_changes,
    shows_within_turn,
)
from twin.nc.dialects.sinumerik.variables.variables import text_of
from twin.nc.iso import base
from twin.nc.iso.declared import keep_compensated_plane
from twin.nc.iso.tool_change import go_to_change_height
from twin.nc.iso.tool_compensation import radius_in_spindle, set_length
from twin.nc.path.blends import Blend, BlendKind
from twin.nc.path.feed_rates import counts_blocks
from twin.nc.text.blocks import Word
from twin.nc.text.expressions.arithmetic import is_whole

_BLENDING = re.compile(rb"[RrCc](?:[Nn][Dd]|[Hh][FfRr])")
_BLENDS = {"RND": BlendKind.FILLET, "CHR": BlendKind.CHAMFER, "CHF": BlendKind.CHAMFER_LENGTH}
_CORNERS, _INTERSECTION = "compensation corners", 451.0
_LARGEST_H = 99_999.0
_MOST_EDGES = 12.0
"""D numbers of a tool go so far (tool management manual)."""


# --- feeds


def set_feed(control: Control, word: Word) -> None:
    """F: with G70 and G71 lengths alone change their unit, with G700 and G710 the feed does too (manual)."""
    base.set_feed(control, word)
    assert control.motion.feed is not None
    if control.modal.active.get("units") == 70.0 and not counts_blocks(control.modal.feed_mode):
        control.motion.feed /= control.modal.unit


def keep_feed(control: Control) -> None:
    """G70 to G710: the feed that is in force goes on as fast."""
    memory, unit = memory_of(control), control.modal.unit
    if control.motion.feed is not None and not counts_blocks(control.modal.feed_mode):
        control.motion.feed *= memory.unit / unit
    memory.unit = unit


def feed_of_block(control: Control, word: Word) -> None:
    """FB=: the feed of this block alone."""
    memory_of(control).modal_feed = (
        control.motion.feed if control.motion.feed is not None else math.nan
    )
    set_feed(control, word)


def dwell(control: Control) -> None:
    """G4 F: seconds; G4 S: revolutions of the spindle."""
    seconds, turns = control.take("F"), control.take("S")
    if (seconds is None) == (turns is None):
        control.fail("dwell", "G4 needs its seconds F or its revolutions S", hint="write G4 F1.5")
    if seconds is not None:
        base.wait(control, control.number(seconds), seconds)
    elif turns is not None:
        if not control.motion.spindle or not control.motion.spindle_turns:
            message = "G4 S counts revolutions, and the spindle stands"
            control.fail(
                "dwell", message, turns, "write G4 F and seconds, or start the spindle before"
            )
        base.wait(control, control.number(turns) * 60.0 / control.motion.spindle, turns)


# --- tools


def next_tool(control: Control, word: Word) -> None:
    """T5, T="NAME": the tool that M6 brings; T0 leaves the spindle empty."""
    if word.mark:
        word = word._replace(value=float(tool_named(control, text_of(word), word)))
    number = control.number(word)
    if control.tools.table and number not in control.tools.table and number != 0.0:
        tool_numbered(control, word._replace(mark=""))
    base.next_tool(control, word._replace(mark=""))


def change_tool(control: Control) -> None:
    """M6: the tool goes into the spindle with its offset D1, or as the D of the same block says."""
    go_to_change_height(control)
    control.tools.change()
    says_edge = any(each.address == "D" for each in control.block.words)
    _apply_offset(control, on=memory_of(control).tool_on or not says_edge)


def tool_offset(control: Control, word: Word) -> None:
    """D1: length and radius of the tool count; D0: they do not.

    Decision: the job gives a tool one edge, and that is the one whose number the program calls with it.
    """
    number = control.number(word)
    if not is_whole(number, _MOST_EDGES):
        control.fail("tool-offset", f"{word.text} is no edge of a tool", word, "D1")
    if number > 0.0:
        _take_edge(control, word, number)
    _apply_offset(control, on=number > 0.0)


def _take_edge(control: Control, word: Word, number: float) -> None:
    """Refuse another edge of a tool than the one that the program has called before."""
    comes = any(each.address == "T" for each in control.block.words)
    tool = control.tools.selected if comes else control.tools.spindle
    edge = memory_of(control).edges.setdefault(tool or 0, number)
    if edge != number:
        message = f"the job gives every tool one edge, and the program has called D{edge:g} of tool {tool or 0} before"
        control.fail("tool-offset", message, word, f"write D{edge:g}")
    if number != 1.0:
        message = (
            f"the job gives every tool one edge: {word.text} is taken for that of tool {tool or 0}"
        )
        control.report.warn_once("tool-edge", message, word.column, word.width)


def _apply_offset(control: Control, *, on: bool) -> None:
    memory_of(control).tool_on = on
    tool = control.tools.data(control.tools.spindle) if on else None
    control.tools.length_call = control.tools.spindle if on else LENGTH_ENDED
    before = frame_changes(control)
    set_length(control, 0.0 if tool is None else control.tools.length_difference(tool))
    frame_changed(control, before)


def compensation(side: float) -> Action:
    """G41, G42: by the radius of the tool in the spindle and OFFN; D, OFFN= and DISC= of the block count already."""

    def action(control: Control) -> None:
        memory, modal = memory_of(control), control.modal
        for name, act in (("D", tool_offset), ("OFFN", set_allowance), ("DISC", circumvention)):
            if (word := control.take(name)) is not None:
                act(control, word)
        modal.square_corners = memory.sharp_corners or modal.active.get(_CORNERS) == _INTERSECTION
        radius = radius_in_spindle(control) if memory.tool_on else 0.0
        if not is_led(control):
            compensate(control, side, radius + memory.allowance)

    return action


def end_compensation(control: Control) -> None:
    """G40: the next line leads out, but for a lead of the block."""
    if not is_led(control):
        control.path.end_compensation()


def set_allowance(control: Control, word: Word) -> None:
    """OFFN=: how far the programmed contour lies from the wall; the next G41 or G42 counts it."""
    if control.path.compensation.in_force:
        message = "OFFN= cannot change while radius compensation is in force"
        control.fail("compensation-change", message, word, "write it before G41 or G42")
    memory_of(control).allowance = control.length(word)


def choose_plane(control: Control) -> None:
    """G17, G18, G19: the pole goes to zero of the new plane."""
    keep_compensated_plane(control)
    memory_of(control).pole = (0.0, 0.0)
    forget_polar(control)


# --- M, H, S


def auxiliary(control: Control, word: Word) -> None:
    """H: a function of the machine."""
    number = control.number(word)
    if not is_whole(abs(number), _LARGEST_H):
        message = f"{word.text} is no number of a function: whole ones up to {_LARGEST_H:g} are"
        control.fail("number-range", message, word)
    control.function(f"H{int(number)}", {})


def position_spindle(control: Control, word: Word) -> None:
    """SPOS=: the spindle turns to an angle and stands."""
    control.motion.spindle_turns = False
    control.function("SPOS", {"ANGLE": control.number(word)})


def circumvention(control: Control, word: Word) -> None:
    """DISC=: how outside corners are passed with G450: 0 on an arc, 100 by the intersection (manual)."""
    number = control.number(word)
    if number not in (0.0, 100.0):
        message = (
            "only DISC=0, an arc around the corner, and DISC=100, the intersection, are followed"
        )
        control.fail("unsupported-word", message, word)
    memory_of(control).sharp_corners = number == 100.0


def corner_distance(control: Control, word: Word) -> None:
    """ADIS=: how far G641 and G642 may leave the corner."""
    distance = control.length(word)
    if distance < 0.0:
        control.fail("number-range", f"the distance {word.text} is below 0", word)
    control.modal.corner_tolerance = distance if distance > 0.0 else math.nan


def rapid_corner_distance(_control: Control, _word: Word) -> None:
    """ADISPOS=: the same of rapids, which end as the machine's rapids do here."""


def compressor_tolerance(_control: Control, _word: Word) -> None:
    """CTOL=, OTOL=: how far compressor and rounding may leave the path, which the machine file says here."""


def speed_limit(control: Control, word: Word) -> None:
    """LIMS=: the limit of G96, which a mill does not use."""
    if not control.number(word) > 0.0:
        control.fail("spindle-range", f"the limit {word.text} is not above 0", word)


# --- corners between two moves


def prepare_corners(control: Control) -> None:
    """Hold moves until their successor is known, where the program blends corners at all."""
    if control.program_counter.lines.any_holds(_BLENDING):
        control.path.hold_for_blends()


def modal_rounding(control: Control, word: Word) -> None:
    """RNDM=: the corner behind this block and all further ones are rounded; 0: none behind this block is."""
    radius, memory = control.length(word), memory_of(control)
    if radius < 0.0:
        control.fail("blend", f"the radius {word.text} is below 0", word)
    memory.ends_rounding = radius == 0.0
    if radius > 0.0:
        memory.rounding = radius
        control.path.blend_always(Blend(BlendKind.FILLET, radius, control.motion.part_plane))


def before_motion(control: Control, _rapid: bool) -> None:
    """What holds for every motion block."""
    frames.require_machine_zero(control)
    orientation.point_by_vector(control)
    orientation.require_orientation(control)


def after_motion(control: Control) -> None:
    """What a block does when it has moved: angles within a turn, its corner, its own feed."""
    shows_within_turn(control)
    memory = memory_of(control)
    if memory.ends_rounding:
        memory.ends_rounding, memory.rounding = False, 0.0
        control.path.blend_always(None)
        control.path.hold_for_blends()
    _blend(control)
    if memory.modal_feed is not None:
        control.motion.feed = None if math.isnan(memory.modal_feed) else memory.modal_feed
        memory.modal_feed = None
    call_after_motion(control)


def _blend(control: Control) -> None:
    """RND=, CHR=, CHF= of the block: the corner to the next move."""
    words = [word for name in _BLENDS if (word := control.take(name)) is not None]
    if len(words) > 1:
        control.fail("blend", "a corner has one of RND=, CHR= and CHF=", words[1])
    if not words:
        return
    size, kind = control.length(words[0]), _BLENDS[words[0].address]
    if not size > 0.0:
        control.fail("blend", f"the size of the corner {words[0].text} is not above 0", words[0])
    base.blend_corner_behind(control, kind, size, words[0])
