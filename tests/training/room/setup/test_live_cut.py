"""The cut in the room: what tool and spindle bear is shown, and a tool that breaks is reported."""

import dataclasses
import math
from pathlib import Path

import pytest

from twin.training.scene.scene_file import read_scene, scene_names, scene_path
from twin.training.server.attempts import CELLS_ACROSS
from twin.training.session.session import SceneSession

SCENE = """
schema = 1
title = {{ en = "t" }}
story = {{ en = "s" }}
[job]
program = "p.nc"
dialect = "fagor8070"
[job.start]
Z = 20.0
[job.stock]
shape = "box"
size = [60.0, 40.0, 20.0]
cell = 0.5
{material}
[[job.tools]]
number = 1
diameter = 8.0
length = 60.0
[[tasks]]
text = {{ en = "x" }}
no_alarm = ["any"]
"""
SLOT = "%S\nN10 G90 S4000 M3\nN20 G0 X-40 Y0 Z-2\nN30 G1 X20 F{feed}\nN40 G0 Z50\nN50 M30\n"


def session_of(
    folder: Path, feed: float, material: str = 'material = "C45"', slot: str = SLOT
) -> SceneSession:
    (folder / "p.nc").write_text(slot.format(feed=feed))
    (folder / "scene.toml").write_text(SCENE.format(material=material))
    return SceneSession(read_scene(folder / "scene.toml"))


def do(session: SceneSession, what: str, /, **arguments: object) -> None:
    assert session.submit({"do": what, **arguments}), session.refusal
    session.advance()


def finish(session: SceneSession) -> None:
    while session.room.slot.run is not None or session.room.machine.moving:
        session.advance()
        assert session.room.time_s < 60.0


def run_to_end(session: SceneSession) -> None:
    do(session, "cycle_start")
    finish(session)


def test_a_cut_loads_tool_and_spindle_and_air_does_not(tmp_path):
    session = session_of(tmp_path, 600)
    assert session.snapshot().loads.force == 0.0
    do(session, "cycle_start")
    while session.room.line < 4 or session.room.machine.position[0] < -10.0:
        session.advance()
    loads = session.snapshot().loads
    assert 100.0 < loads.force < 1000.0
    assert 0.0 < loads.force_share < 1.0
    assert loads.chip == pytest.approx(600 / 4000 / 2, rel=0.05)
    assert 0.01 < loads.spindle < 1.0
    assert loads.bend > 0.001
    assert loads.spindle_speed == pytest.approx(4000, rel=0.01)
    finish(session)
    assert session.snapshot().loads.force == 0.0


def test_the_axes_wait_for_the_spindle(tmp_path):
    session = session_of(tmp_path, 600)
    do(session, "cycle_start")
    while not session.room.machine.moving:
        session.advance()
    assert session.snapshot().loads.spindle_speed == pytest.approx(4000, rel=0.01)


def test_without_a_material_no_force_is_shown(tmp_path):
    session = session_of(tmp_path, 6000, "")
    run_to_end(session)
    assert math.isnan(session.snapshot().loads.force)
    assert session.room.alarm is None


@pytest.mark.seconds("a tool is worn until it breaks")
def test_a_broken_tool_is_told_and_goes_on_until_it_is_changed(tmp_path):
    session = session_of(tmp_path, 6000)
    run_to_end(session)
    room = session.room
    notice = session.snapshot().broken
    assert notice is not None
    assert (notice.code, notice.line, notice.block) == ("tool-broken", 4, "N30")
    assert "chip of" in notice.message
    assert room.alarm is None
    assert room.alarms.history[-1] == notice
    assert room.alarms.moments[-1].text.startswith("N30")
    assert room.judge.evidence.alarms == ["tool-broken"]
    # It went to its end without an edge: most of the slot is not there.
    assert room.setup.work is not None
    cut, whole = room.setup.work.removed, 2.0 * (8.0 * 50.0 + 0.5 * math.pi * 4.0**2)
    assert cut < 0.2 * whole
    run_to_end(session)
    assert room.setup.work.removed == cut
    assert len(room.alarms.history) == 1

    do(session, "mode", mode="jog")
    do(session, "new_blank")
    assert session.snapshot().broken == notice
    do(session, "change_tool", number=1)
    assert session.snapshot().broken is None
    do(session, "override", dial="feed", percent=10)
    do(session, "mode", mode="auto")
    run_to_end(session)
    assert session.snapshot().broken is None
    assert room.setup.work.removed == pytest.approx(whole, rel=0.05)


def test_a_rapid_of_a_broken_tool_into_the_stock_is_an_alarm(tmp_path):
    """It has no edge, and yet it is in the way; what it leaves on its way up is no collision."""
    back = SLOT.replace("N40 G0 Z50", "N35 G0 Z20\nN36 X-40\nN37 Z-2\nN38 X-20\nN40 G0 Z50")
    session = session_of(tmp_path, 6000, slot=back)
    run_to_end(session)
    room = session.room
    assert room.alarms.broken[1].line == 4
    assert room.alarm is not None
    assert (room.alarm.code, room.alarm.line) == ("rapid-into-stock", 8)
    assert room.setup.work is not None
    assert room.setup.work.measured(0.0, 0.0, 0.0) == 0.0


def test_going_back_mends_a_tool_that_broke_since(tmp_path):
    session = session_of(tmp_path, 6000)
    run_to_end(session)
    assert session.snapshot().broken is not None
    session.rewind(session.room.time_s - 0.5)
    assert session.snapshot().broken is None
    assert not session.room.alarms.history
    finish(session)
    assert session.snapshot().broken is not None


def test_every_shipped_scene_cuts_a_named_material():
    for name in scene_names():
        preparation = read_scene(scene_path(name)).preparation
        stock = preparation.job.file.stock
        if stock is None:
            # Nothing is there that could be cut: a fixture is what swings up.
            assert preparation.machine.part_frame.chain is not None, name
            continue
        assert stock.material, name


@pytest.mark.parametrize("cells_across", [0, CELLS_ACROSS])
def test_the_spindle_stalls_before_the_teeth_break_on_the_pages_fine_grid_too(cells_across):
    scene = dataclasses.replace(read_scene(scene_path("mefi_stall")), cells_across=cells_across)
    session = SceneSession(scene)
    assert session.submit({"do": "cycle_start"})
    while session.room.slot.running and session.room.alarm is None:
        session.advance(10)
    assert session.room.alarm is not None
    assert session.room.alarm.code == "spindle-stall"
