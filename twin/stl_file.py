"""Solids that come as STL files."""

import functools
from pathlib import Path
from typing import TYPE_CHECKING

from twin.errors import ConfigError

if TYPE_CHECKING:
    import trimesh


@functools.cache
def read_stl(path: Path) -> "trimesh.Trimesh":
    """Read an STL file [mm]; treat the mesh as constant.

    Raises:
        ConfigError: The file cannot be read, or holds no solid.
    """
    import trimesh

    try:
        with path.open("rb") as file:
            mesh = trimesh.load_mesh(file, file_type="stl")
    except (OSError, ValueError, KeyError, IndexError) as error:
        raise ConfigError(f"{path}: is not a readable STL file: {error}") from error
    if not isinstance(mesh, trimesh.Trimesh) or len(mesh.faces) < 4 or mesh.extents.min() <= 0:
        raise ConfigError(f"{path}: holds no solid")
    return mesh


def stl_extent(path: Path) -> tuple[float, float, float]:
    """Size of the box around an STL file's shape [mm].

    Raises:
        ConfigError: The file cannot be read, or holds no solid.
    """
    width, depth, height = (float(value) for value in read_stl(path).extents)
    return (width, depth, height)
