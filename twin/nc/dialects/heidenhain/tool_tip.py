"""M128 and FUNCTION TCPM: the tip is led while rotary axes turn.

Source: user's manuals Klartext of the TNC 640 ("FUNCTION TCPM"). With AXIS SPAT the words A, B and C are spatial angles,
which say the direction of the tool in the part; whatever axes the machine has point it there.
"""

import re

from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.cycles.plane_directions import spatial
from twin.nc.dialects.heidenhain.memory import memory_of
from twin.nc.iso.orientation.tool_center import begin_tool_center, end_tool_center, point_by_words
from twin.nc.text.blocks import Statement, Word

_TCPM = re.compile(
    r"[ \t]*F[ \t]+TCP[ \t]+AXIS[ \t]+(?P<axis>POS|SPAT)[ \t]+PATHCTRL[ \t]+(?P<path>AXIS|VECTOR)"
    r"(?:[ \t]+REFPNT[ \t]+TIP-TIP)?(?:[ \t]+F[ \t]*[0-9.]+)?[ \t]*",
    re.IGNORECASE,
)


def begin_tcpm(control: Control) -> None:
    """M128: F counts the path of the tip; A, B and C are axes of the machine."""
    memory_of(control).spatial = None
    begin_tool_center(control, "M128")


def begin_tcpm_with_feed(control: Control, _word: Word) -> None:
    """M128 F: the feed bounds moves by which the control follows an axis turned by hand, of which there are none here."""
    begin_tcpm(control)


def end_tcpm(control: Control) -> None:
    """M129."""
    memory_of(control).spatial = None
    center = control.path.tool_center
    if center is not None and not center.tilted:
        end_tool_center(control, "M129", keeps_length=True)


def function(control: Control, statement: Statement) -> None:
    """FUNCTION TCPM, RESET TCPM; MODE MILL changes nothing here."""
    text = " ".join(statement.text.upper().split())
    if text.startswith("RESET TCPM"):
        end_tcpm(control)
    elif text.startswith("TCPM"):
        match = _TCPM.fullmatch(text.removeprefix("TCPM"))
        if match is None:
            message = "FUNCTION TCPM is simulated as F TCP AXIS POS or SPAT PATHCTRL AXIS or VECTOR"
            hint = "F counts the tip's path, and the tip's own path is led (REFPNT TIP-TIP)"
            control.fail("tool-center", message, statement, hint)
        in_plane = match["path"].upper() == "VECTOR"
        begin_tool_center(control, "FUNCTION TCPM", in_plane=in_plane)
        memory_of(control).spatial = (0.0, 0.0, 0.0) if match["axis"].upper() == "SPAT" else None
    elif not text.startswith("MODE MILL"):
        name = " ".join(statement.text.split()[:2])
        message = f"FUNCTION {name} is not followed"
        hint = "FUNCTION TCPM, FUNCTION RESET TCPM and FUNCTION MODE MILL are"
        control.fail("unsupported-statement", message, statement, hint)


def take_spatial_angles(control: Control) -> None:
    """With AXIS SPAT the words A, B and C of a block point the tool; those left out stay as they are."""
    memory = memory_of(control)
    if memory.spatial is None or control.path.tool_center is None:
        return
    words = [control.take(name) for name in "ABC"]
    first = next((word for word in words if word is not None), None)
    if first is None:
        return
    a, b, c = (
        old if word is None else control.number(word) + (old if word.incremental else 0.0)
        for old, word in zip(memory.spatial, words, strict=True)
    )
    memory.spatial = (a, b, c)
    matrix = spatial(a, b, c)
    point_by_words(control, (matrix[0][2], matrix[1][2], matrix[2][2]), first)
