"""What a run came to: what result.json, the report and the exit code are made of."""

import dataclasses

from twin.compare.figures import Figures
from twin.compare.verdict import Verdict
from twin.cutting.cut import CutResult
from twin.cutting.forces.load_log import LoadLog
from twin.cutting.inspection import Inspection
from twin.cutting.nominal import NominalGouge
from twin.machine.watching.alarms import Alarm, NearMiss
from twin.nc.canonical import FloatArray
from twin.nc.text.diagnostics import Diagnostic
from twin.run.scope import Scope
from twin.run.tool_use import ToolUse


@dataclasses.dataclass(frozen=True, kw_only=True)
class Outcome:
    """What a run came to.

    Attributes:
        verdict: Pass, fail or alarm, with the reasons.
        figures: Following and contour error.
        cut: What the cut told; None without a stock.
        gouge: The deepest cut into the nominal part, beyond what the job allows.
        inspection: How far the part is from the nominal one; None without one.
        loads: The greatest of what the tools felt.
        alarms: Alarms of the machine, in order.
        near_miss: The closest that the tool's side and the part's came, below the machine's limit.
        warnings: Those of the interpreter, of the program and of the cut.
        scope: What the verdict looked at.
        tools: Those that were in the spindle, with their times and what they took off.
        part: A picture of the part as it was cut, PNG; empty without a stock.
        samples: How many samples were recorded, settling included.
        duration_s: Machine time of the program, settling not counted [s].
        final_commanded: Program coordinates at the end, shape (k,) [mm or deg].
        final_simulated: Program coordinates of the simulated joints at the end, shape (k,)
            [mm or deg].
    """

    verdict: Verdict
    figures: Figures
    cut: CutResult | None
    gouge: NominalGouge | None
    inspection: Inspection | None
    loads: LoadLog
    alarms: tuple[Alarm, ...]
    near_miss: NearMiss | None
    warnings: tuple[Diagnostic, ...]
    scope: Scope
    tools: tuple[ToolUse, ...] = ()
    part: bytes = b""
    samples: int
    duration_s: float
    final_commanded: FloatArray
    final_simulated: FloatArray
