"""The ring buffer against a list that forgets nothing."""

import hypothesis
import hypothesis.strategies as st
import pytest

from twin.serve.buffer import Observation, ObservationBuffer, OutOfRangeError

ITEMS = ("x", "y", "load")
SIZE = 16


def filled(values: list[tuple[str, int]]) -> tuple[ObservationBuffer, list[Observation]]:
    """A buffer, and everything that it was ever told, repetitions left out."""
    buffer = ObservationBuffer(ITEMS, "start", SIZE)
    every = [Observation(i + 1, item, "start", "UNAVAILABLE") for i, item in enumerate(ITEMS)]
    for item, value in values:
        buffer.add(item, "later", str(value))
        before = next(seen for seen in reversed(every) if seen.item == item)
        if before.value != str(value):
            every.append(Observation(len(every) + 1, item, "later", str(value)))
    return buffer, every


VALUES = st.lists(st.tuples(st.sampled_from(ITEMS), st.integers(0, 3)), max_size=60)


@hypothesis.settings(derandomize=True, max_examples=60)
@hypothesis.given(VALUES, st.sets(st.sampled_from(ITEMS), min_size=1), st.data())
def test_answers_are_those_of_a_list(
    values: list[tuple[str, int]], wanted: set[str], data: st.DataObject
) -> None:
    buffer, every = filled(values)
    kept = every[-SIZE:]
    assert (buffer.first_sequence, buffer.next_sequence) == (kept[0].sequence, len(every) + 1)
    first = data.draw(st.integers(buffer.first_sequence, buffer.next_sequence))
    count = data.draw(st.integers(1, SIZE))
    ahead = [each for each in kept if each.sequence >= first and each.item in wanted]
    found, following = buffer.sample(wanted, first, count)
    assert found == ahead[:count]
    assert following == (found[-1].sequence + 1 if len(found) == count else len(every) + 1)
    back = [each for each in reversed(kept) if each.sequence <= first and each.item in wanted]
    assert buffer.sample(wanted, first, -count)[0] == back[:count]
    at = data.draw(st.integers(buffer.first_sequence, len(every)))
    latest = {each.item: each for each in every if each.sequence <= at and each.item in wanted}
    assert {each.item: each for each in buffer.current(wanted, at)} == latest
    assert buffer.current(wanted) == buffer.current(wanted, len(every))


@hypothesis.settings(derandomize=True, max_examples=30)
@hypothesis.given(VALUES, st.integers(1, SIZE))
def test_going_on_from_answer_to_answer_misses_nothing(
    values: list[tuple[str, int]], count: int
) -> None:
    buffer, every = filled(values)
    seen: list[Observation] = []
    following = buffer.first_sequence
    while following < buffer.next_sequence:
        found, following = buffer.sample(ITEMS, following, count)
        seen += found
    assert seen == every[-SIZE:]


def test_what_is_gone_is_refused_with_what_is_there() -> None:
    buffer, every = filled([("x", value) for value in range(40)])
    oldest = buffer.first_sequence
    for first in (oldest - 1, len(every) + 2):
        with pytest.raises(OutOfRangeError, match=rf"holds {oldest} to {len(every)}"):
            buffer.sample(ITEMS, first, 1)
    with pytest.raises(OutOfRangeError, match="'at' is 1;"):
        buffer.current(ITEMS, 1)
    for count in (0, SIZE + 1, -SIZE - 1):
        with pytest.raises(OutOfRangeError, match=f"must be 1 to {SIZE}"):
            buffer.sample(ITEMS, None, count)
