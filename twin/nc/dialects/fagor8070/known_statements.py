"""Statements that the Fagor CNC 8070 knows and that move nothing here, or that this machine lacks.

Names and meanings are those of the control's quick reference; which of them programs hold was seen
in the output of published post-processors.
"""

from collections.abc import Mapping


def _by_keyword(reasons: Mapping[str, str]) -> dict[str, str]:
    """What is said of each keyword, given the keywords, with commas between them, of which it is said."""
    return {word: said for said, words in reasons.items() for word in words.split(", ")}


PASSED_OVER = _by_keyword(
    {
        "a message to the operator": "#MSG",
        "the window of the control's graphics": "#DGWZ",
        "block preparation waits for the motion, and nothing is prepared ahead here": "#FLUSH",
        "high-speed machining; the tolerance of rounded corners is the machine file's": "#HSC",
        "the kinematics, of which the machine has one": "#KIN ID",
        "the shape of the acceleration, which is the machine file's": "#SLOPE",
        "the folder of subroutines, which are looked for beside the program": "#PATH",
        "single block": "#ESBLK, #DSBLK",
        "the stop key": "#ESTOP, #DSTOP",
        "the feed hold key": "#EFHOLD, #DFHOLD",
    }
)
"""What each is; none of them changes the path."""

_NO_TILT = "the machine's tool does not tilt"
_NO_SPLINES = "splines of this control are not simulated"

ENDED_ONLY = _by_keyword(
    {
        _NO_TILT: "#RTCP, #TLC",
        "electronic cams are not simulated": "#TCAM",
        "inclined planes are not simulated": "#CS, #ACS",
        "a spindle as an axis is not simulated": "#CAX, #FACE",
        "wrapping around a cylinder is not simulated; write C itself": "#CYL",
        "the twin has no axis that turns the tool": "#TANGCTRL",
        _NO_SPLINES: "#SPLINE",
        "compensation tables are the machine file's": "#VOLCOMP",
    }
)
"""Why what they begin is not simulated; to end it, by OFF, changes nothing."""

REFUSED = _by_keyword(
    {
        _NO_TILT: "#TOOL ORI, #KINORG",
        "the tool lies along Z": "#TOOL AX",
        _NO_SPLINES: "#ASPLINE, #POLY",
        "the twin has no probe to touch with": "#PROBE, #SELECT PROBE, #MEAS",
        "inclined axes are not simulated": "#ANGAX",
        "the axes of the machine are those of its file": "#LINK, #UNLINK, #SET AX, #CALL AX, "
        "#FREE AX, #RENAME AX, #PARK, #UNPARK",
        "the drives are those of the machine file": "#SERVO, #CD, #FOLLOW, #SYNC, #UNSYNC, #TSYNC, "
        "#TUNSYNC",
        "the machine has one spindle": "#MASTER",
        "programs read and write no files here": "#OPEN, #WRITE, #CLOSE, #DELETE",
        "it runs a whole program, in a channel that may be another one, and the twin runs one program; "
        "make that a subroutine, which ends with #RET, and call it by LL or #CALL": "#EXEC",
        "it runs a block that may belong to another channel, and the machine has one; write the block "
        "itself": "#EXBLK",
        "macros are not simulated; write their text": "#DEF, #INIT MACROS",
        "the machine has one channel": "#MEET, #WAIT, #SIGNAL",
        "nobody stands at the twin": "#CONTJOG, #INCJOG, #MPG",
        "an interrupted program does not go on elsewhere here": "#ABORT",
        "cycles of the editor are not simulated; write the G code": "#CYCLE",
    }
)
"""Why the twin does not follow them."""
