"""RND and CHF: the corner between the last move and the next is rounded or cut off."""

import re

from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.memory import INCH_FEEDS, memory_of
from twin.nc.dialects.heidenhain.values import computed_words, value_at
from twin.nc.path.blends import Blend, BlendKind
from twin.nc.text.blocks import Statement, Word

_KEYWORDS = re.compile(rb"\b(?:RND|CHF)(?![A-Z_])", re.IGNORECASE)


def prepare(control: Control) -> None:
    """Hold moves until their successor is known, where the program blends corners at all."""
    if control.program_counter.lines.any_holds(_KEYWORDS):
        control.path.hold_for_blends()


def round_corner(control: Control, statement: Statement) -> None:
    """RND R5 F100: an arc of radius R; F holds for it alone."""
    words = computed_words(control, statement, 0)
    radius = words.pop("R", None)
    if radius is None:
        control.fail("blend", "RND needs its radius R", statement, "RND R5")
    _blend(control, statement, BlendKind.FILLET, control.length(radius), words)


def cut_corner(control: Control, statement: Statement) -> None:
    """CHF 10 F100: between two lines a further one between the points that lie so far from the corner."""
    if not statement.text.strip():
        control.fail("blend", "CHF needs its length", statement, "CHF 10")
    value, end = value_at(control, statement)
    words = computed_words(control, statement, end)
    memory, memory.chamfered = memory_of(control), control.motion.last
    if memory.chamfered is not None and memory.chamfered.center is not None:
        refuse_chamfered_arc(control, statement)
    _blend(control, statement, BlendKind.CHAMFER, value * control.modal.unit, words)


def refuse_chamfered_arc(control: Control, statement: Statement | None = None) -> None:
    """A chamfer cuts off the corner between two lines (TNC 426 user's manual, 6.4)."""
    message = "CHF belongs between two straight lines, and one of its moves is an arc"
    control.fail("blend", message, statement, "RND rounds the corner beside an arc")


def _blend(
    control: Control, statement: Statement, kind: BlendKind, size: float, words: dict[str, Word]
) -> None:
    feed = words.pop("F", None)
    rate = float("nan") if feed is None else control.length(feed)
    if feed is not None and control.modal.unit != 1.0:
        rate *= INCH_FEEDS
    if words:
        word = next(iter(words.values()))
        control.fail("unused-word", f"nothing in {statement.keyword} uses '{word.text}'", word)
    if size <= 0.0 or rate <= 0.0:
        control.fail("blend", f"{statement.keyword} needs a size and a feed above 0", statement)
    if not control.path.hold_for_blends().blend_next(
        Blend(kind, size, control.motion.part_plane, feed=rate)
    ):
        message = f"{statement.keyword} belongs between two moves, and none is before it"
        control.fail("blend", message, statement, "write it between two lines L")
