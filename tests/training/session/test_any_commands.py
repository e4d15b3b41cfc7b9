"""Whatever is asked of a room in whatever order: it lives, and what it refuses leaves no trace."""

import copy
import dataclasses
import functools
import random
from typing import Any

import hypothesis.strategies as st
import numpy as np
import pytest
from examples import examples
from hypothesis import Phase, given, settings

from twin.training.room.room import Room
from twin.training.scene.scene_file import Scene, read_scene, scene_path
from twin.training.session.session import SceneSession
from twin.training.session.snapshot import take_snapshot

AXES = st.sampled_from(["X", "Y", "Z", "C", "W"])
SIGNS = st.sampled_from([1, -1])
BLOCKS = [
    "G1 X5 F500", "G91 G0 Z-3", "M3", "S2000 M4", "M30", "T2 M6", "G55", "G90 G0 X1", "G2 X1 I5", "M0",
    "N7 G77", "(", "/G0 X3", "G54 X", "G41 X5", "$GOTO N7", "M8 M1", "", "Q", "G0 X9999",
]  # fmt: skip


def command(name: str, /, **given: st.SearchStrategy[Any]) -> st.SearchStrategy[dict[str, Any]]:
    return st.fixed_dictionaries({"do": st.just(name), **given})


NUMBERS = st.sampled_from([0.001, 0.1, 1.0, 7.5, -3.0, 300.0])
COMMANDS = st.one_of(
    command("mode", mode=st.sampled_from(["auto", "single", "jog", "mdi"])),
    command("mode", mode=st.just("jog")),
    command("cycle_start"), command("cycle_start"), command("feed_hold"), command("reset"), command("reset"),
    command("emergency_stop", pressed=st.booleans()),
    command("override", dial=st.sampled_from(["feed", "rapid", "spindle"]), percent=st.sampled_from([0, 50, 100, 120])),
    command("jog", axis=AXES, direction=SIGNS, step=st.sampled_from([0.01, 1.0, 30.0, None]), feed=st.sampled_from([50.0, 3e4])),
    command("jog_stop"),
    command("handwheel", axis=AXES, clicks=st.integers(-100, 100), step=st.sampled_from([0.001, 0.1, 1.0])),
    command("reference"), command("return_to_path"),
    command("search", line=st.integers(0, 12)),
    command("switch", name=st.sampled_from(["optional_stop", "block_skip", "dry_run"]), on=st.booleans()),
    command("mdi", text=st.sampled_from(BLOCKS)),
    command("edit", line=st.integers(1, 12), text=st.sampled_from([*BLOCKS, None])),
    command("undo"), command("reload"),
    command("spindle", on=st.booleans(), speed=st.sampled_from([None, 1.0, 9000.0]), counter_clockwise=st.booleans()),
    command("coolant", on=st.booleans()),
    command("set_zero", axis=AXES, reading=NUMBERS), command("change_tool", number=st.integers(0, 3)), command("new_blank"),
    command("set_offset", axis=AXES, value=NUMBERS, name=st.sampled_from([None, "G54", "G55", "G99"])),
    command("set_tool", number=st.integers(0, 2), length=st.sampled_from([None, 20.0, 900.0]), radius=st.sampled_from([None, 0.0, 5.0])),
    command("add_tool", number=st.integers(1, 4), kind=st.sampled_from(["flat", "drill"]), diameter=st.sampled_from([0.1, 6.0, 100.0]), length=st.sampled_from([20.0, 300.0])),
    command("answer", task=st.integers(1, 3), choice=st.just("R")), command("hint"), command("finish"),
    command("inject", fault=st.fixed_dictionaries({"kind": st.sampled_from(["friction", "backlash", "lost_offset"]), "axis": AXES, "value": NUMBERS})),
    command("inject", fault=st.just({"kind": "alarm"})), command("repair"),
    command("rewind", seconds=st.sampled_from([0.001, 0.3, 9.0])), command("freeze"), command("go_on"),
    command("replay"), command("end_replay"),
)  # fmt: skip
STEPS = st.lists(
    st.tuples(COMMANDS, st.sampled_from([0, 1, 5, 30]), st.sampled_from(["operator", "trainer"])),
    max_size=16,
)


@functools.cache
def scene() -> Scene:
    return read_scene(scene_path("fagor_first_steps"))


def state(room: Room) -> list[Any]:
    """All that a command could change."""
    evidence = dataclasses.asdict(room.judge.evidence)
    return copy.deepcopy([
        take_snapshot(room), tuple(room.manual.moves), room.slot.inherited, room.program.edits, evidence, room.tick,
        room.judge._touched_s, room.judge._trouble, room.judge._hold_line, room.auxiliaries.running_down,
        room.machine.alarm, [room.machine.machine.axis(name) for name in room.machine.machine.axes.names], room.setup.tables.zero.tolist(), room.setup.tables.offsets,
        room.setup.cut._operation.tool.number, None if room.setup.work is None else id(room.setup.work.map),
        None if room.slot.run is None else (id(room.slot.run), room.slot.run.held, room.slot.run._hold_asked, room.slot.run.dropped),
        None if room.slot.suspended is None else (id(room.slot.suspended.run), room.slot.suspended.place.tolist()),
        room.slot.waiting, dataclasses.asdict(room.panel),
    ])  # fmt: skip


def live(session: SceneSession, what: dict[str, Any], slices: int, who: Any) -> None:
    before, room = state(session.room), session.room
    if not session.submit(what, who):
        assert session.refusal
        assert session.room is room
        assert state(room) == before, what
    session.advance(slices)
    room = session.room
    assert np.isfinite(room.machine.position).all()
    assert bool(room.manual.moves) <= (room.slot.running == "jog")
    assert room.alarm is None or room.alarm.code != "internal"


@pytest.mark.seconds("hundreds of commands at a running machine")
@given(STEPS)
@settings(max_examples=examples(12), derandomize=True, deadline=None, phases=[Phase.generate])
def test_random_commands_never_end_the_room_and_leave_no_trace_where_they_are_refused(steps):
    session = SceneSession(scene())
    for step in steps:
        live(session, *step)
    recover(session)


@pytest.mark.seconds("hundreds of commands at a running machine")
@pytest.mark.parametrize("seed", range(3))
def test_after_a_long_quarrel_with_its_panel_the_machine_can_be_started_again(seed):
    session, chance = SceneSession(scene()), random.Random(seed)  # noqa: S311 (no cryptography)
    names = [("jog", {"axis": "X", "direction": 1}), ("jog", {"axis": "Z", "direction": -1, "step": 30.0}),
             ("handwheel", {"axis": "X", "clicks": -40, "step": 1.0}), ("reference", {}), ("jog_stop", {}),
             ("cycle_start", {}), ("cycle_start", {}), ("feed_hold", {}), ("return_to_path", {}), ("reset", {}),
             *(("mode", {"mode": mode}) for mode in ("auto", "single", "jog", "jog", "mdi")),
             ("search", {"line": 5}), ("emergency_stop", {}), ("emergency_stop", {"pressed": False})]  # fmt: skip
    for _ in range(120):
        name, given = chance.choice(names)
        live(session, {"do": name, **given}, chance.choice([0, 1, 3, 20]), "operator")
    recover(session)


def recover(session: SceneSession) -> None:
    """Turn the button free, reset, drive off a switch and out of the part, and run a block."""
    session.submit({"do": "end_replay"}, "trainer")
    session.submit({"do": "go_on"}, "trainer")
    session.submit({"do": "repair"}, "trainer")
    session.submit({"do": "emergency_stop", "pressed": False})
    for _ in range(3):
        session.submit({"do": "reset"})
        session.advance(150)
    room = session.room
    if room.alarm is not None:
        assert room.alarm.code == "hard-limit"
        return
    assert (room.slot.run, room.slot.suspended, room.machine.moving) == (None, None, False)
    for what in (
        {"do": "mode", "mode": "jog"},
        {"do": "jog", "axis": "Z", "direction": 1, "step": 0.5},
    ):
        assert session.submit(what), session.refusal
    session.advance(200)
    assert room.slot.run is None
