"""Programs of LinuxCNC's own language, as its interpreter reads them."""

from pathlib import Path

import numpy as np
import pytest

from tests.nc.linuxcnc.marks import NEEDS_RS274
from tests.nc.running import MILL, good
from twin.job.job_file import JobFile
from twin.link.program_reading import DIALECT, read_program

pytestmark = [pytest.mark.oracle, NEEDS_RS274]

FEEDS = """G21 G91
M3 S1000
G95 G1 X10 F0.5
S500
G1 X10
G94 G1 X10 F600
G20
G95 G1 X1 F0.01
G1 C40
G94 G1 C40 F300
G1 X1 F10
M2
"""


def test_a_feed_counts_what_it_counts_for_linuxcnc(tmp_path: Path):
    """Per revolution it follows the speed; degrees are converted as inches per revolution, and not per minute."""
    path, zero = tmp_path / "part.ngc", np.zeros(4)
    path.write_text(FEEDS)
    written = read_program(path, MILL, zero, zero, JobFile(program=str(path)))
    moves = good(written, DIALECT).moves
    wanted = [500.0, 250.0, 600.0, 0.01 * 25.4 * 500.0, 0.01 * 25.4 * 500.0, 300.0, 254.0]
    assert moves.feed.tolist() == pytest.approx(wanted)
