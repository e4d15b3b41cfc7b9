"""What a machine's MJCF model leaves out, and what the twin puts in its place.

Bodies, joints and shapes are enough for a machine of one's own: actuators, what may not meet, cameras and light follow.
A model that says these itself is not changed.
"""

from collections.abc import Iterator

import mujoco
import numpy as np

from twin.machine.description.config import MachineConfig
from twin.machine.description.kinematics import SPINDLE_NOSE, TABLE_TOP
from twin.machine.model.tool_shape import (
    COLLISION_GROUP,
    FRAME_SIDE,
    PART_SIDE,
    TOOL_SIDE,
    VISUAL_GROUP,
)
from twin.nc.canonical import FloatArray

CAMERAS = ("overview", "tool", "table", "top")
"""Cameras that jobs may name on any machine."""

_ANY_CONTACT = 1
"""MuJoCo's default of ``contype`` and ``conaffinity``."""
_FIELD_DEG = 38.0
_NEAR_TOOL_M = 0.18
"""Radius of what the tool's camera sees [m]: a holder with a tool and what it cuts."""
_NEAR_TABLE_M = 0.3
"""Radius of what the table's cameras see [m]."""
_FROM = {
    "overview": (-0.62, -0.85, 0.42),
    "tool": (-0.45, -0.85, 0.18),
    "table": (-0.45, -0.68, 0.62),
    "top": (0.0, -0.6, 0.8),
}
"""From what a camera looks at to the camera: to the right, to the back and up, seen from the front."""


def supply(spec: mujoco.MjSpec, machine: MachineConfig) -> list[str]:
    """Complete a model that leaves out actuators, what may not meet, cameras, or light.

    Args:
        spec: The model with the sites of spindle and table; it is changed.

    Returns:
        What was supplied, in words.
    """
    return [*_actuators(spec, machine), *_solids(spec), *_cameras(spec), *_light(spec)]


def _actuators(spec: mujoco.MjSpec, machine: MachineConfig) -> Iterator[str]:
    known = {actuator.name for actuator in spec.actuators}
    joints = {joint.name for joint in spec.joints}
    for name in machine.axes.names:
        joint = machine.axis(name).joint
        if name not in known and joint in joints:
            spec.add_actuator(name=name, target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT)
            yield f"actuator '{name}' is missing: a drive acts on joint '{joint}'"


def _solids(spec: mujoco.MjSpec) -> Iterator[str]:
    """Let shapes with MuJoCo's default contact bits be drawn, and be solids of the side that they move with.

    What lies under the table is built so as to pass the frame: it is watched against the tool's side alone.
    """
    tool, part = (_moving_bodies(spec, site) for site in (SPINDLE_NOSE, TABLE_TOP))
    sides: dict[str, list[str]] = {"tool": [], "part": [], "frame": []}
    for geom in [geom for geom in spec.geoms if geom.group not in (VISUAL_GROUP, COLLISION_GROUP)]:
        touches = geom.contype == geom.conaffinity == _ANY_CONTACT
        geom.contype = geom.conaffinity = 0
        geom.group = VISUAL_GROUP
        if not touches or geom.type == mujoco.mjtGeom.mjGEOM_PLANE:
            continue
        carriers = _carriers(geom.parent)
        if any(body in tool for body in carriers):
            side, bits = "tool", (TOOL_SIDE, PART_SIDE | FRAME_SIDE)
        elif any(body in part for body in carriers):
            on_table = carriers[0] == part[0]
            side, bits = "part", (PART_SIDE, TOOL_SIDE | FRAME_SIDE) if on_table else (0, TOOL_SIDE)
        else:
            side, bits = "frame", (FRAME_SIDE, TOOL_SIDE | PART_SIDE)
        sides[side].append(_add_solid(spec, geom, bits))
    yield from (
        f"which shapes may not meet is not said: on the side of the {side} {', '.join(names)}"
        for side, names in sides.items()
        if names
    )


def _moving_bodies(spec: mujoco.MjSpec, site: str) -> list[str]:
    """Bodies with joints that carry a site, from it outwards."""
    return _carriers(spec.site(site).parent)


def _carriers(body: mujoco.MjsBody) -> list[str]:
    """A body and those that carry it, where they have joints, outwards."""
    found = []
    while body is not None and body.name != "world":
        if body.joints:
            found.append(body.name)
        body = body.parent
    return found


def _add_solid(spec: mujoco.MjSpec, drawn: mujoco.MjsGeom, bits: tuple[int, int]) -> str:
    """Add the solid of a shape that is drawn; returns its name."""
    taken = {geom.name for geom in spec.geoms}
    called = name = drawn.name or drawn.parent.name
    number = 1
    if drawn.name:
        drawn.name = f"{name} as drawn"
        taken.remove(called)
    while name in taken:
        number += 1
        name = f"{called} {number}"
    solid = drawn.parent.add_geom(
        name=name,
        type=drawn.type,
        size=list(drawn.size),
        pos=list(drawn.pos),
        quat=list(drawn.quat),
        fromto=list(drawn.fromto),
        meshname=drawn.meshname,
        group=COLLISION_GROUP,
        contype=bits[0],
        conaffinity=bits[1],
        mass=0.0,
    )
    solid.alt = drawn.alt
    return name


def _cameras(spec: mujoco.MjSpec) -> Iterator[str]:
    """Fit the cameras that are missing to the model with all axes at zero."""
    known = {camera.name for camera in spec.cameras}
    missing = [name for name in CAMERAS if name not in known]
    if not missing:
        return
    model = spec.copy().compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    table, nose = data.site(TABLE_TOP), data.site(SPINDLE_NOSE)
    low, high = _bounds(model, data)
    middle, radius = 0.5 * (low + high), 0.5 * float(np.linalg.norm(high - low))
    front = _front(middle, table.xpos, radius)
    below = nose.xpos - _NEAR_TOOL_M * nose.xmat.reshape(3, 3)[:, 2]
    seen = {
        "overview": (spec.worldbody, middle, radius),
        "tool": (_unturned(spec, SPINDLE_NOSE), below, _NEAR_TOOL_M),
        "table": (_unturned(spec, TABLE_TOP), table.xpos, _NEAR_TABLE_M),
        "top": (_unturned(spec, TABLE_TOP), table.xpos, _NEAR_TABLE_M),
    }
    for name in missing:
        body, looked_at, around = seen[name]
        away = front @ (np.array(_FROM[name]) / np.linalg.norm(_FROM[name]))
        right = np.cross([0.0, 0.0, 1.0], away)
        right /= np.linalg.norm(right)
        eye = looked_at + away * around / np.sin(np.deg2rad(0.5 * _FIELD_DEG))
        frame = data.body(body.name)
        turn = frame.xmat.reshape(3, 3).T
        body.add_camera(
            name=name,
            pos=turn @ (eye - frame.xpos),
            xyaxes=[*(turn @ right), *(turn @ np.cross(away, right))],
            fovy=_FIELD_DEG,
        )
    yield f"cameras {', '.join(missing)} are missing: they are fitted to the model"


_LIGHTS = {
    "key": ((0.40, 0.78, -0.62), (0.62, 0.60, 0.57), True),
    "rim": ((-0.75, 0.25, -0.6), (0.22, 0.23, 0.26), False),
}
"""Direction, colour and shadow of the lamps of a model that has none, as the shipped machines are lit."""
_AMBIENT, _DIFFUSE, _SPECULAR = np.array(
    [[0.44, 0.44, 0.45], [0.24, 0.24, 0.24], [0.1, 0.1, 0.1]], np.float32
)
"""Of the light at the camera."""
_ZENITH, _HORIZON = (0.99, 0.99, 0.99), (0.80, 0.84, 0.88)


def _light(spec: mujoco.MjSpec) -> Iterator[str]:
    if not spec.lights:
        lamp = spec.visual.headlight
        lamp.ambient, lamp.diffuse, lamp.specular = _AMBIENT, _DIFFUSE, _SPECULAR
        for name, (direction, colour, shadow) in _LIGHTS.items():
            spec.worldbody.add_light(
                name=name,
                type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
                dir=direction,
                diffuse=colour,
                castshadow=shadow,
            )
        yield "lights are missing: the machine is lit as those that ship"
    if not any(image.type == mujoco.mjtTexture.mjTEXTURE_SKYBOX for image in spec.textures):
        spec.add_texture(
            name="sky",
            type=mujoco.mjtTexture.mjTEXTURE_SKYBOX,
            builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT,
            rgb1=_ZENITH,
            rgb2=_HORIZON,
            width=512,
            height=512,
        )
        yield "a background is missing: it is bright"


def _bounds(model: mujoco.MjModel, data: mujoco.MjData) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest corner of the box around all shapes, shape (3,) each [m]."""
    solid = np.flatnonzero(model.geom_type != mujoco.mjtGeom.mjGEOM_PLANE)
    if not len(solid):
        return data.site(TABLE_TOP).xpos.copy(), data.site(SPINDLE_NOSE).xpos.copy()
    turn = data.geom_xmat[solid].reshape(-1, 3, 3)
    middle = data.geom_xpos[solid] + np.einsum("nij,nj->ni", turn, model.geom_aabb[solid, :3])
    half = np.einsum("nij,nj->ni", np.abs(turn), model.geom_aabb[solid, 3:])
    return (middle - half).min(axis=0), (middle + half).max(axis=0)


def _front(middle: FloatArray, table: FloatArray, radius: float) -> FloatArray:
    """Right, back and up of who stands before the machine as columns: its table is before its middle."""
    back = middle - table
    back[2] = 0.0
    if np.linalg.norm(back) < 0.05 * radius:
        back = np.array([0.0, 1.0, 0.0])
    back /= np.linalg.norm(back)
    up = np.array([0.0, 0.0, 1.0])
    return np.stack([np.cross(back, up), back, up], axis=1)


def _unturned(spec: mujoco.MjSpec, site: str) -> mujoco.MjsBody:
    """The body that carries a site without turning with it."""
    body = found = spec.site(site).parent
    while body is not None and body.name != "world":
        if any(joint.type == mujoco.mjtJoint.mjJNT_HINGE for joint in body.joints):
            found = body.parent
        body = body.parent
    return found
