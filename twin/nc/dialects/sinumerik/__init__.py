"""SINUMERIK 840D sl, ONE, 828D, milling."""

from twin.nc.control.codes import Codes, MCode, WordAction, Words
from twin.nc.control.control import Control, Rules
from twin.nc.control.dialect import Dialect
from twin.nc.dialects.sinumerik import frames, statements, words
from twin.nc.dialects.sinumerik.codes import CODES, NUMBERS, REPLACEMENTS
from twin.nc.dialects.sinumerik.decisions import DECISIONS
from twin.nc.dialects.sinumerik.flow import calls, programs
from twin.nc.dialects.sinumerik.memory import SinumerikMemory, acts_on_lines
from twin.nc.dialects.sinumerik.variables import variables
from twin.nc.dialects.sinumerik.variables.expressions import EXPRESSIONS, NAME
from twin.nc.iso import base, shared_marks
from twin.nc.iso.declared import flow_function
from twin.nc.path.compensation.gouge import NEIGHBOURS
from twin.nc.text.blocks import Word
from twin.nc.text.syntax import Comment, Mark, Syntax

_LONG = "|".join(sorted(statements.LONG_WORDS, key=len, reverse=True))

_OFFSET = r"G5(?=(?:0[5-9]|[1-9][0-9])(?![0-9.]))"
"""G505 to G599: a word whose value is the number less 500."""


def _prepare(control: Control) -> None:
    programs.begin(control)
    words.prepare_corners(control)


def _finish(control: Control) -> None:
    if control.program_counter.is_calling:
        message = "the subprogram ends without M17 or RET"
        control.report.fail("return-outside", message, hint="write M17 or RET at its end")
    control.report.warn("no-end", "the program ends without M30", hint="write M30 at its end")


def _refused_word(meaning: str) -> WordAction:
    def action(control: Control, word: Word) -> None:
        control.fail("unsupported-word", f"{word.address}= ({meaning}) is not simulated", word)

    return action


SINUMERIK = Dialect(
    name="sinumerik",
    title="SINUMERIK 840D sl, ONE, 828D (milling)",
    code_page="cp1252",
    syntax=Syntax(
        address=rf"AX[ \t]*\[[^\]]*\][ \t]*=|(?:{_LONG})[ \t]*=|[MS]1[ \t]*=|[XYZABC]1?[ \t]*=|[ABC]3[ \t]*=|[A-Z][ \t]*=|{_OFFSET}|[A-Z]|:",
        comments=(Comment(";"),),
        expressions=EXPRESSIONS,
        statement=statements.PATTERN,
        label=rf"({NAME})[ \t]*:(?!=)",
        skip_levels=range(10),
        forms={"IC": True, **dict.fromkeys(("AC", "DC", "ACP", "ACN", "QU"), False)},
        codes=NUMBERS,
        texts=frozenset("T"),
        computed_behind="=",
        aliases={
            ":": "N",
            "G5": "G505",
            "M1": "M",
            "S1": "S",
        },
    ),
    codes=Codes(
        start_state={"look_ahead": NEIGHBOURS},
        groups=(
            "language",
            "units",
            "plane",
            "distance",
            "feed",
            "corner",
            "exact stop",
            "corner override",
            "offset",
            "compensation corners",
            "compensation leads",
            "lead side",
            "leads",
            "compensation watch",
            "compensation",
            "spindle",
            "orientation frame",
            "orientation",
            "motion",
        ),
        g=CODES,
        replacements=REPLACEMENTS,
        start=(1, 17, 40, 60, 71, 90, 94, 97, 140, 290, 340, 450, 460, 601, NUMBERS["NORM"]),
        m={
            **base.M_CODES,
            **{
                number: flow_function(meaning, calls.end_of_program(number), "stop")
                for number, meaning in (
                    (2, "end of program, or of a subprogram"),
                    (17, "end of subprogram"),
                    (30, "end of program, or of a subprogram"),
                )
            },
            6: MCode(meaning="tool change", action=words.change_tool, basis="manual"),
            19: MCode(meaning="spindle positioning", basis="manual"),
            70: MCode(meaning="spindle as an axis", basis="manual"),
            **{number: MCode(meaning="spindle gear", basis="manual") for number in range(40, 46)},
        },
        statements=statements.STATEMENTS,
        other_statement=statements.other_statement,
    ),
    words=Words(
        motion=frozenset("XYZABCUVWIJK")
        | {"CR", "AR", "AP", "RP", "TURN", "I1", "J1", "K1", "ANG", "A3", "B3", "C3"},
        indexed=variables.indexed_axis,
        actions={
            "F": words.set_feed,
            "FB": words.feed_of_block,
            "S": base.spindle_speed,
            "T": words.next_tool,
            "D": words.tool_offset,
            "H": words.auxiliary,
            "G505": frames.numbered_offset,
            "ADIS": words.corner_distance,
            "ADISPOS": words.rapid_corner_distance,
            "OFFN": words.set_allowance,
            "DISC": words.circumvention,
            "RNDM": words.modal_rounding,
            "SPOS": words.position_spindle,
            "SPOSA": words.position_spindle,
            "LIMS": words.speed_limit,
            **dict.fromkeys(("CTOL", "OTOL"), words.compressor_tolerance),
            "FRC": _refused_word("the feed of a rounded or cut corner"),
            "FRCM": _refused_word("the feed of rounded and cut corners"),
            "OVR": _refused_word("a feed override of the program"),
            "OVRRAP": _refused_word("a rapid override of the program"),
            "DISRP": _refused_word("the height over which a smooth lead begins"),
        },
        meanings={
            "N": "block number; : of a main block",
            "G": "preparatory code",
            **dict.fromkeys(
                "XYZABCUVW", "axis; X=IC(5), AC(5), of a rotary one DC(5), ACP(5), ACN(5) too"
            ),
            "I": "centre along X from the start of the arc; I=AC(5) from zero",
            "J": "centre along Y",
            "K": "centre along Z",
            "I1": "point between of CIP along X",
            "J1": "point between of CIP along Y",
            "K1": "point between of CIP along Z",
            "CR": "radius of the arc, negative: the larger of the two",
            "AR": "opening angle of the arc, with its end or its centre",
            "TURN": "further whole turns of the arc",
            "AP": "polar angle about the pole",
            "RP": "polar radius about the pole",
            "ANG": "direction of a line that one coordinate ends",
            "RPL": "angle of ROT and AROT in the plane",
            "F": "feed; seconds of G4",
            "FB": "feed of this block alone",
            "S": "spindle speed; revolutions of G4",
            "T": 'tool, by number or by name: T="MILL"',
            "D": "tool edge: 1, or 0 for none",
            "H": "auxiliary function",
            "G505": "G505 to G599: work offset of the job",
            "M": "machine function",
            "ADIS": "how far G641 and G642 may leave the corner",
            "ADISPOS": "the same of rapids: no change here",
            "RND": "radius of the corner to the next move",
            "RNDM": "radius of all corners that follow; 0: none",
            "CHF": "length of the chamfer to the next move",
            "CHR": "width of that chamfer along the moves",
            "OFFN": "allowance of the contour under compensation",
            "DISC": "how G450 passes corners: 0 on an arc, 100 by the intersection",
            "SPOS": "angle at which the spindle stops",
            "SPOSA": "the same, without waiting for it",
            "LIMS": "largest speed of G96: no change here",
            **dict.fromkeys(("CTOL", "OTOL"), "tolerance of the compressor: no change here"),
            "FP": "number of the fixed point of G75",
            **{f"{axis}1": f"axis {axis} of the machine, of G74 and G75" for axis in "XYZABC"},
            **{f"{axis}3": "direction of the tool, from its tip, under TRAORI" for axis in "ABC"},
            "AX": "axis that a variable holds: DEF AXIS NAME=X, AX[NAME]=10",
            "FRC": "refused: feed of a corner",
            "FRCM": "refused: feed of corners",
            "OVR": "refused: feed override",
            "OVRRAP": "refused: rapid override",
            "DISR": "length or radius of a smooth lead",
            "DISCL": "height above the contour at which its rapid move ends; DISCL=AC(5) from zero",
            "FAD": "feed of its move down",
            "DISRP": "refused: height over which a smooth lead begins",
        },
    ),
    rules=Rules(
        memory=SinumerikMemory,
        before_motion=words.before_motion,
        read_variable=variables.read_variable,
        is_local=variables.is_local,
        prepare=_prepare,
        after_motion=words.after_motion,
        finish=_finish,
        acts_on_lines=acts_on_lines,
    ),
    units="mm, degrees; F in mm/min, for rotary axes alone in deg/min",
    decisions=DECISIONS,
    marks=(
        Mark(r"^[ \t]*%_N_|^;[ \t]*\$PATH=", "%_N_NAME_MPF, ;$PATH="),
        Mark(r"\b(?:CYCLE\d+|POCKET\d|HOLES\d|SLOT\d|LONGHOLE)\b", "CYCLE81(...), POCKET3(...)"),
        Mark(r"^[^;]*\b(?:MSG|WORKPIECE|SETAL|EXTCALL)[ \t]*(?:;|\(|$)", "MSG(...)"),
        Mark(r"\bMCALL\b", "MCALL"),
        Mark(
            r"\bA?(?:TRANS|ROT|MIRROR|SCALE)\b[ \t]*(?:[XYZ]|RPL|;|$)",
            "TRANS, ROT, MIRROR, SCALE",
        ),
        Mark(
            r"^[^;]*\b(?:SUPA|TRAORI|TRAFOOF|COMP(?:CAD|CURV|ON|OF)|FFWON|FFWOF|STOPRE|DIAMOF|KONT|CFC|CFTCP)\b",
            "SUPA, STOPRE, FFWON, COMPCAD",
        ),
        Mark(
            r"^[^;]*(?:\bCIP\b|\bCT\b(?=.*[XYZ])|\b(?:TURN|CR|AR|AP|RP|RND|RNDM|CHR|CHF|ADIS)[ \t]*=)",
            "CR=, AP=, TURN=, CIP",
        ),
        Mark(r"\b[XYZABCIJK][ \t]*=[ \t]*(?:IC|AC|DC|ACP|ACN)\b", "X=IC(5), I=AC(5)"),
        Mark(r"^[^;]*\bT[ \t]*=[ \t]*(?:\"|\d)", 'T="NAME"'),
        Mark(
            r"^[^;]*\bGOTO[FBC]\b|^[^;]*\bREPEATB?[ \t]+[A-Z]{2}"
            r"|^[ \t]*(?:N\d+[ \t]*)?(?:DEF|PROC|EXTERN)[ \t]+[A-Z]",
            "GOTOF, REPEAT, DEF, PROC",
        ),
        Mark(r"^[ \t]*(?:N\d+[ \t]*)?R\d+[ \t]*=", "R1= (a parameter)"),
        Mark(r"\$(?:TC|P|AA|AC|MN|MC|MA|SC|SN|A)_[A-Z]\w*(?!\w|\$)", "$P_UIFR, $AA_IM, $TC_DP"),
        Mark(
            r"\bG(?:50[5-9]|5[1-9]\d|60[123]|64[1-5]|45[01]|7[01]0|153|29[01])(?![.\d])",
            "G505, G601, G641, G450, G153, G710",
        ),
        shared_marks.NO_OFFSET,
        shared_marks.SEMICOLON,
        shared_marks.ADDITIONAL_OFFSET,
    ),
    tables={
        "What words were checked against": {
            "G147, G247, G347, DISR": "SINUMERIK 840D sl and 828D, fundamentals, 2.10.4",
            "RND, RNDM, CHF, CHR": "SINUMERIK 828D programming manual, 9.15",
        }
    },
    suffixes=programs.SUFFIXES,
    library=programs.LIBRARY,
)
