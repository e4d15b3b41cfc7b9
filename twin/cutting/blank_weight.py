"""What the blank weighs."""

import math
from pathlib import Path

import numpy as np

from twin.cutting.forces.materials import kienzle
from twin.files.stl import read_stl
from twin.job.fixture import Weight, upright_weight
from twin.job.job_file import StockTable
from twin.units import MM

_KG_PER_MM3 = 1e-6
"""Of a density of 1 g/cm³."""


def blank_weight(stock: StockTable) -> Weight | None:
    """What the uncut blank weighs, about the centre of its top face (of the box around an STL).

    An STL whose surface is not closed counts as its convex hull.

    Returns:
        None where the job tells neither material nor density.

    Raises:
        ConfigError: The material is not known, or the STL file cannot be read.
    """
    material = kienzle(stock)
    density = stock.density or (0.0 if material is None else material.density)
    if not density:
        return None
    density *= _KG_PER_MM3
    if stock.file is not None:
        return _mesh_weight(Path(stock.file), density)
    size = stock.extent
    center = (0.0, 0.0, -0.5 * size[2])
    if stock.diameter is None or stock.height is None:
        return upright_weight(density * math.prod(size), size, center, is_round=False)
    bore, height = stock.bore or 0.0, stock.height
    mass = density * 0.25 * math.pi * (stock.diameter**2 - bore**2) * height
    standing = (stock.diameter, stock.diameter, height)
    weight = upright_weight(mass, standing, center, is_round=True, bore=bore)
    about = list(weight.inertia)
    about[stock.direction], about[2] = about[2], about[stock.direction]
    return weight._replace(inertia=(about[0], about[1], about[2], 0.0, 0.0, 0.0))


def _mesh_weight(path: Path, density: float) -> Weight:
    mesh = read_stl(path)
    solid = mesh if mesh.is_volume else mesh.convex_hull
    low, high = mesh.bounds
    top = np.array([*(0.5 * (low + high))[:2], high[2]])
    x, y, z = (float(value) for value in solid.center_mass - top)
    tensor = solid.moment_inertia * density * MM**2
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = tensor.tolist()
    return Weight(float(solid.volume) * density, (x, y, z), (xx, yy, zz, xy, xz, yz))
