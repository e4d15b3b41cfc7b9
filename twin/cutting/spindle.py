"""Whether the spindle stands: what the program's functions say of it, by setpoint."""

import numpy as np
import numpy.typing as npt

from twin.cutting.program_summary import ProgramSummary
from twin.motion.setpoints.setpoints import Setpoints

_BEFORE_THE_NEXT = 1.0 - 1e-12
"""The end of a move's path still belongs to it: a function between two moves is not yet heard."""


def standing(summary: ProgramSummary, setpoint: Setpoints) -> npt.NDArray[np.bool_]:
    """During which setpoints the spindle is off, shape (n,)."""
    place = setpoint.move + np.clip(setpoint.fraction, 0.0, _BEFORE_THE_NEXT)
    off = np.array([speed == 0.0 for speed in summary.spindle.values])
    step = np.searchsorted(summary.spindle.first_move, place, side="right") - 1
    return off[np.maximum(step, 0)]
