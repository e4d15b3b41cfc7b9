"""How one block differs from the stored one, in words."""

import math
import operator

from twin.compare.baseline_text import BaselineEntry, number
from twin.job.tolerance import BaselineTable

_SMALLEST_TIME = 1e-6
"""Dwells that differ by no more are the same [s]."""
_SWEEP_DEG = 0.5
"""Sweeps that differ by more are not the same; the end point tells a wrong angle within the turn,
but not the sign, nor whole turns."""
_PARALLEL = 1.0 - 1e-9
"""Cosine between normals from which on two planes are the same."""
_PLANES: dict[tuple[float, ...], str] = {(0, 0, 1): "XY", (0, 1, 0): "ZX", (1, 0, 0): "YZ"}

Finding = tuple[str, str]
"""A code and a sentence."""


def same_end(before: BaselineEntry, now: BaselineEntry, tolerance: float) -> bool:
    """Whether two blocks are of one kind and end in one place; then they are taken for each other.

    Args:
        before: The stored one.
        tolerance: How far apart the ends may be [mm or deg].
    """
    if now.kind != before.kind:
        return False
    return all(abs(a - b) <= tolerance for a, b in zip(before.end, now.end, strict=False))


def block_differences(
    before: BaselineEntry,
    now: BaselineEntry,
    names: tuple[str, ...],
    limits: BaselineTable,
    *,
    begins_apart: bool,
) -> list[Finding]:
    """All that differs between two blocks of one kind, in the coordinates that the control shows.

    Args:
        names: Of the axes.
        begins_apart: The block before ends elsewhere, so that this one begins elsewhere.
    """
    tolerance = limits.path_um / 1e3
    path: list[str] = []
    places = [("ends", now.end, before.end)]
    if not begins_apart:
        places.insert(0, ("starts", now.start, before.start))
    for what, one, other in places:
        added = now.shown or (0.0,) * len(names)
        apart = [
            (name, here + more, there + more)
            for name, here, there, more in zip(names, one, other, added, strict=False)
            if abs(here - there) > tolerance
        ]
        if apart:
            here = " ".join(name + number(value) for name, value, _ in apart)
            there = " ".join(name + number(value) for name, _, value in apart)
            path.append(f"{what} at {here}, baseline {there}")
    if now.kind == "dwell" and abs(now.value - before.value) > _SMALLEST_TIME:
        path.append(f"dwell {number(now.value)} s, baseline {number(before.value)} s")
    if now.center and before.center:
        path += _arc_differences(before, now, tolerance, begins_apart=begins_apart)
    found = [("baseline-path", "; ".join(path))] if path else []
    if abs(now.feed - before.feed) > limits.feed_percent / 100.0 * before.feed + 1e-6:
        message = (
            f"feed {number(now.feed)}, baseline {number(before.feed)}: "
            f"differs by more than {limits.feed_percent:g} %"
        )
        found.append(("baseline-feed", message))
    if now.corner != before.corner:
        found.append(("baseline-corner", f"corner {now.corner}, baseline {before.corner}"))
    if now.acceleration != before.acceleration:
        message = f"acceleration {now.acceleration}, baseline {before.acceleration}"
        found.append(("baseline-acceleration", message))
    return found


def _arc_differences(
    before: BaselineEntry, now: BaselineEntry, tolerance: float, *, begins_apart: bool
) -> list[str]:
    same_side = sum(a * b for a, b in zip(now.normal, before.normal, strict=True))
    if abs(same_side) < _PARALLEL:
        return [f"arc in the plane {_plane(now)}, baseline {_plane(before)}"]
    found = []
    if math.dist(now.center, before.center) > tolerance and not begins_apart:
        added = now.shown or (0.0, 0.0, 0.0)
        here, there = (
            " ".join(map(number, map(operator.add, arc.center, added))) for arc in (now, before)
        )
        found.append(f"arc about ({here}), baseline ({there})")
    if abs(now.value * math.copysign(1.0, same_side) - before.value) > _SWEEP_DEG:
        found.append(f"arc {_turn(now)}, baseline {_turn(before)}")
    return found


def _plane(arc: BaselineEntry) -> str:
    axis = tuple(round(abs(part), 9) for part in arc.normal)
    return _PLANES.get(axis, f"across ({' '.join(map(number, arc.normal))})")


def _turn(arc: BaselineEntry) -> str:
    turning = "counter-clockwise" if arc.value > 0.0 else "clockwise"
    return f"{turning} by {number(abs(arc.value))} degrees"
