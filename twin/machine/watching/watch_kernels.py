"""What a control sees in samples of its axes: limit switches, lag, force."""

import enum
from typing import NamedTuple

from twin.compilation.kernel import kernel
from twin.nc.canonical import FloatArray, IntArray


class Raised(enum.IntEnum):
    """What ends a run; of what comes in one sample the first counts."""

    NOTHING = -1
    HARD_LIMIT = 0
    FOLLOWING_ERROR = 1
    SATURATION = 2


class AxisWatch(NamedTuple):
    """What k axes may do, and what they have done so far.

    Attributes:
        lag: Largest distance from the setpoint, shape (k,) [mm or deg].
        force: From which the drive is at its limit, shape (k,) [N or N m].
        patience: For how many samples it may be there, shape (k,).
        switches: Where the limit switches lie, shape (2, k) [mm or deg].
        raised_at: Beyond what the switches raise an alarm, shape (2, k) [mm or deg]; overwritten.
        saturated: For how many samples the drives have been at their limits, shape (k,); overwritten.
    """

    lag: FloatArray
    force: FloatArray
    patience: IntArray
    switches: FloatArray
    raised_at: FloatArray
    saturated: IntArray


@kernel
def find_raised(
    watched: AxisWatch, setpoint: FloatArray, position: FloatArray, force: FloatArray
) -> tuple[int, int, int]:
    """The first sample that raises an alarm.

    Args:
        setpoint: Positions that were asked for, shape (n, k).
        position: Of the joints, shape (n, k).
        force: Of the drives, shape (n, k).

    Returns:
        ``Raised.HARD_LIMIT`` and so on or ``Raised.NOTHING``, the sample, and the axis that raises it.
    """
    kind, first, raising = Raised.NOTHING, 0, 0
    count, axes = position.shape
    lowest, highest = watched.raised_at[0], watched.raised_at[1]
    saturated = watched.saturated
    for row in range(count):
        found = Raised.NOTHING
        for axis in range(axes):
            at_limit = abs(force[row, axis]) >= watched.force[axis]
            saturated[axis] = saturated[axis] + 1 if at_limit else 0
            here, own = position[row, axis], Raised.NOTHING
            if here < lowest[axis] or here > highest[axis]:
                own = Raised.HARD_LIMIT
            elif abs(setpoint[row, axis] - here) > watched.lag[axis]:
                own = Raised.FOLLOWING_ERROR
            elif saturated[axis] > watched.patience[axis]:
                own = Raised.SATURATION
            if own != Raised.NOTHING and (found == Raised.NOTHING or own < found):
                found = own
                if kind == Raised.NOTHING:
                    raising = axis
        if kind == Raised.NOTHING and found != Raised.NOTHING:
            kind, first = found, row
    for axis in range(axes):
        # An axis that has left its limit switch raises the alarm there again.
        if position[count - 1, axis] > watched.switches[0, axis]:
            lowest[axis] = watched.switches[0, axis]
        if position[count - 1, axis] < watched.switches[1, axis]:
            highest[axis] = watched.switches[1, axis]
    return kind, first, raising
