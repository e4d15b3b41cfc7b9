"""Motion for the cutting tests, made by hand."""

from collections.abc import Callable

import numpy as np
import pytest

from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray
from twin.recording.reader import Samples

Motion = Callable[..., Samples]


def samples(
    position: FloatArray,
    line: int | FloatArray = 1,
    start: float = 0.0,
    commanded: FloatArray | None = None,
) -> Samples:
    """Samples at 1 ms of axes that stand where they were told to, or off it."""
    position = np.asarray(position, np.float64)
    still, column = np.zeros_like(position), np.zeros(len(position))
    lines = np.broadcast_to(np.asarray(line, np.int64), len(position)).copy()
    time = start + 1e-3 * np.arange(len(position), dtype=np.float64)
    wanted = position if commanded is None else np.asarray(commanded, np.float64)
    setpoint = Setpoints(time, lines, lines - 1, column, wanted, still, still)
    return Samples(setpoint, position.copy(), still, still)


@pytest.fixture(name="samples")
def samples_fixture() -> Motion:
    return samples
