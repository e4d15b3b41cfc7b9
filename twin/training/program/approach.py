"""The way from where the axes stand to where a block in mid-program begins."""

import itertools

import numpy as np

from twin.nc.canonical import NO_BLOCK_NUMBER, Corner, FloatArray, Motion, Moves
from twin.nc.control.control import Control
from twin.nc.path.feed_rates import FEED_FACTORS
from twin.nc.path.move_columns import NAN, MoveColumns, Segment

Z = 2
SHORTEST = 1e-6
"""A leg that is shorter is left out [mm or deg]."""


def approach(control: Control, stand: FloatArray, line: int, clearance: float) -> Moves:
    """Straight moves to where the control stands after a search.

    The tool is lifted first, travels at the height of clearance, and goes down last, in the feed that is in
    force there: it may stand in the part, and may have material under it. Where the other axes stand
    right, Z goes straight.

    Args:
        control: After the blocks that were only computed.
        stand: Where the axes stand, part coordinates, shape (k,) [mm or deg].
        line: Source line of the block.
        clearance: Height at which the tool travels, at least, part coordinates [mm].
    """
    motion = control.motion
    goal = np.array(motion.part)
    label = np.array(motion.programmed) - goal
    above_stand, above_goal = stand.copy(), goal.copy()
    travels = bool(np.abs(np.delete(goal - stand, Z)).max() >= SHORTEST)
    height = max(goal[Z], stand[Z], clearance if travels else -np.inf)
    above_stand[Z] = above_goal[Z] = height
    factor = FEED_FACTORS.get(control.modal.feed_mode)
    feed = motion.feed * factor if motion.feed and factor else control.settings.default_feed
    columns = MoveColumns(control.settings.axes)
    for start, end in itertools.pairwise((stand, above_stand, above_goal, goal)):
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
