"""The part of a recording, cut anew: along the simulated motion or the commanded one."""

from pathlib import Path
from typing import Literal

from twin.cutting.cut import Cutter
from twin.cutting.height_map import HeightMap
from twin.cutting.inspection import Inspection, inspect
from twin.cutting.nominal import nominal_map
from twin.cutting.program_summary import ProgramSummary
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
    cutter = Cutter(
        stock,
        summary.tools,
        header.part_frame,
        header.part_zero,
        along=along,
        tilts=summary.tilts,
    )
    for samples in recording.chunks():
        cutter.add(samples, summary.is_rapid(samples.setpoint.move))
    return cutter


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
        ideal = nominal_map(
            part, Path(nominal), recording.header.part_frame, recording.header.part_zero
        )
    return inspect(part, ideal, tolerance_um), part
