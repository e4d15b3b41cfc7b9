"""A program's velocity: its pieces, with the corners that were tried, and their phases."""

from collections.abc import Iterable, Iterator

from twin.motion.corner_trials import PiecesOfChunks
from twin.motion.limits import MotionLimits
from twin.motion.phases_of_pieces import phases_of_pieces
from twin.motion.profile.phases import Phases
from twin.nc.canonical import Chunk, FloatArray


def plan_phases(
    chunks: Iterable[Chunk], limits: MotionLimits, *, start: FloatArray
) -> Iterator[Phases]:
    """Plan the velocity along a program.

    Args:
        chunks: The program.
        limits: Of the axes and the path.
        start: Where the axes stand before, part coordinates, shape (k,) [mm or deg].
    """
    return phases_of_pieces(PiecesOfChunks(chunks, limits, start), limits)
