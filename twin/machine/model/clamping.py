"""What a job clamps on the table: it may not reach into each other, nor into the table; and what carries the stock."""

import itertools
import math

import mujoco
import numpy as np

from twin.errors import ConfigError
from twin.machine.description.kinematics import part_carrier
from twin.machine.model.fixture_shape import fixture_of
from twin.machine.model.model import BLANK, MachineModel
from twin.machine.model.tool_shape import COLLISION_GROUP
from twin.machine.model.work_holding import PARALLELS, POST
from twin.nc.canonical import FloatArray
from twin.units import MM

TOUCHING = 0.01
"""Overlap that is touching [mm]: the overlap that is no collision either."""
_FAR = 1.0


def refuse_overlaps(clamped: MachineModel, bore: float | None = None) -> None:
    """Hold fixtures against each other, against the stock and against the table that they are on.

    Args:
        clamped: The machine with all that is clamped on it.
        bore: Diameter of the stock's hole [mm], in which a fixture may stand; None: it has none.

    Raises:
        ConfigError: Two of them are in one place.
    """
    fixtures = {fixture.name for fixture in clamped.machine.file.fixtures}
    if not fixtures:
        return
    model = clamped.solids
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    table = part_carrier(model)
    solids = [
        geom
        for geom in range(model.ngeom)
        if model.geom_group[geom] == COLLISION_GROUP and int(model.geom_bodyid[geom]) == table
    ]
    for one, two in itertools.combinations(solids, 2):
        names = [fixture_of(model.geom(geom).name) for geom in (one, two)]
        if not fixtures.intersection(names) or any(name in _CARRIES for name in names):
            continue
        if names[0] == names[1]:
            continue
        depth = -mujoco.mj_geomDistance(model, data, one, two, _FAR, None) / MM
        within = BLANK in names and bore is not None
        if depth > TOUCHING and not (within and _in_bore(model, data, one, two, bore)):
            fixture, other = sorted(names, key=lambda name: name not in fixtures)
            raise ConfigError(
                f"fixture '{fixture}' reaches {depth:.2f} mm into the {other}: change its position or size"
            )


_Z = 2
_CARRIES = (*PARALLELS, POST)
"""What the twin puts under the stock gives way to a fixture there."""


def _in_bore(
    model: mujoco.MjModel, data: mujoco.MjData, one: int, two: int, bore: float | None
) -> bool:
    """Whether the one of the two that is no stock is within the stock's hole."""
    stock, fixture = (one, two) if model.geom(one).name == BLANK else (two, one)
    across = _corners(model, data, fixture)[:, :2] - data.geom_xpos[stock][:2]
    reach = float(np.hypot(*across.T).max())
    if model.geom_type[fixture] == mujoco.mjtGeom.mjGEOM_CYLINDER:
        middle = data.geom_xpos[fixture][:2] - data.geom_xpos[stock][:2]
        reach = math.hypot(*middle) + float(model.geom_size[fixture][0])
    return bore is not None and reach / MM <= bore / 2.0 + TOUCHING


def _corners(model: mujoco.MjModel, data: mujoco.MjData, geom: int) -> FloatArray:
    """Corners of a mesh, or of the box around another geom, shape (n, 3) [m]."""
    if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH:
        mesh = int(model.geom_dataid[geom])
        first = int(model.mesh_vertadr[mesh])
        corners = model.mesh_vert[first : first + int(model.mesh_vertnum[mesh])]
    else:
        corners = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
        corners = corners * model.geom_size[geom]
    return corners @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]


def what_carries(clamped: MachineModel) -> str | None:
    """Why nothing carries the stock, or None where something does, or where there is no stock.

    What is under the stock is taken to be packed with parallels or a post, as they are drawn, where there is something
    to stand them on no deeper than ``TALLEST``; a fixture that touches the stock holds it.

    Args:
        clamped: The machine with all that is clamped on it.
    """
    frame = clamped.machine.part_frame
    if clamped.blank is None or (frame.chain is not None and frame.table_about(_Z) is None):
        return None
    model = clamped.solids
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    stock, table = int(model.geom(BLANK).id), part_carrier(model)
    fixtures = {fixture.name for fixture in clamped.machine.file.fixtures}
    below = np.inf
    for geom in range(model.ngeom):
        name = fixture_of(model.geom(geom).name)
        if model.geom_bodyid[geom] != table or name in (BLANK, *_CARRIES):
            continue
        if name in fixtures:
            away = mujoco.mj_geomDistance(model, data, stock, geom, _FAR, None) / MM
            if away <= TOUCHES:
                return None
        below = min(below, _depth_below(model, data, 0.5 * MM * clamped.blank.size[2], geom))
    if below <= TALLEST:
        return None
    if below == np.inf:
        return "nothing of the table or of a fixture lies under the stock's middle"
    return f"the stock lies {below:.0f} mm above what is under it"


TALLEST = 150.0
"""How far parallels, blocks or a post carry a stock at most [mm]: what is higher is on a fixture of its own."""
TOUCHES = 0.5
"""A fixture so near to the stock holds it [mm]: jaws are given to the millimetre."""


def _depth_below(model: mujoco.MjModel, data: mujoco.MjData, half: float, geom: int) -> float:
    """How far a geom lies under the middle of the stock's lower face [mm]; infinite where it does not.

    Args:
        half: Half the stock's height [m].
    """
    stock = data.geom(BLANK)
    down = -data.xmat[part_carrier(model)].reshape(3, 3)[:, 2]
    # From a little within the stock, so that what it lies on is met.
    start = stock.xpos + (half - _WITHIN) * down
    if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH:
        found = mujoco.mj_rayMesh(model, data, geom, start, down, None)
    else:
        turned = data.geom_xmat[geom]
        place, size = data.geom_xpos[geom], model.geom_size[geom]
        kind = int(model.geom_type[geom])
        found = mujoco.mju_rayGeom(place, turned, size, start, down, kind, None)
    return np.inf if found < 0.0 else (found - _WITHIN) / MM


_WITHIN = 1e-3
"""[m]"""
