"""Tool centre point control and tilted planes in the controls that have them."""

import dataclasses

import numpy as np
import pytest

from tests.five_axes import head_and_table, on_machine, settings, trunnion
from tests.nc.running import Outcome, run
from twin.kinematics import tool_direction
from twin.nc.canonical import Moves, Shape
from twin.nc.control.settings import ControlSettings
from twin.nc.path.tool_center.tool_center import ToolCenter

SETTINGS = settings(on_machine(trunnion()))
TIP = ToolCenter(on_machine(trunnion()), 0.0, [0.0] * 5)

LED = {
    "fanuc": "O1\nT1 M6\nG43.4 H1\nG1 X10. Y20. Z5. F500.\nX40. Y-10. A30. C90.\nG49\nM30\n",
    "haas": "O1\nG234 H1\nG1 X10. Y20. Z5. F500.\nX40. Y-10. A30. C90.\nG49\nM30\n",
    "sinumerik": "T1 D1 M6\nTRAORI\nG1 X10 Y20 Z5 F500\nX40 Y-10 A30 C90\nTRAFOOF\nM30\n",
    "heidenhain": "BEGIN PGM A MM\nTOOL CALL 1 Z S1000\nM128\nL X+10 Y+20 Z+5 F500\nL X+40 Y-10 A+30 C+90\nM129\nEND PGM A MM\n",
    "fagor8070": "T1 D1\nM6\n#RTCP ON\nG1 X10 Y20 Z5 F500\nX40 Y-10 A30 C90\n#RTCP OFF\nM30\n",
}
"""The same in each: to X10 Y20 Z5, then to X40 Y-10 while A and C turn."""


def _led(dialect: str, text: str, control: ControlSettings = SETTINGS) -> Outcome:
    outcome = run(text, dialect, control)
    assert outcome.error is None, outcome.error
    return outcome


def _tips(moves: Moves) -> np.ndarray:
    return np.array([TIP.tip(place.tolist()) for place in moves.end])


@pytest.mark.parametrize("dialect", LED)
def test_every_control_leads_the_tip_the_same_way(dialect: str) -> None:
    moves = _led(dialect, LED[dialect]).moves
    expected = _led("fanuc", LED["fanuc"]).moves
    assert np.array_equal(moves.shape, expected.shape)
    assert moves.end == pytest.approx(expected.end, abs=1e-12)
    assert moves.feed == pytest.approx(expected.feed)
    curves = moves.shape == Shape.CURVE
    assert curves.sum() > 20
    assert _tips(moves)[-1] == pytest.approx((40.0, -10.0, 5.0, 30.0, 90.0), abs=1e-9)
    assert moves.length[curves].sum() == pytest.approx(np.hypot(30.0, 30.0))


@pytest.mark.parametrize("dialect", LED)
def test_a_machine_without_rotary_axes_leads_no_tip(dialect: str) -> None:
    outcome = run(LED[dialect], dialect, dataclasses.replace(SETTINGS, setup=None))
    assert outcome.error is not None
    assert outcome.error.code == "tool-center"


def test_a_longer_tool_is_led_at_its_own_tip() -> None:
    text = LED["fanuc"].replace("T1", "T2").replace("H1", "H2")
    end = _led("fanuc", text).moves.end[-1]
    length_difference = ToolCenter(on_machine(trunnion()), 15.0, [0.0] * 5)
    assert length_difference.tip(end.tolist()) == pytest.approx(
        [40.0, -10.0, 5.0, 30.0, 90.0], abs=1e-9
    )


def test_behind_the_control_of_the_tip_positions_are_those_of_the_axes() -> None:
    text = LED["fanuc"].replace("M30", "G1 Z200.\nM30")
    outcome = _led("fanuc", text)
    before, after = outcome.moves.end[-2], outcome.moves.end[-1]
    assert after[2] == 200.0
    assert np.array_equal(before[[0, 1, 3, 4]], after[[0, 1, 3, 4]])


def test_a_head_is_led_as_a_table_is() -> None:
    head = on_machine(head_and_table())
    axes = dataclasses.replace(SETTINGS.axes, names=("X", "Y", "Z", "B", "C"))
    text = LED["fanuc"].replace("A30.", "B30.")
    outcome = _led("fanuc", text, settings(head, axes))
    tip = ToolCenter(head, 0.0, [0.0] * 5).tip(outcome.moves.end[-1].tolist())
    assert tip == pytest.approx([40.0, -10.0, 5.0, 30.0, 90.0], abs=1e-9)


def test_machine_coordinates_count_the_axes() -> None:
    text = LED["fanuc"].replace("G49", "G0 G53 Z-20.\nG0 G53 X-50. Y10.\nG49")
    outcome = _led("fanuc", text)
    assert outcome.moves.end[-1][:3] == pytest.approx((-50.0 - 15.0, 10.0 - 20.0, -20.0 + 430.0))


PLANE = "G0 X0 Y0 Z20.\nG1 Z-1. F200.\nG3 X10. Y10. R10.\n"
TILTED = {
    "fanuc": f"O1\nT2 M6\nG0 Z100.\nG68.2 X10. Y0 Z0 I0 J30. K0\nG53.1\nG43 H2\n{PLANE}G69\nM30\n",
    "sinumerik": 'T2 D1 M6\nG0 Z100\nCYCLE800(0,"T",0,57,10,0,0,30,0,0,0,0,0,1)\nG0 X0 Y0 Z20\nG1 Z-1 F200\nG3 X10 Y10 CR=10\nCYCLE800()\nM30\n',
    "heidenhain": "BEGIN PGM A MM\nTOOL CALL 2 Z S1000\nL Z+100 FMAX\nCYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+10\nPLANE SPATIAL SPA+30 SPB+0 SPC+0 TURN FMAX SEQ+\nL X+0 Y+0 Z+20 FMAX\nL Z-1 F200\nCR X+10 Y+10 R+10 DR+\nPLANE RESET STAY\nEND PGM A MM\n",
    "fagor8070": "T2 D1\nM6\nG0 Z100\nG0 A30\n#CS ON [MODE 1, 10, 0, 0, 30, 0, 0]\nG0 X0 Y0 Z20\nG1 Z-1 F200\nG3 X10 Y10 R10\n#CS OFF\nM30\n",
}


@pytest.mark.parametrize("dialect", TILTED)
def test_every_control_cuts_in_the_same_tilted_plane(dialect: str) -> None:
    moves = _led(dialect, TILTED[dialect]).moves
    length_difference = ToolCenter(on_machine(trunnion()), 15.0, [0.0] * 5)
    tip = np.array(length_difference.tip(moves.end[-1].tolist()))
    # 10 along and 10 up a plane that turns by 30 degrees about X through X10, 1 below it.
    sine, cosine = 0.5, np.sqrt(0.75)
    assert tip[:3] == pytest.approx((20.0, 10.0 * cosine + sine, 10.0 * sine - cosine), abs=1e-9)
    direction = tool_direction(trunnion(), moves.end[-1:] + on_machine(trunnion()).zero)[0]
    assert direction == pytest.approx((0.0, -sine, cosine), abs=1e-9)
    assert moves.shape[-1] == Shape.ARC
    assert moves.radius[-1] == pytest.approx(10.0)
    assert not np.any(moves.shape == Shape.CURVE)


def test_a_post_of_klartext_turns_the_axes_itself() -> None:
    text = (
        "BEGIN PGM A MM\nTOOL CALL 1 Z S1000\nL Z+100 FMAX\n"
        "PLANE SPATIAL SPA90 SPB0 SPC180 STAY SEQ- TABLE ROT\n"
        "L A+Q120 C+Q122 R0 FMAX M126\nL X+0 Y+0 Z+20 R0 FMAX\nEND PGM A MM\n"
    )
    end = _led("heidenhain", text).moves.end[-1]
    assert end[3:] == pytest.approx((-90.0, 0.0), abs=1e-9)
    # The plane's Z points along Y of the part.
    assert TIP.tip(end.tolist())[:3] == pytest.approx((0.0, 20.0, 0.0), abs=1e-9)


@pytest.mark.parametrize(
    ("words", "sign"), [("EULER EULPR+0 EULNU+30 EULROT+0", 1.0), ("AXIAL A+30", 1.0),
     ("VECTOR BX+1 BY+0 BZ+0 NX+0 NY-0.5 NZ+0.8660254037844386", 1.0), ("RELATIV SPA+30", 1.0),
     ("PROJECTED PROPR+0 PROMIN+30 ROT+0", 1.0),
     ("POINTS P1X+5 P1Y+0 P1Z+2 P2X+9 P2Y+0 P2Z+2 P3X-3 P3Y+0.8660254037844386 P3Z+2.5", 1.0)],
)  # fmt: skip
def test_planes_of_klartext_by_other_words(words: str, sign: float) -> None:
    spatial = TILTED["heidenhain"]
    text = spatial.replace("SPATIAL SPA+30 SPB+0 SPC+0", words)
    expected = _led("heidenhain", spatial).moves.end[-1]
    assert sign * _led("heidenhain", text).moves.end[-1] == pytest.approx(expected, abs=1e-6)


def test_move_keeps_the_tip_at_the_part_while_the_axes_turn() -> None:
    text = TILTED["heidenhain"].replace("TURN FMAX", "MOVE FMAX")
    moves = _led("heidenhain", text).moves
    curves = moves[moves.shape == Shape.CURVE]
    length_difference = ToolCenter(on_machine(trunnion()), 15.0, [0.0] * 5)
    tips = np.array([length_difference.tip(place.tolist())[:3] for place in curves.end])
    assert np.abs(tips - tips[0]).max() < 1e-9


def test_move_turns_about_the_place_below_the_tip_that_dist_says() -> None:
    text = TILTED["heidenhain"].replace("TURN FMAX", "MOVE DIST25 FMAX").split("L X+0 Y+0 Z+20")[0]
    moves = _led("heidenhain", text + "\nEND PGM A MM").moves
    below = ToolCenter(on_machine(trunnion()), 15.0 + 25.0, [0.0] * 5)
    places = np.array(
        [below.tip(place.tolist())[:3] for place in moves.end[moves.shape == Shape.CURVE]]
    )
    assert np.abs(places - places[0]).max() < 1e-9


@pytest.mark.parametrize(("how", "turned"), [("TABLE ROT", 40.0), ("COORD ROT", 0.0), ("", 0.0)])
def test_table_rot_turns_a_table_that_the_tool_would_not_need(how: str, turned: float) -> None:
    text = (
        "BEGIN PGM A MM\nTOOL CALL 1 Z S1000\nL Z+100 FMAX\n"
        f"PLANE SPATIAL SPA+0 SPB+0 SPC+40 TURN FMAX {how}\nL X+10 Y+0 Z+20 FMAX\nEND PGM A MM\n"
    )
    end = _led("heidenhain", text).moves.end[-1]
    assert end[3:] == pytest.approx((0.0, turned), abs=1e-9)
    # The same place of the part in both cases: 10 mm along the turned X.
    assert TIP.tip(end.tolist())[:2] == pytest.approx(10.0 * _turn(2, 40.0)[:2, 0], abs=1e-9)


@pytest.mark.parametrize(("words", "sign"), [("SEQ+", 1.0), ("SEQ-", -1.0), ("SYM-", -1.0)])
def test_seq_is_the_sign_of_the_axis_next_to_the_tool(words: str, sign: float) -> None:
    text = TILTED["heidenhain"].replace("SEQ+", words)
    moves = _led("heidenhain", text).moves
    assert moves.end[-1, 3] == pytest.approx(30.0 * sign)
    expected = _led("heidenhain", TILTED["heidenhain"]).moves.end[-1]
    length_difference = ToolCenter(on_machine(trunnion()), 15.0, [0.0] * 5)
    assert length_difference.tip(moves.end[-1].tolist())[:3] == pytest.approx(
        length_difference.tip(expected.tolist())[:3], abs=1e-9
    )


def test_a_plane_that_is_level_again_lets_the_axes_turn() -> None:
    text = "BEGIN PGM A MM\nTOOL CALL 1 Z S1000\nPLANE SPATIAL SPA+0 SPB+0 SPC+0 TURN FMAX\nL C+90 FMAX\nEND PGM A MM\n"
    assert _led("heidenhain", text).moves.end[-1, 4] == 90.0


def test_spatial_angles_of_tcpm_point_the_tool_whatever_axes_there_are() -> None:
    text = (
        "BEGIN PGM A MM\nTOOL CALL 1 Z S1000\nFUNCTION TCPM F TCP AXIS SPAT PATHCTRL AXIS\n"
        "L X+10 Y+20 Z+5 A+20 B+0 C+0 F500\nL X+40 B+10\nFUNCTION RESET TCPM\nEND PGM A MM\n"
    )
    end = _led("heidenhain", text).moves.end[-1]
    assert TIP.tip(end.tolist())[:3] == pytest.approx((40.0, 20.0, 5.0), abs=1e-9)
    direction = tool_direction(trunnion(), end[None] + TIP_ZERO)[0]
    assert direction == pytest.approx((_turn(1, 10.0) @ _turn(0, 20.0))[:, 2], abs=1e-9)


def test_angles_of_cycle800_one_after_the_other() -> None:
    text = TILTED["sinumerik"].replace("57,10,0,0,30,0,0", "{}")
    first = text.replace("{}", "57,0,0,0,20,30,40")
    second = text.replace("{}", "27,0,0,0,40,30,20")
    directions = [
        tool_direction(trunnion(), _led("sinumerik", each).moves.end[-1:] + TIP_ZERO)[0]
        for each in (first, second)
    ]
    # About X, the new Y, the new Z; and about Z, the new Y, the new X.
    by_x_first = _turn(0, 20) @ _turn(1, 30) @ _turn(2, 40)
    by_z_first = _turn(2, 40) @ _turn(1, 30) @ _turn(0, 20)
    assert directions[0] == pytest.approx(by_x_first[:, 2], abs=1e-9)
    assert directions[1] == pytest.approx(by_z_first[:, 2], abs=1e-9)


TIP_ZERO = on_machine(trunnion()).zero


def _turn(axis: int, angle: float) -> np.ndarray:
    matrix = np.eye(3)
    first, second = (axis + 1) % 3, (axis + 2) % 3
    cosine, sine = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    matrix[first, first] = matrix[second, second] = cosine
    matrix[first, second], matrix[second, first] = -sine, sine
    return matrix


SOLID = _turn(2, 30.0) @ _turn(1, 20.0)
ACROSS_TRACES = np.cross((np.cos(np.radians(20.0)), 0.0, -np.sin(np.radians(20.0))),
                         (0.0, np.cos(np.radians(10.0)), np.sin(np.radians(10.0))))  # fmt: skip


@pytest.mark.parametrize(
    ("mode", "angles", "across"),
    [
        (64, "30,20,0", SOLID[:, 2]),
        (185, "10,20,0", ACROSS_TRACES / np.linalg.norm(ACROSS_TRACES)),
        (182, "20,10,0", ACROSS_TRACES / np.linalg.norm(ACROSS_TRACES)),
        (192, "25,40,0", None),
    ],
)
def test_modes_of_cycle800(mode: int, angles: str, across: np.ndarray | None) -> None:
    """Solid angles, projection angles about X and Y or about Y and X, and the rotary axes themselves."""
    text = TILTED["sinumerik"].replace("57,10,0,0,30,0,0", f"{mode},0,0,0,{angles}")
    end = _led("sinumerik", text).moves.end[-1:]
    if across is None:
        here = np.array([0.0, 0.0, 0.0, 25.0, 40.0])
        across = tool_direction(trunnion(), here[None] + TIP_ZERO)[0]
    assert tool_direction(trunnion(), end + TIP_ZERO)[0] == pytest.approx(across, abs=1e-9)


HEAD = on_machine(head_and_table())
HEAD_SETTINGS = settings(HEAD, dataclasses.replace(SETTINGS.axes, names=("X", "Y", "Z", "B", "C")))
BY_AXES = {
    "heidenhain": "BEGIN PGM A MM\nTOOL CALL 1 Z S1000\nL Z+100 FMAX\nPLANE AXIAL B+20 C+30 TURN FMAX\nL X+0 Y+0 Z+25 FMAX\nEND PGM A MM\n",
    "sinumerik": 'T1 D1 M6\nG0 Z100\nCYCLE800(0,"T",0,192,0,0,0,20,30,0,0,0,0,1)\nG0 X0 Y0 Z25\nM30\n',
}


@pytest.mark.parametrize("dialect", BY_AXES)
def test_a_plane_by_the_axes_of_a_head_is_that_across_its_tool(dialect: str) -> None:
    end = _led(dialect, BY_AXES[dialect], HEAD_SETTINGS).moves.end[-1]
    assert end[3:] == pytest.approx((20.0, 30.0))
    tip = ToolCenter(HEAD, 0.0, [0.0] * 5).tip(end.tolist())[:3]
    assert tip == pytest.approx(25.0 * tool_direction(head_and_table(), end[None] + HEAD.zero)[0])


@pytest.mark.parametrize("control", [SETTINGS, HEAD_SETTINGS], ids=["trunnion", "head"])
def test_vectors_of_traori_point_the_tool(control: ControlSettings) -> None:
    text = "T1 D1 M6\nTRAORI\nG1 X10 Y20 Z5 A3=0.1 B3=-0.2 C3=2 F500\nX40\nTRAFOOF\nM30\n"
    setup = control.setup
    assert setup is not None
    moves = _led("sinumerik", text, control).moves
    tip = ToolCenter(setup, 0.0, [0.0] * 5)
    assert tip.tip(moves.end[-1].tolist())[:3] == pytest.approx((40.0, 20.0, 5.0), abs=1e-9)
    wanted = np.array([0.1, -0.2, 2.0]) / np.linalg.norm([0.1, -0.2, 2.0])
    assert tip.direction(moves.end[-1].tolist()) == pytest.approx(wanted, abs=1e-9)


def test_a_dynamic_work_offset_keeps_the_directions_of_the_machine() -> None:
    text = "O1\nT1 M6\nG0 Z100.\nA30. C40.\nG254\nG0 X0 Y0 Z20.\nG1 X5. F100.\nG255\nM30\n"
    moves = _led("haas", text).moves
    assert moves.end[-1] - moves.start[-1] == pytest.approx((5.0, 0.0, 0.0, 0.0, 0.0), abs=1e-9)
    # The origin is the part's, wherever the axes have brought it: 20 mm along the tool from it.
    assert np.linalg.norm(TIP.tip(moves.start[-1].tolist())[:3]) == pytest.approx(20.0)


@pytest.mark.parametrize(
    ("dialect", "text", "code"),
    [
        ("fanuc", "O1\nG68.2 X0 Y0 Z0 I0 J30. K0\nG0 X5.\nM30\n", "tilted-plane"),
        ("fanuc", "O1\nG53.1\nM30\n", "tilted-plane"),
        ("fanuc", "O1\nG43.4 H1\nG1 X5. C40000. F100.\nM30\n", "tool-center"),
        ("fanuc", "O1\nG68.2 X0 Y0 Z0 I0 J130. K0\nG53.1\nM30\n", "tilted-plane"),
        ("fanuc", "O1\nG68.2 X0 Y0 Z0 I0 J30. K0\nG53.1\nG0 A5.\nM30\n", "tool-center"),
        ("fanuc", "O1\nT1 M6\nG41 D1\nG1 X5. F100.\nG43.4 H1\nM30\n", "compensation-change"),
        ("sinumerik", 'CYCLE800(0,"",0,158,0,0,0,30,20,0,0,0,0,1)\nM30\n', "tilted-plane"),
        ("sinumerik", "G1 X5 A3=0 B3=1 C3=1 F100\nM30\n", "tool-center"),
        ("sinumerik", "TRAORI\nG1 X5 A3=0 B3=0 C3=0 F100\nM30\n", "tool-center"),
        ("sinumerik", "TRAORI\nG1 X5 A3=0 B3=0 C3=-1 F100\nM30\n", "tool-center"),
        ("sinumerik", 'CYCLE800(0,"",0,57,0,0,0,30,0,0,0,0,0,0)\nG0 X5\nM30\n', "tilted-plane"),
        ("sinumerik", "TRAORI(2)\nM30\n", "tool-center"),
        ("heidenhain", "BEGIN PGM A MM\nPLANE POINTS\nEND PGM A MM\n", "tilted-plane"),
        (
            "heidenhain",
            "BEGIN PGM A MM\nPLANE SPATIAL SPA+30 SPB+0 SPC+0 STAY\nL X+5 FMAX\nEND PGM A MM\n",
            "tilted-plane",
        ),
        ("heidenhain", "BEGIN PGM A MM\nPLANE SPATIAL SPA+0 SPB+150 SPC+0 STAY\nEND PGM A MM\n", "tilted-plane"),
        ("heidenhain", "BEGIN PGM A MM\nPLANE PROJECTED PROPR+90 PROMIN+0 ROT+0\nEND PGM A MM\n", "tilted-plane"),
        ("heidenhain", "BEGIN PGM A MM\nFUNCTION TCPM F CONT AXIS SPAT\nEND PGM A MM\n", "tool-center"),
        ("fagor8070", "#RTCP\nM30\n", "unreadable-statement"),
    ],
)  # fmt: skip
def test_what_cannot_be_followed_is_refused(dialect: str, text: str, code: str) -> None:
    outcome = run(text, dialect, SETTINGS)
    assert outcome.error is not None
    assert outcome.error.code == code, outcome.error


TOWARD = ["0.3", "0.4", "0.8660254"]
IN_A_PLANE = {
    "fanuc P1": ("fanuc", "O1\nT1 M6\nG43.4 H1 P1\nG1 X10. Y20. Z5. A25. C10. F500.\nX40. Y-10. A40. C100.\nG49\nM30\n"),
    "fanuc vectors": ("fanuc", "O1\nT1 M6\nG43.5 H1 P1\nG1 X10. Y20. Z5. I.1 J-.5 K.8 F500.\nX40. Y-10. I{0} J{1} K{2}\nG49\nM30\n"),
    "sinumerik": ("sinumerik", "T1 D1 M6\nTRAORI\nG1 X10 Y20 Z5 A3=0.1 B3=-0.5 C3=0.8 F500\nX40 Y-10 A3={0} B3={1} C3={2}\nTRAFOOF\nM30\n"),
    "sinumerik plane": ("sinumerik", "T1 D1 M6\nORIMKS ORIPLANE\nTRAORI\nG1 X10 Y20 Z5 A3=0.1 B3=-0.5 C3=0.8 F500\nX40 Y-10 A3={0} B3={1} C3={2}\nTRAFOOF\nM30\n"),
    "heidenhain": ("heidenhain", "BEGIN PGM A MM\nTOOL CALL 1 Z S1000\nFUNCTION TCPM F TCP AXIS POS PATHCTRL VECTOR\nL X+10 Y+20 Z+5 A+25 C+10 F500\nL X+40 Y-10 A+40 C+100\nM129\nEND PGM A MM\n"),
    "heidenhain LN": ("heidenhain", "BEGIN PGM A MM\nTOOL CALL 1 Z S1000\nFUNCTION TCPM F TCP AXIS POS PATHCTRL VECTOR REFPNT TIP-TIP\nLN X+10 Y+20 Z+5 NX+0 NY+0 NZ+1 TX+0.1 TY-0.5 TZ+0.8 F500\nLN X+40 Y-10 Z+5 NX+0 NY+0 NZ+1 TX+{0} TY+{1} TZ+{2}\nM129\nEND PGM A MM\n"),
}  # fmt: skip
"""Each turns the tool in the plane of both directions between its two blocks."""


def _plane_error(moves: Moves, line: int) -> tuple[float, float]:
    """How far the direction leaves the plane of both ends of a block's curves, and how far it turns [rad]."""
    curves = moves[(moves.line == line) & (moves.shape == Shape.CURVE)]
    places = np.concatenate([curves.start[:1], curves.end]) + TIP_ZERO
    directions = tool_direction(trunnion(), places)
    across = np.cross(directions[0], directions[-1])
    size = float(np.linalg.norm(across))
    return float(np.abs(directions @ across).max()) / size, size


@pytest.mark.parametrize("name", IN_A_PLANE)
def test_a_direction_is_interpolated_as_a_vector_where_the_control_does(name: str) -> None:
    dialect, text = IN_A_PLANE[name]
    text = text.format(*TOWARD)
    line = next(
        number for number, row in enumerate(text.splitlines(), 1) if "40" in row and "-10" in row
    )
    moves = _led(dialect, text).moves
    off, angle = _plane_error(moves, line)
    assert angle > 0.3
    assert off < 1e-8
    assert _tips(moves)[-1, :3] == pytest.approx((40.0, -10.0, 5.0), abs=1e-9)


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("fanuc P1", " P1", " P0"),
        ("fanuc vectors", " P1", ""),
        ("sinumerik", "TRAORI", "ORIAXES\nTRAORI"),
        ("sinumerik", "TRAORI", "ORIMKS\nTRAORI"),
        ("heidenhain", "VECTOR", "AXIS"),
    ],
)
def test_else_the_rotary_axes_go_evenly(name: str, old: str, new: str) -> None:
    dialect, text = IN_A_PLANE[name]
    text = text.format(*TOWARD).replace(old, new, 1)
    line = next(
        number for number, row in enumerate(text.splitlines(), 1) if "40" in row and "-10" in row
    )
    moves = _led(dialect, text).moves
    off, _ = _plane_error(moves, line)
    assert off > 1e-3
    curves = moves[(moves.line == line) & (moves.shape == Shape.CURVE)]
    assert curves.curve is not None
    assert not curves.curve[:, 3:, 1:].any()


FORMS = {
    "P1 Q123": ("fanuc", "G68.2 P1 Q123 X10. Y0 Z0 I30. J20. K40.", _turn(2, 40) @ _turn(1, 20) @ _turn(0, 30)),
    "P1": ("fanuc", "G68.2 P1 X10. Y0 Z0 I90. J0 K60.", _turn(2, 60) @ _turn(0, 90)),
    "P2": ("fanuc", "G68.2 P2 Q0 X10. Y0 Z0 R15.\nG68.2 P2 Q1 X5. Y0 Z2.\nG68.2 P2 Q2 X9. Y0 Z2.\nG68.2 P2 Q3 X-3. Y.8660254037844386 Z2.5", _turn(0, 30) @ _turn(2, 15)),
    "P3": ("fanuc", "G68.2 P3 Q1 I0 J-.5 K.8660254\nG68.2 P3 Q0 X10. Y0 Z0 I1. J0 K0", _turn(0, 30)),
    "G268": ("haas", "G268 X10. Y0 Z0 I30. J20. K40. Q123", _turn(2, 40) @ _turn(1, 20) @ _turn(0, 30)),
    "G268 Q321": ("haas", "G268 X10. Y0 Z0 I30. J20. K40. Q321", _turn(0, 30) @ _turn(1, 20) @ _turn(2, 40)),
}  # fmt: skip


@pytest.mark.parametrize("name", FORMS)
def test_forms_of_tilted_planes(name: str) -> None:
    """The post's example of P1 is, by Euler's angles, I60. J90. K0."""
    dialect, words, matrix = FORMS[name]
    orient, end = ("G253", "G269") if dialect == "haas" else ("G53.1", "G69")
    text = f"O1\nT1 M6\nG0 Z100.\n{words}\n{orient}\nG43 H1\nG0 X3. Y4. Z20.\nG1 Z5. F200.\n{end}\nM30\n"
    end_place = _led(dialect, text).moves.end[-1]
    tip = np.array(TIP.tip(end_place.tolist())[:3])
    assert tip == pytest.approx(np.array([10.0, 0.0, 0.0]) + matrix @ (3.0, 4.0, 5.0), abs=1e-6)


def test_g53_6_turns_about_the_tip() -> None:
    text = TILTED["fanuc"].replace("G53.1", "G53.6")
    moves = _led("fanuc", text).moves
    curves = moves[moves.shape == Shape.CURVE]
    longer = ToolCenter(on_machine(trunnion()), 0.0, [0.0] * 5)
    tips = np.array([longer.tip(place.tolist())[:3] for place in curves.end])
    assert len(tips) > 5
    assert np.abs(tips - tips[0]).max() < 1e-9
    assert moves.end[-1] == pytest.approx(_led("fanuc", TILTED["fanuc"]).moves.end[-1], abs=1e-9)


@pytest.mark.parametrize(
    ("dialect", "block", "said"),
    [
        ("fanuc", "G68.2 P4 X0 Y0 Z0 I10. J10. K0", "P0 to P3"),
        ("fanuc", "G68.2 P1 Q122 X0 Y0 Z0 I10. J10. K0", "Q123"),
        ("fanuc", "G68.2 P2 Q4 X0 Y0 Z0", "Q0 to Q3"),
        ("fanuc", "G68.2 P3 Q0 X0 Y0 Z0 I1. J0 K0\nG68.2 P3 Q1 I1. J0 K1.", "right angles"),
        ("fanuc", "G43.4 H1 P3", "P0"),
        ("fanuc", "G43.5 H1 Q2.", "inclination"),
        ("fanuc", "G43.5 H1\nG1 X1. A10. F100.", "rotary axis"),
        ("fanuc", "G68.2 X0 Y0 Z0 I0 J30. K0\nG53.6 R10.", "distance R"),
        ("haas", "G268 X0 Y0 Z0", "rotary axes"),
        ("haas", "G268 X0 Y0 Z0 I10. J20. K0", "order"),
        ("haas", "G253", "G268"),
        ("sinumerik", "ORICONCW", "ORIVECT"),
        ("heidenhain", "LN X+1 TX+0 TY+0 TZ+1 F100", "M128"),
    ],
)
def test_what_is_not_followed_is_refused_by_name(dialect: str, block: str, said: str) -> None:
    head, tail = (
        ("BEGIN PGM A MM\nTOOL CALL 1 Z S1000\n", "\nEND PGM A MM\n")
        if dialect == "heidenhain"
        else ("", "\nM30\n")
    )
    outcome = run(head + block + tail, dialect, SETTINGS)
    assert outcome.error is not None
    assert said in f"{outcome.error.message} {outcome.error.hint}"
