"""Where a job lies on its machine: program zero, the blank on the table, the part's frame."""

import math
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from twin.cutting.forces.materials import kienzle
from twin.errors import ConfigError
from twin.files.stl import read_stl
from twin.job.fixture import Weight, upright_weight
from twin.job.job_file import JobFile, StockTable
from twin.machine.description.config import Blank, MachineConfig
from twin.nc.canonical import FloatArray
from twin.toolpath.part_frame import PartFrame
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


_Z = 2
WORK_HOLDING_HEIGHT = 40.0
"""Height of the jaws or parallels between the rotary table and the stock [mm]."""


class Layout(NamedTuple):
    """A job on its machine.

    Attributes:
        part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        blank: The uncut stock on the table; None without one.
        start: Where the axes are when the program starts, program coordinates, shape (k,) [mm or deg].
    """

    part_zero: FloatArray
    part_frame: PartFrame
    blank: Blank | None
    start: FloatArray


def lay_out(job: JobFile, machine: MachineConfig) -> Layout:
    """Lay a job out on its machine.

    An axis that the job's ``part_zero`` names is where that says. Otherwise program zero lies on
    the table's centre line, at the height of the top face of the stock on its work holding;
    without a stock in the middle of the Z travel. Where the table does not turn about Z, its
    work-holding surface is no floor: program zero lies in the middle of that.

    Raises:
        ConfigError: An axis does not exist, the stock would lie below the table, or its material is not
            known.
    """
    start = np.zeros(len(machine.axes))
    _write_axes(start, job.start, machine, "start")
    over_table, length = machine.at_zero.spindle_over_table, job.tools[0].length
    frame = machine.part_frame
    zero = frame.rotary_zero(len(machine.axes))
    lies = frame.table_about(_Z) is not None or frame.chain is None
    if frame.chain is not None:
        zero[:3] = frame.chain.table + length * frame.chain.tool
    if lies:
        zero[2] = _default_height(job, machine, over_table)
    _write_axes(zero, job.part_zero, machine, "part_zero")
    if lies:
        _require_stock_above_table(job, float(zero[2]), over_table)
    frame = frame.at(zero, length)
    return Layout(zero, frame, _blank(job, frame, zero, over_table), start)


def _blank(job: JobFile, frame: PartFrame, zero: FloatArray, over_table: float) -> Blank | None:
    if job.stock is None:
        return None
    stock, size, weight = job.stock, job.stock.extent, blank_weight(job.stock)
    x, y, z = np.array(stock.position) + frame.program_zero(zero)
    top = z + over_table - job.tools[0].length
    order, down = (0, 1, 2), np.array([0.0, 0.0, size[2] / 2.0])
    if frame.chain is not None:
        to_table = frame.chain.table_axes.T
        x, y, top = to_table @ (np.array([x, y, z]) - frame.chain.table)
        order = _along_table(to_table)
        if order[_Z] != _Z:
            down = to_table @ down
            weight = None if weight is None else weight.turned(to_table)
    place = (float(x), float(y), float(top))
    middle = np.array(place) - down
    return Blank(
        (size[order[0]], size[order[1]], size[order[2]]),
        (float(middle[0]), float(middle[1]), float(middle[2])),
        round=stock.diameter is not None,
        weight=None if weight is None else weight.moved(place),
        on_post=stock.on_post,
        direction=_Z if stock.diameter is None else order.index(stock.direction),
        relief=stock.relief or 0.0,
    )


def _along_table(to_table: FloatArray) -> tuple[int, int, int]:
    """Which of X, Y and Z of the machine lies along x, y and z of the table.

    Where a table lies level, X and Y are taken for x and y, however it is turned.

    Args:
        to_table: Turns directions of the machine into those of the table, shape (3, 3).
    """
    along_z = int(np.argmax(np.abs(to_table[_Z])))
    if along_z == _Z:
        return 0, 1, 2
    others = [axis for axis in range(3) if axis != along_z]
    along_x = max(others, key=lambda axis: abs(to_table[0, axis]))
    return along_x, 3 - along_z - along_x, along_z


def bore_of(job: JobFile) -> float | None:
    """How wide the stock's hole is, in which a fixture may stand [mm]; None: it has none.

    Of a stock from an STL file the box around it is known alone, in which a fixture may stand anywhere.
    """
    if job.stock is None:
        return None
    return math.inf if job.stock.shape == "stl" else job.stock.bore


def require_axes(names: Iterable[str], machine: MachineConfig, key: str) -> None:
    """Hold the axes that a table of the job names to those of its machine.

    Raises:
        ConfigError: An axis does not exist.
    """
    for name in names:
        if name not in machine.axes.names:
            known = ", ".join(machine.axes.names)
            raise ConfigError(f"job key '{key}.{name}': {machine.file.name} has the axes {known}")


def _write_axes(
    row: FloatArray, values: dict[str, float], machine: MachineConfig, key: str
) -> None:
    require_axes(values, machine, key)
    for name, value in values.items():
        row[machine.axes.index(name)] = value


def _default_height(job: JobFile, machine: MachineConfig, over_table: float) -> float:
    if job.stock is not None:
        top = WORK_HOLDING_HEIGHT + job.stock.extent[2] - job.stock.position[2]
        return top + job.tools[0].length - over_table
    travel = machine.axis("Z").travel
    return 0.0 if travel is None else (travel[0] + travel[1]) / 2.0


def _require_stock_above_table(job: JobFile, zero_z: float, over_table: float) -> None:
    if job.stock is None:
        return
    zero_over_table = over_table + zero_z - job.tools[0].length
    bottom = zero_over_table + job.stock.position[2] - job.stock.extent[2]
    if bottom < 0.0:
        raise ConfigError(
            f"the stock would reach {-bottom:.3f} mm below the table: raise part_zero.Z "
            f"to {zero_z - bottom:.3f} or more, or make the stock less high"
        )
