"""Corners that a Fanuc control blends: ,R rounds and ,C chamfers the end of the block's move."""

import re

from twin.nc.control.control import Control
from twin.nc.dialects.fanuc.memory import memory_of
from twin.nc.path.blends import Blend, BlendKind

_WORDS = re.compile(rb",[CR]", re.IGNORECASE)
_KINDS = {",R": BlendKind.FILLET, ",C": BlendKind.CHAMFER}


def prepare(control: Control) -> None:
    """Hold moves until their successor is known, where the program blends corners at all."""
    if control.program_counter.lines.any_holds(_WORDS):
        control.path.hold_for_blends()


def blend_after_motion(control: Control) -> None:
    """The corner between the block's move and the next."""
    words = [control.words.pop(address) for address in _KINDS if address in control.words]
    if not words:
        return
    if len(words) > 1:
        control.fail("blend", "a corner is rounded or chamfered, not both", words[1])
    (word,) = words
    size = control.length(word)
    if size <= 0.0:
        control.fail("blend", f"{word.text} is no size of a corner", word)
    scale = memory_of(control).scale
    if scale is not None:
        size *= abs(scale[0][control.modal.plane.axes[0]])
    blend = Blend(_KINDS[word.address], size, control.motion.part_plane)
    if not control.path.hold_for_blends().blend_next(blend, control.block.line):
        message = f"{word.text} is for the end of a move with G1, G2 or G3, which this block lacks"
        control.fail("blend", message, word)
