"""Global subroutines of the Fagor CNC 8070: files beside the program."""

from pathlib import Path

import pytest

from tests.nc.running import SETTINGS
from twin.nc.canonical import Moves, concatenate
from twin.nc.dialects.fagor8070 import FAGOR8070
from twin.nc.dialects.fagor8070.subroutines import LIBRARY
from twin.nc.interpreter import Interpretation
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.nc.text.source import read_source


def run_files(folder: Path, **files: str) -> Moves:
    for name, text in files.items():
        (folder / name.replace("_", ".")).write_text(text)
    source = LIBRARY(read_source(folder / "main.nc", FAGOR8070), folder, FAGOR8070)
    interpretation = Interpretation(source, FAGOR8070, SETTINGS)
    return concatenate((chunk.moves for chunk in interpretation.chunks()), SETTINGS.axes)


SQUARE = "%SQUARE\n(a square)\nG91 G01 X10\nY10\nX-10\nY-10\nG90\nM17\n"


def test_a_file_is_called_by_l_call_and_pcall(tmp_path: Path) -> None:
    main = "G00 X5\nF100\nL SQUARE\nG00 X30\n#CALL square\n#PCALL SQUARE A1\nM30"
    moves = run_files(tmp_path, main_nc=main, square_NC=SQUARE)
    assert len(moves) == 2 + 3 * 4
    assert moves.end[-1].tolist() == [30.0, 0.0, 0.0, 0.0]


def test_files_call_files_and_have_labels_of_their_own(tmp_path: Path) -> None:
    main = "F100\nP1=0\nN10 G91 G01 X1\nP1+=1\n$IF P1<3 $GOTO N10\nL OUTER\nM30"
    outer = "P2=0\nN10 Y1\nP2+=1\n$IF P2<2 $GOTO N10\nL INNER\n#RET"
    moves = run_files(tmp_path, main_nc=main, OUTER=outer, INNER="Z1\nM29")
    assert moves.end[-1].tolist() == [3.0, 2.0, 1.0, 0.0]


def test_a_local_subroutine_comes_first_for_call(tmp_path: Path) -> None:
    main = "%L STEP\nG01 X1\nM17\n%MAIN\nF100\n#CALL STEP\nL STEP\nM30"
    moves = run_files(tmp_path, main_nc=main, STEP="G01 Y2\nM17")
    assert moves.end.tolist() == [[1.0, 0.0, 0.0, 0.0], [1.0, 2.0, 0.0, 0.0]]


def test_a_missing_end_does_not_run_into_the_library(tmp_path: Path) -> None:
    moves = run_files(tmp_path, main_nc="F100\nL STEP", STEP="G91 G01 Y2\nM17")
    assert moves.end[:, 1].tolist() == [2.0]


@pytest.mark.parametrize(
    ("main", "step", "place", "code"),
    [
        ("L NOWHERE\nM30", "M17", "main.nc:1:1", "unknown-subprogram"),
        ("F100\nL STEP\nM30", "G01 X1\nG02 X5\nM17", "STEP:2:1", "arc-without-center"),
        ("F100\nL STEP\nM30", "G01 X1", "STEP:1:1", "return-outside"),
        ("F100\nL STEP\nM30", "L STEP\nM17", "STEP:1:1", "call-depth"),
    ],
)
def test_errors_name_the_file(tmp_path: Path, main: str, step: str, place: str, code: str) -> None:
    with pytest.raises(ProgramError) as raised:
        run_files(tmp_path, main_nc=main, STEP=step)
    assert f"{tmp_path}/{place}: error {code}:" in str(raised.value)
