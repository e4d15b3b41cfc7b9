"""#CS, #ACS and #TOOL ORI of the Fagor CNC 8070, held against homogeneous matrices written here."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import settings as examples_of
from hypothesis import strategies as st

from tests.examples import examples
from tests.five_axes import HEAD_AXES, head_and_table, on_machine, settings, trunnion
from tests.nc.running import run
from twin.nc.canonical import FloatArray
from twin.nc.control.settings import ControlSettings

TRUNNION = settings(on_machine(trunnion()))
HEAD = settings(on_machine(head_and_table()), HEAD_AXES)
LEVEL = dataclasses.replace(TRUNNION, setup=None)


def _turn(axis: int, angle: float) -> FloatArray:
    a, b = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(4)
    matrix[a, a] = matrix[b, b] = math.cos(math.radians(angle))
    matrix[b, a] = math.sin(math.radians(angle))
    matrix[a, b] = -matrix[b, a]
    return matrix


def _shift(x: float, y: float, z: float) -> FloatArray:
    matrix = np.eye(4)
    matrix[:3, 3] = (x, y, z)
    return matrix


def _system(mode: int, origin: list[float], angles: list[float]) -> FloatArray:
    first, second, third = angles
    return (
        _shift(*origin) @ _turn(0 if mode == 1 else 2, first) @ _turn(1, second) @ _turn(2, third)
    )


def _tool(control: ControlSettings, axes: FloatArray) -> FloatArray:
    """Position and direction of the tool in the part, as a matrix, by the joints of the chain one after the other."""
    setup = control.setup
    assert setup is not None
    chain, joints = setup.chain, axes + setup.zero
    matrix = _shift(*(-setup.length * chain.tool))
    for joint, column in enumerate(chain.column.tolist()):
        if chain.rotary[joint]:
            place = _shift(*chain.anchor[joint])
            about = int(np.argmax(np.abs(chain.axis[joint])))
            sense = chain.axis[joint][about]
            step = place @ _turn(about, sense * joints[column]) @ np.linalg.inv(place)
        else:
            step = _shift(*(joints[column] * chain.axis[joint]))
        matrix = step @ matrix
    # Program zero: the tip of the first tool while all axes are at part zero.
    return _shift(*(-setup.zero[:3] + setup.length * chain.tool)) @ matrix


_ANGLE = st.integers(-60, 60).map(float)
_PLACE = st.integers(-40, 40).map(float)


@given(
    st.sampled_from([TRUNNION, HEAD]),
    st.sampled_from([1, 2]),
    st.lists(_ANGLE, min_size=3, max_size=3),
    st.lists(_PLACE, min_size=6, max_size=6),
    st.booleans(),
)
@examples_of(max_examples=examples(40))
def test_the_tip_is_where_the_systems_say_and_the_tool_stands_square(
    control: ControlSettings, mode: int, angles: list[float], places: list[float], led: bool
) -> None:
    mode_words = ", ".join(f"{value:g}" for value in (*places[:3], *angles))
    x, y, z = places[3:]
    text = (
        f"#RTCP {'ON' if led else 'OFF'}\n#ACS ON [2] [MODE 1, 3, 4, 5, 0, 0, 90]\n"
        f"#CS ON [1] [MODE {mode}, {mode_words}]\n#TOOL ORI\n"
        f"G0 X{x:g} Y{y:g} Z{z + 9:g}\nG1 Z{z:g} F500\nM30\n"
    )
    outcome = run(text, "fagor8070", control)
    if outcome.error is not None:
        assert "do not point the tool along" in outcome.error.message
        return
    system = _system(1, [3.0, 4.0, 5.0], [0.0, 0.0, 90.0]) @ _system(mode, places[:3], angles)
    expected, made = system @ _shift(x, y, z), _tool(control, outcome.moves.end[-1])
    assert made[:3, 3] == pytest.approx(expected[:3, 3], abs=1e-9)
    assert made[:3, 2] == pytest.approx(system[:3, 2], abs=1e-8)


def test_first_and_second_are_the_solutions_near_and_far_of_the_main_axis() -> None:
    """The main axis of a trunnion of A and B, one in the other, is A: 20 or 160 degrees from zero."""
    chain = trunnion()
    chain.axis[4] = (0.0, 1.0, 0.0)
    turning = settings(on_machine(chain)._replace(travel=np.full((5, 2), (-900.0, 900.0))))
    text = "#CS ON [MODE 1, 0, 0, 0, {}, 0, 0, {}]\n#TOOL ORI\nG0 X0 Y0 Z10\nM30\n"
    for tilt, word, expected in ((20, "FIRST", 20.0), (20, "SECOND", 160.0), (160, "FIRST", 20.0)):
        outcome = run(text.format(tilt, word), "fagor8070", turning)
        assert outcome.error is None
        angle = math.remainder(float(outcome.moves.end[-1][3]), 360.0)
        assert abs(angle) == pytest.approx(expected)


def test_systems_end_from_the_last_one_back() -> None:
    """The example of linkage in the manual of the kernel: each #ACS OFF and #CS OFF ends the last of its kind."""
    text = (
        "#CS DEF [1] [MODE 1, 1, 0, 0, 0, 0, 0]\n#CS DEF [2] [MODE 1, 2, 0, 0, 0, 0, 0]\n"
        "#ACS DEF [1] [MODE 1, 10, 0, 0, 0, 0, 0]\n#ACS DEF [2] [MODE 1, 20, 0, 0, 0, 0, 0]\n"
        "G1 X0 F500\n#CS ON [1]\nX0\n#ACS ON [2]\nX0\n#ACS ON [1]\nX0\n#CS ON [2]\nX0\n"
        "#ACS OFF\nX0\n#CS OFF\nX0\n#ACS OFF\nX0\n#CS OFF\nX0.5\nM30\n"
    )
    ends = run(text, "fagor8070", LEVEL).moves.end[:, 0].tolist()
    assert ends == [1.0, 21.0, 31.0, 33.0, 23.0, 21.0, 1.0, 0.5]


def test_the_plane_across_the_tool_leaves_the_tool_where_it_is() -> None:
    text = "G0 A20 C40\n#CS ON [MODE 6, 5, 6, 7, 0]\nG1 X1 Y2 Z3 F500\n#CS OFF\nM30\n"
    end = run(text, "fagor8070", TRUNNION).moves.end[-1]
    made = _tool(TRUNNION, end)
    assert end[3:].tolist() == [20.0, 40.0]
    assert made[:3, 3] == pytest.approx(
        np.array([5.0, 6.0, 7.0]) + made[:3, :3] @ np.array([1.0, 2.0, 3.0]), abs=1e-9
    )


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("#CS ON [1] [MODE 4, 0, 0, 0, 10, 20, 0, 0]", "1, 2 and 6"),
        ("#CS ON [MODE 1, 0, 0, 0, 10]", "3 angles"),
        ("#CS ON [MODE 1, 0, 0, 0, 10, 0, 0, SOL2]", "SOL2"),
        ("#CS ON [6] [MODE 1, 0, 0, 0, 0, 0, 0]", "1 to 5"),
        ("#CS ON [3]", "number 3"),
        ("#ACS ON", "no coordinate system"),
        ("#CS X0 Y0 Z0 RX0 RY10 RZ0", "DEF"),
        ("#CS OFF [1]", "no form"),
        ("#CS DEF [MODE 1, 0, 0, 0, 0, 0, 0]", "needs a number"),
        ("#CS ON [MODE 1, 0, 0, 0, 10, 0, 0]\nG0 X1", "does not stand across"),
        ("#CS ON [MODE 1, 0, 0, 0, 10, 0, 0]\n#TOOL ORI\nG2 X10 I5 J0 F500", "goes straight"),
        ("#CS ON [MODE 1, 0, 0, 0, 10, 0, 0]\n#TOOL ORI\nG0 X1 A5", "names none"),
        ("#CS ON [MODE 1, 0, 0, 0, 10, 0, 0]\nG92 X0", "offsets do not change"),
        ("#CS ON [MODE 1, 0, 0, 0, 180, 0, 0]\n#TOOL ORI\nG0 X1", "do not point the tool"),
        ("#MCS ON\n#CS ON [MODE 1, 0, 0, 0, 10, 0, 0]", "#MCS"),
    ],
)
def test_what_is_not_followed_says_what_would_be(text: str, part: str) -> None:
    error = run(f"{text}\nM30\n", "fagor8070", TRUNNION).error
    assert error is not None
    assert part in f"{error.message} {error.hint}"
