"""Curved slots of Klartext and SINUMERIK: every point of the slot is cut, and none outside it."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from tests.nc.dialects.test_pockets import TOOLS, cutting_points, uncut
from tests.nc.running import good
from twin.nc.canonical import FloatArray, Moves

RADIUS, TOOL = 30.0, 5.0


def klartext(width: float, opening: float, climbs: int) -> Moves:
    stock = 0.0 if width == 2.0 * TOOL else 0.3
    words = f"Q215=0 Q219={width} Q368={stock} Q375=60 Q367=0 Q216=0 Q217=0 Q376=20 Q248={opening} Q378=0 Q377=1"
    words += f" Q207=500 Q351={climbs} Q201=-4 Q202=2 Q369=0.2 Q206=150 Q338=0 Q200=2 Q203=0 Q204=20 Q366=0"
    text = f"BEGIN PGM P MM\nTOOL CALL 1 Z S1000\nL Z+20 R0 FMAX\nCYCL DEF 254 SLOT {words}\nCYCL CALL\nEND PGM P MM"
    return good(text, "heidenhain", tools=TOOLS).moves


def sinumerik(width: float, opening: float, climbs: int) -> Moves:
    call = (
        f"SLOT2(20,0,2,-4,,1,{opening},{width},0,0,30,20,0,150,500,2,{3 if climbs > 0 else 2},0,1)"
    )
    return good(f"G54 G0 Z20 F100\n{call}\nM30", "sinumerik", tools=TOOLS).moves


def beyond(points: FloatArray, opening: float) -> FloatArray:
    """How far points lie from the middle line of the slot [mm]."""
    angle = np.degrees(np.arctan2(points[:, 1], points[:, 0])) - 20.0
    inside = (angle >= 0.0) & (angle <= opening)
    ends = [
        RADIUS * np.array([math.cos(math.radians(a)), math.sin(math.radians(a))])
        for a in (20.0, 20.0 + opening)
    ]
    to_ends = np.min([np.linalg.norm(points - end, axis=1) for end in ends], axis=0)
    return np.where(inside, np.abs(np.linalg.norm(points, axis=1) - RADIUS), to_ends)


@pytest.mark.parametrize("milled", [klartext, sinumerik])
@pytest.mark.parametrize(("width", "opening", "climbs"), [(14, 60, 1), (36, 120, -1), (10, 40, 1)])
def test_a_curved_slot_is_cleared_to_its_walls(
    milled: Callable[[float, float, int], Moves], width: float, opening: float, climbs: int
) -> None:
    moves = milled(width, opening, climbs)
    reach = beyond(cutting_points(moves, -4.0), opening)
    assert reach.max() == pytest.approx(width / 2.0 - TOOL, abs=1e-6)
    grid = np.stack(np.meshgrid(np.linspace(-50, 50, 60), np.linspace(-50, 50, 60)), -1)
    points = grid.reshape(-1, 2)
    inside = points[beyond(points, opening) <= width / 2.0]
    assert uncut(moves, -4.0, inside, TOOL) < 0.05


@pytest.mark.parametrize(("place", "degrees"), [(1, 50.0), (2, 30.0), (3, 10.0)])
def test_the_tool_stands_over_a_place_of_the_slot(place: int, degrees: float) -> None:
    words = (
        f"Q215=1 Q219=12 Q368=0 Q375=60 Q367={place} Q216=0 Q217=0 Q376=50 Q248=40 Q378=0 Q377=1"
    )
    words += " Q207=500 Q351=1 Q201=-4 Q202=4 Q206=150 Q200=2 Q203=0 Q204=20"
    text = f"BEGIN PGM P MM\nTOOL CALL 1 Z S1000\nL X+7 Y+8 Z+20 R0 FMAX\nCYCL DEF 254 SLOT {words}\nCYCL CALL\nEND PGM P MM"
    moves = good(text, "heidenhain", tools=TOOLS).moves
    here = math.radians(50.0)
    center = np.array([7.0, 8.0]) - RADIUS * np.array([math.cos(here), math.sin(here)])
    entry = moves.end[moves.end[:, 2] == -4.0][0, :2] - center
    assert math.degrees(math.atan2(entry[1], entry[0])) == pytest.approx(degrees)
