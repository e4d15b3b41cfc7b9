"""The twin from Python: the same steps as the command line, with NumPy columns and results that explain themselves.

    import twin

    moves = twin.interpret("G1 X10 F100", dialect="haas")
    setpoints = twin.plan("mefi/helix")
    result = twin.run("part.toml")
    result.ok, result["contour_um"].max(), result.by_line()
    twin.sweep("part.toml", {"machine.axes.X.kv": [5.0, 7.5]})

A program is a path, the name of a shipped one, the text of one, or a ``twin.Job``. Every function raises
``twin.errors.TwinError`` where the command would end with a message.
"""

from twin.api.functions import interpret, plan, run
from twin.api.machine import Machine
from twin.api.program import Program
from twin.api.result import Result
from twin.api.session import Session
from twin.api.variations import sweep
from twin.compare.track_comparison import compare_files as compare
from twin.job.job_file import JobFile as Job
from twin.job.job_file import StockTable as Stock
from twin.job.job_file import ToolTable as Tool
from twin.job.tolerance import ToleranceTable as Tolerance

__all__ = [
    "Job",
    "Machine",
    "Program",
    "Result",
    "Session",
    "Stock",
    "Tolerance",
    "Tool",
    "compare",
    "interpret",
    "plan",
    "run",
    "sweep",
]
