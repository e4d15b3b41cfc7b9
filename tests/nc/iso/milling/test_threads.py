"""Helices of threads: their pitch, their hand, how deep they go, and how fast the tool's edge is."""

import numpy as np
import pytest

from tests.nc.dialects.test_pockets import TOOLS
from tests.nc.running import good
from twin.nc.canonical import Moves

BEGIN = "BEGIN PGM P MM\nTOOL CALL 1 Z S1000\nL X+0 Y+0 Z+20 R0 FMAX\n"
COMMON = "Q335=20 Q239={pitch} Q201=-16 Q253=750 Q200=2 Q203=0 Q204=20 Q207=500"


def milled(number: int, words: str, pitch: float = 1.5) -> Moves:
    given = f"{COMMON.format(pitch=pitch)} {words}"
    text = f"{BEGIN}CYCL DEF {number} THREAD {given}\nCYCL CALL\nEND PGM P MM"
    return good(text, "heidenhain", tools=TOOLS).moves


def helices(moves: Moves) -> Moves:
    return moves[np.abs(moves.sweep) >= 360.0]


@pytest.mark.parametrize(
    ("pitch", "climb", "turns", "rise"),
    [(1.5, 1, 1, 1.5), (-1.5, -1, -1, 1.5), (1.5, -1, -1, -1.5), (-1.5, 1, 1, -1.5)],
)
def test_hand_and_way_of_milling_tell_the_sense(
    pitch: float, climb: int, turns: int, rise: float
) -> None:
    """The table of the TNC 426 user's manual for inside threads, 8.3."""
    (helix,) = (helices(milled(262, f"Q355=0 Q351={climb}", pitch)),)
    assert helix.sweep.tolist() == [360.0 * turns]
    assert (helix.end - helix.start)[0, 2] == pytest.approx(rise)
    assert min(helix.start[0, 2], helix.end[0, 2]) == pytest.approx(-16.0)
    assert helix.feed.tolist() == [500.0 * 5.0 / 10.0]


def test_a_helix_all_along_the_thread_has_whole_turns() -> None:
    helix = helices(milled(262, "Q355=1 Q351=1"))
    assert helix.sweep.tolist() == [360.0 * 11]
    assert (helix.start[0, 2], helix.end[0, 2]) == pytest.approx((-16.0, 0.5))


def test_helices_of_several_threads_lie_so_far_apart() -> None:
    helix = helices(milled(262, "Q355=3 Q351=-1"))
    assert helix.end[:, 2].tolist() == pytest.approx([-2.5, -7.0, -11.5, -16.0])


@pytest.mark.parametrize(("pitch", "sense"), [(1.5, -1), (-1.5, 1)])
def test_265_mills_downwards_whatever_hand_it_has(pitch: float, sense: int) -> None:
    helix = helices(milled(265, "Q358=0 Q359=0 Q360=0", pitch))
    assert helix.sweep.tolist() == [sense * 360.0 * 11]
    assert (helix.start[0, 2], helix.end[0, 2]) == pytest.approx((0.5, -16.0))


def test_263_countersinks_before_it_mills() -> None:
    moves = milled(263, "Q356=-20 Q351=1 Q357=0 Q358=-1 Q359=2 Q254=150")
    deepest = int(np.argmin(moves.end[:, 2]))
    assert moves.end[deepest, 2] == -20.0
    assert moves.start[deepest, 2] == pytest.approx(-18.0)
    assert moves.feed[deepest] == 150.0
    ring = moves[(moves.end[:, 2] == -1.0) & (moves.sweep == 360.0)]
    assert ring.radius.tolist() == pytest.approx([2.0])


def test_264_drills_in_pecks_before_it_mills() -> None:
    moves = milled(264, "Q356=-20 Q351=1 Q202=5 Q258=0.2 Q257=0 Q256=0.2 Q358=0 Q359=0 Q206=150")
    down = moves[(moves.feed == 150.0) & (moves.end[:, 2] < moves.start[:, 2])]
    assert down.end[:, 2].tolist() == [-5.0, -10.0, -15.0, -20.0]
    assert len(helices(moves)) == 1


def test_cycle90_goes_down_beside_an_outside_thread() -> None:
    text = "G54 F100\nG0 X0 Y0 Z20\nCYCLE90(10,0,2,-6,,24,21,2,300,2,1,80,30)\nM30"
    moves = good(text, "sinumerik", tools=TOOLS).moves
    helix = helices(moves)
    assert helix.sweep.tolist() == [-360.0 * 3]
    assert helix.radius.tolist() == pytest.approx([12.0 + 5.0])
    low = moves[np.minimum(moves.start[:, 2], moves.end[:, 2]) < 0.0]
    away = np.hypot(low.start[:, 0] - 80.0, low.start[:, 1] - 30.0)
    assert away.min() >= 12.0 + 5.0 - 1e-9
