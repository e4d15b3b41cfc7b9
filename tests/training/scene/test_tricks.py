"""Tricks that earn nothing: programs that only end, values found by trying, ways by hand, a new blank."""

import pytest

from twin.training.scene.scene_file import read_scene, scene_names, scene_path
from twin.training.session.commands import TRAINERS
from twin.training.session.session import SceneSession

MOST_SLICES = 3000


def opened(name: str) -> SceneSession:
    return SceneSession(read_scene(scene_path(name)))


def give(session: SceneSession, what: str, **words: object) -> bool:
    return session.submit({"do": what, **words})


def settle(session: SceneSession) -> None:
    """Let time go on until nothing runs and the axes stand."""
    room = session.room
    for _ in range(MOST_SLICES):
        session.advance()
        if room.slot.run is None and not room.machine.moving:
            return
    raise AssertionError("the axes never came to rest")


def states(session: SceneSession) -> list[str]:
    return [verdict.state for verdict in session.room.judge.verdicts]


@pytest.mark.parametrize("name", scene_names())
def test_a_program_that_only_ends_earns_nothing(name):
    session = opened(name)
    ends = "M5" if session.scene.preparation.dialect.name == "codesys" else "M30"
    for _ in session.room.program.lines[1:]:
        assert give(session, "edit", line=2)
    assert give(session, "edit", line=1, text=ends)
    give(session, "cycle_start")
    settle(session)
    assert give(session, "finish")
    assert session.room.judge.score == 0


def test_no_value_of_a_table_is_found_by_trying():
    session = opened("codesys_tool_length")
    for length in (64.0, 67.0, 70.0, 71.0):
        assert give(session, "set_tool", number=1, length=length)
        session.advance()
        assert states(session)[0] == "open"
    give(session, "finish")
    assert states(session)[0] == "failed"
    session = opened("mefi_handwheel")
    assert give(
        session, "set_offset", axis="Z", value=float(session.room.setup.tables.true_zero[2])
    )
    session.advance()
    assert states(session)[0] == "open"


def test_a_place_that_the_program_must_reach_is_not_reached_by_hand():
    session = opened("gost_unwinding")
    give(session, "mode", mode="jog")
    assert give(session, "jog", axis="C", direction=1, step=370.0, feed=14000.0)
    settle(session)
    assert session.room.machine.position[3] == pytest.approx(370.0, abs=0.05)
    assert states(session)[1] == "open"


def test_lines_of_mdi_are_no_lines_of_the_program():
    session = opened("fagor_first_steps")
    give(session, "mode", mode="mdi")
    give(session, "mdi", text="\n\n\n\nG01 X-20 F600")
    assert give(session, "cycle_start")
    session.advance(100)
    assert give(session, "feed_hold")
    session.advance(30)
    assert not session.room.machine.moving
    give(session, "reset")
    settle(session)
    give(session, "mode", mode="single")
    assert give(session, "cycle_start")
    session.advance(100)
    assert session.room.slot.held
    assert session.room.judge.evidence.held == set()


@pytest.mark.parametrize("text", ["G01 X-30 E5 F1000", "G1 X1e308 F1000", "G01 X-30 F1000 X-20"])
def test_a_refused_line_of_mdi_moves_nothing(text):
    session = opened("fagor_first_steps")
    give(session, "mode", mode="mdi")
    before = session.room.machine.position.copy()
    give(session, "mdi", text=text)
    give(session, "cycle_start")
    settle(session)
    assert session.room.machine.position == pytest.approx(before, abs=1e-6)


def test_a_second_blank_is_counted_where_there_is_but_one():
    session = opened("fagor_climb")
    give(session, "mode", mode="jog")
    session.advance()
    assert give(session, "new_blank")
    session.advance()
    assert states(session)[2] == "failed"


def test_a_trainee_cannot_do_what_is_the_trainer_s():
    session = opened("fagor_overtravel")
    asked = {"inject": {"fault": {"kind": "alarm"}}, "rewind": {"seconds": 1.0}}
    for command in TRAINERS:
        name = command.model_fields["do"].default
        assert not give(session, name, **asked.get(name, {}))
        assert session.refusal == "only the trainer can do that"
