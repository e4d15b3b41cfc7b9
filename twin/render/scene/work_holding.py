"""What carries the stock: parallels between the table and the blank, drawn where there is a gap."""

import mujoco
import numpy as np

from twin.job.job_file import StockTable
from twin.machine.description.kinematics import TABLE_TOP
from twin.machine.model.work_holding import supports
from twin.nc.canonical import FloatArray
from twin.render.scene.placement import Placement
from twin.units import MM

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
    top = part_corner + np.array(stock.position)
    foot = placement.points((top - [0.0, 0.0, stock.extent[2]])[None])[0]
    height = foot[2] - spec.site(TABLE_TOP).pos[2]
    middle = foot - [0.0, 0.0, height / 2]
    for support in supports(stock.extent, height / MM, box=not stock.on_post):
        half = [each * MM for each in support.half]
        kind = mujoco.mjtGeom.mjGEOM_CYLINDER if support.round else mujoco.mjtGeom.mjGEOM_BOX
        size = [half[0], half[2], 0.0] if support.round else half
        aside = placement.rotation @ [0.0, support.aside * MM, 0.0]
        _add(spec, f"{support.name} seen", kind, size, middle + aside, placement)


def _add(
    spec: mujoco.MjSpec,
    name: str,
    kind: mujoco.mjtGeom,
    size: list[float],
    position: FloatArray,
    placement: Placement,
) -> None:
    spec.site(TABLE_TOP).parent.add_geom(
        name=name,
        type=kind,
        size=size,
        pos=list(position),
        quat=list(placement.quaternion),
        rgba=_COLOUR,
        contype=0,
        conaffinity=0,
        mass=0.0,
        group=2,
    )
