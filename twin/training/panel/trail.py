"""The way of the tool's tip over the part, as it is drawn: its last stretch, as a thin tube."""

import itertools
from collections import deque

import mujoco
import numpy as np

from twin.nc.canonical import FloatArray
from twin.render.scene.placement import Frame

MOST = 240
"""Points that are kept: the page draws no more than a thousand extra bodies."""
APART_MM = 0.5
"""Shortest way between two points [mm]."""
PLAIN_MOST, PLAIN_APART_MM = 30, 1.0
"""The same where a processor draws: each stretch costs it as much as the whole table."""
_RADIUS_M = 0.0004
_COLOUR = np.array([1.0, 0.45, 0.05, 1.0], np.float32)


class Trail:
    """The last points that the tip has passed, in the part's frame."""

    def __init__(self, *, plain: bool) -> None:
        """Begin without a point.

        Args:
            plain: Keep few points, for computers without a graphics card.
        """
        self._points: deque[tuple[float, ...]] = deque(maxlen=PLAIN_MOST if plain else MOST)
        self._apart = PLAIN_APART_MM if plain else APART_MM

    def add(self, tip: tuple[float, ...]) -> None:
        """The tip is there now [mm]."""
        if not self._points or np.linalg.norm(np.subtract(tip, self._points[-1])) > self._apart:
            self._points.append(tip)

    def clear(self) -> None:
        """Forget everything."""
        self._points.clear()

    def geoms(self, frame: Frame, position: FloatArray, rotation: FloatArray) -> list[mujoco.MjvGeom]:  # fmt: skip
        """The tube.

        Args:
            frame: Where the part's frame lies on the table.
            position: Of the table in the world, shape (3,) [m].
            rotation: Of the table in the world, shape (3, 3).
        """
        if len(self._points) < 2:
            return []
        places = frame.points(np.array(self._points)) @ rotation.T + position
        found = []
        for first, second in itertools.pairwise(places):
            geom = mujoco.MjvGeom()
            kind = int(mujoco.mjtGeom.mjGEOM_CAPSULE)
            mujoco.mjv_initGeom(geom, kind, np.zeros(3), np.zeros(3), np.eye(3).ravel(), _COLOUR)
            mujoco.mjv_connector(geom, kind, _RADIUS_M, first, second)
            found.append(geom)
        return found
