"""Dialects of other packages, by entry points."""

from pathlib import Path

import pytest

from twin.nc.dialects import OWN, dialects_from_outside

MODULE = '''
"""A control of a maker who writes its comments in braces."""

import dataclasses

from twin.nc.dialects.gost import GOST
from twin.nc.text.syntax import Comment, Mark

BRACES = dataclasses.replace(
    GOST,
    name="braces",
    title="A control with comments in braces",
    syntax=dataclasses.replace(GOST.syntax, comments=(Comment("{", "}"),)),
    marks=(Mark(r"\\{", "{ a comment }"),),
)
'''


@pytest.mark.parametrize(
    ("point", "found", "reason"),
    [
        ("braces = outside_braces:BRACES", ["braces"], ""),
        ("gost = outside_braces:GOST", [], "has the name of another dialect"),
        ("other = outside_braces:BRACES", [], "is called 'braces'"),
        ("missing = outside_braces:NOTHING", [], "cannot be loaded: AttributeError"),
        ("mark = outside_braces:Mark", [], "not a Dialect"),
    ],
)
def test_an_entry_point_brings_a_dialect(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, point: str, found: list[str], reason: str
) -> None:
    (tmp_path / "outside_braces.py").write_text(MODULE)
    info = tmp_path / "outside_braces-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: outside-braces\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(f"[twin.dialects]\n{point}\n")
    monkeypatch.syspath_prepend(tmp_path)
    dialects, failed = dialects_from_outside(OWN)
    assert list(dialects) == found
    assert reason in "".join(failed.values())
