"""What carries the stock: parallels between the table and the blank, drawn where there is a gap."""

import mujoco
import numpy as np

from twin.job.job_file import StockTable
from twin.nc.canonical import FloatArray
from twin.render.scene.placement import ROTARY_TABLE, Placement
from twin.units import MM

TABLE_TOP = "table_top"
"""Site of the model in the middle of the work-holding surface, on the body that carries the part."""
INSET = 0.15
"""How far the parallels stand back from the blank's sides, as a share of its size."""
SMALLEST_GAP_MM = 0.1
_COLOUR = (0.33, 0.36, 0.4, 1.0)


def add_work_holding(
    spec: mujoco.MjSpec, stock: StockTable, placement: Placement, part_corner: FloatArray
) -> None:
    """Put two parallels, or a post under a round blank, between the table and the stock.

    Args:
        spec: The drawn model; it is changed.
        stock: The blank.
        placement: Where the part's frame lies on the body that carries it.
        part_corner: Program zero in the part's frame, shape (3,) [mm].
    """
    size = np.array(stock.extent)
    top = part_corner + np.array(stock.position)
    foot = placement.points((top - [0.0, 0.0, size[2]])[None])[0]
    height = foot[2] - spec.site(TABLE_TOP).pos[2]
    if height < SMALLEST_GAP_MM * MM:
        return
    middle = foot - [0.0, 0.0, height / 2]
    if stock.shape == "box":
        half = [size[0] * (0.5 - INSET) * MM, size[1] * 0.1 * MM, height / 2]
        aside = placement.rotation @ [0.0, size[1] * (0.4 - INSET) * MM, 0.0]
        for number, way in enumerate((-1.0, 1.0)):
            _add(
                spec,
                f"parallel {number}",
                mujoco.mjtGeom.mjGEOM_BOX,
                half,
                middle + way * aside,
                placement,
            )
    else:
        radius = size[0] * (0.5 - INSET) * MM
        _add(
            spec,
            "post",
            mujoco.mjtGeom.mjGEOM_CYLINDER,
            [radius, height / 2, 0.0],
            middle,
            placement,
        )


def _add(
    spec: mujoco.MjSpec,
    name: str,
    kind: mujoco.mjtGeom,
    size: list[float],
    position: FloatArray,
    placement: Placement,
) -> None:
    spec.body(ROTARY_TABLE).add_geom(
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
