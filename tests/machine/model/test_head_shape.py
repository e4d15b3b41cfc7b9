"""What is above the holder, of heads that stand and of heads that swivel."""

import pytest

from twin.files.shipped import machine_file
from twin.job.job_file import ToolTable
from twin.machine.load import read_machine
from twin.machine.model.head_shape import HeadShape, HeadSolid
from twin.machine.model.model import MachineModel

TOOL = ToolTable(number=1, diameter=12.0, length=100.0)


def solids_of(name: str) -> dict[str, HeadSolid]:
    head = HeadShape(MachineModel(read_machine(machine_file(name)), TOOL))
    return {solid.name: solid for solid in head.above_tip(TOOL)}


def test_what_carries_a_swivel_head_is_held_against_the_stock_too() -> None:
    solids = solids_of("mill5h")
    assert set(solids) == {"holder's flange", "spindle nose", "spindle housing", "swivel", "head"}
    head = solids["head"]
    # The swivel B is between it and the spindle; the housing goes with the spindle.
    assert (head.beyond, solids["spindle housing"].beyond) == ((3,), ())
    # 55 mm above the nose, which is 100 mm above the tip; 140 mm to 500 mm behind the spindle's axis.
    assert head.above == pytest.approx(155.0)
    assert head.half == pytest.approx((180.0, 180.0))
    assert head.offset == pytest.approx((0.0, 320.0))


def test_only_what_turns_with_the_spindle_is_round() -> None:
    """A tri-dexel stock lets round solids lean with the tool, and looks at no box."""
    round_ones = {name for name, solid in solids_of("mill5h").items() if solid.round}
    assert round_ones == {"holder's flange", "spindle nose", "spindle housing"}


@pytest.mark.parametrize("name", ["mill4", "mill4_light", "mill4a", "mill5"])
def test_a_head_that_stands_ends_at_its_slide(name: str) -> None:
    solids = solids_of(name)
    assert "head" in solids
    assert not any(solid.startswith("gantry") for solid in solids)
    # What carries the head on its slide does not go up and down with it.
    assert {solid.beyond for solid in solids.values()} == (
        {(), (2,)} if name == "mill4_light" else {()}
    )
