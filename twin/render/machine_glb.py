"""The machine as a GLB file for a web page: a node for each body, with its visible geoms below it."""

import dataclasses
from typing import Any

import mujoco
import numpy as np
import trimesh
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from twin.job.job_file import StockTable, ToolTable
from twin.machine.description.config import MachineConfig
from twin.machine.description.kinematics import SPINDLE_NOSE, part_carrier
from twin.machine.model.model import build_spec
from twin.machine.model.tool_shape import COLLISION_GROUP, VISUAL_GROUP
from twin.nc.canonical import FloatArray
from twin.render.scene.placement import Placement, place
from twin.render.scene.tool_body import PREFIX, ToolBodies
from twin.render.scene.work_holding import add_work_holding
from twin.toolpath.part_frame import PartFrame
from twin.toolpath.tool_plan import ToolPlan
from twin.units import MM

COLLISION_PREFIX = "collision "
"""What the names of nodes of collision bodies begin with, so that a page can hide them."""

_SHAPES = {
    mujoco.mjtGeom.mjGEOM_BOX: lambda s: trimesh.creation.box(extents=2.0 * s),
    mujoco.mjtGeom.mjGEOM_SPHERE: lambda s: trimesh.creation.icosphere(radius=s[0]),
    mujoco.mjtGeom.mjGEOM_CYLINDER: lambda s: trimesh.creation.cylinder(
        s[0], height=2.0 * s[1], sections=64
    ),
    mujoco.mjtGeom.mjGEOM_CAPSULE: lambda s: trimesh.creation.capsule(2.0 * s[1], s[0]),
}


@dataclasses.dataclass(frozen=True)
class DrawnMachine:
    """A machine with a tool and what carries the stock, ready to be drawn by a page.

    Attributes:
        placement: Where the part's frame lies on the turning table.
    """

    model: mujoco.MjModel
    machine: MachineConfig
    placement: Placement
    tool: ToolTable

    def glb(self) -> bytes:
        """The file: nodes are named as the bodies, lengths in m, Z up."""
        scene = trimesh.Scene(base_frame="world")
        model = self.model
        for body in range(1, model.nbody):
            parent = int(model.body_parentid[body])
            scene.graph.update(
                frame_to=model.body(body).name or f"body {body}",
                frame_from="world" if parent == 0 else model.body(parent).name or f"body {parent}",
                matrix=_matrix(model.body_pos[body], model.body_quat[body]),
            )
        for geom in range(model.ngeom):
            group = int(model.geom_group[geom])
            mesh = _mesh(model, geom) if group in (VISUAL_GROUP, COLLISION_GROUP) else None
            if mesh is None:
                continue
            body = int(model.geom_bodyid[geom])
            prefix = COLLISION_PREFIX if group == COLLISION_GROUP else ""
            name = f"{prefix}{model.geom(geom).name or geom} of {model.body(body).name}"
            scene.add_geometry(
                mesh,
                node_name=name,
                geom_name=name,
                parent_node_name="world" if body == 0 else model.body(body).name or f"body {body}",
                transform=_matrix(model.geom_pos[geom], model.geom_quat[geom]),
            )
        content = scene.export(file_type="glb", include_normals=True)
        assert isinstance(content, bytes)
        return content

    def description(self) -> dict[str, Any]:
        """What a page needs to move the nodes, as plain data.

        Returns:
            ``joints``: for each axis, in order, its body, kind, direction in the parent's frame
            and what it moves per mm or degree [m or rad]. ``part``: the body that carries the part
            and the part frame's matrix in it, column by column, from mm. ``tip`` likewise for the
            tool's tip in its body. ``cutter``: the node that spins. ``collision``: what the
            names of nodes begin with that are collision bodies.
        """
        model, joints = self.model, []
        for axis, scale in zip(self.machine.axes.names, self.machine.joint_scale, strict=True):
            joint = model.joint(self.machine.axis(axis).joint)
            body = int(joint.bodyid[0])
            slides = int(joint.type[0]) == mujoco.mjtJoint.mjJNT_SLIDE
            direction = np.array(joint.axis)
            if slides:
                mujoco.mju_rotVecQuat(direction, np.array(joint.axis), model.body_quat[body])
            joints.append(
                {
                    "axis": axis,
                    "body": model.body(body).name,
                    "slides": slides,
                    "direction": direction.tolist(),
                    "anchor": joint.pos.tolist(),
                    "scale": float(scale),
                }
            )
        nose = model.site(SPINDLE_NOSE)
        tip = _matrix(nose.pos, nose.quat) @ np.diag([MM, MM, MM, 1.0])
        tip[:3, 3] -= tip[:3, 2] * self.tool.length
        part = np.eye(4)
        part[:3, :3] = MM * self.placement.rotation
        part[:3, 3] = self.placement.origin
        carrier = int(model.site_bodyid[int(nose.id)])
        return {
            "joints": joints,
            "part": {
                "body": model.body(part_carrier(model)).name,
                "matrix": part.T.ravel().tolist(),
            },
            "tip": {"body": model.body(carrier).name, "matrix": tip.T.ravel().tolist()},
            "cutter": f"{PREFIX}{self.tool.number}",
            "tool": {
                "number": self.tool.number,
                "diameter": self.tool.diameter,
                "length": self.tool.length,
            },
            "collision": COLLISION_PREFIX,
        }


def drawn_machine(
    machine: MachineConfig,
    tool: ToolTable,
    part_frame: PartFrame,
    stock: StockTable | None = None,
    true_zero: FloatArray | None = None,
) -> DrawnMachine:
    """Build the machine as a page draws it.

    Args:
        stock: The blank, for the parallels below it.
        true_zero: Machine coordinates of the part's zero, shape (k,) [mm or deg].

    Raises:
        ConfigError: The model cannot be completed.
    """
    spec = build_spec(machine, tool)
    placement = place(machine, spec.compile(), tool.length, part_frame)
    if stock is not None and true_zero is not None:
        corner = part_frame.program_zero(true_zero)
        add_work_holding(spec, stock, placement, corner)
    ToolBodies(ToolPlan((tool,)), machine.file.spindle.flange_diameter).add_to(spec)
    return DrawnMachine(spec.compile(), machine, placement, tool)


def _mesh(model: mujoco.MjModel, geom: int) -> trimesh.Trimesh | None:
    kind = mujoco.mjtGeom(int(model.geom_type[geom]))
    if kind == mujoco.mjtGeom.mjGEOM_MESH:
        mesh = _own_mesh(model, int(model.geom_dataid[geom]))
    elif kind in _SHAPES:
        mesh = _SHAPES[kind](model.geom_size[geom])
        mesh.unmerge_vertices()
    else:
        return None
    mesh.visual = TextureVisuals(material=_material(model, geom))
    return mesh


def _own_mesh(model: mujoco.MjModel, mesh: int) -> trimesh.Trimesh:
    """A mesh with the normals that MuJoCo gave it: smooth on curves, sharp at edges."""
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    vertices = model.mesh_vert[first : first + count]
    first_normal = int(model.mesh_normaladr[mesh])
    normals = model.mesh_normal[first_normal : first_normal + int(model.mesh_normalnum[mesh])]
    faces = slice(int(model.mesh_faceadr[mesh]), None)
    faces = slice(faces.start, faces.start + int(model.mesh_facenum[mesh]))
    pairs = np.stack([model.mesh_face[faces].ravel(), model.mesh_facenormal[faces].ravel()], 1)
    unique, numbers = np.unique(pairs, axis=0, return_inverse=True)
    return trimesh.Trimesh(
        vertices[unique[:, 0]],
        numbers.reshape(-1, 3),
        vertex_normals=normals[unique[:, 1]],
        process=False,
    )


def _material(model: mujoco.MjModel, geom: int) -> PBRMaterial:
    number = int(model.geom_matid[geom])
    if number < 0:
        colour, metallic, roughness, glow = model.geom_rgba[geom], 0.3, 0.5, 0.0
    else:
        colour = model.mat_rgba[number]
        metallic = max(0.0, float(model.mat_metallic[number]))
        roughness = float(model.mat_roughness[number])
        glow = float(model.mat_emission[number])
    return PBRMaterial(
        baseColorFactor=np.array(colour, float),
        metallicFactor=metallic,
        roughnessFactor=roughness if 0.0 < roughness <= 1.0 else 0.6,
        emissiveFactor=(glow * np.array(colour[:3], float)).tolist(),
    )


def _matrix(position: FloatArray, quaternion: FloatArray) -> FloatArray:
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, np.asarray(quaternion, float))
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = rotation.reshape(3, 3), position
    return result
