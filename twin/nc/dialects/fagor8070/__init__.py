"""Fagor CNC 8070, milling model."""

from twin.nc.control.codes import Codes, MCode, Words
from twin.nc.control.control import Control, Rules
from twin.nc.control.dialect import Dialect
from twin.nc.control.settings import ControlSettings
from twin.nc.dialects.fagor8070 import arcs, statements, subroutines, variables
from twin.nc.dialects.fagor8070.codes import (
    CODES,
    REPLACEMENTS,
    auxiliary,
    plain_dwell,
    prepare_blends,
)
from twin.nc.dialects.fagor8070.decisions import DECISIONS
from twin.nc.dialects.fagor8070.frames import frames, inclined_planes
from twin.nc.dialects.fagor8070.memory import FagorMemory, acts_on_lines
from twin.nc.dialects.fagor8070.subroutines import LIBRARY
from twin.nc.iso import base, shared_marks
from twin.nc.iso.declared import flow_function
from twin.nc.iso.orientation.rotary_targets import turn_by_sign
from twin.nc.path.feed_rates import PATH_COUNTS, FeedRule
from twin.nc.text.syntax import Comment, Mark, Syntax


def _prepare(control: Control) -> None:
    subroutines.begin(control)
    prepare_blends(control)


def _before_motion(control: Control, _rapid: bool) -> None:
    turn_by_sign(control)
    inclined_planes.before_motion(control)


def _after_motion(control: Control) -> None:
    inclined_planes.after_motion(control)
    subroutines.call_after_motion(control)


def _feed_rule(settings: ControlSettings) -> FeedRule:
    """F counts X, Y and Z; with FEEDND rotary axes too, a degree as one programmed unit."""
    return FeedRule(degree=1.0) if settings.feed_of_all_axes else PATH_COUNTS


FAGOR8070 = Dialect(
    name="fagor8070",
    title="Fagor CNC 8070 (milling)",
    code_page="cp1252",
    syntax=Syntax(
        address=(
            r"G0*4(?=[ \t]+[0-9.])|G263[ \t]*=|G159[ \t]*=|R1[ \t]*="
            r"|[XYZABCUVW]1?[ \t]*=|[DFIJKQRST][ \t]*=|NR|[A-Z]"
        ),
        comments=(Comment("(", ")"), Comment(";")),
        expressions=variables.EXPRESSIONS,
        statement=statements.PATTERN,
        label=r"\[[ \t]*([A-Z_]\w*)[ \t]*\]",
        incremental_suffix=True,
        aliases={
            **{f"{axis}1": axis for axis in "XYZABCUVW"},
            **{f"G{'0' * zeros}4": "G04" for zeros in range(4)},
        },
    ),
    codes=Codes(
        groups=(
            "units",
            "plane",
            "distance",
            "centre",
            "feed",
            "corner",
            "offset",
            "return plane",
            "compensation corners",
            "compensation leads",
            "compensation",
            "motion",
            "cycle",
        ),
        g=CODES,
        replacements=REPLACEMENTS,
        start=(1, 17, 40, 50, 71, 80, 90, 94, 97, 98, 108, 137, 139, 152, 197, 262, 265),
        m={
            **base.M_CODES,
            6: MCode(meaning="tool change", action=frames.change_tool, basis="manual"),
            17: flow_function("end of subroutine", Control.go_back),
            19: MCode(meaning="spindle orientation", basis="manual"),
            29: flow_function("end of subroutine", Control.go_back),
            **{number: MCode(meaning="spindle gear", basis="manual") for number in range(41, 45)},
        },
        statements=statements.STATEMENTS,
        other_statement=statements.other_statement,
        start_state={"square_corners": True},
    ),
    words=Words(
        motion=frozenset("XYZABCUVWIJKRQ") | {"R1"},
        repeat="NR",
        actions={
            "F": base.set_feed,
            "S": base.spindle_speed,
            "T": frames.next_tool,
            "D": frames.tool_offset,
            "H": auxiliary,
            "G04": plain_dwell,
            "G159": frames.numbered_offset,
            "G263": arcs.set_circle_radius,
        },
        meanings={
            "N": "block number",
            "G": "preparatory code",
            **dict.fromkeys("XYZABCUVW", "axis; as X1= and with a trailing I (incremental) too"),
            "I": "centre along X; abscissa of G30; depth of a cycle; size of G36 and G39",
            "J": "centre along Y; ordinate of G30; number of pecks",
            "K": "centre along Z; pitch of a helix; seconds of G04 and of a cycle",
            "R": "polar radius; radius of the arc in a block with a coordinate of the plane",
            "R1": "radius of the arc, in force as G263=",
            "Q": "polar angle; direction of a chord; angle of G73",
            "F": "feed",
            "S": "spindle speed; scale of G72",
            "T": "tool",
            "D": "tool offset: 1, or 0 for none; distance to the surface of a cycle",
            "B": "B axis; depth of a pass or of the first peck of a cycle",
            "L": "subroutine; finishing stock of a cycle",
            "H": "auxiliary function",
            "M": "machine function",
            "NR": "how often the block runs",
            "G04": "seconds of a dwell",
            "G159": "number of a work offset",
            "G263": "radius of the arcs that follow",
        },
    ),
    rules=Rules(
        memory=FagorMemory,
        before_motion=_before_motion,
        read_variable=variables.read_variable,
        is_local=variables.is_local,
        prepare=_prepare,
        after_motion=_after_motion,
        finish=statements.warn_of_missing_end,
        acts_on_lines=acts_on_lines,
        feed_rule=_feed_rule,
    ),
    units="mm, degrees; F in mm/min, for rotary axes alone in deg/min",
    decisions=DECISIONS,
    marks=(
        Mark(
            r"^(?!.*\b(?:G0*(?:8\d|7[346]|10|6[56])\b|[XY][ \t]*[-+.\d]))"
            r"(?=.*\bG0*[0-3]\b|(?!.*\bZ))[^\"$;]*\bR[ \t]*[\d.]+.*\bQ[ \t]*-?[\d.]+",
            "polar coordinates R and Q without X and Y",
        ),
        Mark(r"\bG0*30[ \t]*[IJ]|\bG0*26[1-5]\b", "G30 with I or J, G261 to G265"),
        Mark(r"\bG0*8[124568]\b.*\bI[ \t]*-?[\d.]", "a cycle with its depth in I"),
        Mark(r"\bG(?:13[7-9]|15[89]|10[89]|19[37])\b", "G137 to G139, G158, G159, G108, G193"),
        Mark(r"\bG0*72[ \t]*S", "G72 S"),
        Mark(r"^[ \t]*%[ \t]*L[ \t]+\w|^[ \t]*LL[ \t]+[A-Z]", "%L, LL (a local subroutine)"),
        Mark(r"\bNR[ \t]*\d", "NR (a repeated block)"),
        Mark(r"\$(?:IF|ELSE|ENDIF|WHILE|DO|ENDDO|FOR|SWITCH|GOTO)\b(?!\$)", "$IF, $WHILE, $GOTO"),
        Mark(
            r"#(?:RPT|TIME|CALL|PCALL|MCALL|RET|COMMENT|MCS|MSG|HSC|RTCP|CS|KIN|DGWZ|FLUSH|ROUNDPAR)\b",
            "#RPT, #CALL, #TIME, #MCS, #MSG",
        ),
        Mark(r"\bG51[ \t]*A[\d.]+[ \t]*E|\bG501\b", "G51 A E, G501"),
        shared_marks.NO_OFFSET,
        Mark(r"\bV\.(?:A|G|TM|P|S)\.[A-Z]", "V.A.ORGT[1].X, V.P.name"),
        Mark(r"\bP\d+[ \t]*=", "P1= (a parameter)"),
        Mark(r"\b[XYZC]-?[\d.]+I(?![\d-])", "X20I (one word incremental)"),
        Mark(r"^(?!.*\bG0*7[45]\b).*\b[XYZ]1[ \t]*=", "X1="),
        shared_marks.SEMICOLON,
        shared_marks.PECKS_WITH_I,
        shared_marks.BACK_BORING_WITH_I,
        shared_marks.G31_WITH_Q,
        shared_marks.G36_WITH_I,
        shared_marks.CORNER_ARC,
        shared_marks.G73_WITH_Q,
        shared_marks.G102,
        shared_marks.G103_WITH_P,
        shared_marks.ADDITIONAL_OFFSET,
        shared_marks.G136,
        shared_marks.BUILDERS_CODE,
    ),
    library=LIBRARY,
)
