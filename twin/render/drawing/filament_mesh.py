"""A mesh of a model in the form in which Filament takes it."""

from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from twin.nc.canonical import FloatArray

Floats32 = npt.NDArray[np.float32]

_NEARLY_DOWN = 1e-6
"""1 + z of a normal from which on the shortest turn from Z to it has no axis."""


class FilamentMesh:
    """A mesh whose corners each are a vertex of their own; its number of faces is fixed."""

    def __init__(self, filament: Any, context: Any, model: mujoco.MjModel, mesh: int) -> None:
        """Reserve it; it is empty until ``send``.

        Args:
            filament: MuJoCo's module of that name.
            context: Filament's context.
        """
        usage, form = filament.VertexAttributeUsage, filament.VertexAttributeType
        self._filament = filament
        self._model = model
        self._mesh = mesh
        self.corners = 3 * int(model.mesh_facenum[mesh])
        self._config = filament.MeshConfig(
            max_vertices=self.corners,
            max_indices=self.corners,
            interleaved=True,
            index_type=filament.IndexType.INDEX_TYPE_U32,
            attributes=[
                filament.VertexAttribute(
                    usage.VERTEX_ATTRIBUTE_USAGE_POSITION, form.VERTEX_ATTRIBUTE_TYPE_FLOAT3
                ),
                filament.VertexAttribute(
                    usage.VERTEX_ATTRIBUTE_USAGE_TANGENTS, form.VERTEX_ATTRIBUTE_TYPE_FLOAT4
                ),
                filament.VertexAttribute(
                    usage.VERTEX_ATTRIBUTE_USAGE_UV, form.VERTEX_ATTRIBUTE_TYPE_FLOAT2
                ),
            ],
        )
        self.handle: Any = context.create_mesh(self._config)

    def send(self) -> Any:
        """Send it as the model has it now; returns what must live until the next frame is drawn."""
        data = self._filament.MeshData(compute_bounds=True)
        data.set_vertices(self._config, mesh_corners(self._model, self._mesh).tobytes())
        data.set_indices(self._config, np.arange(self.corners, dtype=np.uint32).tobytes())
        self.handle.upload(data)
        return data


def mesh_corners(model: mujoco.MjModel, mesh: int) -> Floats32:
    """Place, tangent frame and texel of every corner of a mesh's faces, shape (3 m, 9)."""
    first, count = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
    faces = slice(first, first + count)
    vertex = int(model.mesh_vertadr[mesh]) + model.mesh_face[faces].ravel()
    normal = int(model.mesh_normaladr[mesh]) + model.mesh_facenormal[faces].ravel()
    corners = np.zeros((3 * count, 9), np.float32)
    corners[:, :3] = model.mesh_vert[vertex]
    corners[:, 3:7] = tangent_frames(model.mesh_normal[normal])
    texels = int(model.mesh_texcoordadr[mesh])
    if texels >= 0:
        corners[:, 7:] = model.mesh_texcoord[texels + model.mesh_facetexcoord[faces].ravel()]
    return corners


def tangent_frames(normals: npt.ArrayLike) -> FloatArray:
    """Quaternions (x, y, z, w) of the shortest turns from Z to unit normals, shape (n, 4).

    Half the turn about z x n: (-n_y, n_x, 0, 1 + n_z), normalised; straight down about X.
    """
    x, y, z = np.asarray(normals, np.float64).T
    turns = np.stack([-y, x, np.zeros_like(x), 1 + z], 1)
    turns[1 + z < _NEARLY_DOWN] = [1.0, 0.0, 0.0, 0.0]
    return turns / np.linalg.norm(turns, axis=1, keepdims=True)
