"""The machine's thread: held keys, frozen time, replays, and that nothing ends it."""

import time

import numpy as np
import pytest

from twin.nc.control.executor import Executor
from twin.training.program import program_run
from twin.training.program.program_run import BLOCKS_AT_REST, BLOCKS_FOR_PLANNER
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.scene.vocabulary import Vocabulary
from twin.training.score_sheets.score import score_sheet
from twin.training.server.driver import CAUGHT_UP_AT_ONCE_S, HELD_S, MOST_BEHIND_S, Driver
from twin.training.session.log import Who
from twin.training.session.session import SceneSession

PAGE = 7


@pytest.fixture
def driver():
    return Driver(SceneSession(read_scene(scene_path("fagor_first_steps"))))


def run_for(driver: Driver, seconds: float) -> None:
    """Let the wall's clock go on."""
    for _ in range(round(seconds / 0.01)):
        driver._step(0.01)


def ask(driver: Driver, name: str, who: Who = "operator", **given: object) -> None:
    driver.ask({"do": name, **given}, who, PAGE)
    driver._step(0.0)


def test_a_held_key_moves_while_its_page_speaks_and_stops_when_it_falls_silent(driver):
    room = driver.session.room
    ask(driver, "mode", mode="jog")
    ask(driver, "jog", axis="X", direction=1)
    for _ in range(30):
        driver.beat(PAGE)
        run_for(driver, 0.01)
    assert room.slot.running == "jog"
    assert room.machine.moving
    time.sleep(HELD_S)
    run_for(driver, 0.01)
    assert driver.session.log[-1].command == {"do": "jog_stop"}
    run_for(driver, 0.5)
    assert not room.machine.moving
    assert room.slot.running == ""


def test_a_page_that_is_gone_holds_no_key(driver):
    ask(driver, "mode", mode="jog")
    ask(driver, "jog", axis="X", direction=1)
    run_for(driver, 0.02)
    driver.leave(PAGE)
    run_for(driver, 0.01)
    assert driver.session.log[-1].command == {"do": "jog_stop"}


def test_a_jog_by_a_step_needs_no_held_key(driver):
    ask(driver, "mode", mode="jog")
    ask(driver, "jog", axis="X", direction=1, step=1.0)
    driver.leave(PAGE)
    place = driver.session.room.machine.position[0]
    run_for(driver, 1.0)
    assert driver.session.room.machine.position[0] == pytest.approx(place + 1.0, abs=1e-3)


def test_time_that_the_computer_was_busy_with_others_is_caught_up_and_presses_do_not_wait(driver):
    ask(driver, "cycle_start")
    driver._step(0.9)
    assert driver.session.room.time_s <= CAUGHT_UP_AT_ONCE_S + 0.011
    ask(driver, "feed_hold")
    assert driver.session.room.slot.run.held
    for _ in range(20):
        driver._step(0.0)
    assert driver.session.room.time_s == pytest.approx(0.9, abs=0.011)
    assert driver.lost_s == 0.0
    driver._step(3.0)
    assert driver.lost_s == pytest.approx(3.0 - MOST_BEHIND_S, abs=0.011)


def test_a_frozen_machine_stands_until_it_goes_on(driver):
    ask(driver, "cycle_start")
    run_for(driver, 0.3)
    ask(driver, "freeze", "trainer")
    before = driver.session.room.time_s
    run_for(driver, 0.1)
    assert driver.session.room.time_s == before
    ask(driver, "go_on", "trainer")
    run_for(driver, 0.1)
    assert driver.session.room.time_s > before


def test_a_replay_comes_back_to_where_the_session_is_and_can_be_ended(driver):
    ask(driver, "cycle_start")
    run_for(driver, 1.0)
    there = driver.session.room.time_s
    place = driver.session.room.machine.position.copy()
    ask(driver, "replay", "trainer")
    run_for(driver, 0.05)
    assert driver.seen is not driver.session.room
    assert driver.look.now.replaying
    ask(driver, "reset")
    assert "shown again" in driver.session.refusal
    run_for(driver, there / 4.0)
    assert driver.seen is driver.session.room
    assert driver.session.room.time_s == pytest.approx(there, abs=0.1)
    ask(driver, "replay", "trainer")
    ask(driver, "end_replay", "trainer")
    assert driver.session.replay is None
    assert np.linalg.norm(driver.session.room.machine.position - place) < 10.0


def test_the_emergency_stop_works_while_a_replay_runs(driver):
    ask(driver, "cycle_start")
    run_for(driver, 0.5)
    ask(driver, "replay", "trainer")
    ask(driver, "emergency_stop")
    assert driver.session.replay is None
    assert driver.session.room.alarm is not None


def test_whatever_goes_wrong_becomes_an_alarm_and_time_goes_on(driver, monkeypatch):
    room = driver.session.room

    def broken(*_: object) -> None:
        raise ZeroDivisionError("of no use")

    with monkeypatch.context() as patch:
        patch.setattr(room, "_step", broken)
        run_for(driver, 0.02)
    assert room.alarm is not None
    assert room.alarm.code == "internal"
    assert "of no use" in room.alarm.message
    ask(driver, "reset")
    assert room.alarm is None
    before = room.time_s
    run_for(driver, 0.1)
    assert room.time_s > before


def test_a_tool_that_is_not_there_is_an_alarm(driver):
    ask(driver, "mode", mode="mdi")
    ask(driver, "mdi", text="T2 M6")
    ask(driver, "cycle_start")
    run_for(driver, 0.1)
    alarm = driver.session.room.alarm
    assert alarm is not None
    assert (alarm.code, alarm.message) == ("program", "no tool 2")


@pytest.mark.parametrize(
    ("before", "moves"), [("$GOTO N1", False), ("G1 X1 F3000", True), ("G0 X1\nG1 X2 F3000", True)]
)
def test_a_program_that_loops_for_ever_keeps_neither_time_nor_the_emergency_stop_waiting(
    driver, monkeypatch, before, moves
):
    session = driver.session
    for line in range(len(session.room.program.lines), 1, -1):
        ask(driver, "edit", line=line)
    ask(driver, "edit", line=1, text=f"%LOOP\n{before}\nN1 $GOTO N2\nN2 $GOTO N1")
    blocks, start = [], session.room.machine.position[0]
    monkeypatch.setattr(program_run, "SLICES_AT_REST", 20)
    monkeypatch.setattr(Executor, "run", counted(Executor.run, blocks))
    ask(driver, "cycle_start")
    for slices in range(1, 100):
        driver._step(0.01)
        assert len(blocks) <= (slices + 1) * (BLOCKS_AT_REST + BLOCKS_FOR_PLANNER)
    assert moves == (session.room.machine.position[0] != start)
    assert session.room.time_s == pytest.approx(0.99)
    assert session.room.slot.running == "program"
    ask(driver, "emergency_stop")
    assert session.room.alarm is not None


def counted(run, blocks: list):
    def counting(control, block):
        blocks.append(block)
        return run(control, block)

    return counting


def test_axes_that_have_caught_up_with_a_computing_program_rest_and_go_on(driver, monkeypatch):
    monkeypatch.setattr(program_run, "SLICES_AT_REST", 3)
    room = driver.session.room
    for line in range(len(room.program.lines), 1, -1):
        ask(driver, "edit", line=line)
    computing = "$FOR P1=0,2000,1\nP2=P1*2\n$ENDFOR"
    ask(driver, "edit", line=1, text=f"%WAIT\nG91 G1 X1 F3000\n{computing}\nG1 X2\nM30")
    ask(driver, "cycle_start")
    start, at, stood = room.machine.position[0], 0.0, False
    for _ in range(600):
        run_for(driver, 0.01)
        at = room.machine.position[0] - start
        stood |= abs(at - 1.0) < 1e-3 and not room.machine.moving
    assert room.alarm is None
    assert room.slot.running == ""
    assert stood
    assert at == pytest.approx(3.0, abs=1e-3)


def test_only_the_trainer_breaks_things_and_repair_takes_everything_back(driver):
    tables = driver.session.room.setup.tables
    zero = tables.zero.copy()
    ask(driver, "inject", fault={"kind": "backlash", "axis": "X", "value": 0.2})
    assert "only the trainer" in driver.session.refusal
    for fault in (
        {"kind": "backlash", "axis": "X", "value": 0.2},
        {"kind": "backlash", "axis": "X", "value": 0.3},
        {"kind": "dull_drive", "axis": "Y", "value": 0.5},
        {"kind": "lost_offset", "axis": "X", "value": 2.0},
    ):
        ask(driver, "inject", "trainer", fault=fault)
    shown = [(fault.kind, fault.value) for fault in driver.session.room.faults.active]
    assert shown == [("backlash", 0.3), ("dull_drive", 0.5), ("lost_offset", 2.0)]
    ask(driver, "repair", "trainer")
    machine = driver.session.room.machine.machine
    sound = driver.session.scene.preparation.machine
    assert [machine.axis(n) for n in machine.axes.names] == [
        sound.axis(n) for n in sound.axes.names
    ]
    assert np.array_equal(tables.zero, zero)
    assert not driver.session.room.faults.active


def test_the_log_keeps_what_was_taken_back_and_names_who(driver):
    ask(driver, "cycle_start")
    run_for(driver, 0.5)
    ask(driver, "rewind", "trainer", seconds=100.0)
    assert driver.session.room.time_s == 0.0
    assert driver.session.frozen
    sheet = score_sheet(driver.session, Vocabulary("en", "fagor8070"))
    assert [(one["who"], one["command"]["do"]) for one in sheet["actions"]] == [
        ("operator", "cycle_start"),
        ("trainer", "rewind"),
    ]


def test_what_is_asked_interrupts_catching_up(driver):
    room = driver.session.room
    advance, slices = driver.session.advance, []

    def noted(count=1):
        slices.append(count)
        advance(count)
        if len(slices) == 2:
            driver.ask({"do": "cycle_start"}, "operator", PAGE)

    driver.session.advance = noted
    driver._step(CAUGHT_UP_AT_ONCE_S)
    assert slices == [1, 1]
    driver._step(0.0)
    assert room.slot.running == "program"
    run_for(driver, 0.0)
    assert room.time_s == pytest.approx(CAUGHT_UP_AT_ONCE_S)
    assert driver.lost_s == 0.0


def test_a_machine_that_loses_time_gives_its_precedence_back(driver, monkeypatch):
    given = []
    monkeypatch.setattr("twin.training.server.driver.take_precedence", lambda: True)
    monkeypatch.setattr(
        "twin.training.server.driver.release_precedence", lambda: given.append(driver.lost_s)
    )
    turns = iter(range(100))

    def step(_passed):
        turn = next(turns)
        driver.lost_s = 0.5 if turn >= 3 else 0.0
        if turn == 5:
            driver.stop()

    monkeypatch.setattr(driver, "_step", step)
    driver.serve(promptly=True)
    assert given == [0.5]
