"""Who reads a force is told by which constants it was reckoned, and where they are published."""

import json
import math
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


DRILLING = "N10 G90 G0 X0 Y0 Z5\nN20 M3 S5000\nN30 G1 Z-8 F300\nN50 G0 Z5\nN60 M30\n"


@pytest.mark.seconds("a job is run with its forces")
def test_a_job_gives_constants_of_its_own(tmp_path: Path) -> None:
    own = "specific_force = 1200.0\nexponent = 0.2\n"
    twin.run(job(tmp_path, "", own), out=tmp_path / "own")
    twin.run(job(tmp_path, "", "specific_force = 2400.0\nexponent = 0.2\n"), out=tmp_path / "twice")
    one, other = (
        json.loads((tmp_path / name / "result.json").read_text())["cut"]
        for name in ("own", "twice")
    )
    assert (one["material"]["kc"], one["material"]["mc"]) == (1200.0, 0.2)
    assert other["force_n"] == pytest.approx(2.0 * one["force_n"], rel=0.02)
    with pytest.raises(ConfigError, match="specific_force and exponent are given together"):
        twin.run(job(tmp_path, "", "specific_force = 1200.0\n"), out=tmp_path / "half")
    with pytest.raises(ConfigError, match=r"stock\.specific_force"):
        twin.run(job(tmp_path, "", 'material = "Unobtainium"\n'), out=tmp_path / "none")


@pytest.mark.parametrize(
    ("limits", "reason"),
    [
        ("", None),
        ("thrust_limit = 100.0\n", "thrust of"),
        ("torque_limit = 0.3\n", "torque of"),
    ],
)
def test_thrust_and_torque_of_a_drill(tmp_path: Path, limits: str, reason: str | None) -> None:
    path = job(tmp_path, 'cutting_force = "teeth"\n', 'material = "C45"\n', DRILLING)
    with path.open("a") as file:
        file.write(f'kind = "drill"\n{limits}')
    outcome = twin.run(path, out=tmp_path / "out").outcome
    found = [alarm.message for alarm in outcome.alarms]
    if reason is not None:
        assert [reason in message for message in found] == [True], found
        return
    assert not found
    cut = json.loads((tmp_path / "out" / "result.json").read_text())["cut"]
    steel, half = materials()["C45"], math.radians(59.0)
    kc = steel.kc * (0.03 * math.sin(half)) ** -steel.mc
    # Sandvik Coromant's drilling formula: Ff = 0.5 kc D/2 fn sin(point angle / 2).
    assert cut["force_n"] == pytest.approx(0.5 * kc * 3.0 * 0.06 * math.sin(half), rel=0.05)
