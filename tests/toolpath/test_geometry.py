import numpy as np
import pytest

from twin.columns import join
from twin.nc.canonical import Axes, FloatArray, Moves, Shape
from twin.toolpath.geometry import Geometry, geometry

AXES = Axes(("X", "Y", "Z", "C"), ("linear", "linear", "linear", "rotary"))


def helix(sweep: float = 500.0, miss: float = 0.0) -> Moves:
    """About a slanted normal, with C in step."""
    normal = np.array([0.36, 0.48, -0.8])
    center = np.array([1.0, 2.0, 3.0])
    spoke = 7.0 * np.array([0.8, -0.6, 0.0])
    angle = np.deg2rad(sweep)
    start = np.array([*(center + spoke), 10.0])
    end = start.copy()
    turned = spoke * np.cos(angle) + np.cross(normal, spoke) * np.sin(angle)
    end[:3] = center + turned + 4.0 * normal + miss
    end[3] = 75.0
    return moves_of(start, end, Shape.ARC, center, normal, 7.0, sweep)


def line() -> Moves:
    nan = np.full(3, np.nan)
    start, end = np.array([1.0, 2.0, 3.0, 4.0]), np.array([11.0, -2.0, 3.5, -4.0])
    return moves_of(start, end, Shape.LINE, nan, nan, np.nan, 0.0)


def moves_of(
    start: FloatArray, end: FloatArray, shape: Shape, center: FloatArray, normal: FloatArray,
    radius: float, sweep: float,
) -> Moves:  # fmt: skip
    one = np.ones(1)
    return Moves(
        AXES, np.ones(1, np.uint8), np.array([shape], np.uint8), np.ones(1, np.int64),
        np.ones(1, np.int64), start[None], end[None], end[None], one, np.zeros(1, np.uint8), one,
        center[None], normal[None], radius * one, sweep * one, np.zeros(1, np.uint8), one, one, one,
    )  # fmt: skip


def rows(shape: Geometry, u: FloatArray) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
    assert len(shape) == 1
    return np.zeros(len(u), np.int64)


def test_helix_follows_the_canonical_formula() -> None:
    moves = helix()
    u = np.linspace(0.0, 1.0, 101)
    shape = geometry(moves)
    points = shape.position(rows(shape, u), u)
    relative = points[:, :3] - moves.center[0]
    normal = moves.normal[0]
    along = relative @ normal
    assert np.allclose(along, 4.0 * u, rtol=0, atol=1e-12)
    across = relative - along[:, None] * normal
    assert np.allclose(np.linalg.norm(across, axis=1), 7.0, rtol=0, atol=1e-12)
    turns = np.unwrap(
        np.arctan2(across @ np.cross(normal, across[0]) / 7.0, across @ across[0] / 7.0)
    )
    assert np.allclose(np.rad2deg(turns), 500.0 * u, rtol=0, atol=1e-9)
    assert np.allclose(points[:, 3], 10.0 + 65.0 * u)


@pytest.mark.parametrize("moves", [line(), helix(), helix(-20.0)])
@pytest.mark.parametrize("order", [1, 2, 3])
def test_derivatives_agree_with_differences(moves: Moves, order: int) -> None:
    shape = geometry(moves)
    u, h = np.linspace(0.1, 0.9, 9), 1e-5
    where = rows(shape, u)

    def lower(at: FloatArray) -> FloatArray:
        if order == 1:
            return shape.position(where, at)
        return shape.derivative(where, at, order - 1)

    difference = (lower(u + h) - lower(u - h)) / (2 * h)
    exact = shape.derivative(where, u, order)
    assert np.allclose(exact, difference, rtol=1e-6, atol=1e-6 * 9.0**order)


def test_curvature_of_a_helix() -> None:
    shape = geometry(helix())
    u = np.array([0.0, 0.3, 1.0])
    lead = 4.0 / np.deg2rad(500.0)
    assert np.allclose(shape.curvature(rows(shape, u), u), 7.0 / (7.0**2 + lead**2))
    straight = geometry(line())
    assert np.all(straight.curvature(rows(straight, u), u) == 0.0)


def test_ends_are_exact_and_a_miss_is_closed() -> None:
    for moves in (line(), helix(), helix(miss=1e-4)):
        shape = geometry(moves)
        u = np.array([0.0, 1.0])
        ends = shape.position(rows(shape, u), u)
        assert np.allclose(ends[0], moves.start[0], rtol=0, atol=1e-14)
        assert np.array_equal(ends[1], moves.end[0])
        almost = shape.position(np.zeros(1, np.int64), np.array([1.0 - 1e-12]))
        assert np.abs(almost - moves.end).max() < 1e-9


def test_joining_and_selecting() -> None:
    first, second = geometry(line()), geometry(helix())
    both = join([first, second])
    assert len(both) == 2
    assert np.array_equal(both[1:].end, second.end)
