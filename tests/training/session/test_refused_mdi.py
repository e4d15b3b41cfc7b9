"""A block typed into MDI that is refused changes nothing: axes, spindle, coolant, tool, what is in force."""

from functools import cache

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.examples import examples
from tests.nc.test_refused_blocks import WORDS
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.session.session import SceneSession

SCENES = {
    "codesys_below_zero": "F600",
    "fagor_first_steps": "G90 F600",
    "fanuc_missing_point": "G90 F600.",
    "gost_part_zero": "G90 F600",
    "heidenhain_second_clearance": "M9",
    "linuxcnc_round_corners": "G90 F600",
    "mefi_lead": "G90 F600",
    "sinumerik_open_frame": "G90 F600",
}
"""A scene of each dialect, and a block that moves nothing."""
BLOCKS = (
    "M3 S1000", "M3 S1000 G91 G1 X1 F77", "M8 G91 X1", "M4 S700 M8 G0 X2", "T1 M6", "G55 M3 S50", "G81 X2 Z-5 R2 F100 M3 S9",
    "L X+5 F200 M3", "TOOL CALL 1 Z S2000", "CYCL DEF 7.1 X+5", "M3 S500 G91 G1 X9999 F100",
)  # fmt: skip
WRONG = st.one_of(WORDS, st.sampled_from([",C.5", ",R.5", "RND=2", "CHF=.5", "G36", "RND R2", ""]))


@cache
def session_of(scene: str) -> SceneSession:
    session = SceneSession(read_scene(scene_path(scene)))
    session.submit({"do": "mode", "mode": "mdi"})
    return session


def typed(session: SceneSession, text: str) -> bool:
    """Run a block; whether it was taken."""
    room = session.room
    session.submit({"do": "mdi", "text": text})
    taken = session.submit({"do": "cycle_start"})
    for _ in range(2000):
        session.advance()
        if (room.slot.run is None or room.slot.waiting) and not room.machine.moving:
            break
    return taken and room.alarm is None


def in_force(session: SceneSession) -> tuple[object, ...]:
    room, now, left = session.room, session.snapshot(), session.room.slot.inherited
    setpoint = tuple(room.machine.setpoint.position[0].tolist())
    state = (setpoint, now.spindle.speed, now.coolant, now.tool, now.modal, now.offsets)
    if left is None:
        return state
    return (*state, left.feed, left.spindle, left.modal.active.numbers(), str(left.shifts))


@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.seconds("a room is opened for each dialect")
@settings(max_examples=examples(24))
@given(block=st.sampled_from(BLOCKS), wrong=WRONG, before=st.booleans())
def test_a_refused_block_changes_nothing(scene: str, block: str, wrong: str, before: bool) -> None:
    session = session_of(scene)
    assert typed(session, SCENES[scene])
    was = in_force(session)
    taken = typed(session, f"{wrong} {block}" if before else f"{block} {wrong}")
    alarm = session.room.alarm
    if taken or alarm is None or alarm.code not in ("program", "soft-limit"):
        session_of.cache_clear()
        return
    assert in_force(session) == was, alarm.message
    assert session.submit({"do": "reset"})
    session.advance()


def test_the_axes_stand_behind_the_block_of_a_stop_where_corners_are_blended() -> None:
    session = SceneSession(read_scene(scene_path("fanuc_missing_point")))
    before = session.room.machine.setpoint.position[0].copy()
    session.submit({"do": "mode", "mode": "mdi"})
    assert typed(session, "G91 G1 X1. F500.\nX2. M0\nX3. ,R.5\nY5.")
    assert session.room.slot.waiting
    assert session.room.machine.setpoint.position[0, 0] - before[0] == pytest.approx(3.0)
    session.submit({"do": "cycle_start"})
    session.advance(400)
    travelled = session.room.machine.setpoint.position[0] - before
    assert travelled[:2] == pytest.approx([6.0, 5.0])


def test_a_corner_before_a_tool_change_is_refused_before_that() -> None:
    session = SceneSession(read_scene(scene_path("fanuc_missing_point")))
    session.submit({"do": "mode", "mode": "mdi"})
    other = next(
        row.number for row in session.snapshot().tools if row.number != session.snapshot().tool
    )
    was = session.snapshot().tool
    assert not typed(session, f"G91 G1 X1. F500. T{other} M6 ,R.5\nY5.")
    alarm = session.room.alarm
    assert alarm is not None
    assert "blend" in alarm.message
    assert session.snapshot().tool == was
