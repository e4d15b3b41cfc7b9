"""Hold the end of the program until the drives have come to rest."""

from collections.abc import Iterable, Iterator

import numpy as np

from twin.motion.setpoints.setpoints import Setpoints

SETTLING_TIME_S = 0.25
"""How long the last setpoint is held [s]: some 25 time constants of a loop gain of 100 1/s."""


def settle(
    chunks: Iterable[Setpoints], period_s: float, seconds: float = SETTLING_TIME_S
) -> Iterator[Setpoints]:
    """Pass setpoints on and add samples that stand still at the last one.

    Args:
        chunks: The planned setpoints.
        period_s: Servo period [s].
        seconds: How long to hold [s].
    """
    last: Setpoints | None = None
    for chunk in chunks:
        if len(chunk):
            last = chunk[-1:]
        yield chunk
    if last is None:
        return
    ticks = np.arange(1, round(seconds / period_s) + 1)
    first_tick = round(float(last.time[0]) / period_s)
    count = len(ticks)
    axes = last.position.shape[1]
    yield Setpoints(
        time=(first_tick + ticks) * np.float64(period_s),
        line=np.repeat(last.line, count),
        move=np.repeat(last.move, count),
        fraction=np.repeat(last.fraction, count),
        position=np.repeat(last.position, count, axis=0),
        velocity=np.zeros((count, axes)),
        acceleration=np.zeros((count, axes)),
    )
