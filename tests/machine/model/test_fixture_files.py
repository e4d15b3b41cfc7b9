"""Fixtures from STL files: their hollows count, they are met where they are, and refused where something is."""

import io
from pathlib import Path

import mujoco
import numpy as np
import pytest
import trimesh

from tests.machine.watching.test_clearance import along
from twin.errors import ConfigError
from twin.files.shipped import machine_file
from twin.job.fixture import FixtureTable
from twin.job.job_file import ToolTable
from twin.job.load import load_job
from twin.machine.description.config import Blank, MachineConfig
from twin.machine.load import read_machine
from twin.machine.model.clamping import TALLEST, refuse_overlaps, what_carries
from twin.machine.model.convex_parts import MOST_PARTS, convex_parts
from twin.machine.model.model import MachineModel, build_spec, clearance_model
from twin.machine.watching.clearance import Clearance
from twin.render.machine_glb import drawn_machine

JAW = (20.0, 60.0, 40.0)


def box(size: tuple[float, float, float], at: tuple[float, float, float]) -> trimesh.Trimesh:
    mesh = trimesh.creation.box(extents=size)
    mesh.apply_translation(at)
    return mesh


def vise_mesh() -> trimesh.Trimesh:
    """A base with two jaws on it, 60 mm apart: the outline of a U, drawn out along Y, one solid."""
    outline = [(-50, 0), (50, 0), (50, 60), (30, 60), (30, 20), (-30, 20), (-30, 60), (-50, 60)]
    # Two triangles for each of three rectangles, at both ends, and the walls between them.
    ends = [(0, 1, 5), (1, 4, 5), (1, 2, 3), (1, 3, 4), (0, 5, 6), (0, 6, 7)]
    points = [(x, y, z) for y in (-30.0, 30.0) for x, z in outline]
    faces = list(ends) + [(a + 8, c + 8, b + 8) for a, b, c in ends]
    for one in range(8):
        two = (one + 1) % 8
        faces += [(one, one + 8, two), (two, one + 8, two + 8)]
    return trimesh.Trimesh(points, faces)


@pytest.fixture
def vise(tmp_path: Path) -> FixtureTable:
    mesh = vise_mesh()
    mesh.fix_normals()
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(100 * 60 * 20 + 2 * 20 * 60 * 40)
    mesh.export(tmp_path / "vise.stl")
    return FixtureTable(name="vise", file=str(tmp_path / "vise.stl"))


def volume(parts: tuple[np.ndarray, ...]) -> float:
    return sum(float(np.prod(np.ptp(part, axis=0))) for part in parts)


def test_what_is_made_of_blocks_is_cut_at_their_faces(vise: FixtureTable) -> None:
    assert vise.file is not None
    parts = convex_parts(Path(vise.file))
    assert len(parts) == 3
    assert all(len(part) == 8 for part in parts)
    assert volume(parts) == pytest.approx(216_000.0)


def test_separate_bodies_are_parts_of_their_own(tmp_path: Path) -> None:
    two = trimesh.util.concatenate(
        [box(JAW, (-40.0, 0.0, 20.0)), box(JAW, (40.0, 3.0, 20.0)), box((5, 5, 5), (0, 0, 90))]
    )
    two.export(tmp_path / "jaws.stl")
    parts = convex_parts(tmp_path / "jaws.stl")
    assert volume(parts) == pytest.approx(2 * 48_000.0 + 125.0)


def test_a_solid_that_is_too_hollow_is_refused_with_its_place(tmp_path: Path) -> None:
    ring = trimesh.creation.annulus(r_min=40.0, r_max=60.0, height=10.0, sections=128)
    ring.export(tmp_path / "ring.stl")
    with pytest.raises(ConfigError, match=rf"is hollow at .* {MOST_PARTS} convex parts"):
        convex_parts(tmp_path / "ring.stl")


def test_a_table_needs_one_shape() -> None:
    with pytest.raises(ValueError, match="either size, or diameter and height, or file"):
        FixtureTable(name="vise", file="vise.stl", size=(1.0, 1.0, 1.0))


def mill(*fixtures: FixtureTable) -> MachineConfig:
    return read_machine(machine_file("mill4"), fixtures=fixtures)


def clamped(blank: Blank | None, *fixtures: FixtureTable) -> MachineModel:
    return MachineModel(mill(*fixtures), TOOL, blank)


TOOL = ToolTable(number=1, diameter=10.0, length=60.0)


@pytest.mark.parametrize(("gap", "meets"), [(0.05, False), (-0.05, True)])
@pytest.mark.parametrize("above", ["jaw", "base"])
def test_a_tool_meets_it_within_a_twentieth(
    vise: FixtureTable, above: str, gap: float, *, meets: bool
) -> None:
    """Between the jaws the tool comes down to the base: their hull is not solid."""
    machine = mill(vise)
    spec = build_spec(machine, TOOL)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    tip = float(data.site("spindle_nose").xpos[2] - data.site("table_top").xpos[2]) * 1e3 - 60.0
    height, x = (60.0, 40.0) if above == "jaw" else (20.0, 0.0)
    z = height - tip + gap
    clearance = Clearance(machine, clearance_model(machine, spec))
    way = along(np.array([(x, 0.0, z + lift, 0.0) for lift in (1.0, 0.0, 1.0)]))
    alarm = clearance.look(way)
    assert (alarm is not None) == meets
    assert alarm is None or "meets the vise (0.05 mm deep)" in alarm.message


def test_stock_between_its_jaws_is_held_and_stock_in_them_is_refused(vise: FixtureTable) -> None:
    between = clamped(Blank((59.8, 40.0, 20.0), (0.0, 0.0, 35.0), round=False), vise)
    refuse_overlaps(between)
    assert what_carries(between) is None
    within = clamped(Blank((60.2, 40.0, 20.0), (0.0, 0.0, 35.0), round=False), vise)
    with pytest.raises(ConfigError, match=r"fixture 'vise' reaches 0\.10 mm into the stock"):
        refuse_overlaps(within)


def test_in_the_faceplate_or_in_another_fixture_it_is_refused(vise: FixtureTable) -> None:
    low = clamped(None, vise.model_copy(update={"position": (0.0, 0.0, -3.0)}))
    with pytest.raises(ConfigError, match=r"fixture 'vise' reaches 3.00 mm into the"):
        refuse_overlaps(low)
    block = FixtureTable(name="block", size=(30.0, 10.0, 50.0), position=(-60.0, 0.0, 0.0))
    with pytest.raises(ConfigError, match=r"reaches 5.00 mm into the (vise|block)"):
        refuse_overlaps(clamped(None, vise, block))


def test_it_is_seen_in_film_and_page(vise: FixtureTable) -> None:
    drawn = drawn_machine(mill(vise), TOOL, mill(vise).part_frame, None, np.zeros(4))
    model = drawn.model
    assert int(model.mesh_facenum[int(model.geom("vise seen").dataid[0])]) == 28
    scene = trimesh.load_scene(io.BytesIO(drawn.glb()), file_type="glb")
    assert any("vise" in name for name in scene.graph.nodes_geometry)


def test_its_path_is_relative_to_the_file_that_names_it(vise: FixtureTable, tmp_path: Path) -> None:
    (tmp_path / "part.nc").write_text("G1 X1 F100\nM2\n")
    text = 'program = "part.nc"\n[[fixtures]]\nname = "vise"\nfile = "vise.stl"\n'
    (tmp_path / "part.toml").write_text(text)
    (fixture,) = load_job(tmp_path / "part.toml").file.fixtures
    assert fixture.file == vise.file
    assert fixture.box == ((100.0, 60.0, 60.0), (0.0, 0.0, 30.0))


@pytest.mark.parametrize(
    ("center", "why"),
    [
        ((0.0, 0.0, 30.0), None),
        ((0.0, 0.0, 20.0 + TALLEST + 5.0), "above what is under it"),
        ((900.0, 0.0, 30.0), "nothing of the table"),
    ],
)
def test_stock_over_nothing_or_far_above_it_floats(
    center: tuple[float, float, float], why: str | None
) -> None:
    found = what_carries(clamped(Blank((40.0, 40.0, 20.0), center, round=False)))
    assert found == why or (why is not None and why in str(found))
