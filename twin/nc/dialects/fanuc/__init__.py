"""Fanuc 0i-MF and 30i, milling, and the Haas mills, whose language is much the same."""

import dataclasses
import math

from twin.nc.control.codes import Codes, Words
from twin.nc.control.control import Control, Rules
from twin.nc.control.dialect import Dialect, JobKey
from twin.nc.dialects.fanuc import (
    codes,
    decimal_point,
    haas,
    macro_calls,
    motion,
    programs,
)
from twin.nc.dialects.fanuc.cycles.canned_cycles import OVERRULED_CYCLE, as_read
from twin.nc.dialects.fanuc.decisions import DECISIONS
from twin.nc.dialects.fanuc.frames import offsets, reference_points
from twin.nc.dialects.fanuc.macros import flow, variables
from twin.nc.dialects.fanuc.memory import FANUC as FANUC_VARIANT
from twin.nc.dialects.fanuc.memory import HAAS as HAAS_VARIANT
from twin.nc.dialects.fanuc.memory import FanucMemory, acts_on_lines, holds_any, memory_of
from twin.nc.dialects.fanuc.tools import tool_offsets, tool_tips
from twin.nc.geometry.arcs import TURN
from twin.nc.iso import base, shared_marks
from twin.nc.iso.orientation import rotary_targets
from twin.nc.text.syntax import HEADING, Comment, Mark, Syntax


def prepare(control: Control) -> None:
    """Look over the program before it runs."""
    memory, lines = memory_of(control), control.program_counter.lines
    programs.begin(control)
    memory.overrules_cycles = holds_any(lines, OVERRULED_CYCLE)
    offsets.put_into_force(control)
    motion.prepare_corners(control)


def before_motion(control: Control, rapid: bool) -> None:
    """A block is about to move.

    Raises:
        ProgramError: G93 without F, or F of another feed mode.
    """
    reference_points.warn_of_cancelled_length(control)
    tool_tips.require_orientation(control)
    tool_tips.point_by_vector(control)
    if not rapid:
        base.require_feed_of_block(control)
        if memory_of(control).feed_lost and control.motion.feed is None:
            message = "F was written for another feed mode, and its number would mean another unit"
            control.fail("no-feed", message, hint="write F behind G93, G94 or G95")


def _roll_over(control: Control) -> None:
    """With ``rollover`` (parameter 1008 #0, ROA) absolute rotary targets are those of a turn, as RAB (#1) says."""
    if control.settings.rollover is None:
        return
    for index, word, value in rotary_targets.absolute_targets(control):
        if control.settings.rollover == "shorter":
            rotary_targets.go_shorter(control, index, value)
        else:
            within = math.copysign(abs(value) % TURN, value)
            rotary_targets.go_by_sign(control, index, word, within)


def _before_motion(control: Control, rapid: bool) -> None:
    _roll_over(control)
    before_motion(control, rapid)


def after_motion(control: Control) -> None:
    """A block has moved."""
    motion.blend_corner(control)
    macro_calls.call_after_motion(control)


_FAMILY = (
    shared_marks.PROGRAM_NUMBER,
    Mark(r"^[ \t]*:[ \t]*[0-9]{1,8}[ \t;]*$", ":1000 (a program's number)"),
    shared_marks.SEMICOLON,
    shared_marks.ARC_WITH_T,
    shared_marks.EXACT_STOP_ARC,
    Mark(r"\bIF[ \t]*\[.*\][ \t]*(?:GOTO|THEN)(?![A-Z])", "IF [...] GOTO, IF [...] THEN"),
    Mark(r"\bWHILE[ \t]*\[.*\][ \t]*DO[ \t]*[1-3]\b", "WHILE [...] DO1"),
    Mark(r"\bG6[56][ \t]*P[ \t]*[0-9]", "G65 P, G66 P (a macro call)"),
    shared_marks.NUMBERED_PARAMETER_3000,
    Mark(r"[0-9.][ \t]*,[ \t]*[RC][ \t]*[.0-9]", "X10. ,R5."),
)
"""What the controls of the family have in common: alone it tells none of them."""


BLOCK_END_ALONE = Comment(";", whole_line=True)
"""A line that begins with the end of a block is none."""

FANUC = Dialect(
    name="fanuc",
    title="Fanuc 0i-MF, 30i (milling)",
    code_page="cp1252",
    syntax=Syntax(
        address=r",[CR]|[A-Z]|:",
        comments=(Comment("(", ")"), HEADING, BLOCK_END_ALONE),
        skip_levels=range(1, 10),
        block_end=";",
        names=programs.NAMED,
        expressions=variables.EXPRESSIONS,
        statement=flow.PATTERN,
        assigned="#",
        open_assignments=True,
        inner_comments=True,
    ),
    codes=Codes(
        groups=codes.GROUPS,
        g=codes.codes(FANUC_VARIANT),
        replacements=codes.REPLACEMENTS,
        start=codes.START,
        m=codes.M_CODES,
        last_of_group_counts=True,
        start_state={"square_corners": True, "look_ahead": tool_offsets.BLOCKS_AHEAD},
        statements={**flow.STATEMENTS, **macro_calls.CALLS_BY_CODE},
    ),
    words=Words(
        actions={
            "O": programs.heading,
            ":": programs.heading,
            programs.NAMED_HEADING: programs.heading,
            "F": base.set_feed,
            "S": base.spindle_speed,
            "T": base.next_tool,
            "H": tool_offsets.set_length_number,
            "D": tool_offsets.set_radius_number,
        },
        before_codes=True,
        meanings={
            "O": "number of the program",
            ":": "number of the program, as a tape of the ISO code has it",
            programs.NAMED_HEADING: "name of the program",
            programs.NAME: "name of the program that is called",
            "N": "block number",
            "G": "preparatory code",
            **dict.fromkeys("XYZABCUVW", "axis"),
            "I": "centre along X, from the start of the arc; scale of X",
            "J": "centre along Y; scale of Y",
            "K": "centre along Z; scale of Z; holes that a cycle's block drills",
            ",R": "radius that rounds the corner at the block's end",
            ",C": "chamfer of the corner at the block's end",
            "R": "radius of the arc, negative: the larger of the two; plane where a cycle's feed begins; angle of G68",
            "P": "milliseconds of a dwell; program or block; work offset of G54.1; scale of G51",
            "Q": "depth of a peck; shift of G76 and G87",
            "L": "how often a subprogram runs (a cycle: K); kind of data of G10",
            "D": "row of the tool radius",
            "H": "row of the tool length",
            "F": "feed",
            "S": "spindle speed",
            "T": "tool",
            "M": "machine function",
        },
    ),
    rules=Rules(
        memory=FanucMemory,
        prepare=prepare,
        read_variable=variables.read_variable,
        write_variable=variables.write_variable,
        is_local=variables.is_local,
        before_motion=_before_motion,
        after_motion=after_motion,
        finish=programs.finish,
        acts_on_lines=acts_on_lines,
        without_point=decimal_point.addresses_without_point,
        increment=decimal_point.increment_of_plain_move,
        count=as_read,
        feed_rule=motion.fanuc_rule,
        length_by_code=True,
    ),
    units='mm, inches (G20), degrees; numbers without a point count 0.001 mm, 0.0001 inch or 0.001 degree, unless decimal_point = "calculator"; F in mm/min',
    job_keys=frozenset(JobKey),
    decisions=DECISIONS,
    marks=(
        *_FAMILY,
        Mark(r"\bG54\.1[ \t]*P", "G54.1 P"),
        Mark(r"\bG0?5\.1[ \t]*Q|\bG0?5[ \t]*P10000\b", "G5.1 Q, G5 P10000"),
        Mark(r"\bG5[01]\.1\b", "G50.1, G51.1 (mirror)"),
        Mark(r"\bM98[ \t]*P[ \t]*[0-9]{6,}", "M98 P00021000"),
        Mark(r"\b(?:M98|G6[56])[ \t]*<", "M98 <NAME>, G65 <NAME> (a call by name)"),
        Mark(r"\bG0?7\.1[ \t]*C", "G7.1 C"),
        Mark(r"\bG43\.4\b|\bG68\.2\b", "G43.4, G68.2"),
        shared_marks.CYLINDER,
        shared_marks.POINT_CODES,
        shared_marks.TURNED_COMPENSATION,
        shared_marks.BACK_BORING_WITH_I,
        shared_marks.CORNER_ARC,
        shared_marks.G31_WITH_Q,
        shared_marks.ADDITIONAL_OFFSET,
    ),
    library=programs.LIBRARY,
)

HAAS = dataclasses.replace(
    FANUC,
    name="haas",
    title="Haas (mills)",
    syntax=dataclasses.replace(FANUC.syntax, names=programs.NAMED_BEGIN),
    codes=dataclasses.replace(
        FANUC.codes,
        last_of_group_counts=False,
        groups=haas.GROUPS,
        g=haas.haas_codes(),
        replacements={**codes.REPLACEMENTS, **haas.REPLACEMENTS},
        start=haas.START,
        m=haas.HAAS_M_CODES,
    ),
    words=dataclasses.replace(
        FANUC.words,
        meanings={
            **{each: text for each, text in FANUC.words.meanings.items() if each != programs.NAME},
            "I": "centre along X, from the start of the arc; first radius of G12 and G13; first peck (G73, G83)",
            "J": "centre along Y; less depth of each peck (G73, G83); how fast a tap comes back (G74, G84)",
            "K": "centre along Z; last radius of G12 and G13; least peck (G73, G83)",
            "L": "how often a subprogram runs; holes that a cycle's block drills; kind of data of G10",
            "P": "dwell, seconds with a point, else milliseconds; program or block; work offset of G154",
            "Q": "depth of a peck; how much each circle of G12 and G13 is larger",
            "E": "deviation at corners (G187)",
        },
    ),
    rules=dataclasses.replace(
        FANUC.rules,
        memory=lambda: FanucMemory(HAAS_VARIANT),
        before_motion=before_motion,
        feed_rule=motion.haas_rule,
    ),
    units=FANUC.units.replace("F in mm/min", "F in mm/min, without a point 0.001 mm/min"),
    job_keys=frozenset({JobKey.DECIMAL_POINT, JobKey.OFFSET_ROWS}),
    decisions=haas.DECISIONS,
    marks=(
        *_FAMILY,
        Mark(r"\bG154[ \t]*P", "G154 P"),
        Mark(r"\bM97[ \t]*P", "M97 P"),
        Mark(r"\bG1[23](?![.0-9])[^GXY]*\bI[ \t]*[.0-9]", "G12 or G13 with I"),
        shared_marks.ADDITIONAL_OFFSET,
        shared_marks.BUILDERS_CODE,
        shared_marks.G103_WITH_P,
        shared_marks.PECKS_WITH_I,
        shared_marks.G36_WITH_I,
        shared_marks.G102,
        shared_marks.G136,
        shared_marks.CYLINDER,
    ),
)
"""The Haas mills."""
