"""LN: a line with the normal of the surface and the direction of the tool, as CAM systems post it.

Source: user's manuals Klartext of the TNC 640 ("Three-dimensional tool compensation"). Decision: normals move nothing, since
the tool has the size that the program was made for; where TOOL CALL says otherwise, LN is refused.
"""

from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.memory import memory_of
from twin.nc.iso.tool_center import point_by_words


def take_vector(control: Control) -> None:
    """TX, TY and TZ of LN point the tool; NX, NY and NZ are normals of the surface, which move nothing by themselves.

    Raises:
        ProgramError: The tool has another size than the program's, by which the normal would move it, or no tip is led.
    """
    normal, vector = ([control.take(f"{kind}{axis}") for axis in "XYZ"] for kind in "NT")
    deltas = memory_of(control).deltas
    if any(word is not None for word in normal) and (deltas.radius or deltas.length):
        message = "compensation along a surface normal (DR, DL of TOOL CALL) is not followed in LN"
        control.fail("tool-center", message, next(word for word in normal if word is not None))
    first = next((word for word in vector if word is not None), None)
    if first is None:
        return
    if control.path.tool_center is None:
        message = "a vector of the tool needs its tip led"
        control.fail("tool-center", message, first, "M128 or FUNCTION TCPM before")
    x, y, z = (control.number(word) for word in vector)
    point_by_words(control, (x, y, z), first)
