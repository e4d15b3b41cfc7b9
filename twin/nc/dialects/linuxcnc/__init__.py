"""LinuxCNC 2.9, milling: RS274/NGC."""

from twin.nc.canonical import Corner
from twin.nc.control.codes import Codes, Words
from twin.nc.control.control import Control, Rules
from twin.nc.control.dialect import Dialect
from twin.nc.dialects.linuxcnc import flow, functions, motion, offsets, parameters
from twin.nc.dialects.linuxcnc.codes import CODES, GROUPS, START
from twin.nc.dialects.linuxcnc.decisions import DECISIONS
from twin.nc.dialects.linuxcnc.memory import LinuxcncMemory, memory_of
from twin.nc.dialects.linuxcnc.parameters import EXPRESSIONS
from twin.nc.dialects.linuxcnc.structure import COMMENTS, LIBRARY
from twin.nc.iso import base, shared_marks
from twin.nc.iso.orientation.rotary_targets import turn_by_sign
from twin.nc.text.syntax import Mark, Syntax

_LONGEST_LINE = 252
"""``rs274`` of 2.9 refuses a longer line as a command too long: its buffer of 255 takes the line's end too."""
_WITH_PITCH = (33, 33.1)
"""Codes whose feed follows from the spindle's speed."""


def _before_motion(control: Control, rapid: bool) -> None:
    turn_by_sign(control)
    memory, number = memory_of(control), control.modal.active.get("motion")
    if number not in _WITH_PITCH:
        motion.check_feed(control, rapid)
    if number != 5:
        memory.spline_end = None
    if memory.control_points and number != 5.2:
        control.report.line = memory.control_line
        control.report.fail("code-words", "a NURBS is ended by G5.3 before another motion")


def _acts_on_lines(control: Control) -> bool:
    """Compensation, absolute centres, a spline, or a feed of another unit, until the program writes one."""
    memory, modal = memory_of(control), control.modal
    return (
        control.settings.module_rotary
        or memory.compensation is not None
        or memory.leading_out
        or modal.center_absolute
        or bool(memory.control_points)
        or memory.spline_end is not None
        or memory.converted_feed is not None
    )


def _finish(control: Control) -> None:
    """The last line is reached without M2, M30 or a second %."""
    if control.program_counter.is_calling:
        control.report.fail("return-outside", "the subroutine has no endsub, return or M99")
    if not memory_of(control).percent_ended:
        hint = "write M2 or M30 at its end, or the program between two lines with %"
        control.report.fail("no-end", "the program ends without M2, M30 or %", hint=hint)


LINUXCNC = Dialect(
    name="linuxcnc",
    title="LinuxCNC 2.9 (RS274/NGC, milling)",
    code_page="cp1252",
    syntax=Syntax(
        address=r"[A-Z@^$]",
        comments=COMMENTS,
        expressions=EXPRESSIONS,
        statement=r"O(?=[ \t]*[0-9<#\[])|%",
        assigned="#",
        fractional_labels=True,
        blanks_in_numbers=True,
        longest_line=_LONGEST_LINE,
    ),
    codes=Codes(
        groups=GROUPS,
        g=CODES,
        replacements={
            15: "polar coordinates are @ and ^",
            16: "polar coordinates are @ and ^",
            50: "write G92.1, or scale by parameters",
            51: "scale by parameters",
            68: "rotate by G10 L2 P0 R and the angle",
            69: "end a rotation by G10 L2 P0 R0",
            65: "call by o<name> call [1] [2]",
            31: "probe by G38.3",
            12: "mill a circle by G2 or G3",
            13: "mill a circle by G2 or G3",
        },
        start=START,
        m=functions.M_CODES,
        statements={"O": flow.run_o_word, "%": flow.percent},
        start_state={"corner": Corner.CONTINUOUS},
    ),
    words=Words(
        of_declared="PQ",
        motion=frozenset("XYZABCUVWIJKR@^"),
        actions={
            "F": functions.set_feed,
            "$": functions.choose_spindle,
            "S": base.spindle_speed,
            "T": functions.select_tool,
        },
        before_codes=True,
        meanings={
            "N": "line number",
            "G": "preparatory code",
            **dict.fromkeys("XYZABCUVW", "axis"),
            "@": "polar radius",
            "^": "polar angle",
            "I": "centre along X, or to a control point; beside the hole (G87)",
            "J": "centre along Y, or to a control point; beside the hole (G87)",
            "K": "centre along Z; distance of each turn (G33); top of the counterbore (G87)",
            "R": "radius of the arc; R plane of a cycle; rotation (G10 L2); tool radius (G10 L1)",
            "P": "seconds; turns of an arc; number of a system, tool or program; corner tolerance",
            "Q": "depth of a peck; tool of M61; seconds of M66; tolerance of straight lines (G64)",
            "L": "kind of G10 and M66; repeats of a cycle; calls of M98; order of a NURBS",
            "D": "tool whose radius compensates; its diameter (G41.1)",
            "E": "analog input or output",
            "H": "tool whose length counts",
            "F": "feed",
            "S": "spindle speed",
            "T": "tool",
            "$": "spindle",
            "M": "machine function",
            "O": "label of a condition, a loop or a subroutine",
        },
    ),
    rules=Rules(
        memory=LinuxcncMemory,
        before_motion=_before_motion,
        read_variable=parameters.read_variable,
        write_variable=parameters.write_variable,
        is_local=parameters.is_local,
        given_variable=parameters.given_variable,
        prepare=offsets.begin,
        length_by_code=True,
        finish=_finish,
        acts_on_lines=_acts_on_lines,
    ),
    units="mm or inches (G20), degrees; F in mm/min, for rotary axes alone in deg/min",
    decisions=DECISIONS,
    marks=(
        Mark(
            r"^[ \t]*(?:N\d+[ \t]*)?O[ \t]*(?:<[^<>]*>|\d+)[ \t]*(?:sub|endsub|call|if|else|elseif|endif|while"
            r"|endwhile|do|repeat|endrepeat|return|break|continue)\b",
            "o100 sub, o<name> call (O-words)",
        ),
        Mark(r"#<\w+>", "#<name> (a named parameter)"),
        Mark(
            r"\bG(?:33\.1|43\.2|61\.1|90\.1|92\.[23]|59\.[123]|5\.[23])(?!\d)",
            "G61.1, G90.1, G43.2, G59.3 and others with a point",
        ),
        Mark(r"\bG0*64[ \t]*P0*\.\d", "G64 P0.01 (a tolerance)"),
        Mark(r"[@^][ \t]*-?[\d.]+", "@ and ^ (polar coordinates)"),
        shared_marks.PROGRAM_NUMBER,
        shared_marks.ARC_WITH_T,
        shared_marks.SEMICOLON,
        shared_marks.POINT_CODES,
        shared_marks.TURNED_COMPENSATION,
        shared_marks.STORED_POSITION_OR_PROBE,
        shared_marks.BACK_BORING_WITH_I,
        shared_marks.NUMBERED_PARAMETER_3000,
    ),
    library=LIBRARY,
)
