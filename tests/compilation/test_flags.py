"""Numba's options are compared as Numba compares them."""

from hypothesis import given
from hypothesis import strategies as st
from numba.core.compiler import Flags

from twin.compilation.flags import compare_at_once

NAMES = ("nrt", "boundscheck", "forceinline", "release_gil", "no_compile")


def flags_of(values: dict[str, bool]) -> Flags:
    flags = Flags()
    for name, value in values.items():
        setattr(flags, name, value)
    return flags


compare_at_once()
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
