"""Programs of many blocks: the axes do not rest where the program goes on, and memory does not grow with it."""

import numpy as np
import pytest

from tests.training.session.commanding import do
from twin.motion import corner_candidates
from twin.training.program.block_tracker import FORGOTTEN_AT_ONCE
from twin.training.program.program_run import MOVES_AT_ONCE, PLANNED_AT_REST
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.session.session import SceneSession


def session_of(program: str) -> SceneSession:
    """The first LinuxCNC scene with another program, without its blank."""
    session = SceneSession(read_scene(scene_path("linuxcnc_round_corners")))
    session.room.setup.work = None
    session.room.program.load(program)
    return session


@pytest.fixture(scope="module")
def contour():
    """Speeds on a contour of 6000 blocks [mm/min], and what is remembered of it near its end."""
    angles = np.linspace(0.0, 40.0 * np.pi, 6000)
    points = (f"X{3.0 * np.cos(a):.4f} Y{3.0 * np.sin(a):.4f}" for a in angles)
    session = session_of("G64 P0.05\nG1 F3000 X3 Y0 Z50\n" + "\n".join(points) + "\nM2\n")
    do(session, "cycle_start")
    speeds, remembered = [], []
    while session.room.slot.running:
        session.advance()
        velocity = session.room.samples.joint_velocity[:, :2]
        speeds.append(60.0 * float(np.hypot(*velocity.T).min()))
        run, move = session.room.slot.run, int(session.room.machine.setpoint.move[0])
        if run is not None and move > 5900:
            remembered.append(
                (len(run.reader.tracker.blocks), sum(map(len, run.reader.moves._moves)))
            )
            state, target = run.modal(move), run.reader.moves.target(move)
            assert state is not None
            assert target is not None
            assert state.line == session.room.line
    return np.array(speeds), remembered


def test_a_contour_of_thousands_of_blocks_is_driven_without_a_rest(contour):
    speeds, _ = contour
    driven = np.flatnonzero(speeds > 1500.0)
    assert len(driven) > 100
    assert min(speeds[driven[0] : driven[-1]]) > 1000.0


def test_what_lies_behind_the_axes_is_forgotten(contour):
    _, remembered = contour
    assert max(blocks for blocks, _ in remembered) <= 2 * FORGOTTEN_AT_ONCE
    assert max(moves for _, moves in remembered) <= 2 * MOVES_AT_ONCE


def test_the_room_is_heard_while_the_corners_of_a_program_are_tried(monkeypatch):
    """A corner beside an arc is planned in three ways, two of them in parts: a slice of time tries few of them."""
    tried = []
    seconds = corner_candidates.seconds_alone

    def counted(pieces, limits):
        tried.append(pieces)
        return seconds(pieces, limits)

    monkeypatch.setattr(corner_candidates, "seconds_alone", counted)
    bend = "G64 P0.05\nG1 X3 Y1\nG2 X6 Y1 R2\nG1 X8 Y0\nG61.1\nX0 Y0\n"
    session = session_of("G1 F3000 X0 Y0 Z50\n" + bend * 60 + "M2\n")
    do(session, "cycle_start")
    in_a_slice = []
    for _ in range(8):
        before = len(tried)
        session.advance()
        in_a_slice.append(len(tried) - before)
    assert max(in_a_slice) == 4 * PLANNED_AT_REST
    assert sum(in_a_slice) > max(in_a_slice)
    assert np.any(session.room.samples.joint_velocity)


@pytest.fixture
def endless():
    return session_of("G1 F12000 Z50\no1 while [1]\nX0.2\nX0\no1 endwhile\nM2\n")


@pytest.mark.seconds("an endless program runs for a while")
def test_single_block_and_going_back_find_their_way_in_an_endless_program(endless):
    do(endless, "cycle_start")
    endless.advance(1500)
    do(endless, "mode", mode="single")
    lines = []
    for _ in range(6):
        endless.advance(100)
        assert endless.room.slot.held
        lines.append(endless.room.line)
        do(endless, "cycle_start")
    after = {2: 3, 3: 4, 4: 5, 5: 2}
    assert lines[1:] == [after[line] for line in lines[:-1]]
    endless.advance(100)
    before = endless.snapshot()
    endless.advance(500)
    endless.rewind(endless.room.time_s - before.time_s)
    assert endless.snapshot().position == before.position
