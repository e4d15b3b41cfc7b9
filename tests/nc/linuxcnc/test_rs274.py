"""LinuxCNC's own interpreter and the dialect ``linuxcnc`` make the same of programs.

``scripts/fuzz rs274 10000`` compares many more.
"""

import re
from pathlib import Path

import pytest

from tests.nc.linuxcnc.oracle import (
    RS274,
    Answer,
    Made,
    compared,
    compared_answers,
    difference,
)
from tests.nc.linuxcnc.random_programs import contour, program
from tests.nc.linuxcnc.wide_programs import wide, wide_contour
from tests.nc.running import ROOT

pytestmark = pytest.mark.skipif(
    RS274 is None, reason="LinuxCNC's rs274 is not installed (Debian: linuxcnc-uspace)"
)
PROGRAMS = sorted((ROOT / "programs" / "linuxcnc").glob("*.nc"))


DECIDED = (60014, 60519, 60213)
"""Seeds whose programs differ, but only as it was decided."""


@pytest.mark.parametrize("seed", [*range(60), 60117, 217058, 227504, 227636, 401181, *DECIDED])
def test_random_programs(seed: int) -> None:
    assert not difference(program(seed)), program(seed)


@pytest.mark.parametrize("seed", [*range(30), 40150, 40495, 60270])
def test_contours_under_compensation(seed: int) -> None:
    assert not difference(contour(seed)), contour(seed)


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.stem)
def test_shipped_programs(path: Path) -> None:
    # The twin that is compared turns on C: on a machine with A that is the same word.
    assert not difference(re.sub(r"\bA(?=[-\d\[])", "C", path.read_text()))


@pytest.mark.parametrize("seed", DECIDED)
def test_a_decided_difference_is_named(seed: int) -> None:
    assert compared(program(seed)).decisions


def test_a_difference_beside_a_decided_one_is_shown() -> None:
    def answer(*heights: float, forgotten: float = 0.0) -> Answer:
        moves = [Made("rapid", [1.0, 0.0, height, 0.0], [], 0) for height in heights]
        return Answer(moves, "", [(0.0, 0.0, forgotten)] if forgotten else [])

    twin = answer(5.0, 6.0)
    assert compared_answers(twin, answer(15.0, 16.0, forgotten=10.0)).decisions
    assert compared_answers(twin, answer(15.0, 17.0, forgotten=10.0)).said
    assert compared_answers(twin, answer(15.0, 16.0)).said


@pytest.mark.parametrize(
    "seed", [*range(25), 208509, 500522, 500565, 400059, 400622, 403449, 405757]
)
def test_wider_random_programs(seed: int) -> None:
    assert not difference(wide(seed)), wide(seed)


@pytest.mark.parametrize("seed", range(15))
def test_wider_contours(seed: int) -> None:
    assert not difference(wide_contour(seed)), wide_contour(seed)
