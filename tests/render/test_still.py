import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from PIL import Image

from tests.render.conftest import SOURCE, STOCK, SUMMARY, Record
from twin.cutting.forces.tool_strength import tool_strength
from twin.cutting.program_summary import Screen, Steps
from twin.errors import RenderError
from twin.job.job_file import ToolTable
from twin.machine.description.config import MachineConfig
from twin.recording.form import STEPS, ToolLoad
from twin.recording.reader import open_recording
from twin.render.frames import deal
from twin.render.gauge import Gauge, load_bars
from twin.render.hud import LoadBar
from twin.render.scene.scene import RenderScene
from twin.render.still import Shot, moment, stills


def take(scene: RenderScene, out: Path, end: int, **more: Any) -> np.ndarray[Any, Any]:
    stills(scene, [Shot(out, end)], **{"quality": "draft", **more})
    return np.asarray(Image.open(out)).astype(int)


@pytest.mark.seconds("a run is drawn at several moments")
def test_one_pass_draws_all_moments_with_the_running_block(
    scene: RenderScene, tmp_path: Path
) -> None:
    shots = [Shot(tmp_path / f"{line}.png", moment(scene.recording, line=line)) for line in (3, 2)]
    stills(scene, shots)
    pictures = [np.asarray(Image.open(tmp_path / f"{line}.png")).astype(int) for line in (2, 3)]
    plain = take(scene, tmp_path / "plain.png", shots[0].end, quality="final", display=False)
    assert pictures[0].shape == (720, 1280, 3)
    accent = [np.all(np.abs(picture[:, :300] - [0, 96, 143]) < 12, axis=2) for picture in pictures]
    rows = [np.flatnonzero(mask.sum(axis=1) > 100).mean() for mask in accent]
    assert 15 < rows[1] - rows[0] < 35, "the mark is one line further down"
    assert np.abs(plain[560:, 20:300] - pictures[1][560:, 20:300]).mean() > 20


def test_odd_sizes_and_programs_that_are_not_there(scene: RenderScene, tmp_path: Path) -> None:
    bare = dataclasses.replace(scene, source=())
    assert take(bare, tmp_path / "s.png", 500, size=(65, 67)).shape == (67, 65, 3)


def test_unwritable_place_is_said(scene: RenderScene, tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("a file")
    with pytest.raises(RenderError, match=r"cannot be written"):
        take(scene, tmp_path / "taken" / "run.png", 500, size=(64, 64))


@pytest.mark.parametrize(
    ("wanted", "message"),
    [({"line": 9}, "line 9 of the program moved nothing"), ({"time_s": 2.0}, "it ends at 1 s")],
)
def test_moments_that_never_were_are_refused(
    scene: RenderScene, wanted: dict[str, Any], message: str
) -> None:
    with pytest.raises(RenderError, match=message):
        moment(scene.recording, **wanted)


def gauge_at(scene: RenderScene, end: int) -> Gauge:
    gauge = Gauge(scene)
    for samples, _ in deal(scene.recording, np.array([end])):
        gauge.add(samples)
    return gauge


def no_warning(_: int) -> str:
    return ""


def test_display_reads_the_lag_where_nobody_compared(scene: RenderScene) -> None:
    reading = gauge_at(scene, 601).reading(no_warning)
    # Two recorded positions, each rounded to its step.
    assert reading.error_um == pytest.approx(5.0, abs=1e3 * STEPS["joint/position"])
    assert reading.line == 3
    assert reading.feed == pytest.approx(80.0 / 0.25 * 60.0, rel=1e-6)
    np.testing.assert_allclose(reading.position, [-40 + 80 * 100 / 250, 0, -5, 0], atol=0.01)


def test_display_reads_contour_spindle_tool_and_the_screens_own_position(
    make_recording: Record, spec: mujoco.MjSpec, machine: MachineConfig
) -> None:
    summary = dataclasses.replace(
        SUMMARY,
        spindle=Steps((0, 2), (None, -800.0)),
        screen=Steps(
            (0, 2),
            (Screen(np.eye(3), np.zeros(4)), Screen(np.eye(3), np.array([0.0, 0.0, 0.0, -360.0]))),
        ),
    )
    with open_recording(make_recording(np.arange(1001.0))) as recording:
        scene = RenderScene(
            recording=recording,
            spec=spec,
            machine=machine,
            summary=summary,
            source=SOURCE,
            stock=STOCK,
        )
        reading = gauge_at(scene, 601).reading(no_warning)
        before = gauge_at(scene, 301).reading(no_warning)
    assert reading.error_um == 600.0
    assert (before.spindle, reading.spindle) == (None, -800.0)
    assert reading.tool == 1
    assert reading.position[3] - before.position[3] == pytest.approx(-360.0)


def red(picture: np.ndarray[Any, Any]) -> int:
    """Pixels of the alarm's chip."""
    chip = picture[18:56, 400:880]
    return int(np.all(np.abs(chip - [196, 40, 27]) < 10, axis=2).sum())


def test_alarms_are_shown_from_their_moment_on(
    make_recording: Record, spec: mujoco.MjSpec, machine: MachineConfig, tmp_path: Path
) -> None:
    alarms: Sequence[tuple[float, str]] = [(0.5, "following error of X")]
    with open_recording(make_recording(alarms=alarms)) as recording:
        scene = RenderScene(
            recording=recording, spec=spec, machine=machine, summary=SUMMARY, stock=STOCK
        )
        assert red(take(scene, tmp_path / "before.png", 401)) == 0
        assert red(take(scene, tmp_path / "after.png", 601)) > 1000


def test_a_block_that_spoils_the_part_is_warned_of(scene: RenderScene, tmp_path: Path) -> None:
    spoiled = dataclasses.replace(
        scene, summary=dataclasses.replace(SUMMARY, rapid=np.ones(4, np.bool_))
    )
    assert red(take(spoiled, tmp_path / "warned.png", 601)) > 1000
    assert red(take(spoiled, tmp_path / "air.png", 101)) == 0


def test_load_bars_are_shares_of_what_tool_and_spindle_bear() -> None:
    tool, nothing = ToolTable(number=1, force_limit=800.0, chip_limit=0.1), np.zeros(1)
    bend = 0.5 * tool_strength(tool).compliance * 800.0
    load = ToolLoad(
        force=np.zeros((1, 3)),
        peak_force=np.array([600.0]),
        power=nothing,
        chip=np.array([0.11]),
        deflection=np.array([[bend, 0.0, 0.0]]),
        spindle_speed=nothing,
        spindle_load=np.array([0.43]),
        broken=nothing > 0.0,
    )
    force, spindle, bending, chip = load_bars(load, tool)
    assert (force.text, force.share) == ("600 N", pytest.approx(0.75))
    assert (spindle.text, spindle.share) == ("43 %", pytest.approx(0.43))
    assert (chip.text, chip.share) == ("0.110 mm", pytest.approx(1.1))
    assert bending.share == pytest.approx(0.5)
    assert bending.text.endswith(" µm")


def test_load_bars_move_and_are_shown_only_where_force_was_simulated(scene: RenderScene) -> None:
    gauge = gauge_at(scene, 601)
    display, reading = gauge.display((1280, 720), None), gauge.reading(no_warning)
    assert reading.loads == ()
    black = np.zeros((720, 1280, 3), np.uint8)
    bare = display.draw(black, reading)
    pictures = [
        display.draw(black, dataclasses.replace(reading, loads=(LoadBar("force", "1 N", share),)))
        for share in (0.0, 0.4, 0.8, 5.0)
    ]
    changed = np.argwhere((pictures[0] != bare).any(axis=2))
    assert changed[:, 1].min() > 900, "at the right, above the axes"
    inks = [(38, 132, 88), (214, 137, 16), (196, 40, 27)]
    filled = [[int((picture == ink).all(axis=2).sum()) for ink in inks] for picture in pictures]
    assert filled[0] == [0, 0, 0]
    green, amber, red_ = filled[1][0], filled[2][1], filled[3][2]
    assert 0 < green < amber < red_
    assert [sum(row) for row in filled[1:]] == [green, amber, red_]


def test_what_a_frame_shows_is_not_left_on_the_next(scene: RenderScene) -> None:
    gauge = gauge_at(scene, 601)
    display, reading = gauge.display((1280, 720), 2.0), gauge.reading(no_warning)
    other = dataclasses.replace(reading, position=reading.position + 123.4, tool=7, time_s=77.7)
    grey = np.full((720, 1280, 3), 90, np.uint8)
    first, second, again = (display.draw(grey, each) for each in (reading, other, reading))
    assert np.array_equal(first, again)
    assert 200 < (first != second).any(axis=2).sum() < 20_000
    assert (grey == 90).all()
