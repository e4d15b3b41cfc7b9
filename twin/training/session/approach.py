"""The way from where the axes stand to where a block in mid-program begins."""

import numpy as np

from twin.nc.canonical import NO_BLOCK_NUMBER, Corner, FloatArray, Motion, Moves
from twin.nc.control.control import Control
from twin.nc.path.move_columns import NAN, MoveColumns, Segment
from twin.nc.path.paces import FEED_FACTORS

Z = 2
SHORTEST = 1e-6
"""A leg that is shorter is left out [mm or deg]."""


def approach(control: Control, stand: FloatArray, line: int) -> Moves:
    """Straight moves to where the control stands after a search.

    Upwards Z goes first; downwards it goes last, in the feed that is in force there: the tool may
    have material under it.

    Args:
        control: After the blocks that were only computed.
        stand: Where the axes stand, part coordinates, shape (k,) [mm or deg].
        line: Source line of the block.
    """
    goal = np.array(control.part)
    label = np.array(control.programmed) - goal
    middle = goal.copy() if goal[Z] < stand[Z] else stand.copy()
    middle[Z] = max(goal[Z], stand[Z])
    factor = FEED_FACTORS.get(control.modal.feed_mode)
    feed = control.feed * factor if control.feed and factor else control.settings.default_feed
    columns = MoveColumns(control.settings.axes)
    for start, end in ((stand, middle), (middle, goal)):
        if np.abs(end - start).max() < SHORTEST:
            continue
        down = end[Z] < start[Z]
        columns.add(
            Segment(
                motion=Motion.FEED if down else Motion.RAPID,
                line=line,
                block=NO_BLOCK_NUMBER,
                start=start.tolist(),
                end=end.tolist(),
                display=(end + label).tolist(),
                feed=feed if down else NAN,
                corner=Corner.EXACT_STOP,
                corner_tolerance=NAN,
            )
        )
    return columns.take().moves
