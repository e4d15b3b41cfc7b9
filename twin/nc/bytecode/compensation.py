"""How radius compensation begins, for both tiers; what is wrong comes back as a number below 0."""

from twin.compilation.compilable import compilable
from twin.nc.bytecode.coordinates import directions, matrix_of, put
from twin.nc.bytecode.registers import INDIRECT_LEADS, SQUARE_CORNERS, TURNED, Constants, State
from twin.nc.geometry import frame, matrices
from twin.nc.path.compensation import leads
from twin.nc.path.compensation.contour import LEADING_OUT, OFF, STAGE, Contour

NO_RADIUS, IN_FORCE, LEADS_OUT = range(-113, -110)
"""Why it cannot begin; other numbers than those of ``effects``."""
NOTHING_TO_COMPENSATE, BEGINS = range(2)


@compilable
def may_begin(radius: float, contour: Contour) -> int:
    """What is to be done to begin with a radius [mm]: one of the numbers of this file."""
    stage = contour.counts[STAGE]
    if not radius >= 0.0:
        return NO_RADIUS
    if stage == LEADING_OUT:
        return LEADS_OUT
    if stage != OFF:
        return IN_FORCE
    return NOTHING_TO_COMPENSATE if radius == 0.0 else BEGINS


@compilable
def begin(side: float, radius: float, constants: Constants, state: State, contour: Contour) -> None:
    """Compensate from the next move on.

    Args:
        side: +1 left of the contour, -1 right of it.
        radius: Of the tool [mm].
        constants: What stays.
        state: Its plane, as the part sees it, is compensated.
        contour: Is made to wait for the move that leads in.
    """
    modal = state.modal
    axes = directions(constants, modal)
    signed_offset = side * radius
    if state.registers[TURNED] != 0.0:
        matrix = matrix_of(state)
        axes = frame.plane_of_part(matrix, axes)
        signed_offset *= matrices.handedness(matrix)
    put(axes[0], contour.plane[0])
    put(axes[1], contour.plane[1])
    put(axes[2], contour.plane[2])
    square, indirect = modal[SQUARE_CORNERS] != 0.0, modal[INDIRECT_LEADS] != 0.0
    leads.begin(contour, signed_offset, square, indirect)
