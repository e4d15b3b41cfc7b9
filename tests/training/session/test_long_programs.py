"""Programs of many blocks: the axes do not rest where the program goes on, and memory does not grow with it."""

import dataclasses

import numpy as np
import pytest

from tests.training.session.commanding import do
from twin.nc.text.source import source_from_text
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.session.program_run import CHUNKS_AHEAD, MOVES_AT_ONCE
from twin.training.session.session import Session


def session_of(program: str) -> Session:
    """The first LinuxCNC scene with another program, without its blank."""
    session = Session(read_scene(scene_path("linuxcnc_round_corners")))
    session.room.work = None
    session.room.program = source_from_text(program, "long")
    session.room.lines = tuple(session.room.program.lines)
    return session


def test_a_contour_of_thousands_of_blocks_is_driven_without_a_rest():
    angles = np.linspace(0.0, 40.0 * np.pi, 6000)
    points = (f"X{3.0 * np.cos(a):.4f} Y{3.0 * np.sin(a):.4f}" for a in angles)
    session = session_of("G64 P0.05\nG1 F3000 X3 Y0 Z50\n" + "\n".join(points) + "\nM2\n")
    do(session, "cycle_start")
    speeds = []
    while session.room.running:
        session.advance()
        velocity = session.room.samples.joint_velocity[:, :2]
        speeds.append(60.0 * float(np.hypot(*velocity.T).min()))
    driven = np.flatnonzero(np.array(speeds) > 1500.0)
    assert len(driven) > 100
    assert min(speeds[driven[0] : driven[-1]]) > 1000.0


@pytest.fixture
def endless():
    return session_of("G1 F12000 Z50\no1 while [1]\nX0.2\nX0\no1 endwhile\nM2\n")


def test_of_an_endless_program_only_what_lies_about_the_axes_is_remembered(endless):
    do(endless, "cycle_start")
    most = 0
    for _ in range(30):
        endless.advance(100)
        run = endless.room.run
        assert run is not None
        most = max(most, len(run._walk.blocks))
        assert sum(map(len, run._moves)) <= (2 * CHUNKS_AHEAD + 4) * MOVES_AT_ONCE
    assert run._count > 3 * most
    assert run.modal(int(endless.room.machine.setpoint.move[0])) is not None
    assert run.target(int(endless.room.machine.setpoint.move[0])) is not None


def test_single_block_and_going_back_find_their_way_in_an_endless_program(endless):
    do(endless, "cycle_start")
    endless.advance(1500)
    do(endless, "mode", mode="single")
    lines = []
    for _ in range(4):
        endless.advance(100)
        assert endless.room.held
        lines.append(endless.room.line)
        do(endless, "cycle_start")
    assert set(lines) == {3, 4}
    endless.advance(100)
    before = endless.snapshot()
    endless.advance(500)
    endless.rewind(endless.room.time_s - before.time_s)
    assert dataclasses.astuple(endless.snapshot()).count(before.position) > 0
