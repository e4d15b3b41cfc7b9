"""Tools as they are drawn: fluted cutters of every kind, of which one is in the spindle."""

import mujoco
import numpy as np

from twin.cutting.tools import Profile, profile
from twin.job.job_file import ToolTable
from twin.machine.description.kinematics import SPINDLE_NOSE
from twin.machine.model.tool_shape import tool_cylinders
from twin.nc.canonical import FloatArray, IntArray
from twin.render.drawing.canvas import HIDDEN_GROUP
from twin.render.scene.live_mesh import SHOWN_GROUP
from twin.toolpath.tool_plan import ToolPlan
from twin.units import MM

PREFIX = "cutter_"
"""What the names of drawn tools begin with; their number follows."""

REPLACED = ("tool_cutter", "tool_ball", "tool_shank", "tool_flange", "tool_nut")
"""Plain geoms of the machine's first tool that those of every tool stand for."""
HOLDER = ("tool_flange", "tool_nut")

HOLDER_MATERIAL = "holder_steel"
CUTTER_RGBA = (0.66, 0.63, 0.56, 1.0)
HOLDER_RGBA = (0.42, 0.43, 0.45, 1.0)
_SEEN = {"contype": 0, "conaffinity": 0, "mass": 0.0, "group": SHOWN_GROUP}

SPIN_DEG = 47.0
"""Turn of the spindle from one picture to the next; the true one could not be followed."""

_AROUND = 48
_HELIX_DEG = 30.0
_FLUTE_DEPTH = 0.3
"""Depth of the flutes, as a share of the radius."""
_LEVELS_IN_TIP = 9


class ToolBodies:
    """Draws the tools of a plan; ``add_to`` the specification, compile, ``bind``, then ``show``."""

    def __init__(self, plan: ToolPlan, flange_diameter: float) -> None:
        """Take the tools.

        Args:
            flange_diameter: Of the holders [mm].
        """
        self._tools = {tool.number: tool for tool in plan.tools}
        self._first = plan.tools[0]
        self._flange = flange_diameter
        self._angle = 0.0

    def add_to(self, spec: mujoco.MjSpec) -> None:
        """Put all tools under the spindle nose of a machine's specification."""
        replaced = [geom for name in REPLACED if (geom := spec.geom(name)) is not None]
        drawn = {geom.name for geom in replaced}
        for geom in replaced:
            spec.delete(geom)
        nose = spec.site(SPINDLE_NOSE)
        for name, rgba in ((PREFIX, CUTTER_RGBA), (HOLDER_MATERIAL, HOLDER_RGBA)):
            spec.add_material(
                name=name, rgba=rgba, specular=0.9, shininess=0.85, metallic=0.6, roughness=0.3
            )
        for tool in self._tools.values():
            body = nose.parent.add_body(
                name=f"{PREFIX}{tool.number}", pos=nose.pos.tolist(), quat=nose.quat.tolist()
            )
            vertices, faces = fluted(tool)
            spec.add_mesh(
                name=body.name,
                uservert=(MM * (vertices - [0.0, 0.0, tool.length])).ravel().tolist(),
                userface=faces.ravel().tolist(),
                inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
            )
            body.add_geom(
                name=body.name,
                type=mujoco.mjtGeom.mjGEOM_MESH,
                meshname=body.name,
                material=PREFIX,
                **_SEEN,
            )
            radius = 0.5 * (tool.shank or 0.98 * tool.diameter)
            # The shank goes on into the holder.
            _add_cylinder(
                body, "shank", PREFIX, radius, -tool.length + min(tool.flute, tool.below_holder)
            )
            for piece in tool_cylinders(tool, self._flange):
                if piece.name in HOLDER and piece.name in drawn:
                    _add_cylinder(
                        body, piece.name, HOLDER_MATERIAL, piece.radius, piece.bottom, piece.top
                    )

    def bind(self, model: mujoco.MjModel) -> None:
        """Take over the compiled tools; the first is shown."""
        self._model = model
        self._rest = model.body_quat.copy()
        self.show(self._first, 1.0)

    def show(self, tool: ToolTable, sense: float) -> None:
        """Show one tool, a little turned on since the last picture.

        Args:
            tool: The one in the spindle.
            sense: 1 where the spindle turns clockwise seen from above, -1 counter-clockwise, 0 where it stands.
        """
        model = self._model
        self._angle -= sense * np.deg2rad(SPIN_DEG)
        spin = np.array([np.cos(0.5 * self._angle), 0.0, 0.0, np.sin(0.5 * self._angle)])
        for number in self._tools:
            body = int(model.body(f"{PREFIX}{number}").id)
            mujoco.mju_mulQuat(model.body_quat[body], self._rest[body], spin)
            first = int(model.body_geomadr[body])
            group = SHOWN_GROUP if number == tool.number else HIDDEN_GROUP
            model.geom_group[first : first + int(model.body_geomnum[body])] = group


def _add_cylinder(
    body: mujoco.MjsBody, name: str, material: str, radius: float, bottom: float, top: float = 0.0
) -> None:
    """Add an upright cylinder between heights over the spindle nose, where it has any height [mm]."""
    if top <= bottom:
        return
    body.add_geom(
        name=f"{body.name}_{name}",
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        size=[MM * radius, 0.5 * MM * (top - bottom), 0.0],
        pos=[0.0, 0.0, 0.5 * MM * (top + bottom)],
        material=material,
        **_SEEN,
    )


def fluted(tool: ToolTable) -> tuple[FloatArray, IntArray]:
    """A cutter's fluted part with its tip at the origin: vertices (n, 3) [mm] and faces (m, 3)."""
    edge = profile(tool)
    length = min(tool.flute, tool.below_holder)
    tip = _tip_height(edge)
    levels = np.concatenate(
        [
            tip * (1 - np.cos(np.linspace(0.0, 0.5 * np.pi, _LEVELS_IN_TIP))),
            np.linspace(tip, max(length, 1.05 * tip), 1 + max(2, round(2 * length / edge.radius))),
        ]
    )
    levels = np.unique(levels.round(9))
    around = 2 * np.pi * np.arange(_AROUND) / _AROUND
    twist = np.tan(np.deg2rad(_HELIX_DEG)) / edge.radius * levels
    phase = tool.teeth * (around[None] - twist[:, None])
    depth = _FLUTE_DEPTH * np.maximum(0.0, np.sin(phase)) ** 0.7
    radius = _envelope(edge, levels)[:, None] * (1.0 - depth)
    rings = np.stack(
        [
            radius * np.cos(around),
            radius * np.sin(around),
            np.broadcast_to(levels[:, None], radius.shape),
        ],
        -1,
    ).reshape(-1, 3)
    ends = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, levels[-1]]])
    return np.concatenate([rings, ends]), _ring_faces(len(levels))


def _tip_height(edge: Profile) -> float:
    return float(edge.height(np.array([edge.radius]))[0])


def _envelope(edge: Profile, height: FloatArray) -> FloatArray:
    """Radius of the cutter at heights above its tip [mm]."""
    if edge.corner:
        below = np.clip(edge.corner - height, 0.0, edge.corner)
        return edge.flat + np.sqrt(edge.corner**2 - below**2)
    if edge.slope:
        return np.minimum(edge.radius, edge.flat + height / edge.slope)
    return np.full_like(height, edge.radius)


def _ring_faces(rings: int) -> IntArray:
    """Faces between rings and over both ends, whose middles are the last two vertices."""
    ring = np.arange(_AROUND)
    following = (ring + 1) % _AROUND
    sides = np.concatenate(
        [
            np.stack([ring, following, following + _AROUND], 1),
            np.stack([ring, following + _AROUND, ring + _AROUND], 1),
        ]
    )
    sides = (_AROUND * np.arange(rings - 1)[:, None, None] + sides).reshape(-1, 3)
    last = _AROUND * (rings - 1)
    count = _AROUND * rings
    bottom = np.stack([following, ring, np.full(_AROUND, count)], 1)
    top = np.stack([ring + last, following + last, np.full(_AROUND, count + 1)], 1)
    return np.concatenate([sides, bottom, top])
