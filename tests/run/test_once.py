"""Nothing is done twice in a run: files read, the program interpreted, the model built, the stock laid."""

from collections import Counter
from pathlib import Path

import mujoco
import pytest

import twin.coupling.operations
import twin.cutting.cut
import twin.job.load
import twin.machine.load
import twin.machine.model.model
from twin.coupling.cutting_process import CuttingProcess
from twin.cutting.height_map_material import HeightMapMaterial
from twin.files.shipped import resource_root
from twin.nc.interpreter import Interpretation
from twin.run.preparing.preparation import prepare
from twin.run.progress import no_progress
from twin.run.run import Run

ONE_TOOL = "codesys/arc_in_xz_then_xy.toml"
TWO_TOOLS = "alarms/fagor8070/collision_change_in_part.toml"
WITH_FORCES = "alarms/fagor8070/tool_broken.toml"


@pytest.fixture
def counts(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """How often each was called."""
    counted = Counter[str]()

    def count(owner: object, name: str, label: str) -> None:
        call = getattr(owner, name)

        def counting(*arguments: object, **named: object) -> object:
            counted[label] += 1
            return call(*arguments, **named)

        monkeypatch.setattr(owner, name, counting)

    count(Interpretation, "chunks", "interpretations")
    count(twin.machine.model.model, "_without_tool", "models")
    count(mujoco.MjSpec, "compile", "compiled")
    count(twin.cutting.cut, "blank", "stocks")
    count(twin.coupling.operations, "blank", "stocks")
    count(HeightMapMaterial, "__init__", "cuts")
    count(CuttingProcess, "__init__", "processes")
    count(twin.job.load, "load_toml", "job files")
    count(twin.machine.load, "load_toml", "machine files")
    count(mujoco.MjSpec, "from_file", "model files")
    return counted


@pytest.mark.parametrize("job", [ONE_TOOL, TWO_TOOLS, WITH_FORCES])
def test_a_run_does_each_once(counts: Counter[str], job: str) -> None:
    run = Run(prepare(Path(resource_root("programs") / job)))
    outcome = run.execute(None, no_progress)
    assert outcome.samples
    assert counts["interpretations"] == counts["models"] == 1
    assert counts["job files"] == counts["machine files"] == 1
    # The joints, for the chain of axes; and what is completed for the simulation.
    assert counts["model files"] == 2
    assert counts["stocks"] == counts["cuts"] == 1
    assert counts["processes"] == (job == WITH_FORCES)
    # The joints, for the chain of axes; the empty machine, for whose masses the drives are tuned; what moves;
    # and the solids around each tool.
    tools = len({tool.number for tool in run.dry_run.summary.tools.tools})
    assert counts["compiled"] == 3 + tools
