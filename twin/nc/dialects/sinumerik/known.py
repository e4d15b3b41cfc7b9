"""What the SINUMERIK knows and what moves nothing here, or what the twin does not follow, by its name.

Meanings are those of the programming manuals (fundamentals, job planning).
"""

from collections.abc import Mapping


def each_name(of_names: Mapping[str, str]) -> dict[str, str]:
    """What is said of every name, given that of names with commas between them."""
    return {name: said for names, said in of_names.items() for name in names.split(", ")}


_DYNAMICS = "acceleration and jerk are the machine file's"
_ORIENTATION = (
    "between two blocks the rotary axes go evenly, as ORIAXES says, and vectors count in the part"
)
_TOOL_FRAME = "the twin's tools stand along Z"
_NO_TILT = "the twin transforms no orientation; post the part for the axes that the machine has"
_SPLINES = "splines of this control are not simulated; write lines and arcs"
_PROBE = "the twin has no probe to touch with"
_OTHER_CHANNEL = "the machine has one channel"
_COUPLING = "couplings of axes are not simulated"

PASSED_CODES: Mapping[str, str] = {
    "BRISK, SOFT, DRIVE": _DYNAMICS,
    "FFWON, FFWOF": "the twin's drives have the feedforward of the machine file",
    "DYNNORM, DYNPOS, DYNROUGH, DYNSEMIFIN, DYNFINISH, DYNPREC": _DYNAMICS,
    "COMPON, COMPCURV, COMPCAD, COMPSURF": "the compressor may leave the lines by its tolerance; the twin drives them",
    "COMPOF": "no compressor",
    "CFC, CFTCP, CFIN": "F counts the path of the tool's centre",
    "FNORM": "the feed is what F says",
    "RTLION": "rapids go straight",
    "STARTFIFO, STOPFIFO, FIFOCTRL": "blocks are not buffered here",
    "DIAMOF": "a mill has no diameters",
    "WALIMON, WALIMOF": "the working area is the machine's travel",
    "CUT2D": "compensation in the working plane",
    "CP": "path motion",
    "ORIWKS, ORIAXES, ORIVECT, ORIC, ORID, OSOF, OSC, OSS, OSSE": _ORIENTATION,
    "SPCOF, ASPCOF": "no analogue spindle",
    "CPRECOF, CPRECON": "the twin keeps to the contour as its drives do",
    "PAROTOF, TOROTOF": "no frame of the tool's orientation is in force",
    "RMB, RMI, RME, RMN": "where a stopped program is resumed",
    "TCOABS, TCOFR": _TOOL_FRAME,
    "LFOF, SPOF, CUTCONOF": "what it ends is not in force",
    "SBLON, SBLOF": "single block",
    "DISPLOF, DISPLON": "what the screen shows",
}
"""Names of codes that change nothing of the path, and why."""

REFUSED_CODES: Mapping[str, str] = {
    "ASPLINE, BSPLINE, CSPLINE, POLY": _SPLINES,
    "INVCW, INVCCW": "involutes are not simulated",
    "KONTC, KONTT": "leads by curves are not simulated; KONT goes around the contour's ends",
    "DIAMON, DIAM90, DIAMCYCOF": "a mill has no diameters",
    "ROTS, AROTS, CROTS": "write ROT X Y Z",
    "TOFRAME, TOFRAMEX, TOFRAMEY, TOFRAMEZ, TOROT, TOROTX, TOROTY, TOROTZ, PAROT": _NO_TILT,
    "CUT2DF, CUT3DC, CUT3DF, CUT3DFS, CUT3DFF": "compensation acts in G17, G18 and G19",
    "FLIN, FCUB, FPO": "feeds that change along a block are not simulated",
    "RTLIOF": "rapids of single axes: every move of the twin goes straight",
    "CDON, CDOF2": "the search for narrow places cannot be chosen",
    "ORIMKS": "vectors count in the part; write ORIWKS",
    "ORIEULER, ORIRPY, ORIRPY2": "A2=, B2= and C2= are not followed; post vectors A3= B3= C3=, or the rotary axes",
    "ORICURVE, ORIPLANE, ORICONCW, ORICONCCW, ORICONIO, ORICONTO, ORIVIRT1, ORIVIRT2": _NO_TILT,
    "PON, PONS, SON, SONS": "a mill does not punch",
    "RTLIOF1": "every move of the twin goes straight",
}
"""Names of codes that the twin does not follow, and why or what to write."""

PASSED_STATEMENTS = each_name(
    {
        "MSG": "a message to the operator",
        "STOPRE": "nothing is read ahead here",
        "GROUP_BEGIN, GROUP_END, GROUP_ADDEND": "the editor's groups of blocks",
        "WAITP, WAITS": "every move has ended before the next block",
        "SETMS": "the machine has one spindle",
        "DELDTG": "nothing was left to go",
        "CDOF": "compensation looks as far ahead as it does",
        "PROTA, PROTS": "collisions are watched by the machine's model",
        "CYCLE832": "tolerance and dynamics of high-speed settings; the machine file has its own",
        "ACC, JERKLIM, VELOLIM, ACCLIMA, VELOLIMA, JERKLIMA": _DYNAMICS,
        "UPATH, SPATH, FGROUP": "F counts the path in X, Y and Z",
        "ACTBLOCNO": "what the screen shows",
        "SYNR, SYNW, SYNRW": "when variables are written",
        "GETD, RELEASE, GET": _OTHER_CHANNEL,
        "CPROT, CPROTDEF, NPROT": "collisions are watched by the machine's model",
        "TANGOF, COUPOF, TRAILOF, LEADOF, MASLOF": "what it ends is not in force",
    }
)
"""Statements that change nothing of the path, and why."""

REFUSED_STATEMENTS = each_name(
    {
        "TRACON, TRAANG": _NO_TILT,
        "FGREF": "F counts degrees where rotary axes move alone",
        "FL, FA": "the machine file limits the axes; F is the feed of the path",
        "ISOCALL": "programs of the ISO mode are another language; --dialect fanuc reads them",
        "TRANSMIT, TRACYL": "write the rotary axis itself",
        "DEFINE": "macros of texts are not followed; write the words that they stand for",
        "G291": "the ISO language of this control is another one",
        "MEAS, MEAW, MEASA, MEAWA, MEAC, CYCLE971, CYCLE976, CYCLE977, CYCLE978, CYCLE979, CYCLE982, CYCLE996, CYCLE998, CYCLE961, CYCLE997, CYCLE995, CYCLE9960": _PROBE,
        "TANG, TANGON, TLIFT, TRAILON, COUPDEF, COUPON, LEADON, CTABDEF, CTABEND, MASLON, EGDEF, EGON, CPON, CPLON": _COUPLING,
        "INIT, START, WAITM, WAITMC, WAITE, SETM, CLEARM, WAITMC": _OTHER_CHANNEL,
        "WRITE, READ, DELETE, ISFILE, FILEDATE, EXTOPEN, EXTCLOSE": "programs read and write no files here",
        "SETINT, CLRINT, ENABLE, DISABLE, REPOSL, REPOSQ, REPOSH, REPOSA, ASUP": "nothing interrupts the twin's program",
        "SETAL": "the program stops itself with an alarm",
        "IDS, ID, WHEN, WHENEVER, EVERY, FROM, DO, CANCEL": "synchronised actions are not simulated; write the blocks one after the other",
        "NEWT, DELT, GETSELT, GETEXET, SETPIECE, SETDNO, GETDNO, CHKDNO, TCA, TCI, POSM": "the tools are those of the job",
        "POLF, POLFMASK, POLFMLIN, LFPOS": "the twin does not lift the tool off by itself",
        "POS, POSA, POSP, OS, OSCTRL, OSNSC, OST1, OST2, OSE, OSP1, OSP2": "axes go with the path here; write G0 or G1",
        "FXS, FXST, FXSW": "the twin has no fixed stop",
        "G63, G331, G332": "write CYCLE84 or CYCLE840",
        "CONTPRON, CONTDCON, EXECUTE, EXECTAB, INTERSEC, ISPOINTS, CALCFIR, CALCDAT": "tables of contours are not simulated",
        "SPLINEPATH": _SPLINES,
        "CYCLE60": "engraving of texts is not simulated; post the letters as lines",
        "CYCLE62": "it names the contours of CYCLE63 and CYCLE64, which are not followed",
        "CYCLE63, CYCLE64": "pockets and spigots of any contour are not simulated; post their paths",
        "CYCLE70": "thread milling is not simulated; post the helix as G2 or G3 with TURN=",
        "CYCLE76, CYCLE77": "spigots are not simulated; write their contour with G41 or G42",
        "CYCLE78": "drilling and thread milling in one is not simulated",
        "CYCLE79": "polygons are not simulated; write their contour with G41 or G42",
        "CYCLE73, CYCLE74, CYCLE75": "pockets of any contour are not simulated; post their paths",
        "CYCLE802": "it drills a list of places; write MCALL and the places",
        "CYCLE899": "open slots are not simulated; write their path",
        "CYCLE93, CYCLE94, CYCLE95, CYCLE96, CYCLE97, CYCLE98, CYCLE92, CYCLE951, CYCLE952, CYCLE930, CYCLE940, CYCLE99": "it turns, and this is a mill",
        "CYCLE116, CYCLE100": "it is a cycle of measuring",
        "POCKET1, POCKET2, CIRCULARPOCKET": "it is the cycle of older controls; write POCKET3 or POCKET4",
        "CUST_800, CUST_832": "it belongs to the machine's builder",
    }
)
"""Statements that the twin does not follow, and why or what to write."""
