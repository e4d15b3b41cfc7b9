"""CODESYS SoftMotion CNC (DIN 66025 with SoftMotion's own codes)."""

from twin.nc.canonical import Corner
from twin.nc.control.codes import Codes, MCode, Words
from twin.nc.control.control import Control, Rules
from twin.nc.control.dialect import Dialect
from twin.nc.dialects.codesys import actions, program, subprograms, words
from twin.nc.dialects.codesys.actions import ADDITIONAL
from twin.nc.dialects.codesys.codes import CODES, REPLACEMENTS
from twin.nc.dialects.codesys.decisions import DECISIONS
from twin.nc.iso import base, shared_marks
from twin.nc.path.feed_rates import FeedMode
from twin.nc.text.syntax import HEADING, Comment, Mark, Syntax

CODESYS = Dialect(
    name="codesys",
    title="CODESYS SoftMotion CNC (DIN 66025)",
    code_page="cp1252",
    syntax=Syntax(
        address=r"FF|EF|[FE][XYZABCPQUVW](?![A-Z])|P[ABCPQUVW](?![A-Z])|L[?!]|[A-Z]",
        comments=(Comment("(*", "*)"), Comment("(", ")"), Comment("//"), HEADING),
        expressions=program.EXPRESSIONS,
        statement=program.STATEMENT,
        several_blocks=True,
        trailing_prose=True,
    ),
    codes=Codes(
        groups=(
            "plane",
            "distance",
            "centre",
            "offset",
            "length",
            "compensation",
            "smoothing",
            "loops",
            "motion",
        ),
        g=CODES,
        replacements=REPLACEMENTS,
        start=(15, 40, 50, 60, 90, 99),
        start_state={"feed_mode": FeedMode.PER_SECOND, "corner": Corner.EXACT_PATH},
        m={
            number: MCode(meaning="end of program", after_motion=True, ends=True)
            for number in (2, 30)
        },
        any_m=True,
        statements={
            "LET": program.let,
            "SUBPROGRAM": subprograms.define,
            **dict.fromkeys(("END_SUBPROGRAM", "RETURN"), Control.go_back),
        },
        other_statement=subprograms.assign_or_call,
    ),
    words=Words(
        axes=frozenset(f"XYZ{ADDITIONAL}"),
        motion=frozenset(f"XYZ{ADDITIONAL}IJKRT"),
        of_functions="KLO",
        references="O",
        signed=("E", "EF", *(f"E{letter}" for letter in f"XYZ{ADDITIONAL}")),
        series="HOL",
        actions={
            "F": base.set_feed,
            "E": words.set_acceleration,
            "E-": words.set_acceleration,
            "FF": words.set_rapid_feed,
            "EF": words.set_rapid_acceleration,
            "EF-": words.set_rapid_acceleration,
            "D": actions.set_smoothing,
            "S": words.refuse_profile,
            "L!": lambda _control, _word: None,  # a place to jump to
            **{f"P{letter}": words.set_period(letter) for letter in ADDITIONAL},
            **{f"F{letter}": words.axis_velocity(letter) for letter in f"XYZ{ADDITIONAL}"},
            **{
                f"E{letter}{sign}": words.axis_acceleration(letter)
                for letter in f"XYZ{ADDITIONAL}"
                for sign in ("", "-")
            },
        },
        spindle="",
        meanings={
            "N": "block number",
            "G": "preparatory code",
            "X": "X axis",
            "Y": "Y axis",
            "Z": "Z axis",
            **dict.fromkeys(ADDITIONAL, "additional axis, linear along the path"),
            "I": "centre along X; component of a normal or a vector",
            "J": "centre along Y",
            "K": "centre along Z; condition of a jump; angle of an ellipse; parameter of M",
            "R": "radius; short by long half axis of an ellipse",
            "T": "opening angle of an arc; seconds of G4; no tool",
            "F": "feed per second",
            "E": "acceleration per second squared",
            "E-": "deceleration per second squared, below 0",
            "FF": "feed of G0 per second; 0: as F",
            "EF": "acceleration of G0; 0: as E",
            "EF-": "deceleration of G0, below 0",
            "D": "tool radius; distance of smoothing; value of G36 and G37",
            "H": "switch point, negative: off",
            "O": "place of a switch point as a share; variable of G36 and G37; parameter of M",
            "L": "block to jump to; place of a switch point as a distance; axis of G70 and G71; "
            "parameter of M",
            "L?": "label to jump to, forwards",
            "L!": "label",
            "S": "profile of additional axes; 0 only",
            "M": "machine function",
            **dict.fromkeys(
                (f"P{each}" for each in ADDITIONAL), "modulo period of the axis; 0: none"
            ),
            **dict.fromkeys(
                (f"F{each}" for each in f"XYZ{ADDITIONAL}"), "largest velocity of the axis"
            ),
            **dict.fromkeys(
                (f"E{each}{sign}" for each in f"XYZ{ADDITIONAL}" for sign in ("", "-")),
                "largest acceleration of the axis; below 0 its largest deceleration",
            ),
        },
    ),
    rules=Rules(
        memory=program.CodesysMemory,
        before_motion=words.before_motion,
        read_variable=program.read_variable,
        is_local=program.is_local,
        given_variable=program.given_variable,
        place_switches=words.place_switches,
        prepare=words.prepare,
        acts_on_lines=program.acts_on_lines,
    ),
    units="mm, degrees; F in units per second, E in units per second squared",
    decisions=DECISIONS,
    marks=(
        Mark(r"^[^\"$;\[]*\bN[ \t]*\d+\b[^\"$;\[]*\bN[ \t]*\d+\b", "several N blocks on one line"),
        shared_marks.ARC_WITH_T,
        Mark(
            r"\bG0?[23]\b.*[IJK].*\bT[ \t]*(?:-|\d*\.\d)",
            "an arc with an opening angle T below 0 or with a point",
        ),
        Mark(r"\bG0?4[ \t]*T", "G4 T"),
        Mark(r"\bE[ \t]*\+?\d.*\bE[ \t]*-[ \t]*\d", "E20 E-30 (acceleration and deceleration)"),
        Mark(r"\$[A-Z_]\w*\$", "$variable$"),
        Mark(r"\bLET[ \t]+#|^[^;]*\bSUBPROGRAM\b", "LET, SUBPROGRAM"),
        Mark(r"\bG20[ \t]+L|\bL[?!][ \t]*\d", "G20 L, L?, L!"),
        Mark(r"\bG5[12][ \t]*D|\bG16[ \t]*[IJK]|\bG36\b.*\bD", "G51 D, G52 D, G16 I J K, G36 D"),
        Mark(r"\b(?:FF|P[ABC])[ \t]*\d", "FF, PA, PB, PC"),
        Mark(r"\bG0?[89]\b(?!.*\bG[ \t]*\d).*\bI.*\bK.*\bR[ \t]*-?[.\d]", "an ellipse: G8 I K R"),
        Mark(r"\bG7[01][ \t]+L[ \t]*\d(?!.*[IJK])", "G71 L6"),
        Mark(r"\bH[ \t]*-?\d+[ \t]*[OL][ \t]*-?[\d.]", "a switch point H with O or L"),
        Mark(
            r"[XYZ](?:[^ \t;$\"]*\b)?(?:SIN|COS|SQRT|PI)\b(?!\[)", "functions with round brackets"
        ),
    ),
    library=subprograms.LIBRARY,
)
