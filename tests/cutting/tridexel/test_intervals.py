import itertools

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from twin.cutting.tridexel.blanks import box
from twin.cutting.tridexel.dexels import TriDexel
from twin.cutting.tridexel.engagement import volume
from twin.cutting.tridexel.intervals import Node, meeting, overlap, subtract

LOW, HIGH = np.array([0.0, 0.0, 0.0]), np.array([1.0, 1.0, 10.0])
LINE = 20
"""The last line: the one along Z, behind ten along X and ten along Y."""
CUT = st.tuples(
    st.floats(-1.0, 11.0, allow_subnormal=False), st.floats(0.0, 4.0, allow_subnormal=False)
)


def bar() -> TriDexel:
    return box(LOW, HIGH, 1.0)


def material(part: TriDexel) -> list[tuple[float, float]]:
    first, count = int(part.dexels.first[LINE]), int(part.dexels.filled[LINE])
    return [(float(low), float(high)) for low, high in part.dexels.ends[first : first + count]]


def subtract_and_grow(part: TriDexel, low: float, high: float, tool: int = 1) -> float:
    node = Node(2, float(part.lattice.origin[2]), part.cell)
    while True:
        piece = subtract(part.dexels, LINE, (low, high), (tool, tool), node)
        if piece.length >= 0.0:
            return piece.length
        part.dexels = part.dexels.grown()


@given(st.lists(CUT, max_size=40))
def test_what_is_left_is_what_no_cut_covers(cuts: list[tuple[float, float]]) -> None:
    part = bar()
    removed = sum(subtract_and_grow(part, low, low + length) for low, length in cuts)
    left = material(part)
    assert all(low < high for low, high in left)
    assert all(a[1] <= b[0] for a, b in itertools.pairwise(left))
    assert abs(sum(high - low for low, high in left) + removed - 10.0) < 1e-7
    for place in np.linspace(0.003, 9.997, 200):
        covered = any(low < place < low + length for low, length in cuts)
        near = any(min(abs(place - low), abs(place - low - length)) < 1e-8 for low, length in cuts)
        assert near or covered != any(low < place < high for low, high in left)


@given(st.lists(CUT, max_size=20), CUT)
def test_a_cut_that_was_made_takes_nothing_more(
    cuts: list[tuple[float, float]], last: tuple[float, float]
) -> None:
    part = bar()
    for low, length in [*cuts, last]:
        subtract_and_grow(part, low, low + length)
    assert subtract_and_grow(part, last[0], last[0] + last[1]) == 0.0
    assert overlap(part.dexels, LINE, last[0], last[0] + last[1]) < 1e-8


@given(st.lists(CUT, max_size=20))
def test_the_order_of_cuts_does_not_matter(cuts: list[tuple[float, float]]) -> None:
    one, other = bar(), bar()
    removed = [sum(subtract_and_grow(one, low, low + length) for low, length in cuts)]
    removed.append(sum(subtract_and_grow(other, low, low + length) for low, length in cuts[::-1]))
    assert abs(removed[0] - removed[1]) < 1e-7


def test_the_surface_that_a_cut_leaves_remembers_its_tool() -> None:
    part = bar()
    subtract_and_grow(part, 2.0, 3.0, tool=7)
    subtract_and_grow(part, 2.5, 4.0, tool=9)
    first = int(part.dexels.first[LINE])
    assert material(part) == [(0.0, 2.0), (4.0, 10.0)]
    assert part.dexels.facet[first, 1] == 7
    assert part.dexels.facet[first + 1, 0] == 9


def test_a_copy_is_not_cut() -> None:
    part = bar()
    kept = part.copy()
    for place in np.linspace(1.0, 9.0, 9):
        subtract_and_grow(part, float(place), float(place) + 0.5)
    assert len(material(part)) == 10
    assert material(kept) == [(0.0, 10.0)]
    assert meeting(kept.dexels, LINE, 4.0, 5.0) == 7
    assert volume(kept) > volume(part)


def test_memory_that_is_full_grows() -> None:
    part = box(LOW, HIGH, 1.0)
    part.dexels = part.dexels._replace(ends=part.dexels.ends[:21], facet=part.dexels.facet[:21])
    for place in np.linspace(0.25, 9.75, 200):
        subtract_and_grow(part, float(place), float(place) + 0.01)
    assert len(material(part)) == 201
