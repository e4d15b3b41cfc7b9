"""Programs of LinuxCNC's own language, as its interpreter reads them."""

import re
from pathlib import Path

import numpy as np
import pytest

from tests.nc.linuxcnc.marks import NEEDS_RS274
from tests.nc.running import MILL, good
from twin.job.job_file import JobFile
from twin.link import program_reading
from twin.link.program_reading import DIALECT, LinuxcncProgramError, Listing, read_program

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


def written(folder: Path, text: str) -> str:
    listing, zero = Listing(folder / "part.ngc", text), np.zeros(4)
    return read_program(listing, MILL, zero, zero, JobFile(program=str(listing.path)))


def test_a_feed_counts_what_it_counts_for_linuxcnc(tmp_path: Path):
    """Per revolution it follows the speed; degrees are converted as inches per revolution, and not per minute."""
    moves = good(written(tmp_path, FEEDS), DIALECT).moves
    wanted = [500.0, 250.0, 600.0, 0.01 * 25.4 * 500.0, 0.01 * 25.4 * 500.0, 300.0, 254.0]
    assert moves.feed.tolist() == pytest.approx(wanted)


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("G21 G18\nG10 L2 P0 R30\nG2 X2 Z0 I1 K0 F60\nM2\n", "3:1: error linuxcnc: an arc in an inclined plane"),
        ("G21\n G38.2 X3 F60\nM2\n", "2:2: error linuxcnc: the twin has nothing for LinuxCNC's TURN_PROBE_ON"),
        ("G1 X1 F60\nG1 X2 Q\nM2\n", "2:1: error linuxcnc: "),
        ("G1 X1 F60\no1 while [1]\nG1 X2\nG1 X1\no1 endwhile\nM2\n", "error linuxcnc: rs274 does not come to its end"),
    ],
)  # fmt: skip
def test_what_cannot_be_read_is_refused_with_its_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str, place: str
):
    monkeypatch.setattr(program_reading, "_MOST_CALLS", 1000)
    with pytest.raises(
        LinuxcncProgramError, match=re.escape(f"part.ngc:{place}" if place[0].isdigit() else place)
    ):
        written(tmp_path, text)


def test_a_loop_that_prints_nothing_ends_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(program_reading, "_TIMEOUT_S", 0.5)
    with pytest.raises(LinuxcncProgramError, match="does not come to its end"):
        written(tmp_path, "o1 while [1]\no1 endwhile\nM2\n")
