"""A horizontal mill of bodies, joints and shapes alone: what is supplied, and where its stock lies."""

from pathlib import Path

import mujoco
import numpy as np
import pytest

from twin.job.job_file import JobFile
from twin.machine.description.config import MachineConfig
from twin.machine.load import read_machine
from twin.machine.model.model import BLANK, MachineModel
from twin.machine.model.supplied import CAMERAS, supply
from twin.run.preparing.layout import lay_out
from twin.units import MM

MODEL = """<mujoco>
  <worldbody>
    <geom name="bed" type="box" size="0.5 0.9 0.1" pos="0 0.3 0.1"/>
    <body name="column" pos="0 1 0.2">
      <joint name="X" type="slide" axis="-1 0 0"/>
      <geom type="box" size="0.2 0.2 0.6" pos="0 0 0.65"/>
      <body name="spindle" pos="0 -0.4 0.8" euler="-90 0 0">
        <joint name="Y" type="slide" axis="0 -1 0"/>
        <geom name="nose" type="cylinder" size="0.06 0.03" pos="0 0 0.03"/>
        <site name="spindle_nose"/>
      </body>
    </body>
    <body name="saddle">
      <joint name="Z" type="slide" axis="0 -1 0"/>
      <geom name="saddle" type="box" size="0.3 0.3 0.05" pos="0 0 0.3"/>
      <body name="pallet" pos="0 0 0.4">
        <joint name="B" type="hinge" axis="0 0 -1"/>
        <geom name="pallet" type="cylinder" size="0.2 0.04"/>
        <site name="table_top" pos="0 0 0.04"/>
      </body>
    </body>
  </worldbody>
  EXCLUDED
</mujoco>
"""
AXIS = '[axes.{0}]\njoint = "{0}"\nkind = "{1}"\nvelocity = 300.0\nacceleration = 3000.0\njerk = 30000.0\nkv = 5.0\n'


def own_machine(folder: Path, excluded: str = "") -> MachineConfig:
    kinds = {"X": "linear", "Y": "linear", "Z": "linear", "B": "rotary"}
    text = 'schema = 1\nname = "own"\nmodel = "own.xml"\npath = { acceleration = 3000.0, jerk = 30000.0 }\n'
    text += "".join(AXIS.format(*axis) for axis in kinds.items())
    (folder / "machine.toml").write_text(text, encoding="utf-8")
    (folder / "own.xml").write_text(MODEL.replace("EXCLUDED", excluded), encoding="utf-8")
    return read_machine(folder / "machine.toml")


def test_all_that_is_left_out_is_supplied_and_said(tmp_path: Path) -> None:
    machine = own_machine(tmp_path)
    spec = mujoco.MjSpec.from_file(str(machine.model_path))
    said = "\n".join(supply(spec, machine))
    for name in machine.axes.names:
        assert f"actuator '{name}' is missing" in said
    assert "on the side of the tool column, nose" in said
    assert "on the side of the part saddle, pallet" in said
    assert "on the side of the frame bed" in said
    assert {camera.name for camera in spec.cameras} == set(CAMERAS)
    assert not supply(spec, machine)


def test_stock_and_column_of_a_horizontal_mill_lie_along_its_own_axes(tmp_path: Path) -> None:
    """The block is 100 wide (X), 80 high (Y) and 60 deep (Z), on the pallet, its front face 30 before the pallet's axis."""
    machine = own_machine(tmp_path)
    job = JobFile.model_validate(
        {
            "program": "none.nc",
            "stock": {"shape": "box", "size": [100.0, 80.0, 60.0], "position": [0.0, 40.0, 30.0]},
        }
    )
    laid = lay_out(job, machine)
    model = MachineModel(machine, job.tools[0], laid.blank).solids
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert data.geom(BLANK).xpos / MM == pytest.approx([0.0, 0.0, 480.0])
    turn = data.geom(BLANK).xmat.reshape(3, 3)
    assert np.abs(turn) @ model.geom(BLANK).size / MM == pytest.approx([50.0, 30.0, 40.0])
    column, nose = (
        next(
            solid
            for solid in MachineModel(machine).head.above_tip(job.tools[0])
            if solid.name == name
        )
        for name in ("column", "nose")
    )
    # Behind the nose by 200, from 750 below it to 450 above, and Y is between the two.
    assert (column.beyond, column.half, column.offset) == (
        (1,),
        (200.0, 600.0),
        (0.0, pytest.approx(-150.0)),
    )
    assert column.above - job.tools[0].length == pytest.approx(200.0)
    assert (nose.round, nose.beyond) == (True, ())


def test_bodies_that_the_model_excludes_may_overlap(tmp_path: Path) -> None:
    from twin.machine.watching.clearance import Clearance

    def pairs(excluded: str) -> set[tuple[str, str]]:
        machine = own_machine(tmp_path, excluded)
        model = MachineModel(machine).solids
        watched = Clearance(machine, model)
        return {watched._names(pair) for pair in range(len(watched._pairs))}

    exclude = '<contact><exclude body1="column" body2="pallet"/></contact>'
    assert pairs("") - pairs(exclude) == {("column", "pallet")}
