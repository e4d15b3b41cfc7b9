"""Cameras that look at the part, wherever it lies and however large it is."""

import mujoco
import numpy as np

from twin.machine.description.kinematics import TABLE_TOP
from twin.nc.canonical import FloatArray
from twin.render.scene.placement import Placement

PART = "part"
"""Close to the part; it goes along with the table but does not turn."""
RIDING = "riding"
"""Camera that turns with the part: the machine seems to turn around it."""
PART_CAMERAS = (PART, RIDING)

_BESIDE, _BEFORE, _ABOVE = -0.45, -1.0, 0.62
"""From the part to the camera: low enough to look in below the head."""
_UPRIGHT = 0.5
"""Of the direction upwards along the spindle, from which on a spindle is a vertical one."""
_FIELD_DEG = 30.0
_MARGIN = 1.12
"""Room around the part's bounding ball."""
SMALLEST_MM = 40.0
"""A smaller part is looked at from as far as one of this size, so that the tool is seen too."""


def add_part_cameras(
    spec: mujoco.MjSpec, placement: Placement, center: FloatArray, radius: float
) -> None:
    """Add the part's cameras to a machine's specification, unless it has its own of these names.

    Args:
        spec: The machine, with its joints where the part's frame is parallel to the machine's.
        placement: Where the part's frame lies on it.
        center: Middle of what is looked at, in the part's frame, shape (3,) [mm].
        radius: Of the ball around it [mm].
    """
    known = [camera.name for camera in spec.cameras]
    away = _direction(placement.up)
    half = np.deg2rad(0.5 * _FIELD_DEG)
    distance = _MARGIN * max(radius, SMALLEST_MM) / np.sin(half)
    eye = center + distance * away
    right = np.cross(placement.up, away)
    right /= np.linalg.norm(right)
    up = np.cross(away, right)
    table = spec.site(TABLE_TOP).parent
    for name, body, frame in (
        (RIDING, table, placement),
        (PART, table.parent, placement.at_rest),
    ):
        if name in known:
            continue
        body.add_camera(
            name=name,
            pos=frame.points(eye[None])[0],
            xyaxes=[*(frame.rotation @ right), *(frame.rotation @ up)],
            fovy=_FIELD_DEG,
        )


def _direction(up: FloatArray) -> FloatArray:
    """Unit vector from the part to the camera; at a horizontal spindle it looks from the side at what the tool does."""
    across, before = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
    if abs(up[2]) < _UPRIGHT:
        before = np.cross(up, [0.0, 0.0, -1.0])
        across = np.cross(before, up)
    away = _BESIDE * across + _BEFORE * before + _ABOVE * up
    return away / np.linalg.norm(away)


def framed(points: FloatArray) -> tuple[FloatArray, float]:
    """Middle and radius of the ball around the bounding box of points, shape (n, 3) [mm]."""
    if not len(points):
        return np.zeros(3), SMALLEST_MM
    low, high = points.min(axis=0), points.max(axis=0)
    return 0.5 * (low + high), 0.5 * float(np.linalg.norm(high - low))
