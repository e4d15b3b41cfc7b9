"""Radius compensation (RL, RR, R0) and its leads: APPR to a contour, DEP away from it.

LT goes on along its first element, LN comes square to it, CT and LCT come on an arc that touches it. R is the radius of
the centre's path; positive it turns RL counter-clockwise and RR clockwise. The auxiliary point is reached at the feed
that was in force before the block, FMAX included, except that of LCT (TNC7 user's manual, APPR CT; TNC 640 ISO
programming, 6.3).
"""

import dataclasses
import math

from twin.nc.control.codes import Interpolation, StatementAction, WordAction
from twin.nc.control.compensation import compensate
from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.memory import memory_of
from twin.nc.dialects.heidenhain.paths.paths import LINE, circle_plane, polar_target
from twin.nc.dialects.heidenhain.tools import compensation_radius
from twin.nc.iso.leads import Lead, LeadKind, approach, depart
from twin.nc.text.blocks import Statement, Word

SIDES = {"RL": 1.0, "RR": -1.0, "R0": 0.0}
"""Where the tool goes beside the contour."""


def compensation_word(side: float) -> WordAction:
    """RL, RR and R0."""

    def action(control: Control, word: Word) -> None:
        memory = memory_of(control)
        if side == memory.side:
            return
        if side == 0.0:
            if control.path.leads is not None:
                message = "the contour that APPR leads to begins with compensation, not with R0"
                control.fail("contour-lead", message, word)
            control.path.end_compensation()
        elif memory.side != 0.0:
            message = "compensation changes its side by way of R0"
            control.fail("compensation-change", message, word, "end it by a block with R0 before")
        else:
            compensate(control, side, compensation_radius(control))
        memory.side = side

    return action


def refuse_paraxial(control: Control, word: Word) -> None:
    """R+ and R-: compensation of a block that moves one axis."""
    message = (
        f"{word.address} lengthens a move of one axis by the radius, which the twin does not follow"
    )
    control.fail("unsupported-word", message, word, "write L with RL or RR")


_KINDS = {
    "LT": LeadKind.TANGENT,
    "LN": LeadKind.NORMAL,
    "CT": LeadKind.ARC,
    "LCT": LeadKind.LINE_AND_ARC,
}
_MOVES = Word("DR+", math.nan, 0, 1)
"""Makes a block move that has no words which do, such as DEP LT LEN10."""


def _keyword(name: str) -> StatementAction:
    """APPR or DEP with its kind, such as ``APPR PLCT``."""
    keyword, shape = name.split()
    arrives, polar = keyword == "APPR", shape.startswith("P")
    kind = _KINDS[shape.removeprefix("P")]

    def action(control: Control, statement: Statement) -> None:
        memory, before = memory_of(control), control.motion.feed

        def move(control: Control) -> None:
            lead = _take_lead(control, statement, kind, before)
            if arrives:
                approach(control, lead, _take_target(control, polar))
            else:
                lead = dataclasses.replace(lead, rapid=False)
                depart(control, lead, _take_target(control, polar))
                memory.side = 0.0

        words = control.block.words
        sides = [SIDES[word.address] for word in words if word.address in SIDES]
        if arrives and memory.side == 0.0:
            memory.side = sides[0] if sides else 0.0
        others = tuple(word for word in words if word.address not in SIDES)
        control.modal.interpolation = Interpolation(move)
        control.run(control.block._replace(statement=None, words=(*others, _MOVES)))
        control.modal.interpolation = LINE
        memory.rapid = False

    return action


def _take_lead(
    control: Control, statement: Statement, kind: LeadKind, before: float | None
) -> Lead:
    """Take LEN, R and CCA."""
    control.take("DR+")
    memory, is_arc = memory_of(control), kind in (LeadKind.ARC, LeadKind.LINE_AND_ARC)
    address = "R" if is_arc else "LEN"
    size, angle = control.length(control.take(address)), control.number(control.take("CCA"))
    if size == 0.0 or (size < 0.0 and kind is LeadKind.LINE_AND_ARC):
        above = " above 0" if kind is LeadKind.LINE_AND_ARC else ""
        message = f"{statement.keyword} needs {address}{above}"
        control.fail("contour-lead", message, statement, f"{statement.keyword} .. {address}10")
    if kind is LeadKind.ARC and not 0.0 < angle <= 360.0:
        control.fail("contour-lead", "the angle CCA of the arc is above 0 and up to 360", statement)
    own, feed = kind is LeadKind.LINE_AND_ARC, control.motion.feed
    return Lead(
        kind=kind,
        size=size,
        angle=angle,
        side=memory.side,
        offset=compensation_radius(control) if memory.side else 0.0,
        feed_before=feed if own else before,
        feed=feed,
        rapid=memory.was_rapid and not own,
    )


def _take_target(control: Control, polar: bool) -> list[float]:
    if not polar:
        return control.target()
    with circle_plane(control) as pole:
        return polar_target(control, pole)


KEYWORDS = {
    name: _keyword(name)
    for name in (
        *(f"APPR {polar}{kind}" for kind in _KINDS for polar in ("", "P")),
        *(f"DEP {kind}" for kind in _KINDS),
        "DEP PLCT",
    )
}
"""Keywords of leads."""
