"""Corners that the Fagor CNC 8070 rounds or chamfers: G36, G39."""

import re

from twin.nc.control.codes import Action
from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070.memory import memory_of
from twin.nc.path.blends import Blend, BlendKind

_CODES = re.compile(rb"G[ \t]*0*3[69](?![0-9])", re.IGNORECASE)


def prepare(control: Control) -> None:
    """Hold moves until their successor is known, where the program blends corners at all."""
    if control.program_counter.lines.any_holds(_CODES):
        control.path.hold_for_blends()


def blend_code(kind: BlendKind, number: int) -> Action:
    """G36 I5: the corner between the last move and the next becomes an arc of radius I.

    G39 I5: it becomes a line between the points that lie I away from it.
    """

    def action(control: Control) -> None:
        memory, word = memory_of(control), control.take("I")
        if word is not None:
            memory.blend = control.length(word)
        if memory.blend <= 0.0:
            message = f"G{number} needs I above 0, the size of the blend"
            control.fail("blend", message, word, hint=f"write G{number} I5 between two moves")
        if control.words:
            message = f"G{number} stands in a block of its own between two moves"
            control.fail(
                "blend", message, hint=f"write G{number} I{memory.blend:g} in its own block"
            )
        if not control.path.blend_next(Blend(kind, memory.blend, control.motion.part_plane)):
            control.fail("blend", "there is no move before the corner")

    return action
