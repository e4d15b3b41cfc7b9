"""A recording frame by frame, without all of it in memory."""

from collections.abc import Iterator

import numpy as np

from twin.nc.canonical import IntArray
from twin.recording.reader import Recording, Samples


def frame_ends(count: int, frames: int) -> IntArray:
    """How many samples lie behind each of evenly spread frames; the last one shows the end."""
    shares = (np.arange(frames, dtype=np.int64) + 1) * count / frames
    return np.maximum(min(1, count), np.round(shares)).astype(np.int64)


def deal(recording: Recording, ends: IntArray) -> Iterator[tuple[Samples, bool]]:
    """Yield samples in order, split at frames.

    Args:
        ends: How many samples lie behind each frame, never falling, shape (n,).

    Yields:
        Samples that follow the last ones, perhaps none, and whether a frame is due after them.
    """
    frame = first = 0
    for chunk in recording.chunks():
        last, done = first + len(chunk), 0
        while frame < len(ends) and ends[frame] <= last:
            end = int(ends[frame]) - first
            yield chunk[done:end], True
            frame, done = frame + 1, end
        if frame == len(ends):
            return
        if done < len(chunk):
            yield chunk[done:], False
        first = last
