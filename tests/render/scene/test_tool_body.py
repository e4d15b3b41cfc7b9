"""Tools as they are drawn."""

import mujoco

from twin.cutting.tools import EMPTY_SPINDLE
from twin.files.shipped import machine_file
from twin.machine.load import read_machine
from twin.render.scene.tool_body import ToolBodies
from twin.toolpath.tool_plan import ToolPlan


def test_an_empty_spindle_is_drawn_without_a_shank() -> None:
    """A picture of an alarm while no tool was in the spindle could not be made."""
    machine = read_machine(machine_file("mill4"))
    spec = mujoco.MjSpec.from_file(str(machine.model_path))
    ToolBodies(ToolPlan((EMPTY_SPINDLE,)), flange_diameter=63.0).add_to(spec)
    names = [geom.name for geom in spec.geoms]
    assert "cutter_0" in names
    assert "cutter_0_shank" not in names
    assert spec.compile().ngeom > 0
