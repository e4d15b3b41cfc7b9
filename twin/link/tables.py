"""LinuxCNC's tool table and parameter file."""

from twin.job.job_file import JobFile, ToolTable
from twin.nc.canonical import Axes, FloatArray

LETTERS = "XYZABCUVW"
"""The axes that LinuxCNC knows, in the order of its offsets."""
_FIRST_OFFSET = 5221
"""LinuxCNC's parameter of G54's first axis."""
_TOOLS = range(1, 100)
"""What a job that lists no tools has in its magazine, as in its own dialects."""


def offsets_text(axes: Axes, part_zero: FloatArray) -> str:
    """The parameter file, in which G54 is program zero.

    Args:
        part_zero: Machine coordinates of program zero, shape (k,), in LinuxCNC's units.
    """
    zero = axes.named(part_zero)
    rows = [
        f"{_FIRST_OFFSET + number}\t{zero.get(letter, 0.0):.9f}"
        for number, letter in enumerate(LETTERS)
    ]
    return "\n".join(["5220\t1", *rows]) + "\n"


def tools_text(job: JobFile, unit_mm: float = 1.0) -> str:
    """The tool table; lengths count against the job's first tool, as in the twin's dialects.

    Args:
        unit_mm: LinuxCNC's unit of length [mm].
    """
    tools = job.tools
    if "tools" not in job.model_fields_set:
        tools = tuple(ToolTable(number=number) for number in _TOOLS)
    return "".join(
        f"T{tool.number} P{tool.number} D{tool.diameter / unit_mm:.9f} "
        f"Z{(tool.length - tools[0].length) / unit_mm:.9f} ;{tool.kind}\n"
        for tool in tools
    )
