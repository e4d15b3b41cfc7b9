"""What carries the tool, as solids that are upright with all axes at zero: nose, housing, head, carriage."""

import dataclasses
from typing import NamedTuple

import mujoco
import numpy as np

from twin.job.job_file import ToolTable
from twin.machine.description.config import MachineConfig
from twin.machine.description.kinematics import SPINDLE_NOSE, TABLE_TOP
from twin.machine.model.tool_shape import (
    COLLISION_GROUP,
    TOOL_NAMES,
    TOOL_SIDE,
    tool_cylinders,
)
from twin.nc.canonical import FloatArray
from twin.units import MM

_UPRIGHT = 1.0 - 1e-9


@dataclasses.dataclass(frozen=True, slots=True)
class HeadSolid:
    """A cylinder or box along the spindle's axis, with all axes at zero.

    Attributes:
        round: A cylinder; else a box.
        half: Half of its size along machine X and Y [mm].
        offset: Its middle off the spindle's axis along machine X and Y [mm].
        above: Height of its lower end above the spindle nose, or, of what ``above_tip`` gives,
            above the tip [mm].
        height: From there to its upper end [mm].
        beyond: Columns of the axes between it and the spindle: they move the tool, and not it.
    """

    name: str
    round: bool
    half: tuple[float, float]
    offset: tuple[float, float]
    above: float
    height: float
    beyond: tuple[int, ...] = ()


class HeadShape:
    """The solids around the spindle, as the model's collision geoms say.

    A geom that is neither a cylinder along the spindle nor a box along machine X, Y and Z counts as the box around it. So does
    a cylinder that does not go with the spindle.
    """

    def __init__(self, machine: MachineConfig, model: mujoco.MjModel) -> None:
        """Measure the solids of a machine with all axes at zero; the tool in its spindle is passed over."""
        self._flange = machine.file.spindle.flange_diameter
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        beyond = _axes_beyond(machine, model)
        table = data.site(TABLE_TOP).xmat.reshape(3, 3)
        view = _View(model, data, machine.kinematics.table_axes @ table.T)
        self._solids = tuple(
            view.solid(geom, beyond[body])
            for geom in range(model.ngeom)
            if model.geom_group[geom] == COLLISION_GROUP
            and model.geom_contype[geom] & TOOL_SIDE
            and (body := int(model.body_weldid[model.geom_bodyid[geom]])) in beyond
            and model.geom(geom).name not in TOOL_NAMES
        )

    def above_tip(self, tool: ToolTable) -> tuple[HeadSolid, ...]:
        """The holder's flange and what is above it, with a tool in the spindle."""
        pieces = tool_cylinders(tool, self._flange)
        flange = tuple(
            HeadSolid(
                "holder's flange",
                True,
                (piece.radius, piece.radius),
                (0.0, 0.0),
                tool.length + piece.bottom,
                piece.top - piece.bottom,
            )
            for piece in pieces
            if piece.name == "tool_flange"
        )
        raised = (
            dataclasses.replace(solid, above=solid.above + tool.length) for solid in self._solids
        )
        return (*flange, *raised)


def _axes_beyond(machine: MachineConfig, model: mujoco.MjModel) -> dict[int, tuple[int, ...]]:
    """Bodies that carry the spindle, itself among them: columns of the axes between it and each."""
    columns = {machine.axis(name).joint: at for at, name in enumerate(machine.axes.names)}
    body = int(model.body_weldid[int(model.site(SPINDLE_NOSE).bodyid[0])])
    found, passed = {}, []
    while body:
        found[body] = tuple(sorted(passed))
        first = int(model.body_jntadr[body])
        joints = range(first, first + int(model.body_jntnum[body]))
        # A spring between motor and axis is a joint of its own.
        names = [model.joint(joint).name for joint in joints]
        passed += [columns[name] for name in names if name in columns]
        body = int(model.body_weldid[model.body_parentid[body]])
    return found


class _View(NamedTuple):
    """A compiled model with all axes at zero, seen along the machine's axes.

    Attributes:
        data: Where all of it is.
        frame: Directions of machine X, Y and Z in the world as rows, shape (3, 3).
    """

    model: mujoco.MjModel
    data: mujoco.MjData
    frame: FloatArray

    def solid(self, geom: int, beyond: tuple[int, ...]) -> HeadSolid:
        """A geom, or the box around it."""
        model, data = self.model, self.data
        turn = self.frame @ data.geom_xmat[geom].reshape(3, 3)
        upright = bool(abs(turn[2, 2]) > _UPRIGHT)
        aabb = model.geom_aabb[geom]
        nose = data.site(SPINDLE_NOSE).xpos
        middle = self.frame @ (data.geom_xpos[geom] - nose) + turn @ aabb[:3]
        half = np.abs(turn) @ aabb[3:]
        x, y, lower = (float(value) / MM for value in (middle[0], middle[1], middle[2] - half[2]))
        return HeadSolid(
            model.geom(geom).name,
            upright and not beyond and model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_CYLINDER,
            (float(half[0]) / MM, float(half[1]) / MM),
            (x, y),
            lower,
            2.0 * float(half[2]) / MM,
            beyond,
        )
