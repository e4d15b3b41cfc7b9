"""MEFI CNC8x6: axes dragged by circular motion, and jumps with repeat.

The control's page says all about G09, G10, G73 and G98; the rest is the base of ISO 6983-1.
"""

import dataclasses

from twin.nc.control.codes import Codes, GCode, Words
from twin.nc.control.control import Control, Rules
from twin.nc.control.dialect import Decision, Dialect
from twin.nc.control.modal import ArcRule
from twin.nc.geometry.arcs import sweep_between
from twin.nc.iso import base, shared_marks
from twin.nc.iso.circular import BOUNDS, arc_center, both_senses, start_and_end
from twin.nc.iso.declared import modal, motion_code, replacement
from twin.nc.text.syntax import HEADING, Comment, Mark, Syntax


@dataclasses.dataclass(slots=True)
class Dragging:
    """What G10 and G09 leave behind.

    Attributes:
        leads: Lead of each dragged axis per full circle, by column [mm or deg].
        on: G09 is in force.
        jumps_left: How often each G73 still jumps, by its line and part, while it does.
    """

    leads: dict[int, float] = dataclasses.field(default_factory=dict)
    on: bool = False
    jumps_left: dict[tuple[int, int], float] = dataclasses.field(default_factory=dict)


def _dragging(control: Control) -> Dragging:
    assert isinstance(control.memory, Dragging)
    return control.memory


def store_leads(control: Control) -> None:
    """G10: the block does not move; each axis word is that axis's lead per full circle."""
    words = control.take_axis_words()
    if not words:
        control.fail("lead", "G10 needs the axis to drag", hint="write Z1.05 G10")
    for index, word in words:
        _dragging(control).leads[index] = control.axis_value(index, word)


def switch_on(control: Control) -> None:
    """G09: circles drag."""
    if not any(_dragging(control).leads.values()):
        message = "G09 finds no lead"
        hint = "store it in a block before: Z1.05 G10"
        control.fail("no-lead", message, control.code_word(9), hint=hint)
    _dragging(control).on = True


def switch_off(control: Control) -> None:
    """G98: circles no longer drag; the leads stay (page: valid until changed)."""
    _dragging(control).on = False


def jump_with_repeat(control: Control) -> None:
    """G73: after the block's own motion go on at block L, Q times; the counter begins again behind that."""
    target, count = control.take("L"), control.take("Q")
    if target is None:
        message = "G73 needs L: the block to jump to"
        hint = "G73 L50 Q2 goes back to N50 twice"
        control.fail("jump-target", message, control.code_word(73), hint=hint)
    wanted = 1.0 if count is None else control.number(count)
    if not (wanted >= 0.0 and wanted == int(wanted)):
        control.fail("repeat-count", "Q must count jumps", count)
    counters, block = _dragging(control).jumps_left, (control.block.line, control.block.part)
    left = counters.pop(block, wanted)
    if left == 0.0:
        return
    counters[block] = left - 1.0
    number = control.number(target)
    if number != int(number):
        control.fail("jump-target", f"{target.text} is no block number", target)
    span = (target.column, target.width)
    control.jump(control.program_counter.find_label(int(number), span, "L"))


def _arc(control: Control, rule: ArcRule) -> None:
    dragging = _dragging(control)
    leads = dragging.leads if dragging.on else {}
    plane = control.modal.plane
    for index, lead in leads.items():
        name = control.settings.axes.names[index]
        if lead and index < 3 and abs(plane.normal[index]) < 0.5:
            message = f"{name} lies in the plane {plane.name} and cannot be dragged by its circles"
            control.fail("dragged-axis", message)
        if lead and name in control.words:
            message = f"{name} is dragged by the circle and cannot be programmed as well"
            hint = "leave it out, or end the helix by G98"
            control.fail("dragged-axis", message, control.words[name], hint=hint)
    target = control.target()
    center = arc_center(control, target, rule)
    start, end = start_and_end(control, target)
    sweep = sweep_between(start, end, center, rule.clockwise)
    for index, lead in leads.items():
        target[index] += lead * abs(sweep) / 360.0
    control.arc_to(target, center, sweep)


CLOCKWISE, COUNTER_CLOCKWISE = both_senses(_arc, ArcRule(bounds=BOUNDS, signed_radius=False))

DECISIONS = (
    Decision(
        "What are I, J, K relative to?",
        "To the start of the arc; a missing one is 0.",
        "In the page's example relative and absolute centres coincide; ISO 6983-1 is relative.",
        example="centre_from_the_start",
    ),
    Decision(
        "What does R draw?",
        "An arc of that radius below 180 degrees; a negative R is refused.",
        "The page shows centres only.",
        example="radius_words",
    ),
    Decision(
        "Which way does a lead drag?",
        "A positive lead moves the dragged axis in + for G02 and G03 alike, by "
        "lead · |sweep| / 360.",
        "The page calls it the distance per full circle and ties no sign to the sense.",
        example="lead_drags_up",
    ),
    Decision(
        "What if a G09 arc block also programs the dragged axis?",
        "A program error.",
        "Two commands for one axis contradict each other.",
        example="dragged_axis_programmed",
    ),
    Decision(
        "What if G09 comes without a lead?",
        "A program error.",
        "A flat circle is not what a helix code asks for.",
        example="no_lead",
    ),
    Decision(
        "In which order do motion and jump of a G73 block happen, and how often?",
        "The block's own motion first, then the jump, Q times; the counter belongs to the block "
        "and starts again when the loop is entered again; a missing Q is 1.",
        "The page's Q20 gives 21 circles.",
        example="counter_starts_anew",
    ),
    Decision(
        "What about G codes that the page does not name?",
        "Those of ISO 6983-1 have their meaning there; any other is a program error.",
        "Ignoring a code is a guess.",
        example="unknown_code",
    ),
    Decision(
        "What does F count?",
        "mm/min along the path of X, Y, Z; deg/min where only rotary axes move.",
        "ISO practice; the page shows no feed.",
        example="feed_of_rotary_axes",
    ),
    Decision(
        "How does a path pass its corners?",
        "Exactly: the speed falls as far as the corner demands, and no more.",
        "Nothing in the page allows the tool to leave the programmed path.",
        example="exact_path",
    ),
    *base.DECISIONS,
)

MEFI = Dialect(
    name="mefi",
    title="MEFI CNC8x6",
    code_page="cp1250",
    syntax=Syntax(comments=(Comment('"'), HEADING), excused=base.excuse_ellipsis),
    codes=Codes(
        groups=(*base.GROUPS, "helix"),
        g={
            **base.CODES,
            2: motion_code("arc clockwise", CLOCKWISE, "control page"),
            3: motion_code("arc counter-clockwise", COUNTER_CLOCKWISE, "decision"),
            9: modal("helix on", "helix", switch_on, basis="control page"),
            10: replacement("lead of the dragged axis", store_leads, basis="control page"),
            73: GCode(
                meaning="jump with repeat: L, Q",
                after_motion=jump_with_repeat,
                basis="control page",
            ),
            98: GCode(
                meaning="helix off",
                group="helix",
                action=switch_off,
                exclusive=True,
                basis="control page",
            ),
        },
        replacements={
            **base.REPLACEMENTS,
            99: "cycles return to the height of their call; G98 ends a helix here",
        },
        start=base.START,
        m=base.M_CODES,
    ),
    words=Words(
        actions=base.WORDS,
        meanings={
            **base.WORD_MEANINGS,
            "R": "radius of an arc below 180 degrees; reference plane of a cycle",
            "L": "block to jump to (G73)",
            "Q": "number of jumps (G73); depth of one peck (G83)",
        },
    ),
    rules=Rules(
        memory=Dragging,
        acts_on_lines=lambda control: _dragging(control).on,
    ),
    units="mm, degrees; F in mm/min, for rotary axes alone in deg/min",
    decisions=DECISIONS,
    marks=(
        Mark(r'^[^;$#="]*"[^"]*$', 'a comment after "'),
        Mark(r"\bG73\b.*\bL[ \t]*\d|\bL[ \t]*\d+.*\bG73\b", "G73 with L"),
        shared_marks.EXACT_STOP_ARC,
        shared_marks.G73_WITH_Q,
    ),
)
