"""Work offsets of raw programs: that in which the program feeds lies at program zero."""

from pathlib import Path

import numpy as np
import pytest

from twin.nc.canonical import concatenate
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.run.preparing.assumed_job import prepare_run, text_beside
from twin.run.preparing.preparation import Preparation, prepare

ISO = (
    "%\nO1\n(T1 D=10. - flat end mill)\nG90 G94 G17 G21{head}\nT1 M6\nS5000 M3\n{first}\nG0 X-12. Y0.\nG43 Z15. H1\n"
    "G1 Z-4. F300.\nX80. F1000.\nY60.\nG0 Z15.\n{then}M30\n%\n"
)
OTHER = "{}\nG0 X0. Y0.\nG1 Z-4.\nX50.\nG0 Z15.\n"
KLARTEXT = "BEGIN PGM A MM\nTOOL CALL 1 Z S3000\n{}L X-12 Y+0 Z+15 FMAX M3\nL Z-4 F300\nL X+80 F1000\nL Z+15 FMAX\nM30\nEND PGM A MM\n"
SINUMERIK = (
    "G90 G17 G71\nT1 M6\nS3000 M3\nG54\n{}\nG0 X-12 Y0 Z15\nG1 Z-4 F300\nX80 F1000\nG0 Z15\nM30\n"
)


def iso(first: str, head: str = "", then: str = "") -> str:
    return ISO.format(head=head, first=first, then=then)


def ends(made: Preparation) -> np.ndarray:
    chunks = made.interpretation().chunks()
    return concatenate((chunk.moves for chunk in chunks), made.machine.axes).end


@pytest.mark.parametrize(
    ("name", "text", "offset"),
    [
        ("part.nc", iso("G55"), "G55"),
        ("part.nc", iso("G55", head=" G54"), "G55"),
        ("part.nc", iso("G59", then="G54\nG0 X0. Y0.\n"), "G59"),
        ("part.nc", iso("G54.1 P3"), "G54.1 P3"),
        ("part.nc", iso("G154 P2"), "G54.1 P2"),
        ("part.nc", iso("G110 G187 P2"), "G54.1 P1"),
        ("part.nc", iso("G59.1"), "G59.1"),
        ("part.nc", iso("G55").replace("G0 X-12. Y0.", "G0 X-12."), "G55"),
        ("part.mpf", SINUMERIK.format("G505"), "G505"),
        ("part.h", KLARTEXT.format("CYCL DEF 247 DATUM SETTING ~\n  Q339=+2\n"), "PRESET2"),
        ("part.h", KLARTEXT.format("CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 #2\n"), "DATUM2"),
    ],
)
def test_zero_is_at_the_offset_that_is_fed_in(
    name: str, text: str, offset: str, tmp_path: Path
) -> None:
    path = tmp_path / name
    path.write_text(text)
    made, assumed = prepare_run(path)
    assert assumed is not None
    assert made.job.file.offsets == {offset: {}}
    assert f"{offset} lies at program zero" in "; ".join(made.assumptions)
    stock = made.job.file.stock
    assert stock is not None
    assert stock.position is not None
    assert stock.position[0] == pytest.approx(34.0)
    job = tmp_path / "part.toml"
    job.write_text(text_beside(job, assumed, path))
    again = prepare(job)
    assert again.job.file.offsets == {offset: {}}
    assert ends(again) == pytest.approx(ends(made))


@pytest.mark.parametrize(
    ("text", "line"),
    [
        (iso("G54", then=OTHER.format("G55")), 14),
        (iso("", then=OTHER.format("G55")), 14),
        (iso("G54", then="G55\nG1 Z-2.\nG0 Z15.\nX150.\n"), 14),
        (iso("G55", then=OTHER.format("G56")), 7),
        ("O1\nG90 G0 X10. Y0.\nG55\nX150. Y90.\nM30\n", 3),
    ],
)
def test_several_offsets_that_are_fed_in_are_asked_for(
    text: str, line: int, tmp_path: Path
) -> None:
    path = tmp_path / "part.nc"
    path.write_text(text)
    with pytest.raises(ProgramError, match="no work offset G55") as raised:
        prepare_run(path)
    assert raised.value.diagnostic.line == line
    assert "twin.toml" in str(raised.value.diagnostic.hint)
    (tmp_path / "twin.toml").write_text("[offsets.G55]\nX = 100.0\n[offsets.G56]\nY = 90.0\n")
    made, _ = prepare_run(path)
    assert ends(made)[:, 0].max() >= 150.0 or ends(made)[:, 1].max() >= 90.0
