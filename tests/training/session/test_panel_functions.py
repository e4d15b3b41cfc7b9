"""What the keys of the panel do: switches, block search, handwheel, tables, and what a control refuses."""

import dataclasses

import numpy as np
import pytest

from tests.training.session.commanding import do, refused
from twin.nc.control.settings import ToolData
from twin.nc.dialects.linuxcnc import LINUXCNC
from twin.nc.text.source import source_from_text
from twin.training.program.program_run import ProgramRun, RunOptions
from twin.training.room.control.tables import MAGAZINE_PLACES
from twin.training.room.observed import block_number
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.session import checkpoints
from twin.training.session.commands import LONGEST_TEXT
from twin.training.session.session import SceneSession

pytestmark = pytest.mark.seconds("programs are run at a panel")


@pytest.fixture
def session() -> SceneSession:
    return SceneSession(read_scene(scene_path("fagor_first_steps")))


def rest(session: SceneSession) -> None:
    """Until nothing moves and nothing goes on by itself."""
    still = 0
    for _ in range(4000):
        session.advance()
        room = session.room
        waits = room.slot.run is None or room.slot.held
        still = still + 1 if waits and not room.machine.moving else 0
        if still > 3:
            return
    raise AssertionError(f"the axes never came to rest: {session.room.alarm}")


def do_and_rest(session: SceneSession, what: str, /, **arguments: object) -> None:
    do(session, what, **arguments)
    rest(session)


def start(session: SceneSession, text: str | None = None) -> None:
    """Start the program that is loaded, or another, until it ends or waits."""
    if text is not None:
        load(session, text)
    do_and_rest(session, "cycle_start")


def to_line(session: SceneSession, line: int) -> None:
    while session.room.line < line:
        session.advance()


def load(session: SceneSession, text: str) -> None:
    session.room.program.load(text)


def at(session: SceneSession) -> tuple[float, ...]:
    """The tip, part coordinates [mm]."""
    room = session.room
    return tuple(np.round(room.machine.position - room.setup.tables.zero, 2)[:3])


def seconds(session: SceneSession, text: str) -> float:
    """Machine time of a program [s]."""
    load(session, text)
    do(session, "cycle_start")
    began = session.room.time_s
    rest(session)
    return session.room.time_s - began


def second_tool(session: SceneSession) -> float:
    """Give the scene a second tool; how long its change takes [s]."""
    session.room.setup.tables.tools[2] = session.room.setup.tables.tool.model_copy(
        update={"number": 2}
    )
    session.room.setup.tables.lengths[2], session.room.setup.tables.radii[2] = 60.0, 4.0
    change_s = session.room.machine.machine.file.spindle.tool_change_s
    assert change_s > 1.0
    return change_s


def test_a_tool_change_takes_the_time_that_the_machine_file_says(session):
    """As in a run: twin.run.dry_run.spindle_dwells; a tool that is there already takes none."""
    change_s = second_tool(session)
    same = seconds(session, "N10 T1 M6\nN20 G90 G1 F500 X1\nN30 M30")
    other = seconds(session, "N10 T2 M6\nN20 G90 G1 F500 X2\nN30 M30")
    assert session.room.setup.tables.spindle == 2
    assert other - same == pytest.approx(change_s, abs=0.05)


def test_a_tool_that_was_selected_before_a_stop_takes_its_time_too(session):
    change_s = second_tool(session)
    seconds(session, "N10 T2\nN20 M0\nN30 M6\nN40 M30")
    assert (session.room.slot.held, session.room.setup.tables.spindle) == (True, 1)
    do(session, "cycle_start")
    began = session.room.time_s
    rest(session)
    assert session.room.setup.tables.spindle == 2
    assert session.room.time_s - began == pytest.approx(change_s, abs=0.1)


def test_a_tool_that_is_not_there_is_told_at_once(session):
    assert seconds(session, "N10 T9 M6\nN20 G90 G1 F500 X1\nN30 M30") < 1.0
    alarm = session.room.alarm
    assert (alarm.code, alarm.message, alarm.line) == ("program", "no tool 9", 1)


def test_functions_wait_for_those_before_them(session):
    """Between two moves: each function comes when the waits before it are over."""
    load(
        session,
        "N10 S4000 M3\nN20 G4 K1\nN30 M8\nN40 G4 K1\nN50 M9\nN60 S2000 M4\nN70 G1 F500 X1\nN80 M30",
    )
    do(session, "cycle_start")
    room = session.room
    seen = []
    while not room.machine.moving:
        session.advance()
        now = (
            room.line,
            room.auxiliaries.spindle.speed,
            room.auxiliaries.coolant,
            room.auxiliaries.spindle.counter_clockwise,
        )
        if now not in seen:
            seen.append(now)
    assert [one for one in seen if one[0]] == [
        (1, 4000.0, False, False),
        (2, 4000.0, False, False),
        (4, 4000.0, True, False),
        (6, 2000.0, False, True),
        (7, 2000.0, False, True),
    ]


def test_single_block_stops_behind_blocks_that_move_nothing(session):
    load(session, "N10 G90 F500\nN20 S3000 M3\nN30 G0 X0 Y0\nN40 M8\nN50 G1 X5\nN60 M30")
    do(session, "mode", mode="single")
    seen = []
    for _ in range(6):
        start(session)
        room = session.room
        seen.append(
            (room.line, room.auxiliaries.spindle.turns, room.auxiliaries.coolant, at(session)[0])
        )
    there = seen[0][3]
    assert seen[:5] == [
        (1, False, False, there),
        (2, True, False, there),
        (3, True, False, 0.0),
        (4, True, True, 0.0),
        (5, True, True, 5.0),
    ]
    assert session.room.slot.run is None
    assert session.room.judge.noted(session.room)[0] == {1, 2, 3, 4, 5, 6}
    # It is not the scene's program, and has not made the part.
    assert session.room.judge.evidence.single == set()


def test_a_block_that_began_in_automatic_was_not_run_singly(session):
    do(session, "cycle_start")
    to_line(session, 5)
    do_and_rest(session, "mode", mode="single")
    assert session.room.line == 5
    assert session.room.judge.evidence.single == set()
    start(session)
    assert session.room.judge.evidence.single == {6}


def test_a_hold_within_a_single_block_goes_on_to_its_end(session):
    load(session, "N10 G90 S3000 M3\nN20 G1 X-40 F600\nN30 X-30\nN40 M30")
    do(session, "mode", mode="single")
    for _ in range(2):
        do(session, "cycle_start")
    session.advance(100)
    do_and_rest(session, "feed_hold")
    assert session.room.line == 2
    start(session)
    assert (session.room.line, at(session)[0]) == (2, -40.0)


@pytest.mark.parametrize("on", [False, True])
def test_the_optional_stop_stops_where_its_switch_says_so(session, on):
    load(session, "N10 G90 F500\nN20 G0 X-5\nN30 M1\nN40 G0 X5\nN50 M30")
    do(session, "switch", name="optional_stop", on=on)
    start(session)
    assert session.room.slot.waiting == on
    assert at(session)[0] == (-5.0 if on else 5.0)


@pytest.mark.parametrize("on", [False, True])
def test_a_block_with_a_slash_is_left_out_where_the_switch_says_so(session, on):
    load(session, "N10 G90 G0 X-5\n/N20 G0 X5\nN30 M30")
    do(session, "switch", name="block_skip", on=on)
    start(session)
    assert at(session)[0] == (-5.0 if on else 5.0)


def test_what_changes_how_a_program_is_read_cannot_change_while_it_runs(session):
    do(session, "cycle_start")
    for name in ("block_skip", "dry_run"):
        assert "while something runs" in refused(session, "switch", name=name, on=True)
    do(session, "switch", name="optional_stop", on=True)


def test_a_dry_run_goes_at_its_own_feed_and_finishes_nothing(session):
    do(session, "switch", name="dry_run", on=True)
    do(session, "cycle_start")
    to_line(session, 5)
    session.advance(40)
    velocity = session.room.samples.joint_velocity[-1, :3]
    assert 60.0 * float(np.linalg.norm(velocity)) == pytest.approx(3000.0, rel=1e-2)
    rest(session)
    assert not session.room.judge.evidence.ended_well


def test_a_search_goes_up_over_and_down_and_waits(session):
    do(session, "search", line=5)
    start(session)
    room = session.room
    assert room.slot.waiting
    assert at(session) == (-40.0, -20.0, -2.0)
    assert room.auxiliaries.spindle.turns
    assert room.alarm is None
    do(session, "cycle_start")
    to_line(session, 6)
    assert room.slot.modal is None or "G1" in room.slot.modal.codes
    rest(session)
    assert room.slot.run is None
    assert room.judge.evidence.ended_well


def test_a_search_lifts_a_tool_that_stands_in_the_part_before_it_travels(session):
    do(session, "cycle_start")
    to_line(session, 6)
    do_and_rest(session, "feed_hold")
    do_and_rest(session, "reset")
    assert at(session)[2] == pytest.approx(-2.0, abs=0.01)
    do(session, "search", line=8)
    do(session, "cycle_start")
    highest = -2.0
    while not session.room.slot.waiting and session.room.alarm is None:
        session.advance()
        highest = max(highest, at(session)[2])
    assert session.room.alarm is None
    assert highest == pytest.approx(5.0, abs=0.01)
    assert session.room.auxiliaries.spindle.turns


def test_a_search_behind_a_side_leaves_the_part_unfinished(session):
    do(session, "search", line=6)
    start(session)
    start(session)
    assert session.room.slot.run is None
    assert session.room.alarm is None
    assert not session.room.judge.evidence.ended_well


def test_a_search_that_finds_nothing_is_told(session):
    load(session, "N10 G90 G0 X0\n(goto end)\nN30 M30")
    do(session, "search", line=2)
    start(session)
    assert session.room.alarm.message == "the program never comes to line 2"
    assert refused(session, "search", line=9) == "the program has 3 lines"


@pytest.mark.parametrize(
    ("code", "end"), [("G41.1 D2", "program"), ("G41 D1", "program"), ("G40", "")]
)
def test_a_search_does_not_begin_within_a_compensated_contour(session, code, end):
    options = RunOptions(search=4)
    text = f"G0 X0 Y0\n{code} G1 X5 F500\nG1 Y9\nG1 X20\nG40 X30\nM30"
    room = session.room
    machine, given = room.machine.machine, session.scene.preparation.settings
    begin = dict(zip(machine.axes.names, (0.0,) * len(machine.axes), strict=True))
    settings = dataclasses.replace(given, start=begin, tools={1: ToolData(radius=1.0, length=60.0)})
    run = ProgramRun(source_from_text(text, "test"), LINUXCNC, settings, machine, options)
    where = room.standing_setpoint, room.setup.tables.program_zero
    run.begin(*where, room.auxiliaries.spindle)
    assert (run.reader.ending, "compensated" in run.reader.message) == (end or "stop", bool(end))


def test_jog_during_a_hold_and_the_way_back_to_the_path(session):
    do(session, "cycle_start")
    to_line(session, 5)
    session.advance(40)
    do_and_rest(session, "feed_hold")
    held = at(session)
    do(session, "mode", mode="jog")
    do_and_rest(session, "jog", axis="Z", direction=1, step=20.0)
    do_and_rest(session, "jog", axis="X", direction=-1, step=10.0)
    assert refused(session, "set_zero", axis="X") != ""
    do(session, "mode", mode="auto")
    assert refused(session, "cycle_start") == "the axes stand off the path: return to it first"
    do(session, "mode", mode="jog")
    do_and_rest(session, "return_to_path")
    assert at(session) == held
    do(session, "mode", mode="auto")
    start(session)
    assert session.room.judge.evidence.ended_well
    assert session.room.alarm is None


def test_going_back_into_a_hold_with_jogged_axes(session):
    do(session, "cycle_start")
    to_line(session, 5)
    do_and_rest(session, "feed_hold")
    do(session, "mode", mode="jog")
    for _ in range(45):
        session.advance(10)
    do_and_rest(session, "jog", axis="Z", direction=1, step=5.0)
    session.rewind(0.5)
    assert session.room.slot.suspended is not None
    do_and_rest(session, "return_to_path")
    do(session, "mode", mode="auto")
    start(session)
    assert session.room.judge.evidence.ended_well


def test_the_handwheel_moves_by_its_clicks_and_no_further_than_the_travel(session):
    do(session, "mode", mode="jog")
    before = at(session)
    for _ in range(5):
        do(session, "handwheel", axis="X", clicks=2, step=0.1)
    rest(session)
    assert at(session)[0] == pytest.approx(before[0] + 1.0)
    do_and_rest(session, "handwheel", axis="X", clicks=-1, step=0.01)
    assert at(session)[0] == pytest.approx(before[0] + 0.99)
    assert session.snapshot().modal is None


def test_the_reference_return_drives_up_first(session):
    do(session, "mode", mode="jog")
    do_and_rest(session, "jog", axis="X", direction=1, step=30.0)
    do(session, "reference")
    velocity = session.room.machine.velocity
    session.advance(10)
    velocity = session.room.machine.velocity
    assert abs(velocity[2]) > 0.0
    assert velocity[0] == pytest.approx(0.0, abs=1e-6)
    rest(session)
    assert session.room.machine.position == pytest.approx(np.zeros(4), abs=1e-3)


def test_mdi_keeps_what_a_block_left_in_force_until_reset(session):
    do(session, "mode", mode="mdi")
    for text in ("G91 G1 F600", "X2", "X2"):
        do(session, "mdi", text=text)
        start(session)
    assert session.room.alarm is None
    stands = at(session)[0]
    do(session, "mdi", text="G90 X10")
    start(session)
    assert at(session)[0] == 10.0
    assert stands != 10.0
    do(session, "reset")
    assert session.room.slot.inherited is None


def test_an_mdi_block_keeps_the_work_offset(session):
    do(session, "set_offset", axis="X", value=7.0, name="G55")
    do(session, "mode", mode="mdi")
    for text in ("G55", "G90 G0 X1"):
        do(session, "mdi", text=text)
        start(session)
    assert at(session)[0] == 8.0


def test_an_offset_that_is_typed_counts_for_the_next_mdi_block(session):
    do(session, "set_offset", axis="X", value=7.0, name="G55")
    do(session, "mode", mode="mdi")
    for text, name in (("G55", "G55"), ("G90 G0 X1", "G54"), ("X1", "")):
        do(session, "mdi", text=text)
        start(session)
        if name:
            do(session, "set_offset", axis="X", value=9.0, name=name)
    assert at(session)[0] == 10.0


def test_going_back_into_a_run_takes_the_offsets_that_it_began_with(session):
    load(session, "N10 G55 G90 G1 X-30 F6000\nN20 X-20\nN30 X-30\nN40 X-10 F200\nN50 M30")
    do(session, "set_offset", axis="X", value=7.0, name="G55")
    do(session, "cycle_start")
    for _ in range(45):
        session.advance(10)
    assert session.room.slot.run is not None
    there, then = at(session)[0], session.room.time_s
    rest(session)
    do(session, "set_offset", axis="X", value=50.0, name="G55")
    session.rewind(session.room.time_s - then)
    assert session.room.slot.run is not None
    assert at(session)[0] == there
    rest(session)
    assert at(session)[0] == -3.0


def test_typed_tool_data_reach_the_control(session):
    number = session.room.setup.tables.spindle
    do(session, "set_tool", number=number, radius=4.0)
    row = next(tool for tool in session.snapshot().tools if tool.number == number)
    assert row.radius == 4.0
    length = row.length
    do(session, "set_tool", number=number, length=length + 1.0)
    assert session.room.setup.tables.lengths[number] == length + 1.0
    assert session.room.setup.tables.radii[number] == 4.0


def test_the_program_can_be_taken_back_and_loaded_anew(session):
    lines = session.room.program.lines
    assert refused(session, "undo") == "the program has not been changed"
    do(session, "edit", line=5, text="N40 X30 F1200")
    do(session, "edit", line=6, text="N50 Y10")
    do(session, "undo")
    assert session.room.program.lines[5] == lines[5]
    assert session.room.program.lines[4] == "N40 X30 F1200"
    do(session, "reload")
    assert session.room.program.lines == lines
    do(session, "undo")
    assert session.room.program.lines[4] == "N40 X30 F1200"


def test_a_new_blank_has_not_been_cut(session):
    start(session)
    assert session.room.setup.work.removed > 0.0
    do(session, "mode", mode="jog")
    do(session, "new_blank")
    assert session.room.setup.work.removed == 0.0
    assert not session.room.setup.work.map.machined().any()


def test_the_spindle_needs_a_speed_and_the_tool_a_standing_spindle(session):
    assert refused(session, "spindle", on=True) == "no spindle speed is set: type S first"
    do(session, "spindle", on=True, speed=2000.0, counter_clockwise=True)
    now = session.snapshot()
    assert (now.spindle.speed, now.counter_clockwise) == (2000.0, True)
    do(session, "mode", mode="jog")
    assert "spindle turns" in refused(session, "change_tool", number=1)
    do(session, "spindle", on=False)
    do(session, "change_tool", number=1)


def test_a_start_without_a_speed_turns_nothing(session):
    load(session, "N10 M3\nN20 G90 G1 X5 F100\nN30 M30")
    do(session, "cycle_start")
    session.advance(20)
    assert session.room.auxiliaries.spindle.started
    assert not session.room.auxiliaries.spindle.turns


def test_more_speed_than_the_spindle_gives_is_limited_told_once_and_stops_nothing(session):
    load(session, "N10 S15000 M3\nN20 G90 G1 X5 F600\nN30 M3\nN40 G1 X0\nN50 M30")
    do(session, "cycle_start")
    session.advance(200)
    now = session.snapshot()
    assert (now.alarm, now.spindle_turning) == (None, 12000.0)
    assert [(told.code, told.block) for told in now.alarms] == [("spindle-limited", "N10")]


def test_coolant_closes_with_an_alarm_and_stays_closed(session):
    do(session, "coolant", on=True)
    do(session, "emergency_stop")
    assert not session.room.auxiliaries.coolant
    assert "emergency-stop" in refused(session, "coolant", on=True)


def test_the_limit_alarm_stands_until_the_axis_has_left_its_switch():
    session = SceneSession(read_scene(scene_path("fagor_overtravel")))
    refusal = refused(session, "reset")
    assert refusal == "X is on its limit switch: jog it back first"
    do(session, "mode", mode="jog")
    assert "end of its travel" in refused(session, "jog", axis="X", direction=1, step=1.0)
    assert "limit switch" in refused(session, "jog", axis="Y", direction=1, step=1.0)
    do_and_rest(session, "jog", axis="X", direction=-1, step=1.0)
    assert session.room.alarm is not None
    do(session, "reset")
    assert session.room.alarm is None
    assert [notice.code for notice in session.room.alarms.history] == ["hard-limit"]


def test_an_alarm_names_the_block_by_its_number(session):
    start(session, "N10 G90 F500\nN20 G1 X9999\nN30 M30")
    alarm = session.room.alarm
    assert (alarm.code, alarm.line, alarm.block) == ("soft-limit", 2, "N20")


@pytest.mark.parametrize(
    ("text", "number"),
    [("N20 G1 X9", "N20"), ("/ n0030 X1", "N30"), ("X1 (N20)", ""), ("N40 G77 X1", "N40"), ("N50 X=(", "N50"), ("(N20)", ""), ("", "")],
)  # fmt: skip
def test_the_number_of_a_block_is_what_its_language_reads(text, number):
    program = source_from_text(f"G0 X0\n{text}\nM30", "test")
    dialect = read_scene(scene_path("fagor_first_steps")).preparation.dialect
    assert block_number(dialect, program, 2) == number
    assert block_number(dialect, program, 0) == block_number(dialect, program, 9) == ""


def test_a_jog_changes_nothing_that_is_in_force(session):
    start(session)
    before = session.snapshot().modal
    assert before is not None
    do(session, "mode", mode="jog")
    do(session, "jog", axis="X", direction=1, step=10.0)
    session.advance(5)
    assert session.room.slot.running == "jog"
    assert session.snapshot().modal == before


def test_time_counts_from_the_first_touch():
    scene = read_scene(scene_path("fagor_first_steps"))
    task = scene.file.tasks[0].model_copy(update={"held": (), "within_s": 1.0})
    file = scene.file.model_copy(update={"tasks": (task,), "time_limit_s": 2.0})
    session = SceneSession(dataclasses.replace(scene, file=file))
    session.advance(500)
    assert session.room.judge.verdicts[0].state == "open"
    do(session, "coolant", on=True)
    session.advance(120)
    assert session.room.judge.verdicts[0].state == "failed"
    session.advance(100)
    assert session.room.judge.over


def test_at_a_program_stop_the_axes_can_be_jogged_and_come_back(session):
    """M0 is where a part is measured (Fagor 8070: tool inspection; SINUMERIK Operate: JOG, REPOS)."""
    start(session, "N10 G90 G1 F500 X1\nN20 M0\nN30 G1 X3\nN40 M30")
    room = session.room
    assert (room.slot.waiting, room.line, at(session)[0]) == (True, 2, 1.0)
    assert "reset first" in refused(session, "mode", mode="mdi")
    do(session, "mode", mode="jog")
    do_and_rest(session, "jog", axis="X", direction=1, step=5.0)
    do(session, "mode", mode="auto")
    assert "off the path" in refused(session, "cycle_start")
    do(session, "mode", mode="jog")
    do_and_rest(session, "return_to_path")
    do(session, "mode", mode="auto")
    assert room.line == 2
    start(session)
    assert at(session)[0] == 3.0
    assert room.slot.run is None


def test_going_back_to_a_program_stop_with_jogged_axes(session, monkeypatch):
    monkeypatch.setattr(checkpoints, "APART_S", 0.1)
    session = SceneSession(session.scene)
    start(session, "N10 G90 G1 F500 X1\nN20 M0\nN30 G1 X3\nN40 M30")
    do(session, "mode", mode="jog")
    session.advance(40)
    session.rewind(0.3)
    do(session, "mode", mode="auto")
    start(session)
    assert at(session)[0] == 3.0


def test_while_a_program_moves_the_spindle_is_stopped_by_hand_and_not_started(session):
    """AXIS starts it by hand only where nothing runs; its stop key counts always."""
    load(session, "N10 G90 S2000 M3\nN20 G1 F500 X-10\nN30 M30")
    do(session, "cycle_start")
    session.advance(20)
    assert "hold it" in refused(session, "spindle", on=True, counter_clockwise=True)
    assert not session.room.auxiliaries.spindle.counter_clockwise
    do(session, "spindle", on=False)
    assert not session.room.auxiliaries.spindle.turns
    do_and_rest(session, "feed_hold")
    do(session, "spindle", on=True)
    assert session.room.auxiliaries.spindle.turning == 2000.0


def test_what_stood_before_the_axes_at_a_reset_does_not_happen(session):
    load(session, "N10 G90 G1 F500 X-1\nN20 S2000 M3\nN30 M8\nN40 G1 X-2\nN50 M0\nN60 M30")
    do(session, "cycle_start")
    session.advance(5)
    do_and_rest(session, "reset")
    assert session.room.slot.run is None
    assert at(session)[0] > -1.0
    assert not session.room.auxiliaries.spindle.turns
    assert not session.room.auxiliaries.coolant


@pytest.mark.parametrize("state", ["standing", "running", "held", "stopped", "jogged"])
def test_a_reset_stops_spindle_and_coolant_in_every_state(session, state):
    load(session, "N10 G90 S2000 M3\nN15 M8\nN20 G1 F500 X-3\nN25 M0\nN30 X5\nN40 M30")
    do(session, "coolant", on=True)
    if state != "standing":
        do(session, "cycle_start")
        session.advance(15)
    if state in ("held", "jogged"):
        do_and_rest(session, "feed_hold")
    if state == "jogged":
        do(session, "mode", mode="jog")
        do(session, "jog", axis="X", direction=1)
        session.advance(5)
    if state == "stopped":
        rest(session)
        assert session.room.slot.waiting
    do(session, "reset")
    for _ in range(400):
        session.advance()
        if session.room.slot.run is None and not session.room.machine.moving:
            break
    room = session.room
    assert (room.slot.run, room.slot.suspended, room.slot.waiting, room.alarm) == (
        None,
        None,
        False,
        None,
    )
    assert not room.auxiliaries.spindle.turns
    assert not room.auxiliaries.coolant
    do(session, "mode", mode="auto")
    do(session, "cycle_start")
    assert room.slot.running == "program"


@pytest.mark.parametrize(
    ("text", "line", "begins", "ends"),
    [
        ("o1 sub\nG1 X2 F900\nG1 Y2\no1 endsub\nG90 G0 X0 Y0\no1 call\nM2", 3, (2, 0), (2, 2)),
        ("G90 G0 X0 Y0\n#1=0\no2 while [#1 LT 2]\n#1=[#1+1]\nG1 X#1 F900\no2 endwhile\nM2", 5, (0, 0), (2, 0)),
        ("G90 G0 X0 Y0\nS900 M3\nG98 G81 X1 Y1 Z29 R29.5 F900\nX2\nX3\nG80\nM2", 4, (1, 1), (3, 1)),
        ("G90 G0 X0 Y0\nG10 L2 P1 R90\nG54\nG1 X2 F900\nX3\nM2", 5, (0, 2), (0, 3)),
        ("G90 G0 X0 Y0\nG91 G1 X1 F900\nX1\nX1\nM2", 4, (2, 0), (3, 0)),
    ],
    ids=["subprogram", "loop", "cycle", "rotated", "incremental"],
)  # fmt: skip
def test_a_search_comes_to_where_its_block_begins(text, line, begins, ends):
    """What is before the block is computed, its first pass counts (SINUMERIK: block search)."""
    session = SceneSession(read_scene(scene_path("linuxcnc_round_corners")))
    load(session, text)
    do(session, "search", line=line)
    start(session)
    assert session.room.line == line
    assert at(session)[:2] == pytest.approx(begins)
    start(session)
    assert session.room.slot.run is None
    assert at(session)[:2] == pytest.approx(ends)


def test_a_tool_that_is_added_is_mounted_and_cuts(session):
    added = {"number": 7, "kind": "flat", "diameter": 4.0, "length": 70.0}
    do(session, "mode", mode="jog")
    do(session, "add_tool", **added)
    row = next(row for row in session.snapshot().tools if row.number == 7)
    assert (row.kind, row.diameter, row.length, row.radius) == ("flat", 4.0, 70.0, 2.0)
    assert "T7" in refused(session, "add_tool", **added)
    do(session, "change_tool", number=7)
    assert session.room.setup.tables.length_difference[2] == 10.0
    do(session, "mode", mode="auto")
    start(session, "N10 T7 M6\nN20 S3000 M3\nN30 G90 G1 F500 X1\nN40 M30")
    assert session.room.alarm is None


def test_a_full_magazine_takes_no_more_tools(session):
    for number in range(2, MAGAZINE_PLACES + 1):
        do(session, "add_tool", number=number, kind="drill", diameter=3.0, length=50.0)
    more = refused(session, "add_tool", number=98, kind="drill", diameter=3.0, length=50.0)
    assert more == f"the magazine has {MAGAZINE_PLACES} places, and all are taken"


def test_a_line_that_is_too_long_is_refused_with_its_limit(session):
    too_long = "X" * (LONGEST_TEXT + 1)
    assert refused(session, "edit", line=1, text=too_long) == (
        f"text: there is room for {LONGEST_TEXT} characters"
    )
