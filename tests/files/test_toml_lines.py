"""Keys are found at their lines, in whatever form a file has them."""

from pathlib import Path

import pytest

from twin.files.toml_lines import place_of_key

JOB = """program = "part.nc"
part_zero = { X = 20.0 }
tolerance.contour_um = 5.0

[stock]
shape = "box"   # size = not here
size = [1.0, 2.0, 3.0]

[[tools]]
number = 1
diameter = 10.0

[[tools]]
kind = "drill"
number = 5   # the drill
diameter = 6.0

[offsets.G54]
X = 1.0
"""


@pytest.mark.parametrize(
    ("key", "line"),
    [
        ("program", 1),
        ("part_zero.X", 2),
        ("tolerance.contour_um", 3),
        ("stock.size", 7),
        ("stock.position", 5),
        ("tools.1.diameter", 11),
        ("tools.5.diameter", 16),
        ("tools.5.kind", 14),
        ("tools.5.length", 13),
        ("tools.7.length", 9),
        ("offsets.G54.X", 19),
        ("offsets.G54.Y", 18),
        ("machine", 1),
    ],
)
def test_a_key_is_found_at_its_line(tmp_path: Path, key: str, line: int):
    job = tmp_path / "part.toml"
    job.write_text(JOB, encoding="utf-8")
    assert place_of_key([job], key) == (job, line)


def test_a_key_that_another_file_sets_is_found_there(tmp_path: Path):
    job, shared = tmp_path / "part.toml", tmp_path / "twin.toml"
    job.write_text('program = "part.nc"\n[tolerance]\ncorner_um = 5.0\n', encoding="utf-8")
    shared.write_text('machine = "mill4"\n[tolerance]\ncontour_um = 9.0\n', encoding="utf-8")
    assert place_of_key([job, shared], "tolerance.contour_um") == (shared, 3)
    assert place_of_key([job, shared], "tolerance.corner_um") == (job, 3)
    assert place_of_key([job, shared], "tolerance.cycle_time_s") == (job, 2)
    assert place_of_key([job, shared], "machine") == (shared, 1)
