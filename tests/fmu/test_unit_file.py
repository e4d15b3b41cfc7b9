"""The unit's file, held against fmpy: its validator, and its own import of FMI 3."""

from pathlib import Path

import numpy as np
import pytest
from command_line import Twin

from tests.fmu.recorded import START, Recorded

pytestmark = pytest.mark.oracle


@pytest.fixture(scope="module")
def unit_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    from twin.fmu.build import build_unit

    path = tmp_path_factory.mktemp("unit") / "mill4.fmu"
    build_unit("mill4", path)
    return path


def test_the_validator_finds_nothing(unit_file: Path) -> None:
    from fmpy.validation import validate_fmu

    assert validate_fmu(str(unit_file)) == []


def test_fmpy_moves_the_machine_as_the_twin_does(unit_file: Path, recorded: Recorded) -> None:
    from fmpy import extract, read_model_description
    from fmpy.fmi3 import FMU3Slave

    description = read_model_description(str(unit_file))
    numbers = {each.name: each.valueReference for each in description.modelVariables}
    assert description.coSimulation is not None
    folder = extract(str(unit_file))
    slave = FMU3Slave(
        guid=description.guid, unzipDirectory=folder, instanceName="mill",
        modelIdentifier=description.coSimulation.modelIdentifier,
    )  # fmt: skip
    axes = "XYZC"
    inputs = [
        numbers[f"setpoint.{what}.{axis}"]
        for what in ("position", "velocity", "acceleration")
        for axis in axes
    ]
    joints = [numbers[f"joint.position.{axis}"] for axis in axes]
    forces = [numbers[f"drive.force.{axis}"] for axis in axes]
    slave.instantiate()
    slave.enterInitializationMode()
    slave.setFloat64([numbers[f"start.{axis}"] for axis in axes], list(START))
    slave.exitInitializationMode()
    for row in range(len(recorded.position)):
        given = [recorded.position[row], recorded.velocity[row], recorded.acceleration[row]]
        slave.setFloat64(inputs, np.concatenate(given).tolist())
        slave.doStep(currentCommunicationPoint=row * 0.001, communicationStepSize=0.001)
        assert (
            np.array(slave.getFloat64(joints)).tobytes() == recorded.joint_position[row].tobytes()
        )
        assert np.array(slave.getFloat64(forces)).tobytes() == recorded.force[row].tobytes()
    assert slave.getString([numbers["alarm"]]) in ([""], [b""])
    slave.terminate()
    slave.freeInstance()


def test_a_machine_of_ones_own_travels_with_the_unit(twin: Twin, tmp_path: Path) -> None:
    from fmpy import read_model_description

    own = tmp_path / "mine" / "machine.toml"
    own.parent.mkdir()
    own.write_text('schema = 1\nbase = "mill4"\nname = "my-mill 2"\n')
    path = tmp_path / "mine.fmu"
    assert twin("export", "--fmu", own, "--out", path).code == 0
    assert read_model_description(str(path)).modelName == "my_mill_2"


def test_what_cannot_be_built_is_refused(twin: Twin, tmp_path: Path) -> None:
    for machine, out in (("mill4", "mill4.zip"), ("no_mill", "x.fmu")):
        done = twin("export", "--fmu", machine, "--out", tmp_path / out)
        assert done.code == 2
        assert "no machine" in done.stderr or str(tmp_path) in done.stderr
    assert not list(tmp_path.rglob("*.fmu"))
