"""Kinds of this folder's files."""

import pytest

KINDS = {
    "test_both_tiers": "thorough",
    "test_compiled_compensation": "thorough",
    "test_compiled_cycles": "thorough",
    "test_compiled_loops": "thorough",
    "test_compiled_paces": "thorough",
    "test_compiled_transformations": "thorough",
    "test_own_registers": "thorough",
    "test_one_rule": "thorough",
    "test_oracle": "oracle",
    "test_rs274": "oracle",
}


def pytest_itemcollected(item: pytest.Item) -> None:
    """Mark by file what is of a kind that ``scripts/test`` leaves out."""
    if kind := KINDS.get(item.path.stem):
        item.add_marker(kind)
