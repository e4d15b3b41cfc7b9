"""Mirror, scale and rotation: both ways bit for bit, and what they do to arcs and to compensation."""

import dataclasses
import math
from random import Random

import numpy as np
import pytest

from tests.nc.compiled.test_both_tiers import assert_same, general_blocks
from tests.nc.compiled.transformation_programs import program
from tests.nc.running import SETTINGS, WITH_TABLES, good
from twin.nc.canonical import FloatArray, Shape
from twin.nc.control.settings import ToolData
from twin.nc.geometry.matrices import IDENTITY, applied, inverse, product, rotated, stretched
from twin.nc.geometry.planes import PLANE_ORDER
from twin.nc.text.source import source_from_text

JOB = dataclasses.replace(WITH_TABLES, step_limit=3000)
TOOLS = {1: ToolData(2.0, 60.0)}


def test_both_ways_agree_on_programs_that_transform() -> None:
    ran = moves = 0
    for seed in range(200):
        text = program(Random(seed))  # noqa: S311 (programs need no cryptography)
        result = assert_same(source_from_text(text), "fagor8070", JOB)
        ran += result.error is None
        moves += len(result.moves)
    assert 80 < ran < 190
    assert moves > 5000


ROUND = (
    "X[P1*0.5] Y3 F100\nG2 X10 Y8 R400\nG91 G3 X0 Y0 I5 J2\nG90\nG1 R9 Q[P1]\nC[P1]\nG0 Z5\n"
    "G1 X0 Y0 Z0"
)
CONTOUR = "G41\nX0 Y-5\nY30\nG2 X5 Y35 I5 J0\nG1 X[40+P1*0.01]\nY0 M8\nZ1\nX-5\nG40 X-20 Y-20\nZ0"
HOLES = "G81 Z2 I-5\n$WHILE P1<300\nP1=P1+1\nX[P1] Y5\n$ENDWHILE\nG80"
FORMS = {
    "mirror around": f"G11\n@{ROUND}",
    "mirror inside": f"@G11\n{ROUND}\nG12\n{ROUND}\nG10",
    "mirror by a value": f"@G14 X[1-2*[P1 MOD 2]] Y-1 Z-1\n{ROUND}",
    "scale around": f"G72 S2.5\n@{ROUND}",
    "scale inside": f"@G72 S[1+P1/100]\n{ROUND}\nG72",
    "rotation around": f"G73 Q33.3 I5 J6\n@{ROUND}",
    "rotation inside": f"@G73 Q[P1*7] I[P1]\n{ROUND}\nG73",
    "all of them": f"@G11\nG72 S0.7\nG73 Q[P1*7] J5\n{ROUND}\nG73\nG72\nG10\nX3",
    "contour, mirror": f"G11\nG1 X-20 Y-20\n@{CONTOUR}",
    "contour, rotation inside": f"@G73 Q[P1*7] I5\nG1 X-20 Y-20\n{CONTOUR}\nG73",
    "contour, all inside": f"@G12 G13\nG72 S3\nG73 Q30\nG1 X-20 Y-20\n{CONTOUR}\nG73\nG72\nG10",
}
"""What stands before a loop, and behind @ in it."""


@pytest.mark.parametrize("form", FORMS)
def test_the_compiled_run_takes_every_form(form: str, monkeypatch: pytest.MonkeyPatch) -> None:
    before, _, body = FORMS[form].partition("@")
    loop = f"P1=0\n$WHILE P1<300\nP1=P1+1\n{body}\n$ENDWHILE"
    text = f"G90 G1 F100 X-20 Y-20\n{before}{loop}\nM30"
    job = dataclasses.replace(WITH_TABLES, step_limit=100_000)
    assert assert_same(source_from_text(text), "fagor8070", job).error is None
    assert general_blocks(text, "fagor8070", job, monkeypatch) < 10


def test_holes_under_a_rotation_go_the_compiled_way() -> None:
    text = f"G90 G1 F100 X1\nG73 Q30 I5\nG11\nG72 S2\nP1=0\n{HOLES}\nM30"
    result = assert_same(source_from_text(text), "fagor8070", JOB)
    assert result.error is None
    assert len(result.moves) > 900


SHAPE = "G1 X10 Y-5 F100\nG41 X0 Y0\nY30\nG2 X10 Y40 I10 J0\nG1 X40\nG3 X50 Y50 J10 I0\nG1 Y60\nG40 X30 Y70"


def _mirrored(points: FloatArray) -> FloatArray:
    return points * np.array([-1.0, 1.0, 1.0, 1.0])


def test_a_mirrored_contour_is_the_mirror_image_of_the_path() -> None:
    """A mirror turns clockwise into counter-clockwise, and left of the contour into right of it."""
    plain = good(f"G00 X0 Y0\n{SHAPE}\nM30", "fagor8070", tools=TOOLS).moves
    turned = good(f"G11\nG00 X0 Y0\n{SHAPE}\nM30", "fagor8070", tools=TOOLS).moves
    np.testing.assert_allclose(turned.end, _mirrored(plain.end), atol=1e-9)
    np.testing.assert_array_equal(turned.shape, plain.shape)
    np.testing.assert_allclose(turned.sweep, -plain.sweep, atol=1e-9)
    arcs = plain.shape == Shape.ARC
    assert arcs.sum() >= 2
    np.testing.assert_allclose(turned.radius[arcs], plain.radius[arcs], atol=1e-9)
    np.testing.assert_allclose(
        turned.center[arcs], plain.center[arcs] * np.array([-1.0, 1.0, 1.0]), atol=1e-9
    )
    np.testing.assert_array_equal(turned.normal[arcs], plain.normal[arcs])


def test_two_mirrors_are_half_a_turn() -> None:
    both = good(f"G11 G12\nG00 X0 Y0\n{SHAPE}\nM30", "fagor8070", tools=TOOLS).moves
    half = good(f"G73 Q180\nG00 X0 Y0\n{SHAPE}\nM30", "fagor8070", tools=TOOLS).moves
    np.testing.assert_allclose(both.end, half.end, atol=1e-9)
    np.testing.assert_allclose(both.sweep, half.sweep, atol=1e-9)


def test_a_scale_leaves_the_tool_as_large_as_it_is() -> None:
    """The arc about (10, 30) has twice its radius of 10, and the tool beside it its own of 2."""
    moves = good(f"G72 S2\nG00 X0 Y0\n{SHAPE}\nM30", "fagor8070", tools=TOOLS).moves
    first = np.flatnonzero((moves.shape == Shape.ARC) & (moves.line == 6))[0]
    assert moves.radius[first] == pytest.approx(22.0)


TURNS = {
    "rotation": "G73 Q33",
    "rotation about a point": "G73 Q33 I1 J7",
    "scale": "G72 S3",
    "offset": "G158 X0.3 Y0.7 Z0.1",
}


@pytest.mark.parametrize("frame", TURNS.values(), ids=TURNS)
@pytest.mark.parametrize("code", ["G1", "G0"])
def test_the_table_turns_where_a_frame_has_rounded_x_y_z(frame: str, code: str) -> None:
    """What is left of X, Y and Z when they are seen anew (1e-16 mm) is not the way of the block."""
    text = f"G1 X10.1 Y5.3 Z3.3 F100\n{frame}\n{code} C90\nC180\nX1\nC0\nM30"
    moves = good(text, "fagor8070").moves
    assert moves.line.tolist() == [1, 3, 4, 5, 6]
    np.testing.assert_allclose(moves.length[[1, 2, 4]], [90.0, 90.0, 180.0])
    np.testing.assert_array_equal(moves.start[1:3, :3], moves.end[1:3, :3])
    assert_same(source_from_text(text), "fagor8070", SETTINGS)


def test_a_polar_origin_that_is_set_while_offsets_are_cancelled_holds_later() -> None:
    for origin in ("G17", "G30 I2 J9"):
        text = f"G1 X5 Y3 F100\nG30 I5 J3\nG53\nX9\n{origin}\nX8\nG54\nX7\nQ30\nX6\nM30"
        result = assert_same(source_from_text(text), "fagor8070", JOB)
        assert result.error is None


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("G72 S0", "scale"),
        ("G14 X2", "mirror"),
        ("G14 C-1", "mirror"),
        ("G14", "mirror"),
        ("G73 Q1\nG73 Q1", "rotation-active"),
        ("G73 Q1\nG18", "rotation-active"),
        ("G41\nX30 Y30\nG11", "compensation-change"),
        ("G72 S[P1*0]", "scale"),
    ],
)
def test_what_is_wrong_is_said_alike(text: str, code: str) -> None:
    whole = f"P1=0\nG1 X1 F100\n$WHILE P1<9\nP1=P1+1\nX[P1]\nY[P1]\n{text}\nG73\n$ENDWHILE\nM30"
    result = assert_same(source_from_text(whole), "fagor8070", JOB)
    assert result.error is not None
    assert result.error.code == code


def test_a_matrix_and_its_inverse_leave_a_vector() -> None:
    chance = Random(4)  # noqa: S311 (the same)
    for plane in PLANE_ORDER:
        for _ in range(50):
            signs = (chance.choice([1.0, -1.0]), chance.choice([1.0, -1.0]), 1.0)
            stretch = stretched(signs, chance.uniform(0.01, 9.0))
            angle, center = chance.uniform(-400.0, 400.0), (chance.random(), chance.random())
            matrix, shift = rotated(stretch, plane.directions, angle, center)
            np.testing.assert_allclose(product(inverse(matrix), matrix), IDENTITY, atol=1e-12)
            turning, _ = rotated(IDENTITY, plane.directions, angle, center)
            stays = plane.world(*center, chance.random())
            np.testing.assert_allclose(np.add(applied(turning, stays), shift), stays, atol=1e-12)
            x, y = (plane.local(applied(turning, plane.world(1.0, 0.0, 0.0)))[i] for i in (0, 1))
            assert math.isclose(math.cos(math.atan2(y, x) - math.radians(angle)), 1.0)
