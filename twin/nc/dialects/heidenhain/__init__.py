"""HEIDENHAIN TNC 320 to 640, Klartext."""

from twin.nc.control.codes import Codes, Words
from twin.nc.control.control import Control, Rules
from twin.nc.control.dialect import Dialect
from twin.nc.dialects.heidenhain import feeds, flow, parameters
from twin.nc.dialects.heidenhain.cycles.planes import enter_plane
from twin.nc.dialects.heidenhain.decisions import DECISIONS
from twin.nc.dialects.heidenhain.functions import FUNCTIONS, reduce_rotary, turn_shortest
from twin.nc.dialects.heidenhain.memory import KlartextMemory, acts_on_lines, memory_of
from twin.nc.dialects.heidenhain.page import TABLES
from twin.nc.dialects.heidenhain.paths import corners, paths
from twin.nc.dialects.heidenhain.paths.leads import SIDES, compensation_word, refuse_paraxial
from twin.nc.dialects.heidenhain.statements import STATEMENTS, other_statement
from twin.nc.dialects.heidenhain.syntax import SYNTAX
from twin.nc.dialects.heidenhain.tool_tip import begin_tcpm_with_feed, take_spatial_angles
from twin.nc.iso import shared_marks
from twin.nc.iso.base import spindle_speed
from twin.nc.path.compensation.gouge import NEIGHBOURS
from twin.nc.text.blocks import Word
from twin.nc.text.syntax import Mark

_AXES = "XYZABCUVW"


def _nothing(_control: Control, _word: Word) -> None:
    """F or M without a value: what was in force stays."""


def _prepare(control: Control) -> None:
    corners.prepare(control)
    flow.pass_text_before_program(control)
    control.modal.interpolation = paths.LINE


def _before_motion(control: Control, _rapid: bool) -> None:
    take_spatial_angles(control)
    turn_shortest(control)
    enter_plane(control)


def _after_motion(control: Control) -> None:
    memory = memory_of(control)
    memory.was_rapid, memory.rapid, memory.machine = memory.rapid, False, ""


HEIDENHAIN = Dialect(
    name="heidenhain",
    title="HEIDENHAIN TNC 320 to 640 (Klartext)",
    code_page="cp1252",
    syntax=SYNTAX,
    codes=Codes(
        start_state={"look_ahead": NEIGHBOURS},
        groups=(),
        g={},
        start=(),
        m=FUNCTIONS,
        statements=STATEMENTS,
        other_statement=other_statement,
    ),
    words=Words(
        axes=frozenset(_AXES),
        motion=paths.MOTION_WORDS,
        before_codes=True,
        actions={
            "F": feeds.set_feed,
            "FU": feeds.set_feed_per_turn,
            "FAUTO": feeds.feed_of_tool,
            "FMAX": feeds.go_rapidly,
            "S": spindle_speed,
            **{name: compensation_word(side) for name, side in SIDES.items()},
            **dict.fromkeys(("M94A", "M94B", "M94C"), reduce_rotary),
            "M128F": begin_tcpm_with_feed,
            "R+": refuse_paraxial,
            "R-": refuse_paraxial,
        },
        meanings={
            **dict.fromkeys(_AXES, "axis; incremental as IX; as LIN_Z with an arc"),
            "PR": "polar radius; incremental as IPR",
            "PA": "polar angle; incremental as IPA",
            "R": "radius of CR, RND and a lead",
            **{f"N{axis}": "normal of the surface (LN)" for axis in "XYZ"},
            **{f"T{axis}": "direction of the tool, from its tip (LN)" for axis in "XYZ"},
            "LEN": "length of a straight lead",
            "CCA": "angle of a lead's arc",
            "DR+": "arc counter-clockwise",
            "DR-": "arc clockwise",
            "DR": "with a value: what TOOL CALL adds to the radius",
            "DL": "what TOOL CALL adds to the length",
            "DR2": "what TOOL CALL adds to the corner of the tool",
            "L": "length of TOOL DEF and BLK FORM",
            "F": "feed per minute",
            "FU": "feed per revolution of the spindle",
            "FZ": "feed per tooth",
            "FT": "seconds of a move",
            "FMAX": "this block as fast as the machine can",
            "FAUTO": "feed of TOOL CALL",
            "R0": "no radius compensation",
            "RL": "the tool left of the contour",
            "RR": "the tool right of the contour",
            "R+": "one axis longer by the radius",
            "R-": "one axis shorter by the radius",
            "S": "spindle speed",
            "M": "machine function",
            "M128F": "M128 with the feed of its own moves",
            "MB": "distance of M140; as MB MAX",
            "MBMAX": "M140 to the end of the travel",
            **{f"M94{axis}": f"M94 of the axis {axis} alone" for axis in "ABC"},
            "LA": "blocks that M120 looks ahead",
            "D": "diameter of BLK FORM CYLINDER",
            "DIST": "top of BLK FORM CYLINDER above the datum",
            "RI": "inner radius of BLK FORM CYLINDER",
        },
    ),
    rules=Rules(
        memory=KlartextMemory,
        prepare=_prepare,
        before_motion=_before_motion,
        after_motion=_after_motion,
        finish=flow.warn_of_missing_end,
        jog="L I{axis}{distance} F{feed}",
        read_variable=parameters.read_variable,
        is_local=parameters.is_local,
        acts_on_lines=acts_on_lines,
    ),
    units="mm or inches by BEGIN PGM, degrees; F in mm/min or tenths of an inch per minute",
    decisions=DECISIONS,
    marks=(
        Mark(r"^[ \t]*\d*[ \t]*(?:BEGIN|END)[ \t]+PGM\b", "BEGIN PGM, END PGM", decides=True),
        Mark(r"^[ \t]*\d*[ \t]*(?:BLK[ \t]+FORM|TOOL[ \t]+(?:CALL|DEF))\b", "BLK FORM, TOOL CALL"),
        Mark(r"^[ \t]*\d*[ \t]*CYCL[ \t]+(?:DEF|CALL)\b", "CYCL DEF, CYCL CALL"),
        Mark(r"^[ \t]*\d*[ \t]*(?:LBL|CALL[ \t]+LBL)[ \t]*[\d\"]", "LBL, CALL LBL"),
        Mark(r"^[ \t]*\d*[ \t]*FN[ \t]*\d+[ \t]*:", "FN 0:"),
        Mark(r"^[ \t]*\d*[ \t]*(?:APPR|DEP)[ \t]+P?L?(?:LT|LN|CT)\b", "APPR, DEP"),
        Mark(
            r"^[ \t]*\d*[ \t]*(?:L|LP|CP|CC|CR|CT)[ \t]+I?(?:[XYZABC]|P[RA])[ \t]*[-+]?[.\dQ]",
            "L X+10",
        ),
        Mark(r"\bF[ \t]*MAX\b", "FMAX"),
        shared_marks.SEMICOLON,
    ),
    tables=TABLES,
    library=flow.LIBRARY,
    suffixes=(".h",),
)
