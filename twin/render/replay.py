"""A recording, dealt out frame by frame without holding all of it."""

from collections.abc import Iterator

import numpy as np

from twin.cutting.outline import BoolArray
from twin.nc.canonical import IntArray
from twin.recording import Recording, Samples


def frame_ends(count: int, frames: int) -> IntArray:
    """How many samples lie behind each of evenly spread frames; the last one shows the end.

    Args:
        count: Samples of the recording.
        frames: Pictures to be spread over it.
    """
    shares = (np.arange(frames, dtype=np.int64) + 1) * count / frames
    return np.maximum(min(1, count), np.round(shares)).astype(np.int64)


def deal(recording: Recording, ends: IntArray) -> Iterator[tuple[Samples, bool]]:
    """Deal out samples in order, split at frames.

    Args:
        recording: What to replay.
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


def rapid_mask(samples: Samples, rapid_moves: BoolArray | None) -> BoolArray:
    """Which samples belong to rapids; those before the first move do.

    Args:
        samples: n samples.
        rapid_moves: Whether each move of the program is a rapid; None: none is.
    """
    move = samples.setpoint.move
    if rapid_moves is None or not len(rapid_moves):
        return np.zeros(len(move), np.bool_)
    known = (move >= 0) & (move < len(rapid_moves))
    return np.where(known, rapid_moves[np.clip(move, 0, len(rapid_moves) - 1)], True)
