"""Tables of the page of Klartext besides those that every dialect has."""

from collections.abc import Mapping

from twin.nc.dialects.heidenhain.cycles import definitions
from twin.nc.dialects.heidenhain.statements import REFUSED

_KEYWORDS: Mapping[str, str] = {
    "BEGIN PGM, END PGM": "heading with the unit, and end",
    "BLK FORM": "blank: 0.1 and 0.2, CYLINDER; the stock of a raw program",
    "TOOL CALL": "tool with S, F, DL, DR; without one S and F alone",
    "TOOL DEF": "tool that comes next, with L and R its data",
    "L, LP": "straight line, by Cartesian or polar coordinates",
    "CC": "pole; its axes name the plane",
    "C, CR, CT": "arc about the pole, of a radius, tangential",
    "CP, CTP": "arc about the pole by an angle, also a helix; tangential to polar coordinates",
    "RND, CHF": "rounded and chamfered corner",
    "APPR, DEP": "lead to the contour and away: LT, LN, CT, LCT, with polar coordinates PLT, PLN, PCT, PLCT",
    "LBL, CALL LBL": "label, subprogram, part that is repeated (REP)",
    "CALL PGM": "program in another file",
    "FN 0 to FN 8, FN 13, Q1 =": "Q, QL and QR parameters and their formulas",
    "FN 9 to FN 12, IF": "jump where a condition holds",
    "FN 14": "the program stops itself",
    "FN 17, FN 18": "length and radius of tools; number, positions of axes",
    "QS1 =": "text, joined by ||",
    "STOP": "program stop",
    "CYCL DEF, CYCL CALL": "cycle, its call, also POS and PAT; M99, M89",
    "PATTERN DEF": "places of CYCL CALL PAT: POS, ROW, PAT, FRAME, CIRC, PITCHCIRC",
    "PLANE": "tilted plane: SPATIAL, PROJECTED, EULER, VECTOR, POINTS, RELATIV, AXIAL, RESET; MOVE, TURN, STAY, SEQ, TABLE ROT, COORD ROT",
    "FUNCTION": "TCPM with AXIS POS or SPAT, RESET TCPM, MODE MILL",
    "TRANS DATUM": "datum shift, AXIS and RESET",
}

_STEPS: Mapping[str, str] = {
    "1, 2, 4, 5": "old pecking, tapping, rectangular and circular pocket",
    "7, 8, 10, 11": "datum shift, mirror, rotation, scale",
    "9": "dwell",
    "13": "spindle orientation",
    "19": "tilted plane by spatial angles",
    "32": "tolerance of corners",
    "247": "preset",
}


def _cycle(number: int) -> str:
    definition = definitions.DEFINITIONS[number]
    needed = " ".join(f"Q{each}" for each in definition.needed)
    others = " ".join(f"Q{each}" for each in definition.others)
    only = "".join(f"; Q{each} {value:g} alone" for each, value in definition.only.items())
    return f"{definition.meaning}: {needed}; also {others}{only}"


_SOURCES: Mapping[str, str] = {
    "L, C, CC, CR, CT, LP, CP, LBL": "worked examples of the TNC 426 user's manual, 6.4",
    "262 to 265, 267": "TNC 426 user's manual, 8.3",
    "APPR, DEP": "TNC 640 ISO programming, 6.3; CT: TNC7 user's manual",
    "256, 257": "TNC 640 cycle programming, 5.6",
    "207, 251, 253": "programs of Autodesk Fusion's post",
}

TABLES: Mapping[str, Mapping[str, str]] = {
    "Keywords": _KEYWORDS,
    "Cycles": {**_STEPS, **{str(number): _cycle(number) for number in definitions.DEFINITIONS}},
    "Keywords that are refused": {keyword: reason for keyword, (reason, _) in REFUSED.items()},
    "Cycles that are refused": {str(n): text for n, text in definitions.REFUSED.items()},
    "What words were checked against": _SOURCES,
}
