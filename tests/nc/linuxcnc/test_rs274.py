"""LinuxCNC's own interpreter and the dialect ``linuxcnc`` make the same of programs.

``scripts/rs274 10000`` compares many more.
"""

from pathlib import Path

import pytest

from tests.nc.linuxcnc.oracle import RS274, difference
from tests.nc.linuxcnc.random_programs import contour, program
from tests.nc.running import ROOT

pytestmark = pytest.mark.skipif(
    RS274 is None, reason="LinuxCNC's rs274 is not installed (Debian: linuxcnc-uspace)"
)
PROGRAMS = sorted((ROOT / "programs" / "linuxcnc").glob("*.nc"))


@pytest.mark.parametrize("seed", range(60))
def test_random_programs(seed: int) -> None:
    assert not difference(program(seed)), program(seed)


@pytest.mark.parametrize("seed", range(30))
def test_contours_under_compensation(seed: int) -> None:
    assert not difference(contour(seed)), contour(seed)


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.stem)
def test_shipped_programs(path: Path) -> None:
    assert not difference(path.read_text())
