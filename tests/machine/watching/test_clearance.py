"""Who may not meet whom, how finely that is seen, and at what speed."""

import copy
import itertools
from pathlib import Path

import hypothesis
import hypothesis.strategies as st
import mujoco
import numpy as np
import pytest
from examples import examples

from tests.machine.machine_fixtures import (
    setpoints,
    shipped_machine,
    three_axis_machine,
    with_fixtures,
)
from twin.job.fixture import FixtureTable
from twin.job.job_file import ToolTable
from twin.machine.description.config import MachineConfig
from twin.machine.model.model import build_spec, clearance_model
from twin.machine.model.tool_shape import COLLISION_GROUP
from twin.machine.watching.clearance import Clearance
from twin.nc.canonical import FloatArray
from twin.recording.reader import Samples
from twin.units import MM

TOOL = ToolTable(
    number=1, diameter=10.0, length=100.0, flute=20.0, shank=14.0, holder=40.0, free_length=50.0
)
FIXTURES = (
    FixtureTable(name="jaw", size=(80.0, 20.0, 30.0), position=(0.0, 60.0, 0.0)),
    FixtureTable(name="clamp", diameter=16.0, height=45.0, position=(-60.0, 0.0, 0.0)),
)
MOVING = (
    "cutter",
    "tool's shank",
    "holder's nut",
    "holder's flange",
    "spindle nose",
    "spindle housing",
    "head",
)
STANDING = (
    "jaw",
    "clamp",
    "faceplate",
    "rotary table's bearing",
    "rotary table's housing",
    "rotary table's gearbox",
    "rotary table's motor",
    "X table",
    "saddle",
    "base",
    "column",
)
MACHINE = with_fixtures(shipped_machine(), *FIXTURES)
SPEC = build_spec(MACHINE, TOOL)


def along(position: FloatArray) -> Samples:
    """Samples of axes that stand exactly where they are told to."""
    still = np.zeros_like(position)
    return Samples(setpoints(position, still, still), position, still, still)


def watch(clearance: Clearance, position: FloatArray, size: int = 700) -> str:
    """Message of the alarm that positions of the axes raise; empty for none."""
    for first in range(0, len(position), size):
        alarm = clearance.look(along(position[first : first + size]))
        if alarm is not None:
            assert alarm.code == "collision"
            return alarm.message
    return ""


def alone(
    spec: mujoco.MjSpec, machine: MachineConfig, *names: str
) -> tuple[Clearance, mujoco.MjModel]:
    """The watch over a few geoms of a machine, as if it had no others."""
    spec = spec.copy()
    for geom in list(spec.geoms):
        if geom.group == COLLISION_GROUP and geom.name not in names:
            spec.delete(geom)
    model = clearance_model(machine, spec)
    return Clearance(machine, model), model


def passing(gap: float, step: float, model: mujoco.MjModel, one: str, two: str) -> FloatArray:
    """A way past a solid along X with so much room [mm] at the closest, a step each sample."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    apart, half = [], []
    for name in (one, two):
        geom = model.geom(name).id
        turn = data.geom_xmat[geom].reshape(3, 3)
        apart.append((data.geom_xpos[geom] + turn @ model.geom_aabb[geom, :3]) / MM)
        half.append(np.abs(turn) @ model.geom_aabb[geom, 3:] / MM)
    x, y, z = apart[1] - apart[0]
    if two in ("column", "base"):  # which stand still under X and Y: from above, onto it
        down = np.arange(40.0, 0.0, -step)
        position = np.zeros((len(down) + 1, 4))
        position[:, 2] = z + half[0][2] + half[1][2] + gap + np.append(down, 0.0)
        return position
    travel = np.arange(-25.0, 25.0, step) + 0.37 * step
    position = np.zeros((len(travel), 4))
    position[:] = x, y + half[0][1] + half[1][1] + gap, z, 0.0
    position[:, 0] += travel
    return position


@pytest.mark.parametrize(("one", "two"), [*itertools.product(MOVING, STANDING)])
def test_a_twentieth_of_a_millimetre_is_seen_and_no_alarm_is_false(one: str, two: str) -> None:
    """At 3 m/min and at 30 m/min, past the flank; column and base from above."""
    spec = SPEC.copy()
    if two in ("column", "base"):  # out of reach on this machine: brought under the tool
        nose = SPEC.site("spindle_nose").parent
        reach = spec.geom(one)
        under = [0.0, 0.0, 0.0]
        if reach.parent.name != nose.name:
            under = [0.0, reach.pos[1] + 0.6, 0.0]
        spec.geom(two).pos = np.array([under[0], under[1], spec.geom(two).pos[2] - 3.0])
    for step in (0.05, 0.5):
        for gap in (-0.05, 0.05):
            clearance, model = alone(spec, MACHINE, one, two)
            message = watch(clearance, passing(gap, step, model, one, two))
            if gap > 0.0:
                assert message == "", (step, gap)
            else:
                assert message.startswith(f"the {one} meets the {two} (0.0"), (step, gap)


@pytest.mark.parametrize("kind", ["flat", "ball", "bull", "drill", "chamfer"])
@pytest.mark.parametrize("gap", [-0.05, 0.05])
def test_the_end_of_a_cutter_has_its_shape(kind: str, gap: float) -> None:
    """Down onto the faceplate, and down beside the edge of a jaw where the shape gives way."""
    corner = 2.0 if kind == "bull" else None
    tool = ToolTable.model_validate(
        {"number": 1, "kind": kind, "diameter": 10.0, "length": 100.0, "corner": corner}
    )
    spec = build_spec(MACHINE, tool)
    table = -620.0 + 100.0
    down = np.append(np.arange(60.0, 0.0, -0.5), 0.0)
    position = np.zeros((len(down), 4))
    position[:, 2] = table + gap + down
    assert bool(watch(Clearance(MACHINE, clearance_model(MACHINE, spec)), position)) == (gap < 0)
    aside = 3.0  # the tool's axis is so far beside the jaw's face
    rise = {
        "flat": 0.0,
        "ball": 5.0 - np.sqrt(25.0 - 9.0),
        "bull": 0.0,
        "drill": 3.0 / np.tan(np.radians(59.0)),
        "chamfer": 3.0,
    }[kind]
    position[:, 1] = 50.0 - aside
    position[:, 2] = table + 30.0 - rise + gap + down
    assert bool(watch(Clearance(MACHINE, clearance_model(MACHINE, spec)), position)) == (gap < 0)


def test_between_two_samples_nothing_is_jumped_over() -> None:
    """A thin pin that two samples at 60 m/min step over, the flanks 0.1 mm into each other."""
    pin = FixtureTable(name="pin", diameter=0.4, height=50.0)
    machine = with_fixtures(shipped_machine(), pin)
    thin = ToolTable(number=1, diameter=0.4, length=100.0, shank=0.4, holder=1.0)
    for gap, met in ((-0.1, True), (-0.05, True), (0.05, False)):
        clearance, _ = alone(build_spec(machine, thin), machine, "cutter", "pin")
        position = np.zeros((61, 4))
        position[:, 0] = np.arange(-30.0, 31.0) + 0.5
        position[:, 1] = 0.4 + gap
        position[:, 2] = -620.0 + 100.0 + 40.0
        assert bool(watch(clearance, position)) == met


def box_gap(position: FloatArray) -> FloatArray:
    """Clearance of the cutter and the jaw, in the jaw's own frame [mm]."""
    angle = np.radians(position[:, 3])
    x = np.cos(angle) * position[:, 0] - np.sin(angle) * position[:, 1]
    y = np.sin(angle) * position[:, 0] + np.cos(angle) * position[:, 1]
    aside = np.hypot(np.maximum(np.abs(x) - 40.0, 0.0), np.maximum(np.abs(y - 60.0) - 10.0, 0.0))
    inside = np.minimum(np.maximum(np.abs(x) - 40.0, np.abs(y - 60.0) - 10.0), 0.0)
    level = aside + inside - 5.0
    above = position[:, 2] - (-620.0 + 100.0) - 30.0
    return np.where((level > 0) & (above > 0), np.hypot(level, above), np.maximum(level, above))


stop = st.tuples(
    st.floats(-80.0, 80.0), st.floats(-20.0, 120.0), st.floats(0.0, 45.0), st.floats(-200.0, 200.0)
)


@hypothesis.settings(derandomize=True, max_examples=examples(60), deadline=None)
@hypothesis.given(st.lists(stop, min_size=2, max_size=5), st.sampled_from([40, 400]))
def test_any_way_with_a_turning_table_agrees_with_the_closed_form(
    stops: list[tuple[float, float, float, float]], samples: int
) -> None:
    clearance, _ = alone(SPEC, MACHINE, "cutter", "jaw")
    corners = np.array(stops)
    corners[:, 2] += -620.0 + 100.0
    share = np.linspace(0.0, 1.0, samples, endpoint=False)[:, None]
    way = np.concatenate([a + share * (b - a) for a, b in itertools.pairwise(corners)])
    least = box_gap(way).min()
    hypothesis.assume(abs(least) > 0.02)
    fine = np.concatenate([a + share * (b - a) for a, b in itertools.pairwise(way)][:20_000])
    hypothesis.assume(least < 0.0 or box_gap(fine).min() > 0.05)
    assert bool(watch(clearance, way, 97)) == (least < 0.0)


def test_a_tool_that_stands_on_a_jaw_may_be_driven_off_it() -> None:
    clearance, _ = alone(SPEC, MACHINE, "cutter", "jaw")
    down = np.tile([0.0, 60.0, -490.0, 0.0], (100, 1))
    down[:, 2] -= np.linspace(-1.0, 1.0, 100)
    assert watch(clearance, down)
    clearance.acknowledge(down[-1])
    assert watch(clearance, down[::-1].copy()) == ""
    assert watch(clearance, down), "what is free again counts as at first"


def test_the_nearest_of_holder_and_head_is_told_but_not_that_of_the_cutter() -> None:
    clearance, _ = alone(SPEC, MACHINE, "cutter", "holder's nut", "jaw")
    position = np.tile([0.0, 60.0 - 10.0 - 23.0, -620.0 + 100.0 - 30.0, 0.0], (400, 1))
    position[:, 2] += np.linspace(30.0, 0.0, 400)
    assert watch(clearance, position) == ""
    assert clearance.near_miss is not None
    assert clearance.near_miss.between == ("holder's nut", "jaw")
    assert clearance.near_miss.clearance_mm == pytest.approx(3.0, abs=0.05)


def test_a_machine_without_rotary_axes_is_watched_too(tmp_path: Path) -> None:
    machine = three_axis_machine(tmp_path)
    spec = build_spec(machine, TOOL)
    clearance = Clearance(machine, clearance_model(machine, spec))
    down = np.zeros((400, 3))
    down[:, 2] = np.linspace(0.0, -550.0, 400)
    assert "the cutter meets the faceplate" in watch(clearance, down)


def test_a_copy_watches_for_itself() -> None:
    clearance, _ = alone(SPEC, MACHINE, "cutter", "holder's nut", "jaw")
    position = np.tile([0.0, 60.0 - 10.0 - 23.0, -620.0 + 100.0 - 30.0, 0.0], (400, 1))
    position[:, 2] += np.linspace(30.0, 0.0, 400)
    copied = copy.deepcopy(clearance)
    assert watch(copied, position, size=1) == ""
    assert (clearance.near_miss, copied.near_miss is None) == (None, False)
    assert watch(clearance, position, size=1) == ""
    assert clearance.near_miss == copied.near_miss
