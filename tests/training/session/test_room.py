"""The machine under an operator's hands, without a window."""

import json

import hypothesis.strategies as st
import numpy as np
import pytest
from examples import examples
from hypothesis import given, settings

from twin.errors import UsageError
from twin.nc.canonical import FloatArray
from twin.training.room.room import Room
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.session import checkpoints
from twin.training.session import session as session_module
from twin.training.session.commands import command_from
from twin.training.session.log import relive
from twin.training.session.session import SceneSession


@pytest.fixture
def session() -> SceneSession:
    return SceneSession(read_scene(scene_path("fagor_first_steps")))


def do(session: SceneSession, name: str, **arguments: object) -> None:
    assert session.submit({"do": name, **arguments}), session.refusal


def run_to_line(session: SceneSession, line: int) -> None:
    for _ in range(2000):
        if int(session.room.machine.setpoint.line[0]) == line:
            return
        session.advance()
    raise AssertionError(f"line {line} never ran: {session.room.alarm}")


def start_to_line(session: SceneSession, line: int) -> None:
    do(session, "cycle_start")
    run_to_line(session, line)


def rest(session: SceneSession) -> None:
    session.advance(5)
    for _ in range(2000):
        session.advance()
        if not session.room.machine.moving:
            return
    raise AssertionError("the axes never came to rest")


def heights_of(room: Room) -> FloatArray:
    """Of the stock in the machine."""
    assert room.setup.work is not None
    assert room.setup.work.map is not None
    return room.setup.work.map.heights


def speed(session: SceneSession) -> float:
    """What the axes are commanded [mm/min]: the joints tremble under the teeth."""
    return 60.0 * float(np.linalg.norm(session.room.samples.setpoint.velocity[-1, :3]))


def test_override_turns_the_feed(session):
    start_to_line(session, 5)
    session.advance(50)
    assert speed(session) == pytest.approx(1200.0, rel=1e-3)
    do(session, "override", dial="feed", percent=50)
    session.advance(50)
    assert speed(session) == pytest.approx(600.0, rel=1e-3)
    do(session, "override", dial="feed", percent=120)
    session.advance(50)
    assert speed(session) == pytest.approx(1440.0, rel=1e-3)
    do(session, "override", dial="feed", percent=0)
    rest(session)
    assert session.room.slot.running == "program"


def test_hold_stops_on_the_path_and_start_goes_on(session):
    start_to_line(session, 5)
    session.advance(50)
    do(session, "feed_hold")
    rest(session)
    stands = session.room.machine.position - session.room.setup.tables.zero
    assert session.snapshot().held
    assert stands[1:3] == pytest.approx([-20.0, -2.0], abs=2e-3)
    do(session, "cycle_start")
    run_to_line(session, 6)
    assert session.room.alarm is None


def test_distance_to_go_and_the_screen_agree(session):
    start_to_line(session, 5)
    session.advance(30)
    now = session.snapshot()
    lag = now.following_error[0]
    assert now.position[0] + lag + now.distance_to_go[0] == pytest.approx(40.0)
    assert now.modal is not None
    assert {"G1", "G17", "G90"} <= set(now.modal.codes)
    assert now.modal.feed == 1200.0
    assert now.spindle.turning == 6000.0


def test_emergency_stop_latches_until_it_is_turned_free_and_reset(session):
    start_to_line(session, 5)
    do(session, "emergency_stop")
    rest(session)
    assert session.room.alarm.code == "emergency-stop"
    assert not session.room.auxiliaries.spindle.turns
    assert not session.submit({"do": "reset"})
    assert "turn it free" in session.refusal
    assert not session.submit({"do": "cycle_start"})
    do(session, "emergency_stop", pressed=False)
    do(session, "reset")
    assert session.room.alarm is None


def test_reset_comes_to_rest_on_the_path_and_drops_the_program(session):
    start_to_line(session, 5)
    session.advance(30)
    do(session, "reset")
    rest(session)
    session.advance()
    assert session.room.slot.running == ""
    stands = session.room.machine.position - session.room.setup.tables.zero
    assert stands[1:3] == pytest.approx([-20.0, -2.0], abs=2e-3)
    assert session.room.judge.verdicts[3].state == "open"


def test_mdi_runs_through_interpreter_and_limits(session):
    do(session, "mode", mode="mdi")
    do(session, "mdi", text="G90 G01 X10 F2000")
    do(session, "cycle_start")
    session.advance(100)
    assert session.snapshot().position[0] == pytest.approx(10.0, abs=1e-3)
    do(session, "mdi", text="G91 G77 X1")
    session.submit({"do": "cycle_start"})
    session.advance()
    assert session.room.alarm.code == "program"
    assert "unknown-g" in session.room.alarm.message
    do(session, "reset")
    do(session, "mdi", text="G90 G01 X500 F2000")
    do(session, "cycle_start")
    session.advance()
    assert session.room.alarm.code == "soft-limit"
    assert session.snapshot().position[0] == pytest.approx(10.0, abs=1e-3)


def test_jog_stops_when_let_go_and_at_the_end_of_the_travel(session):
    do(session, "mode", mode="jog")
    do(session, "jog", axis="X", direction=1)
    session.advance(50)
    assert speed(session) == pytest.approx(2000.0, rel=1e-3)
    do(session, "jog_stop")
    rest(session)
    do(session, "jog", axis="X", direction=1, feed=30000)
    rest(session)
    for _ in range(300):
        session.advance()
    assert session.room.alarm is None
    assert session.room.machine.position[0] == pytest.approx(400.0, abs=1e-3)
    assert not session.submit({"do": "jog", "axis": "X", "direction": 1})
    assert "end of its travel" in session.refusal


def test_an_edited_program_is_what_runs(session):
    do(session, "edit", line=5, text="N40 X20 F1200\nN45 X25")
    assert len(session.room.program.lines) == 11
    do(session, "edit", line=6)
    assert session.room.program.lines[4] == "N40 X20 F1200"
    assert not session.submit({"do": "edit", "line": 99, "text": "M30"})


@pytest.mark.parametrize(
    ("fault", "code"),
    [
        ({"kind": "friction", "axis": "X", "value": 20000.0}, "following-error"),
        ({"kind": "alarm"}, "external"),
    ],
)
def test_injected_faults_have_consequences(session, fault, code):
    assert not session.submit({"do": "inject", "fault": fault})
    assert "trainer" in session.refusal
    start_to_line(session, 5)
    assert session.submit({"do": "inject", "fault": fault}, "trainer")
    session.advance(400)
    assert session.room.alarm.code in (code, "drive-saturation")


def test_a_lost_offset_shows_and_the_machine_is_repaired(session):
    before = session.snapshot()
    fault = {"kind": "lost_offset", "axis": "Y", "value": 3.0}
    assert session.submit({"do": "inject", "fault": fault}, "trainer")
    assert session.snapshot().position[1] == pytest.approx(before.position[1] - 3.0)
    fault = {"kind": "backlash", "axis": "X", "value": 0.2}
    assert session.submit({"do": "inject", "fault": fault}, "trainer")
    session.advance(10)
    assert session.room.machine.machine.axis("X").backlash == 0.2
    assert session.submit({"do": "repair"}, "trainer")
    assert session.room.machine.machine.axis("X").backlash == 0.0


@pytest.mark.seconds("a session is lived twice")
def test_living_it_again_is_the_same_to_the_last_bit(session):
    do(session, "cycle_start")
    session.advance(120)
    do(session, "override", dial="feed", percent=70)
    session.advance(37)
    do(session, "feed_hold")
    session.advance(40)
    do(session, "cycle_start")
    session.advance(200)
    room = session.room
    again = relive(Room(session.scene), session.log, room.tick)
    assert np.array_equal(again.machine.position, room.machine.position)
    assert again.setup.work is not None
    assert room.setup.work is not None
    assert np.array_equal(heights_of(again), heights_of(room))
    session.rewind(1.5)
    assert session.room.tick == room.tick - 1500
    session.advance(150)
    assert np.array_equal(session.room.machine.position, room.machine.position)


def test_a_replay_comes_to_where_the_session_is(session):
    do(session, "cycle_start")
    session.advance(150)
    assert session.submit({"do": "replay"}, "trainer")
    replay = session.replay
    assert replay is not None
    while not replay.over:
        replay.advance(0.06)
    assert np.array_equal(replay.room.machine.position, session.room.machine.position)


def test_what_was_handed_in_stays_as_it_was(session):
    do(session, "finish")
    score = session.room.judge.score
    for command in ({"do": "hint"}, {"do": "finish"}, {"do": "answer", "task": 1, "choice": "R"}):
        assert not session.submit(command)
        assert "handed in" in session.refusal
    assert (session.room.judge.score, session.room.judge.hints) == (score, 0)
    do(session, "cycle_start")


def test_freezing_stops_time(session):
    do(session, "cycle_start")
    session.frozen = True
    session.advance(100)
    assert session.room.tick == 0


ANYTHING = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3),
    max_leaves=6,
)  # fmt: skip
NAMES = st.sampled_from(["jog", "mode", "edit", "override", "set_tool", "inject", "answer", "nope"])


@pytest.mark.seconds("hundreds of commands at a running machine")
@given(ANYTHING | st.dictionaries(st.sampled_from(["do", "axis", "step", "mode", "line", "fault"]), ANYTHING | NAMES))  # fmt: skip
@settings(max_examples=examples(200), derandomize=True, deadline=None)
def test_malformed_commands_are_refused_in_words(data):
    try:
        command = command_from(data)
    except UsageError:
        return
    assert json.dumps(command.model_dump())


@pytest.mark.parametrize(
    "data",
    [
        {"do": "jog", "axis": "\ud800", "direction": 1}, {"do": "jog", "axis": "X" * 10**6, "direction": 1},
        {"do": "\ud800"}, {"do": "x" * 10**6}, {"do": "sign", "name": "\ud800"}, {"do": "search", "line": 10**300},
        {"do": "inject", "fault": {"kind": "friction", "axis": "\ud800"}}, {"do": "set_tool", "number": 10**300},
        {"do": "set_tool", "number": 1, "length": "1_0"}, {"do": "set_tool", "number": 1, "length": ""},
        {"do": "override", "percent": True}, {"do": "switch", "name": "dry_run", "on": "no"},
    ],
)  # fmt: skip
def test_what_is_refused_can_be_shown_to_everybody(session, data):
    assert not session.submit(data, "trainer")
    assert len(session.refusal.encode()) < 300


def test_a_malformed_command_changes_nothing(session):
    before = session.snapshot()
    assert not session.submit({"do": "jog", "axis": "X", "direction": float("nan")})
    assert not session.submit("reset")
    assert not session.log
    assert session.snapshot().position == before.position


def test_a_spindle_starts_at_its_last_speed_and_without_one_not_at_all(session):
    room = session.room
    do(session, "mode", mode="mdi")
    for text, turns, speed in (
        ("M3", False, None), ("S1500 M4", True, 1500.0), ("M5", False, 1500.0), ("M3", True, 1500.0),
    ):  # fmt: skip
        do(session, "mdi", text=text)
        do(session, "cycle_start")
        while room.slot.run is not None:
            session.advance()
        assert (room.auxiliaries.spindle.turns, room.auxiliaries.spindle.speed) == (turns, speed)
    do(session, "spindle", on=False)
    assert not room.auxiliaries.spindle.turns
    do(session, "spindle", on=True)
    assert room.auxiliaries.spindle.turning == 1500.0


def test_going_back_from_a_copy_is_the_same_to_the_last_bit(session, monkeypatch):
    monkeypatch.setattr(checkpoints, "APART_S", 0.3)
    session = SceneSession(session.scene)
    do(session, "cycle_start")
    session.advance(70)
    do(session, "override", dial="feed", percent=70)
    session.advance(41)
    do(session, "feed_hold")
    session.advance(20)
    do(session, "cycle_start")
    session.advance(30)
    room = session.room
    assert room.setup.work is not None
    place, removed = room.machine.position, room.setup.work.removed
    heights = heights_of(room).copy()
    assert room.setup.cut.process is not None
    felt_from = room.setup.cut.process.material.heights.copy()
    walls = room.setup.cut.process.walls.copy()
    later = []
    for _ in range(2):
        session.advance(80)
        later.append(session.room.machine.position)
        session.rewind(0.8)
        back = session.room
        assert back.slot.run is not None
        assert back.slot.run.modal(0) is not None
        assert np.array_equal(back.machine.position, place)
        assert back.setup.work is not None
        assert back.setup.work.removed == removed
        assert np.array_equal(heights_of(back), heights)
        assert back.setup.cut.process is not None
        assert np.array_equal(back.setup.cut.process.material.heights, felt_from)
        assert np.array_equal(back.setup.cut.process.walls, walls)
    assert np.array_equal(later[0], later[1])
    assert len(session.log) == 4


def test_a_copy_holds_no_map_of_its_own(session):
    session.advance(500)
    before = checkpoints.checkpoint(session.room, 0, ())
    after = checkpoints.checkpoint(session.room, 0, before.maps)
    assert len(after.maps) == 3
    for old, new in zip(before.maps, after.maps, strict=True):
        assert all(a is b for a, b in zip(old.tiles, new.tiles, strict=True))
    work, process = after.room.setup.work, after.room.setup.cut.process
    assert work is not None
    assert process is not None
    cut = heights_of(after.room), process.material.heights, process.walls
    assert all(a is b for a, b in zip(after.maps, cut, strict=True))
    assert process.material.uncut is session.room.setup.cut.process.material.uncut


def test_of_the_stock_a_copy_keeps_only_the_tiles_that_were_cut():
    heights = np.zeros((150, 200))
    first = checkpoints.KeptMap(heights, None)
    heights[140, 10] = -1.0
    second = checkpoints.KeptMap(heights, first)
    other = checkpoints.KeptMap(np.zeros((10, 200)), second)
    assert other.laid_out().shape == (10, 200)
    own = [a is not b for a, b in zip(first.tiles, second.tiles, strict=True)]
    assert own.count(True) == 1
    assert np.array_equal(second.laid_out(), heights)
    assert not first.laid_out().any()


def test_going_far_back_restores_a_checkpoint_without_living_it_again(session, monkeypatch):
    monkeypatch.setattr(checkpoints, "DENSE", 2)
    monkeypatch.setattr(checkpoints, "APART_S", 1.0)
    monkeypatch.setattr(session_module, "LIVED_AGAIN_S", 0.5)
    session = SceneSession(session.scene)
    for _ in range(48):
        session.advance(10)
    session.rewind(0.3)
    assert session.room.time_s == pytest.approx(4.5)
    session.rewind(0.8)
    assert session.room.time_s == pytest.approx(3.0)


def test_copies_are_bounded_in_number_and_the_beginning_is_kept(session, monkeypatch):
    for name, value in (("DENSE", 2), ("MOST", 4), ("SPREAD", 0.0), ("APART_S", 0.02)):
        monkeypatch.setattr(checkpoints, name, value)
    session = SceneSession(session.scene)
    session.advance(10)
    for _ in range(10):
        session.advance(2)
        assert len(session._checkpoints._kept) <= 4
    session.rewind(session.room.time_s)
    assert session.room.tick == 0


def test_a_reset_in_the_midst_of_a_cut_is_no_cut_without_rotation(session):
    do(session, "cycle_start")
    while session.room.machine.setpoint.line[0] < 5 or not session.room.machine.moving:
        session.advance()
    session.advance(20)
    do(session, "reset")
    session.advance(100)
    assert session.room.alarm is None
    assert not session.room.machine.moving
    assert not session.room.auxiliaries.spindle.turns
