import dataclasses
import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from twin.columns import Columns, Picked, join


@dataclasses.dataclass(frozen=True, slots=True)
class Inner(Columns):
    value: np.ndarray


@dataclasses.dataclass(frozen=True, slots=True)
class Outer(Columns):
    number: np.ndarray
    inner: Inner
    row: np.ndarray


def table(count: int) -> Outer:
    number = np.arange(count)
    return Outer(number, Inner(number * 10.0), np.stack([number, -number], axis=1))


@settings(derandomize=True)
@given(st.lists(st.integers(0, 30), max_size=4))
def test_cut_anywhere_and_joined_it_is_the_same(cuts: list[int]) -> None:
    whole = table(30)
    borders = [0, *sorted(cuts), 30]
    parts = [whole[begin:end] for begin, end in itertools.pairwise(borders)]
    assert [len(part) for part in parts] == [b - a for a, b in itertools.pairwise(borders)]
    again = join(parts)
    assert isinstance(again, Outer)
    assert isinstance(again.inner, Inner)
    assert np.array_equal(again.number, whole.number)
    assert np.array_equal(again.inner.value, whole.inner.value)
    assert np.array_equal(again.row, whole.row)


@settings(derandomize=True)
@given(st.lists(st.integers(0, 11), max_size=20), st.lists(st.integers(0, 20), max_size=4))
def test_picked_rows_cut_and_joined_are_the_same(numbers: list[int], cuts: list[int]) -> None:
    picked = Picked(np.array(numbers, np.int64), table(12))
    count = len(numbers)
    borders = [0, *sorted(min(cut, count) for cut in cuts), count]
    again = join([picked[begin:end] for begin, end in itertools.pairwise(borders)])
    assert len(again) == len(picked) == count
    assert again.whole().number.tolist() == picked.whole().number.tolist() == numbers
    assert np.array_equal(again.whole().row, picked.whole().row)


def test_a_join_keeps_no_rows_that_nothing_picks() -> None:
    first, second = Picked(np.array([7, 7, 8]), table(12)), Picked(np.array([2, 4]), table(12))
    both = join([first[1:], second])
    assert both.row.tolist() == [0, 1, 2, 4]
    assert both.table.number.tolist() == [7, 8, 2, 3, 4]


def test_rows_are_chosen_by_mask_and_by_number() -> None:
    assert table(6)[table(6).number % 2 == 1].inner.value.tolist() == [10.0, 30.0, 50.0]
    assert table(6)[np.array([4, 0])].row.tolist() == [[4, -4], [0, 0]]


def test_nothing_to_join_is_refused() -> None:
    with pytest.raises(ValueError, match="nothing to join"):
        join(list[Outer]())


@settings(derandomize=True)
@given(st.lists(st.integers(-12, 11), max_size=20))
def test_rows_are_selected_by_number_and_by_mask(numbers: list[int]) -> None:
    whole, rows = table(12), np.array(numbers, np.int64)
    mask = np.isin(np.arange(12), rows)
    for selection in (rows, mask):
        found = whole[selection]
        assert np.array_equal(found.number, whole.number[selection])
        assert np.array_equal(found.inner.value, whole.inner.value[selection])
        assert np.array_equal(found.row, whole.row[selection])
