"""What is done shortly is done as Numba does it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numba.core.compiler import Flags

from twin.compilation.kernel import array_kernel
from twin.compilation.shortcuts import take_shortcuts
from twin.nc.canonical import FloatArray

NAMES = ("nrt", "boundscheck", "forceinline", "release_gil", "no_compile")


def flags_of(values: dict[str, bool]) -> Flags:
    flags = Flags()
    for name, value in values.items():
        setattr(flags, name, value)
    return flags


take_shortcuts()
some_values = st.dictionaries(st.sampled_from(NAMES), st.booleans())


@given(some_values, some_values)
def test_options_are_equal_where_all_their_values_are(
    one: dict[str, bool], other: dict[str, bool]
) -> None:
    first, second = flags_of(one), flags_of(other)
    assert (first == second) == (first.values() == second.values())
    if first == second:
        assert hash(first) == hash(second)
    assert first != one


@array_kernel
def assign_rows(target: FloatArray, source: FloatArray) -> None:
    target[1:] = source


@pytest.mark.seconds("a kernel is compiled")
def test_an_array_that_does_not_fit_its_slice_is_an_error() -> None:
    target = np.zeros((3, 2))
    assign_rows(target, np.ones((2, 2)))
    assert target.sum() == 4.0
    with pytest.raises(ValueError, match="cannot assign slice from input of different size"):
        assign_rows(target, np.ones((3, 2)))
