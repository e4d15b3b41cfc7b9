"""Statements that the Fagor CNC 8070 knows and that move nothing here, or that this machine lacks.

Names and meanings are those of the control's quick reference; which of them programs hold was seen
in the output of published post-processors.
"""

from collections.abc import Mapping

PASSED_OVER: Mapping[str, str] = {
    "#MSG": "a message to the operator",
    "#DGWZ": "the window of the control's graphics",
    "#FLUSH": "block preparation waits for the motion, and nothing is prepared ahead here",
    "#HSC": "high-speed machining; the tolerance of rounded corners is the machine file's",
    "#KIN ID": "the kinematics, of which the machine has one",
    "#SLOPE": "the shape of the acceleration, which is the machine file's",
    "#PATH": "the folder of subroutines, which are looked for beside the program",
    "#ESBLK": "single block",
    "#DSBLK": "single block",
    "#ESTOP": "the stop key",
    "#DSTOP": "the stop key",
    "#EFHOLD": "the feed hold key",
    "#DFHOLD": "the feed hold key",
}
"""What each is; none of them changes the path."""

_NO_TILT = "the machine's tool does not tilt"
_NO_PLANES = "inclined planes are not simulated"
_NO_AXES = "the axes of the machine are those of its file"
_NO_SPLINES = "splines of this control are not simulated"
_NO_FILES = "programs read and write no files here"
_NO_CHANNELS = "the machine has one channel"
_NO_LOOPS = "the drives are those of the machine file"

ENDED_ONLY: Mapping[str, str] = {
    "#RTCP": _NO_TILT,
    "#TLC": _NO_TILT,
    "#TCAM": "electronic cams are not simulated",
    "#CS": _NO_PLANES,
    "#ACS": _NO_PLANES,
    "#CAX": "a spindle as an axis is not simulated",
    "#FACE": "a spindle as an axis is not simulated",
    "#CYL": "wrapping around a cylinder is not simulated; write C itself",
    "#TANGCTRL": "the twin has no axis that turns the tool",
    "#SPLINE": _NO_SPLINES,
    "#VOLCOMP": "compensation tables are the machine file's",
}
"""Why what they begin is not simulated; to end it, by OFF, changes nothing."""

REFUSED: Mapping[str, str] = {
    "#TOOL ORI": _NO_TILT,
    "#TOOL AX": "the tool lies along Z",
    "#KINORG": _NO_TILT,
    "#ASPLINE": _NO_SPLINES,
    "#POLY": _NO_SPLINES,
    "#PROBE": "the twin has no probe to touch with",
    "#SELECT PROBE": "the twin has no probe to touch with",
    "#ANGAX": "inclined axes are not simulated",
    "#LINK": _NO_AXES,
    "#UNLINK": _NO_AXES,
    "#SET AX": _NO_AXES,
    "#CALL AX": _NO_AXES,
    "#FREE AX": _NO_AXES,
    "#RENAME AX": _NO_AXES,
    "#PARK": _NO_AXES,
    "#UNPARK": _NO_AXES,
    "#SERVO": _NO_LOOPS,
    "#CD": _NO_LOOPS,
    "#FOLLOW": _NO_LOOPS,
    "#SYNC": _NO_LOOPS,
    "#UNSYNC": _NO_LOOPS,
    "#TSYNC": _NO_LOOPS,
    "#TUNSYNC": _NO_LOOPS,
    "#MASTER": "the machine has one spindle",
    "#OPEN": _NO_FILES,
    "#WRITE": _NO_FILES,
    "#CLOSE": _NO_FILES,
    "#DELETE": _NO_FILES,
    "#EXEC": "it runs a whole program, in a channel that may be another one, and the twin runs one program; "
    "make that a subroutine, which ends with #RET, and call it by LL or #CALL",
    "#EXBLK": "it runs a block that may belong to another channel, and the machine has one; write the block itself",
    "#DEF": "macros are not simulated; write their text",
    "#INIT MACROS": "macros are not simulated; write their text",
    "#MEET": _NO_CHANNELS,
    "#WAIT": _NO_CHANNELS,
    "#SIGNAL": _NO_CHANNELS,
    "#CONTJOG": "nobody stands at the twin",
    "#INCJOG": "nobody stands at the twin",
    "#MPG": "nobody stands at the twin",
    "#MEAS": "the twin has no probe to touch with",
    "#ABORT": "an interrupted program does not go on elsewhere here",
    "#CYCLE": "cycles of the editor are not simulated; write the G code",
}
"""Why the twin does not follow them."""
