"""A raw program that writes its own work offset: it lies where the part is, whatever machine it was written for."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from tests.run.preparing.test_assumed_job import raw
from twin.nc.canonical import FloatArray, concatenate
from twin.run.dry_run.dry_run import interpret_all
from twin.run.preparing.assumed_job import text_beside, with_assumptions
from twin.run.preparing.preparation import Preparation, prepare
from twin.run.progress import StageClock

SQUARE = "G0 X-10. Y-10.\nZ2.\nG1 Z-4. F200.\nX50. F600.\nY30.\nG0 Z20.\n"
ISO = "G17 G21 G90 G94\nT1 M6\nS4000 M3\n"
METRIC = ISO.replace("G21", "G71")
WRITTEN = {
    "fanuc": f"O1\nG90 G10 L2 P1 X-1412.5 Y-231.3 Z-823.7\n{ISO}G54\n{SQUARE}M30\n",
    "fanuc by variables": f"O1\n#5221=-1412.5\n#5222=-231.3\n#5223=-823.7\n{ISO}G54\n{SQUARE}M30\n",
    "haas": f"O00021 (T1 D=10. - END MILL)\nG10 L20 P7 X-1412.5 Y-231.3 Z-823.7\n{ISO}G154 P7\n{SQUARE}M30\n",
    "linuxcnc": f"G10 L2 P2 X-1412.5 Y-231.3 Z-823.7 R0\n{ISO}G55\nG64 P0.01\n{SQUARE}M2\n",
    "grbl": f"{ISO}G10 L2 P1 X-1412.5 Y-231.3 Z-823.7\nG54\n{SQUARE}M2\n",
    "fagor8070": f"V.A.ORGT[1].X=-1412.5\nV.A.ORGT[1].Y=-231.3\nV.A.ORGT[1].Z=-823.7\n{METRIC}G54\n{SQUARE}M30\n",
    "sinumerik": f"$P_UIFR[1]=CTRANS(X,-1412.5,Y,-231.3,Z,-823.7)\n{METRIC}G54 D1\n{SQUARE}M30\n",
}
ZERO = {"X": -1412.5, "Y": -231.3, "Z": -823.7}


def path_of(made: Preparation) -> FloatArray:
    chunks = list(made.interpretation().chunks())
    return concatenate([chunk.moves for chunk in chunks], made.machine.axes).end[:, :3]


@pytest.mark.parametrize("control", WRITTEN)
def test_what_a_program_writes_as_its_zero_lies_at_part_zero(control: str, tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text(WRITTEN[control])
    prepared = prepare(path, dialect=control.split(maxsplit=1)[0], assuming=True)
    made, assumed = with_assumptions(prepared, machine=None, strict=False)
    written = made.job.file.written_zero
    assert {axis: written[axis] for axis in "XYZ"} == ZERO
    assert any("X-1412.5 Y-231.3 Z-823.7" in line for line in assumed.assumptions)
    low, high = path_of(made)[-5:].min(axis=0), path_of(made)[-5:].max(axis=0)
    assert low == pytest.approx([-10.0, -10.0, -4.0])
    assert high == pytest.approx([50.0, 30.0, 20.0])
    stock = made.job.file.stock
    assert stock is not None
    assert stock.position == (20.0, 10.0, 0.0)
    dry = interpret_all(made, StageClock())
    assert dry.alarm is None
    assert not any(each.code == "value-never-read" for each in dry.warnings)
    kept = tmp_path / "kept.toml"
    kept.write_text(text_beside(kept, assumed, tmp_path / "part.nc"))
    assert path_of(prepare(kept)) == pytest.approx(path_of(made))


@pytest.mark.parametrize(
    ("text", "written"),
    [
        (f"O1\n{ISO}G91 G10 L2 P1 X5.\nG90 G54\n{SQUARE}M30\n", {}),  # by 5 mm more than before
        (f"O1\nG10 L2 P0 X0. Y0.\n{ISO}G54\n{SQUARE}M30\n", {}),  # of all of them: it is a shift
        (f"O1\n{ISO}G54\n{SQUARE}M30\n", {}),
        (
            f"O1\nG10 L2 P1 X1. Y2.\nG10 L2 P2 X101. Y2. Z-9.\n{ISO}G54\n{SQUARE}G55\n{SQUARE}M30\n",
            {"X": 1.0, "Y": 2.0, "Z": -9.0},
        ),
    ],
)
def test_the_first_place_of_each_axis_is_the_zero(
    text: str, written: Mapping[str, float], tmp_path: Path
) -> None:
    made, _ = raw(tmp_path, text)
    assert made.job.file.written_zero == written


def test_parts_keep_their_distance(tmp_path: Path) -> None:
    text = f"O1\nG10 L2 P1 X-400. Y-200. Z-500.\nG10 L2 P2 X-280. Y-200. Z-500.\n{ISO}G54\n{SQUARE}G55\n{SQUARE}M30\n"
    ends = path_of(raw(tmp_path, text)[0])
    first, second = ends[-11:-6], ends[-5:]
    assert second - first == pytest.approx(np.tile([120.0, 0.0, 0.0], (5, 1)))
