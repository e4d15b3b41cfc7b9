import numpy as np
import pytest

from twin.errors import ConfigError
from twin.files.shipped import machine_file
from twin.job.job_file import JobFile, StockTable, ToolTable
from twin.machine.description.config import MachineConfig
from twin.machine.load import read_machine
from twin.run.preparing.layout import WORK_HOLDING_HEIGHT, lay_out


@pytest.fixture(scope="module")
def machine() -> MachineConfig:
    return read_machine(machine_file("mill4"))


@pytest.fixture(scope="module")
def clearance(machine: MachineConfig) -> float:
    return machine.at_zero.spindle_over_table


def stock(height: float, top: float = 0.0) -> StockTable:
    return StockTable(shape="box", size=(100.0, 100.0, height), position=(0.0, 0.0, top))


@pytest.mark.parametrize("top", [0.0, 15.0, -3.0])
def test_the_default_zero_lies_on_the_stock_that_stands_on_its_jaws(
    machine: MachineConfig, clearance: float, top: float
):
    tool = ToolTable(number=1, length=80.0)
    zero = lay_out(JobFile(program="a", stock=stock(30.0, top), tools=(tool,)), machine).part_zero
    tip_over_table = clearance + zero[2] - tool.length
    assert tip_over_table + top - 30.0 == pytest.approx(WORK_HOLDING_HEIGHT)
    assert tuple(zero[:2]) == machine.part_frame.center


def test_without_stock_there_is_room_both_ways(machine: MachineConfig):
    zero = lay_out(JobFile(program="a"), machine).part_zero
    travel = machine.axis("Z").travel
    assert travel is not None
    assert zero[2] == pytest.approx(sum(travel) / 2)


def test_a_given_zero_is_taken_at_its_word(machine: MachineConfig):
    job = JobFile(program="a", part_zero={"X": 12.5, "Z": -200.0, "C": 30.0})
    np.testing.assert_array_equal(lay_out(job, machine).part_zero, [12.5, 0.0, -200.0, 30.0])


def test_axes_that_the_machine_lacks_are_refused(machine: MachineConfig):
    with pytest.raises(ConfigError, match=r"part_zero\.A.*X, Y, Z, C"):
        lay_out(JobFile(program="a", part_zero={"A": 1.0}), machine)
    with pytest.raises(ConfigError, match=r"start\.W"):
        lay_out(JobFile(program="a", start={"W": 1.0}), machine)


def test_a_stock_below_the_table_is_refused_with_the_height_that_fits(
    machine: MachineConfig,
):
    low = JobFile(program="a", part_zero={"Z": -540.0}, stock=stock(200.0))
    with pytest.raises(ConfigError, match=r"raise part_zero\.Z to") as caught:
        lay_out(low, machine)
    lifted = float(str(caught.value).split("part_zero.Z to ")[1].split(" ")[0])
    fitting = JobFile(program="a", part_zero={"Z": lifted + 1e-3}, stock=stock(200.0))
    assert lay_out(fitting, machine).part_zero[2] == pytest.approx(lifted + 1e-3)


def test_on_a_table_along_x_program_zero_is_in_the_middle_of_the_faceplate() -> None:
    machine = read_machine(machine_file("mill4a"))
    job = JobFile.model_validate({"program": "p.nc", "tools": [{"number": 1, "length": 120.0}]})
    layout = lay_out(job, machine)
    np.testing.assert_allclose(layout.part_zero, [-150.0, 0.0, -525.0, 0.0])
    assert machine.part_frame.over_table == (-150.0, 0.0)


def test_on_a_trunnion_the_blank_is_over_the_table_with_its_axes_at_zero() -> None:
    machine = read_machine(machine_file("mill5"))
    stock = {"shape": "box", "size": [60.0, 60.0, 50.0]}
    tools = [{"number": 1, "length": 100.0}]
    job = JobFile.model_validate({"program": "p.nc", "stock": stock, "tools": tools})
    layout = lay_out(job, machine)
    # 630 mm from the nose to the table, 40 mm of work holding, a blank of 50 mm, a tool of 100 mm.
    np.testing.assert_allclose(layout.part_zero, [0.0, 0.0, -440.0, 0.0, 0.0])
    assert layout.blank is not None
    np.testing.assert_allclose(layout.blank.center, [0.0, 0.0, 65.0], atol=1e-9)


def test_under_a_swivel_head_program_zero_is_measured_with_the_tool_upright() -> None:
    machine = read_machine(machine_file("mill5h"))
    stock = {"shape": "box", "size": [110.0, 110.0, 30.0]}
    tools = [{"number": 1, "length": 100.0}]
    job = JobFile.model_validate({"program": "p.nc", "stock": stock, "tools": tools})
    layout = lay_out(job, machine)
    # 620 mm from the nose to the table, 40 mm of work holding, a blank of 30 mm, a tool of 100 mm.
    np.testing.assert_allclose(layout.part_zero, [0.0, 0.0, -450.0, 0.0, 0.0])
    assert layout.blank is not None
    np.testing.assert_allclose(layout.blank.center, [0.0, 0.0, 55.0], atol=1e-9)
