"""Statements that the Fagor CNC 8070 knows and that move nothing here, or that this machine lacks.

Names and meanings are those of the control's quick reference; which of them programs hold was seen
in the output of published post-processors.
"""

from collections.abc import Mapping


def _each(of_keywords: Mapping[str, str]) -> dict[str, str]:
    """What is said of every keyword, given that of keywords with commas between them."""
    return {word: said for words, said in of_keywords.items() for word in words.split(", ")}


_BY_AXES = "write the rotary axes themselves, and #RTCP ON, which leads the tip while they turn"
_NO_SPLINES = "splines of this control are not simulated"
_NO_PROBE = "the twin has no probe to touch with"

PASSED_OVER = _each(
    {
        "#MSG": "a message to the operator",
        "#DGWZ": "the window of the control's graphics",
        "#FLUSH": "block preparation waits for the motion, and nothing is prepared ahead here",
        "#HSC": "high-speed machining; the tolerance of rounded corners is the machine file's",
        "#KIN ID": "the kinematics, of which the machine has one",
        "#SLOPE": "the shape of the acceleration, which is the machine file's",
        "#PATH": "the folder of subroutines, which are looked for beside the program",
        "#ESBLK, #DSBLK": "single block",
        "#ESTOP, #DSTOP": "the stop key",
        "#EFHOLD, #DFHOLD": "the feed hold key",
    }
)
"""What each is; none of them changes the path."""

ENDED_ONLY = _each(
    {
        "#TLC": "the length of the tool is that of the job, and #RTCP counts it",
        "#CSROT": _BY_AXES,
        "#TCAM": "electronic cams are not simulated",
        "#CAX, #FACE": "a spindle as an axis is not simulated",
        "#CYL": "wrapping around a cylinder is not simulated; write C itself",
        "#TANGCTRL": "the twin has no axis that turns the tool",
        "#SPLINE": _NO_SPLINES,
        "#VOLCOMP": "compensation tables are the machine file's",
    }
)
"""Why what they begin is not simulated; to end it, by OFF, changes nothing."""

REFUSED = _each(
    {
        "#DEFROT, #SELECT ORI": _BY_AXES,
        "#TOOL AX": "the tool lies along Z",
        "#KINORG": "the part's zero goes with the table where #RTCP ON leads the tip",
        "#ASPLINE, #POLY": _NO_SPLINES,
        "#PROBE, #SELECT PROBE": _NO_PROBE,
        "#ANGAX": "inclined axes are not simulated",
        "#LINK, #UNLINK, #SET AX, #CALL AX, #FREE AX, #RENAME AX, #PARK, #UNPARK": "the axes of the machine are those of its file",
        "#SERVO, #CD, #FOLLOW, #SYNC, #UNSYNC, #TSYNC, #TUNSYNC": "the drives are those of the machine file",
        "#MASTER": "the machine has one spindle",
        "#OPEN, #WRITE, #CLOSE, #DELETE": "programs read and write no files here",
        "#EXEC": (
            "it runs a whole program, in a channel that may be another one, and the twin runs one "
            "program; make that a subroutine, which ends with #RET, and call it by LL or #CALL"
        ),
        "#EXBLK": (
            "it runs a block that may belong to another channel, and the machine has one; write the "
            "block itself"
        ),
        "#DEF, #INIT MACROS": "macros are not simulated; write their text",
        "#MEET, #WAIT, #SIGNAL": "the machine has one channel",
        "#CONTJOG, #INCJOG, #MPG": "there is no operator",
        "#MEAS": _NO_PROBE,
        "#ABORT": "an interrupted program does not go on elsewhere here",
        "#CYCLE": "cycles of the editor are not simulated; write the G code",
    }
)
"""Why the twin does not follow them."""
