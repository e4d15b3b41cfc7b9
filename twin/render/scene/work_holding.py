"""What carries the stock: parallels between the table and the blank, drawn where there is a gap."""

import mujoco
import numpy as np

from twin.job.job_file import StockTable
from twin.machine.description.kinematics import TABLE_TOP
from twin.machine.model.work_holding import supports
from twin.nc.canonical import FloatArray
from twin.render.scene.placement import Placement
from twin.units import MM

_UP = np.array([0.0, 0.0, 1.0])
_UPRIGHT = 0.5
"""Of a table's normal along the part's Z, from which on the part stands on it."""
_ROUNDED = 9
"""Digits of a direction that the rounding of quaternions leaves."""
_COLOUR = (0.33, 0.36, 0.4, 1.0)


def add_work_holding(
    spec: mujoco.MjSpec, stock: StockTable, placement: Placement, part_corner: FloatArray
) -> None:
    """Put two parallels, or a post under a round blank, between the table and the stock.

    Args:
        spec: The drawn model; it is changed.
        placement: Where the part's frame lies on the body that carries it.
        part_corner: Program zero in the part's frame, shape (3,) [mm].
    """
    upright = abs(float(placement.rotation[2, 2])) > _UPRIGHT
    # On a table that does not lie across the tool its own axes are those of what is put on it.
    axes = placement.rotation if upright else np.eye(3)
    size = np.abs(np.round(axes.T @ placement.rotation, _ROUNDED)) @ stock.extent
    middle = part_corner + np.array(stock.position) - [0.0, 0.0, 0.5 * stock.extent[2]]
    foot = placement.points(middle[None])[0] - MM * 0.5 * size[2] * _UP
    height = foot[2] - spec.site(TABLE_TOP).pos[2]
    for support in supports(tuple(size.tolist()), height / MM, box=not stock.on_post):
        half = [each * MM for each in support.half]
        kind = mujoco.mjtGeom.mjGEOM_CYLINDER if support.round else mujoco.mjtGeom.mjGEOM_BOX
        aside = axes @ [0.0, support.aside * MM, 0.0]
        turn = np.zeros(4)
        mujoco.mju_mat2Quat(turn, axes.ravel())
        spec.site(TABLE_TOP).parent.add_geom(
            name=f"{support.name} seen",
            type=kind,
            size=[half[0], half[2], 0.0] if support.round else half,
            pos=list(foot - 0.5 * height * _UP + aside),
            quat=list(turn),
            rgba=_COLOUR,
            contype=0,
            conaffinity=0,
            mass=0.0,
            group=2,
        )
