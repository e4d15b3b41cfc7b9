"""Who reads a force is told by which constants it was reckoned, and where they are published."""

import json
from pathlib import Path

import pytest

import twin
from twin.cutting.forces.materials import materials
from twin.errors import ConfigError

PROGRAM = "N10 G90 G0 X0 Y0 Z5\nN20 M3 S5000\nN30 G1 Z-1 F200\nN40 X4\nN50 G0 Z5\nN60 M30\n"


def job(folder: Path, keys: str, material: str, program: str = PROGRAM) -> Path:
    (folder / "part.nc").write_text(program)
    path = folder / "part.toml"
    path.write_text(
        f'program = "part.nc"\ndialect = "fagor8070"\n{keys}[stock]\nshape = "box"\n'
        f"size = [30.0, 30.0, 20.0]\ncell = 0.5\n{material}[[tools]]\nnumber = 1\ndiameter = 6.0\n"
    )
    return path


@pytest.mark.parametrize("way", ["teeth", "mean"])
def test_page_and_result_name_the_source_of_the_constants_behind_a_force(
    tmp_path: Path, way: str
) -> None:
    path = job(tmp_path, f'cutting_force = "{way}"\n', 'material = "C45"\n')
    out = tmp_path / "out"
    twin.run(path, out=out)
    known = materials()["C45"]
    told = json.loads((out / "result.json").read_text())["cut"]["material"]
    assert told == {
        "name": "C45",
        "kc": known.kc,
        "mc": known.mc,
        "density": known.density,
        "source": known.source,
    }
    page = (out / "report.html").read_text()
    assert f"C45: kc1.1 2220 N/mm², mc 0.14 ({known.source})" in page


@pytest.mark.parametrize(
    ("material", "program"),
    [("", PROGRAM), ('material = "C45"\n', PROGRAM.replace("M3 S5000", "M3"))],
    ids=["no material", "no speed"],
)
def test_no_source_is_named_where_no_force_was_reckoned(
    tmp_path: Path, material: str, program: str
) -> None:
    out = tmp_path / "out"
    twin.run(job(tmp_path, "", material, program), out=out)
    cut = json.loads((out / "result.json").read_text())["cut"]
    assert cut["force_n"] is None
    assert "material" not in cut
    assert "Kienzle" not in (out / "report.html").read_text()


def test_a_load_on_the_axes_without_a_force_is_refused(tmp_path: Path) -> None:
    path = job(tmp_path, 'cutting_load = true\ncutting_force = "none"\n', 'material = "C45"\n')
    with pytest.raises(ConfigError, match=r'cutting_load needs a force.*"mean" or "teeth"'):
        twin.run(path, out=tmp_path / "out")
