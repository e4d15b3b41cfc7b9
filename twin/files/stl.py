"""Reading and writing STL files."""

import functools
import logging
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from twin.errors import ConfigError

_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attributes", "<u2")])
"""Of a binary STL file."""
LARGEST_MM = 1e6
"""A corner farther from zero than a kilometre is damage, and no sum with it is exact any more."""

FloatArray = npt.NDArray[np.float64]

if TYPE_CHECKING:
    import trimesh

# It logs tracebacks of what it recovers from; the rest is reported here.
logging.getLogger("trimesh").addHandler(logging.NullHandler())


@functools.cache
def read_stl(path: Path) -> "trimesh.Trimesh":
    """Read an STL file [mm]; treat the mesh as constant.

    Raises:
        ConfigError: The file cannot be read, or holds no solid.
    """
    import trimesh

    try:
        # Corners that are no numbers are reported below.
        with path.open("rb") as file, np.errstate(all="ignore"):
            mesh = trimesh.load_mesh(file, file_type="stl", process=False)
    except (OSError, ValueError, KeyError, IndexError) as error:
        raise ConfigError(f"{path}: is not a readable STL file: {error}") from error
    except ImportError as error:
        # With a package that an installation need not have, trimesh guesses how such a text is encoded.
        raise ConfigError(
            f"{path}: is not a readable STL file: neither a binary one nor text in UTF-8"
        ) from error
    if np.abs(mesh.vertices).max(initial=0.0) > LARGEST_MM or np.isnan(mesh.vertices).any():
        raise ConfigError(f"{path}: a corner lies beyond {LARGEST_MM:g} mm")
    mesh.process()
    if not isinstance(mesh, trimesh.Trimesh) or len(mesh.faces) < 4 or mesh.extents.min() <= 0:
        raise ConfigError(f"{path}: holds no solid")
    return mesh


def stl_text(triangles: FloatArray) -> bytes:
    """Triangles as a binary STL file; trimesh, which reads them, takes as long to load as a short run.

    Args:
        triangles: Corners, counter-clockwise seen from outside, shape (n, 3, 3) [mm].
    """
    corners = triangles.astype("<f4")
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    records = np.zeros(len(corners), _TRIANGLE)
    records["normal"] = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0.0)
    records["corners"] = corners
    return b"".join((bytes(80), np.uint32(len(corners)).tobytes(), records.tobytes()))


def stl_extent(path: Path) -> tuple[float, float, float]:
    """Size of the box around an STL file's shape [mm].

    Raises:
        ConfigError: The file cannot be read, or holds no solid.
    """
    width, depth, height = (float(value) for value in read_stl(path).extents)
    return (width, depth, height)
