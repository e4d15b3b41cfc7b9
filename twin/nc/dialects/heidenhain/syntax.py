"""How Klartext is written: keywords, words with and without values, Q parameters and their formulas."""

import math
import operator

from twin.nc.text.expressions import arithmetic
from twin.nc.text.expressions.expressions import ARITHMETIC, IN_DEGREES, ExpressionSyntax, Operator
from twin.nc.text.syntax import Comment, Syntax

_VALUE = r"(?=[ \t]*[-+]?[ \t]*(?:[.0-9]|Q))"
_AXES = "XYZABCUVW"

WORDED = frozenset(
    (
        *("L", "LN", "C", "CC", "CR", "CT", "LP", "CP", "CTP", "CYCL CALL", "CYCL CALL POS"),
        *(f"APPR {polar}{kind}" for kind in ("LT", "LN", "CT", "LCT") for polar in ("", "P")),
        *("DEP LT", "DEP LN", "DEP CT", "DEP LCT", "DEP PLCT"),
    )
)
"""Keywords behind which the words of a block stand."""

KEYWORDS = (
    r"BEGIN[ \t]+PGM|END[ \t]+PGM|BLK[ \t]+FORM|TOOL[ \t]+(?:CALL|DEF)|STOP\b|\*"
    r"|CYCL[E]?[ \t]+DEF|CYCL[ \t]+CALL[ \t]+(?:PAT|POS)\b|CYCL[ \t]+CALL\b|PATTERN[ \t]+DEF\b"
    r"|CALL[ \t]+(?:LBL|PGM|SELECTED[ \t]+PGM)|LBL(?![A-Z_])|FN[ \t]*[0-9]+[ \t]*:|IF\b"
    r"|(?:APPR|DEP)[ \t]+P?(?:LCT|LT|LN|CT)\b|RND\b|CHF(?![A-Z_])"
    r"|CTP\b|CC\b|CR\b|CT\b|CP\b|LP\b|LN\b|L(?=[ \t]|$)"
    r"|C(?=[ \t]+(?![-+.0-9]|Q[LR]?[0-9])|$)|Q[LR]?[0-9]{1,4}[ \t]*(?==)|QS[0-9]{1,4}[ \t]*(?==)"
    r"|PLANE\b|FUNCTION\b|TRANS\b|TCH[ \t]+PROBE|SEL[ \t]+[A-Z]+|CONTOUR[ \t]+DEF|GLOBAL[ \t]+DEF|DECLARE\b|ERROR\b"
    r"|F(?:LT|CT|L|C|POL|SELECT)(?![A-Z0-9_=])|SPL\b|APPR\b|DEP\b|POLARKIN\b|TABDATA\b|OPEN\b|CLOSE\b"
)
"""Keywords of Klartext, those that are refused among them; longer ones first."""

_OF_AXIS = r"M[ \t]*94[ \t]+[ABC](?![ \t]*[-+.0-9Q])"
"""M94 with the axis that it is for."""
_FEED_OF_M128 = rf"M128 F{_VALUE}"
"""M128 with the feed of the moves by which it makes up for what axes turn: the F behind it is no feed of the block."""
_ADDRESS = (
    rf"{_FEED_OF_M128}|I?(?:PR|PA){_VALUE}|[NT][XYZ]{_VALUE}|LIN_[XYZ]|I[{_AXES}]{_VALUE}|LEN|CCA|DL|DR{_VALUE}|DR2|DIST|RI|MB{_VALUE}|LA"
    rf"|FU|FZ|FT|R(?!0(?![.,0-9]))|L{_VALUE}|(?!{_OF_AXIS})[{_AXES}FSMDN]"
)
_FLAG = (
    rf"{_OF_AXIS}|"
    r"R(?=[ \t]|$)|R[LR](?![A-Z0-9_])|R0(?![.,0-9])|R[-+](?![ \t]*[.0-9Q])|DR[ \t]*[-+](?![ \t]*[.0-9Q])|F[ \t]*MAX|F[ \t]*AUTO"
    r"|MB[ \t]*MAX|[FM](?=[ \t]|$)"
)

Q_PARAMETER = r"Q[LR]?[0-9]{1,4}"

EXPRESSIONS = ExpressionSyntax(
    operators={
        **{name: each for name, each in ARITHMETIC.items() if name != "MOD"},
        "%": Operator(6, math.fmod),
        "DIV": Operator(6, operator.truediv),
        "^": Operator(7, math.pow),
        "LEN": Operator(5, math.hypot),
        "ANG": Operator(5, arithmetic.direction_from_zero),
    },
    functions={},
    constants={"PI": math.pi},
    variable=Q_PARAMETER,
    brackets="()",
    bracketed=True,
    one_sign=True,
    prefixes={
        **{name: function.compute for name, function in IN_DEGREES.items()},
        "SQ": lambda a: a * a,
        "LOG": math.log10,
        "NEG": operator.neg,
        "INT": int,
        "FRAC": arithmetic.fraction,
        "SGN": lambda a: (a > 0.0) - (a < 0.0),
    },
)
"""Formulas and the operators of FN 4, FN 8 and FN 13; angles are degrees (manual)."""

SYNTAX = Syntax(
    address=_ADDRESS,
    comments=(Comment(";"),),
    expressions=EXPRESSIONS,
    statement=KEYWORDS,
    worded=WORDED,
    line_keyword="L",
    flag=_FLAG,
    relative={**{f"I{axis}": axis for axis in _AXES}, "IPR": "PR", "IPA": "PA"},
    aliases={**{f"LIN_{axis}": axis for axis in "XYZ"}, "M128 F": "M128F"},
    decimal_comma=True,
    continued="~",
)
