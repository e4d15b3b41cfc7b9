"""What goes up and down with the tool above its holder, as upright solids: nose, housing, head."""

import dataclasses

import mujoco
import numpy as np

from twin.job.job_file import ToolTable
from twin.machine.model.model import MachineModel
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
    """An upright cylinder or box that is fixed to the spindle's housing.

    Attributes:
        round: A cylinder; else a box.
        half: Half of its size along machine X and Y [mm].
        offset: Its middle off the spindle's axis along machine X and Y [mm].
        above: Height of its lower end above the spindle nose, or, of what ``above_tip`` gives,
            above the tip [mm].
        height: From there to its upper end [mm].
        swivels: It turns with the tool where a head does.
    """

    name: str
    round: bool
    half: tuple[float, float]
    offset: tuple[float, float]
    above: float
    height: float
    swivels: bool = True


class HeadShape:
    """The solids around the spindle, as the model's collision geoms say.

    A geom that is neither an upright cylinder nor an upright box counts as the box around it. So does what
    carries a swivel head: it is so above the spindle only while the head is upright, and is held
    against the stock only then.
    """

    def __init__(self, whole: MachineModel) -> None:
        """Measure a machine with all axes at zero; the tool in its spindle is passed over."""
        self._flange, model = whole.machine.file.spindle.flange_diameter, whole.solids
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        nose = data.site("spindle_nose")
        inner, *outer = _above_nose(model, data)
        self._solids = tuple(
            _solid(model, data, geom, nose.xpos, swivels=body == inner)
            for geom in range(model.ngeom)
            if model.geom_group[geom] == COLLISION_GROUP
            and model.geom_contype[geom] & TOOL_SIDE
            and (body := int(model.body_weldid[model.geom_bodyid[geom]])) in (inner, *outer)
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


def _above_nose(model: mujoco.MjModel, data: mujoco.MjData) -> list[int]:
    """Bodies that move with the spindle while its swivels stand at zero, from the spindle outwards."""
    nose = model.site("spindle_nose")
    along = data.site("spindle_nose").xmat.reshape(3, 3)[:, 2]
    found = [int(model.body_weldid[int(nose.bodyid[0])])]
    while found[-1] and all(
        model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE
        and abs(data.xaxis[joint] @ along) < _UPRIGHT
        for joint in _joints_of(model, found[-1])
    ):
        found.append(int(model.body_weldid[model.body_parentid[found[-1]]]))
    return found


def _joints_of(model: mujoco.MjModel, body: int) -> range:
    first = int(model.body_jntadr[body])
    return range(first, first + int(model.body_jntnum[body]))


def _solid(
    model: mujoco.MjModel, data: mujoco.MjData, geom: int, nose: FloatArray, *, swivels: bool
) -> HeadSolid:
    turn = data.geom_xmat[geom].reshape(3, 3)
    upright = bool(abs(turn[2, 2]) > _UPRIGHT)
    form = mujoco.mjtGeom(model.geom_type[geom])
    aabb = model.geom_aabb[geom]
    middle = data.geom_xpos[geom] + turn @ aabb[:3] - nose
    half = np.abs(turn) @ aabb[3:]
    x, y, lower = (float(value) / MM for value in (middle[0], middle[1], middle[2] - half[2]))
    return HeadSolid(
        model.geom(geom).name,
        swivels and upright and form == mujoco.mjtGeom.mjGEOM_CYLINDER,
        (float(half[0]) / MM, float(half[1]) / MM),
        (x, y),
        lower,
        2.0 * float(half[2]) / MM,
        swivels,
    )
