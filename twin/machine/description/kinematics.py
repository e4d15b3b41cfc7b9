"""The chain of joints from tool to part, read from a machine's MJCF model."""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np

from twin.errors import ConfigError
from twin.kinematics import Kinematics
from twin.nc.canonical import SPATIAL_AXES, Axes, FloatArray
from twin.units import MM

SPINDLE_NOSE = "spindle_nose"
"""Site on the head at the lower end of the spindle, on its axis; tools lie along the z axis of its body."""
TABLE_TOP = "table_top"
"""Site in the middle of the work-holding surface."""

_SQUARE = 1e-6
"""Sines of angles between X, Y and Z, less of right angles, that rounding of a model's numbers explains."""

_ROUNDING = 1e-9
_JOINT_TYPES = {"linear": mujoco.mjtJoint.mjJNT_SLIDE, "rotary": mujoco.mjtJoint.mjJNT_HINGE}


class Joint(NamedTuple):
    """What a machine file says of the joint of an axis."""

    name: str
    direction: int
    """1, or -1 where the joint counts against the machine coordinate."""


def part_carrier(model: mujoco.MjModel) -> int:
    """Number of the body that the part is clamped to."""
    return int(model.site_bodyid[model.site(TABLE_TOP).id])


class ModelAtZero(NamedTuple):
    """What a machine's model says of it with all axes at zero.

    Attributes:
        kinematics: Which joints carry the tool and which the part, their order, directions and centres.
        spindle_over_table: Height of the spindle nose over the work-holding surface [mm].
    """

    kinematics: Kinematics
    spindle_over_table: float


def read_model(model_path: Path, axes: Axes, joints: Sequence[Joint]) -> ModelAtZero:
    """Read a machine's model, without its solids.

    Raises:
        ConfigError: The model is no mill; the message says why.
    """
    try:
        spec = mujoco.MjSpec.from_file(str(model_path))
        for geom in spec.geoms:
            geom.contype = geom.conaffinity = 0
        spec.compiler.discardvisual = True
        model = spec.compile()
    except ValueError as error:
        raise ConfigError(f"{model_path}: is not an MJCF model: {error}") from error
    try:
        data = mujoco.MjData(model)
        data.qpos[:] = 0.0
        mujoco.mj_kinematics(model, data)
        chain = _chain(model, data, axes, joints)
    except ValueError as error:
        raise ConfigError(f"{model_path}: is no mill: {error}") from error
    over_table = data.site(SPINDLE_NOSE).xpos[2] - data.site(TABLE_TOP).xpos[2]
    return ModelAtZero(chain, float(over_table) / MM)


def _chain(
    model: mujoco.MjModel, data: mujoco.MjData, axes: Axes, joints: Sequence[Joint]
) -> Kinematics:
    tool, part = _joints_to(model, SPINDLE_NOSE), _joints_to(model, TABLE_TOP)
    columns = _columns(model, joints)
    _require_mill(model, axes, columns, tool, part)
    chain = np.array([*reversed(tool), *part], dtype=np.int64)
    column = np.array([columns[joint] for joint in chain], dtype=np.int64)
    on_tool = np.array([joint in tool for joint in chain])
    sign = np.where(on_tool, 1, -1) * np.array([joints[at].direction for at in column])
    moves = sign[:, None] * data.xaxis[chain]
    frame = _machine_frame(moves[np.argsort(column)[:3]])
    nose, table = data.site(SPINDLE_NOSE), data.site(TABLE_TOP)
    rotary = model.jnt_type[chain] == mujoco.mjtJoint.mjJNT_HINGE
    anchor = (data.xanchor[chain] - nose.xpos) @ frame.T / MM
    return Kinematics(
        column=column,
        rotary=rotary,
        on_tool=on_tool,
        axis=_directions(moves @ frame.T),
        anchor=_places(np.where(rotary[:, None], anchor, 0.0)),
        tool=_spindle(_directions(frame @ nose.xmat.reshape(3, 3)[:, 2])),
        table=_places(frame @ (table.xpos - nose.xpos) / MM),
        table_axes=_directions(frame @ table.xmat.reshape(3, 3)),
    )


def in_words(names: Sequence[str], chain: Kinematics) -> str:
    """The chain, for people: ``the part turns on C, C on A, A on Y; the tool moves in X and Z``."""
    sides = []
    for what, on_tool in (("part", False), ("tool", True)):
        joints = np.flatnonzero(chain.on_tool == on_tool)
        inward = joints if on_tool else joints[::-1]
        carriers = [names[int(chain.column[joint])] for joint in inward]
        if not carriers:
            sides.append(f"the {what} stands still")
        elif chain.rotary[joints].any():
            verb = "turns on" if chain.rotary[inward[0]] else "moves in"
            carried = [f"{inner} on {outer}" for inner, outer in pairwise(carriers)]
            sides.append(", ".join([f"the {what} {verb} {carriers[0]}", *carried]))
        else:
            *first, last = sorted(carriers)
            sides.append(
                f"the {what} moves in {' and '.join([', '.join(first), last] if first else [last])}"
            )
    return "; ".join(sides)


def _joints_to(model: mujoco.MjModel, site: str) -> list[int]:
    """Joints between the base and the body of a site, from the base."""
    index = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, site)
    if index < 0:
        raise ValueError(f"it has no site '{site}'")
    if not np.array_equal(model.site_quat[index], (1.0, 0.0, 0.0, 0.0)):
        raise ValueError(f"site '{site}' must not be turned against its body")
    body, joints = int(model.site_bodyid[index]), []
    while body:
        first, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
        joints.extend(range(first + count - 1, first - 1, -1))
        body = int(model.body_parentid[body])
    return joints[::-1]


def _columns(model: mujoco.MjModel, joints: Sequence[Joint]) -> dict[int, int]:
    """Joint to column of its axis."""
    found = {}
    for column, joint in enumerate(joints):
        index = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, joint.name)
        if index < 0:
            raise ValueError(f"it has no joint '{joint.name}'")
        found[index] = column
    return found


def _require_mill(
    model: mujoco.MjModel, axes: Axes, columns: dict[int, int], tool: list[int], part: list[int]
) -> None:
    """Raise unless every joint between tool and part is an axis, and X, Y and Z are among them."""
    for joint in (*tool, *part):
        name = model.joint(joint).name
        if joint not in columns:
            raise ValueError(f"joint '{name}' between base and tool or part is of no axis")
        if joint in tool and joint in part:
            raise ValueError(f"joint '{name}' moves tool and part together")
        kind = axes.kinds[columns[joint]]
        if model.jnt_type[joint] != _JOINT_TYPES[kind]:
            raise ValueError(f"joint '{name}' does not move as a {kind} axis")
    moved = {axes.names[columns[joint]] for joint in (*tool, *part)}
    for name in SPATIAL_AXES:
        if name not in moved:
            raise ValueError(f"{name} moves neither tool nor part")


def _machine_frame(directions: FloatArray) -> FloatArray:
    """Rows are the directions of X, Y and Z in the world."""
    if np.abs(directions @ directions.T - np.eye(3)).max() > _SQUARE:
        raise ValueError("X, Y and Z are not at right angles")
    if np.linalg.det(directions) < 0.0:
        raise ValueError("X, Y and Z are left-handed; one of them points the wrong way")
    return directions


def _spindle(direction: FloatArray) -> FloatArray:
    """The direction of the spindle, which is Z (ISO 841)."""
    if not np.array_equal(direction, (0.0, 0.0, 1.0)):
        x, y, z = direction
        raise ValueError(
            f"the spindle points along {x:.3g}, {y:.3g}, {z:.3g} of X, Y, Z, not along Z"
        )
    return direction


def _places(values: FloatArray) -> FloatArray:
    """Without the rounding of metres: to a picometre."""
    return np.round(values, 9) + 0.0


def _directions(values: FloatArray) -> FloatArray:
    """With what rounding of quaternions has turned put back among the axes."""
    whole = np.round(values)
    return np.where(np.abs(values - whole) < _ROUNDING, whole, values) + 0.0
