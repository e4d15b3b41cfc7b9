"""Radius compensation: RL, RR, R0."""

from twin.nc.control.codes import WordAction
from twin.nc.control.compensation import compensate
from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.memory import memory_of
from twin.nc.dialects.heidenhain.tools import compensation_radius
from twin.nc.text.blocks import Word

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
    """R+ and R-: compensation of a block that moves one axis.

    Raises:
        ProgramError: Always.
    """
    message = (
        f"{word.address} lengthens a move of one axis by the radius, which the twin does not follow"
    )
    control.fail("unsupported-word", message, word, "write L with RL or RR")
