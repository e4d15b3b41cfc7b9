import json
from pathlib import Path

import numpy as np
import pytest
import trimesh

from tests.command_line import Twin
from twin.files.shipped import resource_root
from twin.files.stl import stl_text

JOB = resource_root("programs") / "haas"


@pytest.mark.seconds("a whole run on mill5 with its part")
def test_a_part_that_is_cut_from_five_sides_is_judged(twin: Twin, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert twin("run", str(JOB / "five_sides.toml"), "--out", str(out)).code == 0
    result = json.loads((out / "result.json").read_text())
    assert result["scope"]["stock"] == result["cut"]["stock"] == "tri-dexel"
    assert result["cut"]["removed_mm3"] > 0.0
    assert any("rapids" in each for each in result["scope"]["watched"])
    assert (out / "part.stl").stat().st_size > 0


def shallow_job(folder: Path, *, deep: float) -> Path:
    """A slot in a block whose nominal part ends 2 mm below its top."""
    (folder / "p.nc").write_text(PROGRAM.format(deep=deep))
    nominal = trimesh.creation.box(bounds=[(-30, -30, -50), (30, 30, -2)])
    (folder / "nominal.stl").write_bytes(stl_text(np.asarray(nominal.triangles)))
    job = folder / "p.toml"
    job.write_text(
        (JOB / "five_sides.toml")
        .read_text()
        .replace("five_sides.nc", "p.nc")
        .replace("[start]", "[start]\nX = -45.0")
        .replace("size = [60.0, 60.0, 50.0]", "size = [60.0, 60.0, 50.0]\ncell = 0.5")
        + '\n[nominal]\nfile = "nominal.stl"\ngouge_um = 50.0\n'
    )
    return job


PROGRAM = """%
O1 (A SLOT IN THE TOP OF A PART THAT IS TILTED THEN)
G21 G90 G94 G17 G40 G49 G80
T1 M6
G54 G43 H1
S6000 M3
G0 X-45. Y0. Z20.
G0 A0. C0.
G1 Z-{deep} F2000.
G1 X45.
G0 Z120.
G0 A-30.
M30
%
"""


@pytest.mark.seconds("a whole run on mill5 with its part")
@pytest.mark.parametrize(("deep", "code"), [(2.0, 0), (2.03, 0), (2.5, 1)])
def test_a_cut_into_the_nominal_part_is_told_with_its_depth(
    twin: Twin, tmp_path: Path, deep: float, code: int
) -> None:
    job = shallow_job(tmp_path, deep=deep)
    run = twin("run", str(job), "--out", str(tmp_path / "out"))
    assert run.code == code, run.stderr
    result = json.loads((tmp_path / "out" / "result.json").read_text())
    assert result["scope"]["stock"] == "tri-dexel"
    assert result["cut"]["nominal"]["min_um"] == pytest.approx(1e3 * (2.0 - deep), abs=1.0)
    if code:
        gouge = result["cut"]["nominal_gouge"]
        assert gouge["depth_mm"] == pytest.approx(0.5, abs=1e-3)
        assert gouge["line"] == 10
        assert gouge["place"][2] == pytest.approx(-2.5, abs=1e-3)
