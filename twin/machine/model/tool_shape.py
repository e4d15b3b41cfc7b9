"""The tool in the spindle, as bodies of revolution in the model."""

import dataclasses
import math

import mujoco
import numpy as np

from twin.job.job_file import ToolTable
from twin.nc.canonical import FloatArray
from twin.units import MM

VISUAL_GROUP = 2
"""Geom group of what is only looked at; the physics drops it."""

COLLISION_GROUP = 3
"""Geom group of what may not meet; the physics drops it too, the clearance is watched apart."""
TOOL_SIDE, PART_SIDE, FRAME_SIDE, STOCK_SIDE = 1, 2, 4, 8
"""Sides of a collision, as bits of ``contype``: head and holder, table and fixture, column, stock."""
CLAMPED_SIDE = 16
"""What is clamped on the table and turns with it, against all of the machine that does not."""

_VISUAL = {"contype": 0, "conaffinity": 0, "group": VISUAL_GROUP, "mass": 0.0}
_COLLISION = {
    "contype": TOOL_SIDE,
    "conaffinity": PART_SIDE | FRAME_SIDE,
    "group": COLLISION_GROUP,
    "mass": 0.0,
}


def default_tool(flange_diameter: float) -> ToolTable:
    """A 10 mm end mill whose holder fits a spindle, for a machine without a job.

    Args:
        flange_diameter: Of the spindle's tool holders [mm].
    """
    return ToolTable(number=1, holder=flange_diameter / 2.0)


@dataclasses.dataclass(frozen=True, slots=True)
class Cylinder:
    """A piece of the tool in the spindle's frame: z is 0 at the nose and negative below.

    Attributes:
        radius: [mm].
        top: z of the upper end [mm].
        bottom: z of the lower end [mm].
    """

    name: str
    radius: float
    top: float
    bottom: float


MATERIALS = {
    "tool_steel": (0.42, 0.43, 0.45, 1.0),
    "carbide": (0.78, 0.68, 0.40, 1.0),
    "steel": (0.52, 0.54, 0.56, 1.0),
}
"""Colours of holder, cutter and fixtures where the machine's model has no materials so called."""

_HOLDER = ("tool_flange", "tool_nut")
CUTTER = "cutter"
_COLLISION_NAMES = {
    "tool_flange": "holder's flange",
    "tool_nut": "holder's nut",
    "tool_shank": "tool's shank",
    "tool_cutter": CUTTER,
}
_END = "cutter's end"
CUTTING_PARTS = (CUTTER, _END)
"""Geoms that may go into the stock, and into nothing else."""
TOOL_NAMES = (*_COLLISION_NAMES.values(), _END)
"""Geoms that come and go with the tool."""
_AROUND, _ACROSS = 180, 24
"""Corners of a round or conical end around its axis and along its rounding: a collision sees it
smaller by 0.02 % of its radius."""
_FLANGE_SHARE = 0.3
"""Of the length above the flutes: what the holder's flange takes."""


def tool_cylinders(tool: ToolTable, flange_diameter: float) -> tuple[Cylinder, ...]:
    """Flange, collet nut, shank and cutter, from the spindle nose down.

    The nut ends ``tool.below_holder`` above the tip, and the cutter's bottom is the tip,
    ``tool.length`` below the nose. A piece of no height is left out.
    """
    nut = tool.length - tool.below_holder
    above = tool.length - min(tool.flute, 0.8 * tool.length, tool.below_holder)
    flange = min(_FLANGE_SHARE * above, nut)
    cutter, rim = tool.diameter / 2.0, flange_diameter / 2.0
    shank = cutter * 0.98 if tool.shank is None else tool.shank / 2.0
    pieces = (
        Cylinder("tool_flange", max(rim, shank), 0.0, -flange),
        Cylinder("tool_nut", max(tool.holder / 2.0, shank), -flange, -nut),
        Cylinder("tool_shank", shank, -nut, -above),
        Cylinder("tool_cutter", cutter, -above, -tool.length),
    )
    return tuple(piece for piece in pieces if piece.top > piece.bottom)


def add_materials(spec: mujoco.MjSpec) -> None:
    """Give the model those of ``MATERIALS`` that it lacks."""
    known = {material.name for material in spec.materials}
    for name, colour in MATERIALS.items():
        if name not in known:
            spec.add_material(name=name, rgba=colour, specular=0.8, shininess=0.8)


def add_tool(spec: mujoco.MjSpec, tool: ToolTable, flange_diameter: float) -> None:
    """Put the tool into the spindle: geoms on the body that carries the site ``spindle_nose``.

    Args:
        spec: The machine; gains geoms, to look at and to collide, and the site ``tool_tip``.
        flange_diameter: Of the holder [mm].
    """
    nose = spec.site("spindle_nose")
    body = nose.parent
    x, y, z = (float(value) for value in nose.pos)
    for piece in tool_cylinders(tool, flange_diameter):
        bottom = piece.bottom
        is_ball = piece.name == "tool_cutter" and tool.kind == "ball"
        if is_ball:
            bottom += piece.radius
            body.add_geom(
                name="tool_ball",
                type=mujoco.mjtGeom.mjGEOM_SPHERE,
                size=[piece.radius * MM, 0.0, 0.0],
                pos=[x, y, z + bottom * MM],
                material="carbide",
                **_VISUAL,
            )
        if piece.top <= bottom:
            continue
        form = {
            "type": mujoco.mjtGeom.mjGEOM_CYLINDER,
            "size": [piece.radius * MM, (piece.top - bottom) / 2 * MM, 0.0],
            "pos": [x, y, z + (piece.top + bottom) / 2 * MM],
        }
        material = "tool_steel" if piece.name in _HOLDER else "carbide"
        body.add_geom(name=piece.name, material=material, **form, **_VISUAL)
    _add_solids(spec, tool, flange_diameter)
    body.add_site(name="tool_tip", pos=[x, y, z - tool.length * MM], size=[0.001] * 3, group=4)


def _add_solids(spec: mujoco.MjSpec, tool: ToolTable, flange_diameter: float) -> None:
    """Add what may not meet anything: the exact shapes of holder, shank and cutting part."""
    nose = spec.site("spindle_nose")
    x, y, z = (float(value) for value in nose.pos)
    tip = z - tool.length * MM
    outline = _end_outline(tool)
    for piece in tool_cylinders(tool, flange_diameter):
        bottom, radius = piece.bottom, piece.radius
        if piece.name == "tool_cutter":
            bottom += outline[-1][1]
        if piece.name == "tool_shank" and tool.shank is None:
            radius = tool.diameter / 2.0
        if piece.top > bottom:
            nose.parent.add_geom(
                name=_COLLISION_NAMES[piece.name],
                type=mujoco.mjtGeom.mjGEOM_CYLINDER,
                size=[radius * MM, (piece.top - bottom) / 2 * MM, 0.0],
                pos=[x, y, z + (piece.top + bottom) / 2 * MM],
                **_COLLISION,
            )
    if tool.kind == "ball":
        radius = tool.diameter / 2.0 * MM
        nose.parent.add_geom(
            name=_END,
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            size=[radius, 0.0, 0.0],
            pos=[x, y, tip + radius],
            **_COLLISION,
        )
    elif len(outline) > 1:
        spec.add_mesh(name=_END, uservert=(_revolved(outline).ravel() * MM).tolist())
        nose.parent.add_geom(
            name=_END,
            type=mujoco.mjtGeom.mjGEOM_MESH,
            meshname=_END,
            pos=[x, y, tip],
            **_COLLISION,
        )


def _end_outline(tool: ToolTable) -> list[tuple[float, float]]:
    """Radius and height above the tip of a cutter's lower end, from its flat to its flank [mm]."""
    radius = tool.diameter / 2.0
    if tool.kind == "ball":
        return [(0.0, 0.0), (radius, radius)]
    if tool.corner is not None:
        turns = (math.pi / 2 * step / _ACROSS for step in range(_ACROSS + 1))
        flat, corner = radius - tool.corner, tool.corner
        return [(flat + corner * math.sin(t), corner * (1.0 - math.cos(t))) for t in turns]
    if tool.point_angle is not None:
        flat = tool.tip / 2.0
        rise = (radius - flat) / math.tan(math.radians(tool.point_angle / 2.0))
        return [(flat, 0.0), (radius, rise)]
    return [(radius, 0.0)]


def _revolved(outline: list[tuple[float, float]]) -> FloatArray:
    """Points of an outline turned about the z axis, shape (n, 3)."""
    turns = np.linspace(0.0, 2.0 * np.pi, _AROUND, endpoint=False)
    rings = [
        np.stack([r * np.cos(turns), r * np.sin(turns), np.full(len(turns), z)], axis=1)
        if r > 0.0
        else np.array([[0.0, 0.0, z]])
        for r, z in outline
    ]
    return np.concatenate(rings)
