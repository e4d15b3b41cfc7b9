import json
import shutil
from pathlib import Path

import pytest

from tests.command_line import Twin
from twin.files.shipped import resource_root

JOB = resource_root("programs") / "haas"


@pytest.mark.seconds("a whole run on mill5 with its part")
def test_a_part_that_is_cut_from_five_sides_is_judged(twin: Twin, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert twin("run", str(JOB / "five_sides.toml"), "--out", str(out)).code == 0
    result = json.loads((out / "result.json").read_text())
    assert result["scope"]["stock"] == result["cut"]["stock"] == "tri-dexel"
    assert result["cut"]["removed_mm3"] > 0.0
    assert any("rapids" in each for each in result["scope"]["watched"])
    assert any("boxes of the head" in each["what"] for each in result["scope"]["not_watched"])
    assert (out / "part.stl").stat().st_size > 0


def test_a_nominal_part_of_it_is_refused_by_name(twin: Twin, tmp_path: Path) -> None:
    for name in ("five_sides.nc", "five_sides.toml"):
        shutil.copy(JOB / name, tmp_path)
    job = tmp_path / "five_sides.toml"
    (tmp_path / "nominal.stl").write_text("solid\nendsolid\n")
    job.write_text(job.read_text() + '\n[nominal]\nfile = "nominal.stl"\n')
    run = twin("run", str(job), "--out", str(tmp_path / "out"))
    assert run.code == 2
    assert "from several sides" in run.stderr
