"""The height of the spindle over the table, read from the MJCF file without compiling it."""

import hypothesis
import hypothesis.strategies as st
import mujoco
import pytest

from twin.machine.description.kinematics import SPINDLE_NOSE, TABLE_TOP
from twin.machine.model.model import height_between

NUMBER = st.floats(-2.0, 2.0).map(lambda value: round(value, 3))


def numbers(count: int) -> st.SearchStrategy[str]:
    return st.lists(NUMBER, min_size=count, max_size=count).map(
        lambda values: " ".join(map(str, values))
    )


@st.composite
def turns(draw: st.DrawFn) -> str:
    """An orientation as MJCF writes it."""
    kind = draw(st.sampled_from(["none", "euler", "axisangle", "quat"]))
    if kind == "none":
        return ""
    if kind == "euler":
        return f'euler="{draw(numbers(3))}"'
    return f'{kind}="1 {draw(numbers(3))}"'


@st.composite
def branches(draw: st.DrawFn, site: str) -> str:
    """A site in bodies and frames within each other."""
    text = f'<site name="{site}" pos="{draw(numbers(3))}" {draw(turns())}/>'
    for depth in range(draw(st.integers(0, 4))):
        place = f'pos="{draw(numbers(3))}" {draw(turns())}'
        if draw(st.booleans()):
            text = f"<frame {place}>{text}</frame>"
        else:
            mass = '<joint type="slide"/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
            text = f'<body name="{site} {depth}" {place}>{mass}{text}</body>'
    return text


@hypothesis.settings(max_examples=60, deadline=None)
@hypothesis.given(
    nose=branches(SPINDLE_NOSE),
    table=branches(TABLE_TOP),
    angle=st.sampled_from(["degree", "radian"]),
    sequence=st.sampled_from(["xyz", "ZYX", "xzy"]),
)
def test_it_is_that_of_the_compiled_model(nose: str, table: str, angle: str, sequence: str) -> None:
    text = (
        f'<mujoco><compiler angle="{angle}" eulerseq="{sequence}"/>'
        f"<worldbody>{nose}{table}</worldbody></mujoco>"
    )
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    expected = data.site(SPINDLE_NOSE).xpos[2] - data.site(TABLE_TOP).xpos[2]
    found = height_between(mujoco.MjSpec.from_string(text), TABLE_TOP, SPINDLE_NOSE)
    assert found == pytest.approx(expected, abs=1e-12)
