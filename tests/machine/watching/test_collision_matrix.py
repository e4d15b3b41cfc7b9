"""Every pair of solids of every shipped machine is watched, or is named here with its reason."""

import itertools

import mujoco
import numpy as np
import pytest

from tests.machine.watching.test_clearance import along
from twin.errors import ConfigError
from twin.files.shipped import machine_file, machine_names
from twin.job.fixture import FixtureTable
from twin.job.job_file import ToolTable
from twin.machine.description.config import Blank, MachineConfig
from twin.machine.load import read_machine
from twin.machine.model.clamping import refuse_overlaps
from twin.machine.model.model import MachineModel, clearance_model
from twin.machine.model.tool_shape import COLLISION_GROUP, TOOL_SIDE
from twin.machine.watching.clearance import Clearance
from twin.units import MM

TOOL = ToolTable(number=1, kind="ball", diameter=10.0, length=60.0, flute=20.0, shank=14.0)
CLAMPED = ("arm", "stock", "parallel 1", "parallel 2")
BY_HEIGHT_MAP = "stock"
"""What is on the tool's side is held against it as it is cut."""


ARM = FixtureTable(name="arm", size=(20.0, 10.0, 10.0), position=(0.0, 45.0, 0.0))
BLANK_IN_AIR = Blank((40.0, 40.0, 20.0), (0.0, 0.0, 40.0), round=False)


def clamped(name: str, *fixtures: FixtureTable) -> MachineModel:
    """A machine with a fixture and a stock on its work holding, and others."""
    machine = read_machine(machine_file(name), fixtures=(ARM, *fixtures))
    return MachineModel(machine, TOOL, BLANK_IN_AIR)


def all_pairs(name: str) -> list[tuple[str, str, str]]:
    """Machine and names of every two solids of different bodies that may come to each other."""
    model = clamped(name).solids
    solids = [model.geom(i) for i in range(model.ngeom) if model.geom_group[i] == COLLISION_GROUP]
    return [
        (name, one.name, two.name)
        for one, two in itertools.combinations(solids, 2)
        if model.geom_bodyid[one.id] != model.geom_bodyid[two.id]
        and not built_to_pass(model, one.id, two.id)
    ]


def built_to_pass(model: mujoco.MjModel, one: int, two: int) -> bool:
    """Parts of the machine alone, of which neither carries the tool or the workpiece; and the stock."""
    names = {model.geom(one).name, model.geom(two).name}
    tool = [bool(model.geom_contype[each] & TOOL_SIDE) for each in (one, two)]
    if all(tool) or (any(tool) and BY_HEIGHT_MAP in names):
        return True
    gantry = any(name.startswith("gantry") for name in names)
    return not names.intersection(CLAMPED) and (not any(tool) or gantry)


MACHINES = tuple(machine_names())
EVERYDAY = ("mill4", "mill5")
"""Machines whose every pair is looked at ten times a day."""
PAIRS = [pair for name in MACHINES for pair in all_pairs(name)]


@pytest.fixture(scope="module")
def machines() -> dict[str, tuple[MachineConfig, mujoco.MjSpec]]:
    models = {name: clamped(name) for name in MACHINES}
    return {name: (model.machine, model.spec) for name, model in models.items()}


def lone(
    machines: dict[str, tuple[MachineConfig, mujoco.MjSpec]], name: str, *kept: str
) -> tuple[MachineConfig, mujoco.MjSpec]:
    machine, spec = machines[name]
    spec = spec.copy()
    for geom in list(spec.geoms):
        if geom.group == COLLISION_GROUP and geom.name not in kept:
            spec.delete(geom)
    return machine, spec


@pytest.mark.parametrize(
    ("name", "one", "two"),
    [
        pytest.param(*pair, marks=() if pair[0] in EVERYDAY else pytest.mark.thorough)
        for pair in PAIRS
    ],
)
def test_an_overlap_of_a_twentieth_is_seen_and_a_gap_of_one_is_none(
    machines: dict[str, tuple[MachineConfig, mujoco.MjSpec]], name: str, one: str, two: str
) -> None:
    machine, spec = lone(machines, name, one, two)
    for gap, seen in ((0.05, False), (-0.05, True)):
        placed = spec.copy()
        # What is lowest in the tree is set off by the gap above the other, wherever that is.
        model = clearance_model(machine, placed)
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        first, second = model.geom(one).id, model.geom(two).id
        move = data.geom_xpos[second] - data.geom_xpos[first]
        half = [_half_height(model, data, each) for each in (first, second)]
        move[2] += sum(half) + gap * MM
        body = data.xmat[model.geom_bodyid[first]].reshape(3, 3)
        placed.geom(one).pos = np.array(placed.geom(one).pos) + body.T @ move
        watch = Clearance(machine, clearance_model(machine, placed))
        alarm = watch.look(along(np.zeros((2, len(machine.axes)))))
        assert (alarm is not None) is seen, (gap, alarm)


def _half_height(model: mujoco.MjModel, data: mujoco.MjData, geom: int) -> float:
    """Half the height of an upright or lying solid, by its own turn."""
    turn, size = data.geom_xmat[geom].reshape(3, 3), model.geom_size[geom]
    kind = model.geom_type[geom]
    if kind == mujoco.mjtGeom.mjGEOM_SPHERE:
        return float(size[0])
    if kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
        size = np.array([size[0], size[0], size[1]])
        lying = abs(turn[2, 2]) < 0.5
        return float(size[0] if lying else size[2])
    return float(np.abs(turn[2]) @ size)


def test_every_body_of_the_machine_is_in_the_matrix() -> None:
    named = {solid for _, one, two in PAIRS for solid in (one, two)}
    for name in MACHINES:
        for geom in clamped(name).spec.geoms:
            assert geom.group != COLLISION_GROUP or geom.name in named, geom.name


@pytest.mark.parametrize(
    ("position", "into"),
    [
        ((0.0, 0.0, -3.0), "faceplate"),
        ((0.0, 30.0, 42.0), "stock"),
        ((12.0, 45.0, 5.0), "(arm|block)"),
    ],
)
def test_a_fixture_in_something_else_is_refused(
    position: tuple[float, float, float], into: str
) -> None:
    block = FixtureTable(name="block", size=(30.0, 30.0, 30.0), position=position)
    with pytest.raises(ConfigError, match=f"reaches .* mm into the {into}"):
        refuse_overlaps(clamped("mill4", block))


def test_a_jaw_that_touches_the_stock_is_none() -> None:
    jaw = FixtureTable(name="jaw", size=(40.0, 20.0, 45.0), position=(0.0, -30.0, 0.0))
    model = clamped("mill4", jaw)
    refuse_overlaps(model)
    assert "jaw" in [geom.name for geom in model.spec.geoms]
