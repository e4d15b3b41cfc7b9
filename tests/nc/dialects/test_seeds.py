"""The numbers that the four controls' own pages state."""

import math
from pathlib import Path

import numpy as np
import pytest

from tests.nc.running import ROOT, SHIPPED, good, shipped
from twin.nc.canonical import Axes, Moves, Shape, concatenate
from twin.nc.interpreter import Interpretation
from twin.nc.text.diagnostics.reporter import NOTICE

PROGRAMS = ROOT / "programs"

GOST_EXAMPLES = [
    # first target, second target, second move, where the table is in the end
    ("359.999", "10", -349.999, 10.0),
    ("360.000", "10", 10.0, 370.0),
    ("721.000", "10", 9.0, 730.0),
    ("-359.999", "10", 369.999, 10.0),
    ("-360.000", "10", 10.0, -350.0),
    ("-360.000", "-10", -10.0, -370.0),
    ("-721.000", "-10", -9.0, -730.0),
]


def moves_of(interpretation: Interpretation) -> Moves:
    axes: Axes = interpretation.settings.axes
    return concatenate((chunk.moves for chunk in interpretation.chunks()), axes)


@pytest.mark.parametrize(("number", "example"), list(enumerate(GOST_EXAMPLES, start=1)))
def test_gost_second_move_and_physical_end(
    number: int, example: tuple[str, str, float, float]
) -> None:
    first, second, move, physical = example
    interpretation = shipped(PROGRAMS / "gost" / f"recalculation_{number}.nc")
    moves = moves_of(interpretation)
    turning = moves[moves.end[:, 3] != moves.start[:, 3]]
    assert turning.end[0, 3] == pytest.approx(float(first), abs=1e-9)
    assert turning.end[1, 3] - turning.start[1, 3] == pytest.approx(move, abs=1e-9)
    assert interpretation.position[3] == pytest.approx(physical, abs=1e-9)
    assert interpretation.display[3] == pytest.approx(float(second), abs=1e-9)


def test_gost_text_of_the_page_with_its_wrapped_comments() -> None:
    text = (
        "  ...\n  G0 C0\n  G0 X100 Y100\n"
        "  G102 C360          $ вкл.режим пересчёта для круговой оси\n"
        "  G1 C-359.999 F1200 $\n"
        "  G1 C10  $ начальная точка -359.999>-360 (|-359.999|<360), поэтому пересчёта нет и ось\n"
        "C переместится на +369.999 град.\n"
        "  G102 C0 $\n  ...\n"
    )
    outcome = good(text, "gost")
    assert outcome.codes == ["ellipsis", "comment-tail", "ellipsis"]
    assert outcome.delta(-1)["C"] == pytest.approx(369.999, abs=1e-9)


@pytest.mark.parametrize(
    "tail",
    [
        "на -349.999 град.",
        "равна 0.000 град.) и ось C переместится на +10 град.",
        "-1.000 град.) и ось C",
    ],
)
def test_gost_tails_of_comments_are_left_out(tail: str) -> None:
    outcome = good(f"G1 C1 F100 $ длинный комментарий\n{tail}\nG1 C2", "gost")
    assert outcome.codes == ["comment-tail"]
    assert outcome.position["C"] == 2.0


def test_codesys_semicircle_is_the_same_in_every_form() -> None:
    names = ["radius", "relative_centre", "absolute_centre", "opening_angle"]
    forms = [moves_of(shipped(PROGRAMS / "codesys" / f"semicircle_by_{name}.nc")) for name in names]
    for form in forms:
        for column in ("start", "end", "center", "normal", "radius", "sweep", "length"):
            np.testing.assert_allclose(getattr(form, column), getattr(forms[0], column), atol=1e-12)
    arc = forms[0][1:]
    assert arc.shape.tolist() == [Shape.ARC]
    assert arc.sweep[0] == -180.0
    assert arc.center[0].tolist() == [150.0, 100.0, 0.0]
    assert arc.feed[0] == 6000.0


def test_codesys_two_turns_are_one_arc() -> None:
    moves = moves_of(shipped(PROGRAMS / "codesys" / "two_turns.nc"))
    assert moves.sweep.tolist() == [0.0, -720.0]
    assert moves.length[1] == pytest.approx(2 * 2 * math.pi * 50.0)
    assert moves.end[1].tolist() == [100.0, 100.0, 0.0, 0.0]


def test_codesys_arc_in_xz_dips_to_minus_50() -> None:
    moves = moves_of(shipped(PROGRAMS / "codesys" / "arc_in_xz_then_xy.nc"))
    for row, lowest in ((1, (150.0, 100.0, -50.0)), (2, (150.0, 150.0, 0.0))):
        np.testing.assert_allclose(middle(moves, row), lowest, atol=1e-9)


def middle(moves: Moves, row: int) -> np.ndarray:
    """Halfway along a semicircle, by the convention of ``canonical``."""
    spoke, normal = moves.start[row, :3] - moves.center[row], moves.normal[row]
    return moves.center[row] + math.copysign(1.0, moves.sweep[row]) * np.cross(normal, spoke)


def test_mefi_program_as_the_page_prints_it() -> None:
    text = (
        '    N5  X0 Y0 Z0 G00\n    N10 Z1.05 G10                    "введение подъема 1.05 мм\n'
        "     ....\n     ....\n"
        '    N50 G09 G02 X0 Y0 I100 G73 L50 Q20  "начало винтовой линии\n'
        '    N60 X200. Y0 I100\n    N70 G98                             "конец винтовой линии\n'
    )
    outcome = good(text, "mefi")
    assert outcome.position == pytest.approx({"X": 200.0, "Y": 0.0, "Z": 22.575, "C": 0.0})
    assert outcome.codes == ["ellipsis", "ellipsis", "no-feed"]


def test_mefi_helix_ends_where_the_page_says() -> None:
    interpretation = shipped(PROGRAMS / "mefi" / "helix.nc")
    moves = moves_of(interpretation)
    circles = moves[moves.sweep == -360.0]
    assert len(circles) == 21
    np.testing.assert_allclose(circles.center[:, :2], [[100.0, 0.0]] * 21, atol=1e-12)
    np.testing.assert_allclose(circles.end[:, 2] - circles.start[:, 2], 1.05, atol=1e-12)
    np.testing.assert_allclose(interpretation.position, [200.0, 0.0, 22.575, 0.0], atol=1e-9)
    flat = np.sum(np.abs(np.deg2rad(moves.sweep)) * np.nan_to_num(moves.radius))
    assert flat == pytest.approx(13508.8484, abs=1e-4)


HALF = math.sqrt(0.5)
SINE_60 = math.sqrt(0.75)
FAGOR_ENDS = {
    "bolt_hole_ring": [
        (50.0, 20.0),
        (30.0, 20.0 + 40.0 * SINE_60),
        (-10.0, 20.0 + 40.0 * SINE_60),
        (-30.0, 20.0),
        (-10.0, 20.0 - 40.0 * SINE_60),
        (30.0, 20.0 - 40.0 * SINE_60),
    ],
    "scroll": [(10, 0), (-20, 0), (30, 0), (-40, 0), (50, 0), (-60, 0), (60, 0)],
    "rounded_polygon": [
        (0, -40), (25, -40), (40, -25), (40, 25), (25, 40), (-25, 40), (-40, 25), (-40, -25),
        (-25, -40), (0, -40),
    ],
    "omitted_words": [
        (30, 0), (30 * HALF, 30 * HALF), (50 * HALF, 50 * HALF), (-50 * HALF, 50 * HALF),
        (-30 * HALF, 30 * HALF), (-30, 0), (0, -30), (0, -50), (50, 0), (30, 0),
    ],
    "full_circles": [
        (40, 0), (40, 0), (0, 25), (25, 0), (15, 0), (0, 15), (-15, 0), (15, 0), (15, 0),
    ],
    "three_planes": [(-40, -20), (40, -20), (40, 20), (-40, 20), (-40, -20)],
}  # fmt: skip


@pytest.mark.parametrize("name", FAGOR_ENDS)
def test_fagor_ends_worked_out_by_hand(name: str) -> None:
    moves = moves_of(shipped(PROGRAMS / "fagor8070" / f"{name}.nc"))
    cutting = moves[moves.motion == 1]
    np.testing.assert_allclose(cutting.end[:, :2], FAGOR_ENDS[name], atol=1e-6)


def test_fagor_sweeps_worked_out_by_hand() -> None:
    def sweeps(name: str) -> list[float]:
        moves = moves_of(shipped(PROGRAMS / "fagor8070" / f"{name}.nc"))
        return moves.sweep[moves.shape == Shape.ARC].tolist()

    assert sweeps("scroll") == pytest.approx([180.0] * 6)
    assert sweeps("rounded_polygon") == pytest.approx([90.0] * 4, abs=1e-5)
    assert sweeps("full_circles") == pytest.approx([360.0, -90.0, 90.0, 90.0, 180.0, -360.0])
    wide, narrow = math.degrees(math.asin(40 / 85)), math.degrees(math.asin(20 / 52))
    assert sweeps("three_planes") == pytest.approx([-2 * wide, 2 * wide, -2 * narrow], abs=1e-5)


def test_fagor_arc_of_g18_dips_below_the_part() -> None:
    moves = moves_of(shipped(PROGRAMS / "fagor8070" / "three_planes.nc"))
    arcs = moves[moves.shape == Shape.ARC]
    np.testing.assert_allclose(arcs.center[:, 2] - arcs.radius, [-10.0, -10.0, -4.0], atol=1e-6)
    assert arcs.normal.tolist() == [[0, 1, 0], [0, 1, 0], [1, 0, 0]]


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_every_program_has_its_job_and_ends_quietly(path: Path) -> None:
    interpretation = shipped(path)
    moves = moves_of(interpretation)
    assert len(moves)
    assert {each.code for each in interpretation.diagnostics} <= {"no-feed", NOTICE}
    np.testing.assert_array_equal(moves.start[1:], moves.end[:-1])
