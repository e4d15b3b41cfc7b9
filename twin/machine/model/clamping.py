"""What a job clamps on the table: it may not reach into each other, nor into the table."""

import itertools
import math

import mujoco

from twin.errors import ConfigError
from twin.machine.description.config import Machine
from twin.machine.model.model import BLANK, ROTARY_TABLE, clearance_model
from twin.machine.model.tool_shape import COLLISION_GROUP
from twin.machine.model.work_holding import PARALLELS, POST
from twin.units import MM

TOUCHING = 0.01
"""Overlap that is touching [mm]: the overlap that is no collision either."""
_FAR = 1.0


def refuse_overlaps(machine: Machine, spec: mujoco.MjSpec, bore: float | None = None) -> None:
    """Hold fixtures against each other, against the stock and against the table that they stand on.

    Args:
        machine: The machine with all that is clamped on it.
        spec: Its model.
        bore: Diameter of the stock's hole [mm], in which a fixture may stand; None: it has none.

    Raises:
        ConfigError: Two of them are in one place.
    """
    fixtures = {fixture.name for fixture in machine.file.fixtures}
    if not fixtures:
        return
    model = clearance_model(machine, spec)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    table = int(model.body(ROTARY_TABLE).id)
    solids = [
        geom
        for geom in range(model.ngeom)
        if model.geom_group[geom] == COLLISION_GROUP and int(model.geom_bodyid[geom]) == table
    ]
    for one, two in itertools.combinations(solids, 2):
        names = [model.geom(geom).name for geom in (one, two)]
        if not fixtures.intersection(names) or any(name in _CARRIES for name in names):
            continue
        depth = -mujoco.mj_geomDistance(model, data, one, two, _FAR, None) / MM
        within = BLANK in names and bore is not None
        if depth > TOUCHING and not (within and _in_bore(model, data, one, two, bore)):
            fixture, other = sorted(names, key=lambda name: name not in fixtures)
            raise ConfigError(
                f"fixture '{fixture}' reaches {depth:.2f} mm into the {other}: change its position or size"
            )


_CARRIES = (*PARALLELS, POST)
"""What the twin puts under the stock gives way to a fixture there."""


def _in_bore(
    model: mujoco.MjModel, data: mujoco.MjData, one: int, two: int, bore: float | None
) -> bool:
    """Whether the one of the two that is no stock stands within the stock's hole."""
    stock, fixture = (one, two) if model.geom(one).name == BLANK else (two, one)
    x, y, _ = abs(data.geom_xpos[fixture] - data.geom_xpos[stock])
    size = model.geom_size[fixture]
    if model.geom_type[fixture] == mujoco.mjtGeom.mjGEOM_BOX:
        reach = math.hypot(x + size[0], y + size[1])
    else:
        reach = math.hypot(x, y) + size[0]
    return bore is not None and reach / MM <= bore / 2.0 + TOUCHING
