"""The part of a recording, cut again: along the simulated motion or the commanded one."""

from pathlib import Path
from typing import Literal

from twin.cutting.cut import Cutter
from twin.cutting.height_map_material import HeightMapMaterial
from twin.cutting.measuring.measured_part import MeasuredPart, measured, nominal_of
from twin.cutting.program_summary import ProgramSummary
from twin.cutting.tridexel.material import TriDexelMaterial
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
        summary: What is in the spindle when, and which moves are rapids.
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
        cutter.add(samples, summary.is_rapid(samples.setpoint.move), goes_on=True)
    cutter.catch_up()
    return cutter


def inspect_recorded(
    recording: Recording,
    summary: ProgramSummary,
    stock: StockTable,
    nominal: Path | Commanded,
    tolerance_um: float,
) -> MeasuredPart:
    """Measure the part of a recording.

    Args:
        summary: What is in the spindle when, and which moves are rapids.
        nominal: STL of the nominal part in program coordinates, or ``COMMANDED``.
        tolerance_um: Deviation that is still good [µm].

    Raises:
        ConfigError: The stock or the nominal part is wrong.
    """
    cutter = recut(recording, summary, stock)
    if nominal == COMMANDED:
        ideal = recut(recording, summary, stock, "setpoints").material
        assert isinstance(ideal, HeightMapMaterial | TriDexelMaterial)
        wanted = ideal.map if isinstance(ideal, HeightMapMaterial) else ideal.stock
    else:
        header = recording.header
        wanted = nominal_of(cutter, Path(nominal), header.part_frame, header.part_zero)
    return measured(cutter.material, wanted, tolerance_um)
