"""Kinds of this folder's files."""

import pytest

KINDS = {"test_oracle": "oracle", "test_rs274": "oracle"}


def pytest_itemcollected(item: pytest.Item) -> None:
    """Mark by file what is of a kind that ``scripts/test`` leaves out."""
    if kind := KINDS.get(item.path.stem):
        item.add_marker(kind)
