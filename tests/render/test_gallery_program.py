"""The gallery's own program: it passes, cuts with three tools, and turns the table."""

import json
from pathlib import Path

import pytest
from command_line import Twin

from twin.files.shipped import resource_root

JOB = resource_root("programs") / "gallery" / "fagor8070" / "rosette.toml"


@pytest.mark.thorough
def test_the_rosette_passes_and_spoils_nothing(twin: Twin, tmp_path: Path) -> None:
    done = twin("run", JOB, "--out", tmp_path)
    assert done.code == 0, done.stderr
    result = json.loads((tmp_path / "result.json").read_text(encoding="utf-8"))
    cut = result["cut"]
    assert not cut["gouges"]
    assert not cut["rapid_into_stock"]
    # The rim is an annulus of the part's radius and the tool's inner edge, 4 mm deep.
    rim = next(block["removed_mm3"] for block in cut["blocks"] if block["line"] == 9)
    plunge = next(block["removed_mm3"] for block in cut["blocks"] if block["line"] == 8)
    annulus = 3.141592653589793 * (80.0**2 - 62.0**2) * 4.0
    assert rim + plunge == pytest.approx(annulus, rel=2e-3)
    assert result["final"]["simulated"]["C"] == pytest.approx(1440.0 + 315.0, abs=2e-3)
