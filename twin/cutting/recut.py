"""The part of a recording, cut anew: along the simulated motion or the commanded one."""

from pathlib import Path
from typing import Literal

import numpy as np

from twin.cutting.cut import Cutter
from twin.cutting.height_map import HeightMap
from twin.cutting.inspection import Inspection, inspect
from twin.cutting.kernels.drape import drape
from twin.cutting.program_summary import ProgramSummary
from twin.files.stl import read_stl
from twin.job.job_file import StockTable
from twin.recording.reader import Recording

Commanded = Literal["commanded"]
COMMANDED: Commanded = "commanded"
"""The nominal part is the one that the commanded path cuts."""


def recut(
    recording: Recording,
    summary: ProgramSummary,
    stock: StockTable,
    along: Literal["joints", "setpoints"] = "joints",
) -> Cutter:
    """Cut a stock along a whole recording.

    Args:
        recording: The run.
        summary: What is in the spindle when, and which moves are rapids.
        stock: The blank.
        along: Whether the simulated motion cuts or the commanded one.

    Raises:
        ConfigError: The stock is wrong.
    """
    header = recording.header
    cutter = Cutter(stock, summary.tools, header.part_frame, header.part_zero, along=along)
    for samples in recording.chunks():
        cutter.add(samples, summary.is_rapid(samples.setpoint.move))
    return cutter


def nominal_map(part: HeightMap, file: Path, recording: Recording) -> HeightMap:
    """A nominal part on the grid of a machined one: seen from above, the highest surface counts.

    Args:
        part: The machined part.
        file: STL of the nominal part in program coordinates [mm].
        recording: The run, whose program zero the file counts from.

    Raises:
        ConfigError: The file cannot be read.
    """
    header = recording.header
    corner = header.part_zero[:3] - np.array([*header.part_frame.center, 0.0])
    result = part.copy()
    result.heights[:] = part.bottom
    triangles = np.ascontiguousarray(read_stl(file).triangles + corner, dtype=np.float64)
    drape(result.heights, result.origin, result.cell, triangles)
    return result


def inspect_recorded(
    recording: Recording,
    summary: ProgramSummary,
    stock: StockTable,
    nominal: Path | Commanded,
    tolerance_um: float,
) -> tuple[Inspection, HeightMap]:
    """Measure the part of a recording.

    Args:
        recording: The run.
        summary: What is in the spindle when, and which moves are rapids.
        stock: The blank.
        nominal: STL of the nominal part in program coordinates, or ``COMMANDED``.
        tolerance_um: Deviation that is still good [µm].

    Returns:
        What was found, and the machined part.

    Raises:
        ConfigError: The stock or the nominal part is wrong.
    """
    part = recut(recording, summary, stock).map
    if nominal == COMMANDED:
        ideal = recut(recording, summary, stock, "setpoints").map
    else:
        ideal = nominal_map(part, Path(nominal), recording)
    return inspect(part, ideal, tolerance_um), part
