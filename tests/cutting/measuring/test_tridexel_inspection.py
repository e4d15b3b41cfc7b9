"""Parts that are off by what is known beforehand, measured on a tri-dexel stock."""

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import trimesh

from twin.cutting.measuring.inspection import Inspection
from twin.cutting.measuring.tridexel_inspection import EXACT_MM, inspect_stock, nominal_stock
from twin.cutting.tools import profile
from twin.cutting.tridexel.blanks import box
from twin.cutting.tridexel.dexels import TriDexel
from twin.cutting.tridexel.engagement import cut
from twin.cutting.tridexel.solids.moving_solid import Poses
from twin.cutting.tridexel.solids.solids import cutting_edge
from twin.cutting.tridexel.surface.mesh import part_mesh
from twin.errors import ConfigError
from twin.files.stl import stl_text
from twin.job.job_file import ToolTable

CELL_MM = 0.25
TOLERANCE_UM = 20.0
NOWHERE = np.zeros(3)


def slot(tool: ToolTable, tilt: float, off: float = 0.0, aside: float = 0.0) -> TriDexel:
    """A slot through a block along X by a tool that leans about X, so much too high and aside [mm]."""
    block = box(np.array([-8.0, -10.0, -10.0]), np.array([8.0, 10.0, 0.0]), CELL_MM)
    axis, across = np.array([0.0, math.sin(tilt), math.cos(tilt)]), np.array([0.0, 1.0, 0.0])
    along = np.linspace(-13.0, 13.0, 40)[:, None] * [1.0, 0.0, 0.0]
    poses = Poses(along + (off - 3.0) * axis + aside * across, np.tile(axis, (40, 1)))
    cut(block, poses, cutting_edge(profile(tool), 20.0), 1)
    return block


def measured(part: TriDexel, nominal: TriDexel) -> tuple[Inspection, dict[str, float]]:
    found = inspect_stock(part, nominal, TOLERANCE_UM)
    return found, found.as_json()


@pytest.mark.parametrize("tilt", [0.0, 0.5])
@pytest.mark.parametrize("off", [0.3, 0.01, -0.05])
@pytest.mark.parametrize("kind", ["flat", "ball", "bull"])
def test_a_slot_is_off_by_how_much_higher_or_deeper_it_was_cut(
    kind: str, off: float, tilt: float
) -> None:
    corner = {"corner": 1.0} if kind == "bull" else {}
    tool = ToolTable.model_validate({"number": 1, "kind": kind, "diameter": 6.0, **corner})
    found, figures = measured(slot(tool, tilt, off), slot(tool, tilt))
    farthest = figures["max_um"] if off > 0.0 else figures["min_um"]
    # A disc about a crossing is off a curved surface by the sagitta of a cell.
    radius = {"flat": math.inf, "ball": 3.0, "bull": 1.0}[kind]
    assert farthest == pytest.approx(1e3 * off, abs=0.5 + 1e3 * CELL_MM**2 / (8.0 * radius))
    # Nothing is off the other way.
    assert (figures["min_um"] if off > 0.0 else -figures["max_um"]) >= -0.5
    assert figures["measured_share"] == 1.0
    if kind == "flat" and not tilt:
        volume = found.standing_mm3 if off > 0.0 else found.missing_mm3
        assert volume == pytest.approx(abs(off) * 6.0 * 16.0, rel=2e-3)


def test_a_wall_is_off_by_how_far_aside_it_was_cut() -> None:
    tool = ToolTable(number=1, diameter=6.0)
    _, figures = measured(slot(tool, 0.0, aside=0.03), slot(tool, 0.0))
    assert figures["max_um"] == pytest.approx(30.0, abs=0.2)
    assert figures["min_um"] == pytest.approx(-30.0, abs=0.2)
    assert figures["bound_um"] < 1e3 * (EXACT_MM + CELL_MM + 1e-6)


def groove(kind: str, cell: float, diameter: float = 3.0, **defect: float) -> TriDexel:
    """A groove through a small block by a tool that leans, with a defect: off, aside [mm] or turned about Z [rad]."""
    corner = {"corner": 0.5} if kind == "bull" else {}
    tool = ToolTable.model_validate({"number": 1, "kind": kind, "diameter": diameter, **corner})
    block = box(np.array([-HALF, -HALF, -HALF]), np.array([HALF, HALF, 0.0]), cell)
    axis = np.array([0.0, math.sin(LEAN), math.cos(LEAN)])
    turn, way = defect.get("turn", 0.0), np.linspace(-HALF - 3.0, HALF + 3.0, 60)[:, None]
    along = way * [math.cos(turn), math.sin(turn), 0.0] + [0.0, defect.get("aside", 0.0), 0.0]
    poses = Poses(along + (defect.get("off", 0.0) - 1.5) * axis, np.tile(axis, (60, 1)))
    cut(block, poses, cutting_edge(profile(tool), 20.0), 1)
    return block


def defects_of(cell: float) -> Iterator[tuple[str, float, float]]:
    """Kinds and sizes, and how far the surface of walls that lean is off for them at least [mm]."""
    for size in (0.01, 0.03, -0.05, cell, -1.2 * cell):
        yield "off", size, abs(size)
    for size in (0.01, 0.03, 0.5 * cell, cell):
        yield "aside", size, size * math.cos(LEAN)
    for size in (0.01, cell / HALF):
        yield "turn", size, size * HALF * math.cos(LEAN)
    for size in (0.02, 0.06, cell):
        yield "under", size, 0.9 * size


HALF, LEAN = 3.0, 0.37
FINE_CELLS = [
    pytest.param(cell, marks=pytest.mark.by_hand("fine cells take up to a minute each"))
    for cell in (0.05, 0.1)
]


@pytest.mark.thorough
@pytest.mark.parametrize("cell", [*FINE_CELLS, 0.2, 0.5])
@pytest.mark.parametrize("kind", ["flat", "ball", "bull"])
def test_no_displacement_is_missed(kind: str, cell: float) -> None:
    nominal = groove(kind, cell)
    for what, size, least in defects_of(cell):
        diameter = 3.0 - 2.0 * size if what == "under" else 3.0
        found, figures = measured(groove(kind, cell, diameter, **{what: size}), nominal)
        seen = max(figures["max_um"], -figures["min_um"]) / 1e3
        assert seen >= least - 1e-3 - found.bound_mm, (what, size)
        if least > TOLERANCE_UM / 1e3 + found.bound_mm:
            assert not found.holds, (what, size)


def test_a_part_is_what_it_is_and_the_blanks_own_skin_is_not_judged() -> None:
    part = slot(ToolTable(number=1, diameter=6.0), 0.4)
    found, figures = measured(part, part)
    assert np.abs(found.deviation_mm).max() < 1e-9
    assert figures["bound_um"] == pytest.approx(1e3 * EXACT_MM)
    assert found.judged < part.dexels.filled.sum()


def test_what_is_missing_altogether_counts_with_how_deep_it_is() -> None:
    nominal = box(np.array([-8.0, -10.0, -10.0]), np.array([8.0, 10.0, 0.0]), CELL_MM)
    found, figures = measured(slot(ToolTable(number=1, diameter=6.0), 0.0), nominal)
    # The middle of the slot's floor is 3 mm below the top; above it nothing is nearer.
    assert figures["min_um"] == pytest.approx(-3000.0, abs=1.0)
    assert found.missing_mm3 == pytest.approx(6.0 * 3.0 * 16.0, rel=2e-3)


def test_a_nominal_part_comes_from_a_closed_file(tmp_path: Path) -> None:
    tool = ToolTable(number=1, diameter=6.0)
    part, file = slot(tool, 0.0), tmp_path / "nominal.stl"
    mesh = part_mesh(part)
    file.write_bytes(stl_text(np.asarray(mesh.triangles) - [1.0, 2.0, 3.0]))
    nominal = nominal_stock(part, file, np.array([1.0, 2.0, 3.0]))
    _, figures = measured(part, nominal)
    assert max(figures["max_um"], -figures["min_um"]) < 1.0
    file = tmp_path / "open.stl"
    file.write_bytes(stl_text(np.asarray(trimesh.creation.box().triangles)[:-1]))
    with pytest.raises(ConfigError, match="not closed"):
        nominal_stock(part, file, NOWHERE)


def test_parts_on_other_grids_are_not_compared() -> None:
    part = slot(ToolTable(number=1, diameter=6.0), 0.0)
    other = box(np.array([-8.0, -10.0, -10.0]), np.array([8.0, 10.0, 0.0]), 0.5)
    with pytest.raises(ConfigError, match="same grid"):
        inspect_stock(part, other, TOLERANCE_UM)
