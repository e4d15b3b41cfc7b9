"""A rule stands in one file: who changes a number there changes what both tiers do."""

import re

import pytest

from tests.nc.one_rule import CHANGES, Change, outcomes
from tests.nc.running import ROOT


@pytest.mark.parametrize("change", CHANGES, ids=lambda change: change.file)
def test_a_changed_rule_is_seen_at_both_tiers(change: Change):
    ways = "interpreter,cold"
    assert outcomes((change,), ways)[change.file] == ["interpreter differs", "cold differs"]


def test_every_changed_rule_stands_in_the_table():
    page = (ROOT / "twin" / "nc" / "README.md").read_text(encoding="utf-8")
    named = set(re.findall(r"^\|[^|]*\| `([\w/]+)` \|$", page, re.MULTILINE))
    assert {change.file for change in CHANGES} <= named
    assert all((ROOT / "twin" / "nc" / f"{file}.py").exists() for file in named)
