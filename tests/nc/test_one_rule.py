"""A rule stands in one file: who changes a number there changes what both tiers do."""

import re

import pytest

from tests.nc.one_rule import CHANGES, Change, outcomes
from tests.nc.running import ROOT


@pytest.mark.parametrize("change", CHANGES, ids=lambda change: change.file)
def test_a_changed_rule_is_seen_at_both_tiers(change: Change):
    ways = "interpreter,cold"
    assert outcomes((change,), ways)[change.file] == ["interpreter differs", "cold differs"]


WORDS_ALONE = "bytecode/opcodes"
"""Says what an instruction does, and computes nothing."""


def test_every_rule_of_the_table_is_changed():
    page = (ROOT / "twin" / "nc" / "README.md").read_text(encoding="utf-8")
    named = set(re.findall(r"^\|[^|]*\| `([\w/]+)` \|$", page, re.MULTILINE))
    assert {change.file for change in CHANGES} == named - {WORDS_ALONE}
    assert all((ROOT / "twin" / "nc" / f"{file}.py").exists() for file in named)
