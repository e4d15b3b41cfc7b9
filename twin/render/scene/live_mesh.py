"""Meshes that change while they are drawn, on the body that carries the part."""

import mujoco
import numpy as np

from twin.machine.description.kinematics import TABLE_TOP
from twin.nc.canonical import FloatArray, IntArray
from twin.render.drawing.canvas import HIDDEN_GROUP
from twin.render.scene.placement import Placement
from twin.units import MM

SHOWN_GROUP = 2
"""Geom group of what is only looked at."""

_SEEN = {"contype": 0, "conaffinity": 0, "mass": 0.0, "group": SHOWN_GROUP}

_GOLDEN_ANGLE = 2.4
"""Turn from one stand-in vertex to the next [rad]."""


def add_live_mesh(
    spec: mujoco.MjSpec,
    name: str,
    material: str,
    texels: FloatArray,
    faces: IntArray,
    *,
    shadow: bool = True,
) -> None:
    """Add a mesh and its geom to the rotary table of a machine that is yet to be compiled.

    The compiler would refuse or shift a mesh that has no area yet, so that it gets vertices on a
    screw line; ``LiveMesh.put`` gives it its real ones.

    Args:
        texels: Place of every vertex in the material's texture, shape (n, 2) [0 to 1].
        faces: Vertices of every face, counter-clockwise from outside, shape (m, 3).
        shadow: Whether it casts one.
    """
    turn = _GOLDEN_ANGLE * np.arange(len(texels))
    stand_in = np.stack([np.cos(turn), np.sin(turn), np.arange(len(texels)) / len(texels)], 1)
    spec.add_mesh(
        name=name,
        uservert=stand_in.ravel().tolist(),
        userface=faces.ravel().tolist(),
        usernormal=np.tile([0.0, 0.0, 1.0], 3 * len(faces)).tolist(),
        userfacenormal=np.arange(3 * len(faces)).tolist(),
        usertexcoord=texels.ravel().tolist(),
        userfacetexcoord=faces.ravel().tolist(),
        inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
    )
    spec.site(TABLE_TOP).parent.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_MESH,
        meshname=name,
        material=material,
        **{**_SEEN, "castshadow": shadow},
    )


class LiveMesh:
    """A compiled mesh, in the part's frame, whose corners each have their own normal.

    Attributes:
        id: Number of the mesh in the model, for the upload.
    """

    def __init__(self, model: mujoco.MjModel, name: str, placement: Placement) -> None:
        """Take over a compiled mesh and lay it where the part's frame is."""
        self.id = int(model.mesh(name).id)
        self._model = model
        self._geom = int(model.geom(name).id)
        model.geom_pos[self._geom] = placement.origin
        model.geom_quat[self._geom] = placement.quaternion
        model.geom_sameframe[self._geom] = mujoco.mjtSameFrame.mjSAMEFRAME_NONE
        first, count = int(model.mesh_faceadr[self.id]), int(model.mesh_facenum[self.id])
        self._faces = model.mesh_face[first : first + count]
        model.mesh_facenormal[first : first + count] = np.arange(3 * count).reshape(-1, 3)
        self._face_texels = model.mesh_facetexcoord[first : first + count]
        first, vertices = int(model.mesh_vertadr[self.id]), int(model.mesh_vertnum[self.id])
        self._vertices = model.mesh_vert[first : first + vertices]
        first = int(model.mesh_normaladr[self.id])
        self._normals = model.mesh_normal[first : first + 3 * count]

    def put(self, vertices: FloatArray, normals: FloatArray) -> None:
        """Move the vertices.

        Args:
            vertices: Shape (n, 3) [mm], in the part's frame.
            normals: One for each corner of each face, shape (3 m, 3) or (m, 3, 3).
        """
        self._vertices[:] = MM * vertices
        self._normals[:] = normals.reshape(-1, 3)

    def put_faces(self, faces: IntArray, texels: IntArray) -> None:
        """Change the faces; one with equal corners is not seen.

        Args:
            faces: Shape (m, 3).
            texels: Vertices whose places in the texture their corners have, shape (m, 3).
        """
        self._faces[:], self._face_texels[:] = faces, texels

    def fill(
        self, vertices: FloatArray, faces: IntArray, normals: FloatArray, texels: IntArray
    ) -> None:
        """Change all of it, to at most as many vertices and faces as it has; the others are not seen.

        Args:
            vertices: Shape (n, 3) [mm], in the part's frame.
            faces: Shape (m, 3).
            normals: One for each corner of each face, shape (m, 3, 3).
            texels: Vertex whose place in the texture each face has, shape (m,).
        """
        self._vertices[: len(vertices)] = MM * vertices
        self._faces[: len(faces)] = faces
        self._faces[len(faces) :] = 0
        self._normals[: 3 * len(faces)] = normals.reshape(-1, 3)
        self._face_texels[: len(faces)] = texels[:, None]

    def show(self, shown: bool) -> None:
        """Whether pictures show it."""
        self._model.geom_group[self._geom] = SHOWN_GROUP if shown else HIDDEN_GROUP
