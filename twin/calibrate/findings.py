"""Findings about a log."""

import dataclasses

import numpy as np

from twin.nc.canonical import FloatArray


@dataclasses.dataclass(frozen=True, slots=True)
class LogFinding:
    """A finding about a log, for the user.

    Attributes:
        code: ``gap``, ``missing``, ``clock-jump``, ``slow``, ``coarse``, ``held``, ``uneven``, ``skew``,
            ``filtered``, ``scale``, ``offset``, ``unit``, ``spike``, ``repeated``, ``clipped``,
            ``reference``, ``jump``, ``feed-forward``, ``force``, ``long``.
        message: In words, with what can still be fitted.
    """

    code: str
    message: str


def resolution(values: FloatArray) -> float:
    """The step that values come in, 0 where they come in none.

    The least difference counts when (nearly) all others are its multiples.
    """
    steps = np.abs(np.diff(np.unique(values)))
    steps = steps[steps > 1e-12 * max(1.0, float(np.abs(values).max()))]
    if len(steps) < 2:
        return 0.0
    least = float(np.min(steps))
    parts = steps / least
    even = np.abs(parts - np.round(parts)) < 0.02
    return least if float(np.mean(even)) > 0.95 else 0.0
