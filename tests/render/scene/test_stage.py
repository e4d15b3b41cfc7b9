"""What is on the picture, by segmentation and coarse statistics: it holds on any OpenGL."""

import dataclasses

import mujoco
import numpy as np
import pytest
import trimesh

from tests.render.conftest import SUMMARY, TOOL, Record
from twin.cutting.tools import profile
from twin.job.job_file import StockTable, ToolTable
from twin.machine.description.config import MachineConfig
from twin.nc.canonical import FloatArray
from twin.recording.reader import Recording, open_recording
from twin.render.drawing.canvas import (
    DRAFT,
    FINAL,
    HIDDEN_GROUP,
    SHOWN_GROUPS,
    Pixels,
    Quality,
)
from twin.render.frames import deal
from twin.render.scene.placement import tip_position
from twin.render.scene.scene import RenderScene
from twin.render.scene.stage import ScenePlayer, stage
from twin.render.scene.tool_body import fluted
from twin.render.still import moment
from twin.toolpath.tool_plan import ToolPlan

SIZE = (320, 240)


def play_to(play: ScenePlayer, recording: Recording, samples: int) -> None:
    for chunk, _ in deal(recording, np.array([samples])):
        play.advance(chunk)


def projected(play: ScenePlayer, camera: str, point: FloatArray) -> tuple[float, float]:
    """Column and row of a point of the world."""
    model, data = play.model, play.data
    eye = data.camera(camera)
    seen = eye.xmat.reshape(3, 3).T @ (point - eye.xpos)
    focal = 0.5 * SIZE[1] / np.tan(0.5 * np.deg2rad(model.camera(camera).fovy[0]))
    return SIZE[0] / 2 - focal * seen[0] / seen[2], SIZE[1] / 2 + focal * seen[1] / seen[2]


@pytest.mark.seconds("a stage is built and drawn")
@pytest.mark.parametrize("line", [2, 3, 4])
def test_tool_tip_is_where_the_recording_says(scene: RenderScene, line: int) -> None:
    with stage(scene, SIZE, DRAFT) as play:
        play_to(play, scene.recording, moment(scene.recording, line=line) - 60)
        tool = play.objects("overview") == int(play.model.geom("cutter_1").id)
        tip = tip_position(play.model, play.data, TOOL.length)
        column, row = projected(play, "overview", tip)
    rows, columns = np.nonzero(tool)
    assert rows.max() == pytest.approx(row, abs=4)
    assert columns[rows > rows.max() - 5].mean() == pytest.approx(column, abs=2)


def test_a_change_of_tool_is_seen(scene: RenderScene) -> None:
    long = ToolTable(number=2, kind="drill", diameter=8.0, length=55.0)
    changed = dataclasses.replace(
        scene, summary=dataclasses.replace(SUMMARY, tools=ToolPlan((TOOL, long), (0, 2)))
    )
    with stage(changed, SIZE, DRAFT) as play:
        for line, number in ((2, 1), (3, 2)):
            rest = [s for s, _ in deal(scene.recording, np.array([300, 600]))][number - 1]
            play.advance(rest)
            seen = set(np.unique(play.objects("overview")).tolist())
            assert int(play.model.geom(f"cutter_{number}").id) in seen, line
            assert int(play.model.geom(f"cutter_{3 - number}").id) not in seen
            length = (TOOL, long)[number - 1].length
            tip = tip_position(play.model, play.data, length)
            part = scene.recording.header.part_frame.position(rest.joint_position[-1:])
            part[:, 2] -= length - TOOL.length
            body = play.data.body("rotary_table")
            point = body.xpos + body.xmat.reshape(3, 3) @ play.placement.points(part)[0]
            np.testing.assert_allclose(tip, point, atol=1e-9)


@pytest.mark.parametrize(
    "tool",
    [
        TOOL,
        ToolTable(number=1, kind="ball"),
        ToolTable(number=1, kind="bull", corner=2.0),
        ToolTable(number=1, kind="drill"),
        ToolTable(number=1, kind="chamfer", tip=1.0, teeth=5),
    ],
    ids=lambda tool: tool.kind,
)
def test_drawn_cutter_lies_within_its_profile(tool: ToolTable) -> None:
    vertices, faces = fluted(tool)
    radius = np.hypot(vertices[:, 0], vertices[:, 1])
    assert np.all(
        vertices[:, 2] >= profile(tool).height(np.minimum(radius, tool.diameter / 2)) - 1e-6
    )
    assert radius.max() == pytest.approx(tool.diameter / 2, rel=1e-3)
    assert vertices[:, 2].min() == 0.0
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    assert mesh.is_watertight
    assert mesh.volume > 0


def stock_pixels(play: ScenePlayer, camera: str) -> np.ndarray[tuple[int, int], np.dtype[np.bool_]]:
    names = [play.model.geom(number).name.startswith("stock") for number in range(play.model.ngeom)]
    return np.array([*names, False])[play.objects(camera)]


def groove(before: Pixels, after: Pixels) -> np.ndarray[tuple[int, int], np.dtype[np.bool_]]:
    return np.abs(after.astype(int) - before.astype(int)).max(axis=2) > 12


@pytest.fixture(params=[False, True], ids=["height map", "tri-dexel"])
def stocked(scene: RenderScene, request: pytest.FixtureRequest) -> RenderScene:
    """The same cuts with either description of the material."""
    summary = dataclasses.replace(scene.summary, tilts=request.param)
    return dataclasses.replace(scene, summary=summary)


@pytest.mark.seconds("a stage is built and drawn")
def test_groove_is_where_the_tool_was(stocked: RenderScene) -> None:
    with stage(stocked, SIZE, DRAFT) as play:
        blank, stock = play.picture("top"), stock_pixels(play, "top")
        play_to(play, stocked.recording, moment(stocked.recording, line=3))
        # Away from tool and trail: the slot is 10 mm wide along X from -40 to 40.
        cut = groove(blank, play.picture("top"))
        body = play.data.body("rotary_table")

        def at(x: float, y: float) -> bool:
            part = np.array([[x, y, -235.0]])
            local = play.placement.points(part)[0]
            world = body.xpos + body.xmat.reshape(3, 3) @ local
            column, row = projected(play, "top", world)
            return bool(cut[round(row), round(column)])

        stock_now = stock_pixels(play, "top")
        for x in (-35.0, -20.0, 0.0, 20.0):
            assert at(x, 3.0)
            assert at(x, -3.0)
    assert stock.sum() > 2000
    assert stock_now.sum() > 0.5 * stock.sum()


def test_stock_turns_with_the_table(stocked: RenderScene) -> None:
    with stage(stocked, SIZE, DRAFT) as play:
        play_to(play, stocked.recording, moment(stocked.recording, line=1))
        rows, columns = np.nonzero(stock_pixels(play, "top"))
        lying = np.ptp(columns) / np.ptp(rows)
        play_to(play, stocked.recording, 0)
        play.advance(next(iter(stocked.recording.chunks()))[-1:])
        rows, columns = np.nonzero(stock_pixels(play, "top"))
        standing = np.ptp(columns) / np.ptp(rows)
    assert lying > 1.2
    assert standing < 0.85


def test_trail_grows(scene: RenderScene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("twin.render.scene.stage.TRAIL_MM", (2.0, 2.0))

    def visible(play: ScenePlayer) -> int:
        names = [
            play.model.geom(number).name.startswith("trail") for number in range(play.model.ngeom)
        ]
        return int(np.array([*names, False])[play.objects("top")].sum())

    scene = dataclasses.replace(scene, stock=None)
    with stage(scene, SIZE, DRAFT) as play:
        assert visible(play) == 0
        play_to(play, scene.recording, moment(scene.recording, line=3))
        slot = visible(play)
        assert slot > 10
        rest = [samples for samples, _ in deal(scene.recording, np.array([751, 1001]))][1]
        play.advance(rest)
        assert visible(play) > slot + 10


def trail_colour(scene: RenderScene) -> FloatArray:
    """Mean colour of the trail when the run has ended, seen from above."""
    with stage(scene, SIZE, DRAFT) as play:
        play_to(play, scene.recording, 1001)
        names = [
            play.model.geom(number).name.startswith("trail") for number in range(play.model.ngeom)
        ]
        here = np.array([*names, False])[play.objects("top")]
        return play.picture("top")[here].astype(float).mean(axis=0)


def test_trail_shows_the_error(
    make_recording: Record,
    spec: mujoco.MjSpec,
    machine: MachineConfig,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("twin.render.scene.stage.TRAIL_MM", (2.0, 2.0))
    feeds = dataclasses.replace(SUMMARY, rapid=np.zeros(4, np.bool_))
    colours = []
    for error in (0.0, 25.0):
        with open_recording(make_recording(np.full(1001, error))) as recording:
            scene = RenderScene(
                recording=recording, spec=spec, machine=machine, summary=feeds, error_scale_um=20.0
            )
            colours.append(trail_colour(scene))
    assert colours[0][1] > colours[0][0] + 30, "green"
    assert colours[1][0] > colours[1][1] + 60, "red"


@pytest.mark.parametrize("camera", ["part", "riding"])
def test_part_cameras_see_the_stock_in_the_middle(scene: RenderScene, camera: str) -> None:
    middles = []
    with stage(scene, SIZE, DRAFT) as play:
        for samples in (1, 1000):
            play_to(play, scene.recording, samples)
            rows, columns = np.nonzero(stock_pixels(play, camera))
            middles.append((np.ptp(columns), columns.mean(), rows.mean()))
            assert len(rows) > 0.08 * SIZE[0] * SIZE[1]
            assert columns.mean() == pytest.approx(SIZE[0] / 2, abs=25)
            assert rows.mean() == pytest.approx(SIZE[1] / 2, abs=40)
            assert rows.min() > 0
            assert rows.max() < SIZE[1] - 1
    turned = abs(middles[1][0] - middles[0][0]) > 10
    assert turned == (camera == "part"), "the riding camera turns with the stock"


@pytest.mark.seconds("two stages are built and drawn")
def test_a_hole_through_the_stock_shows_the_table(stocked: RenderScene) -> None:
    thin = StockTable(shape="box", size=(100.0, 100.0, 4.0), position=(0, 0, -4), cell=0.5)
    with stage(dataclasses.replace(stocked, stock=thin), SIZE, DRAFT) as play:
        plate = int(play.model.geom("plate").id)
        before = (play.objects("top") == plate).sum()
        play_to(play, stocked.recording, moment(stocked.recording, line=3))
        after = (play.objects("top") == plate).sum()
    assert after < before, "the sheet floats over the plate, and the slot is not through yet"
    through = thin.model_copy(update={"position": (0.0, 0.0, -3.0), "size": (100.0, 100.0, 1.5)})
    with stage(dataclasses.replace(stocked, stock=through), SIZE, DRAFT) as play:
        before = (play.objects("top") == plate).sum()
        play_to(play, stocked.recording, moment(stocked.recording, line=3))
        after = (play.objects("top") == plate).sum()
    assert after > before + 100


def test_a_stock_that_is_cut_away_is_seen_no_more(stocked: RenderScene) -> None:
    sliver = StockTable(shape="box", size=(60.0, 6.0, 3.0), position=(0.0, 0.0, -1.0), cell=0.5)
    with stage(dataclasses.replace(stocked, stock=sliver), SIZE, DRAFT) as play:
        before = stock_pixels(play, "top").sum()
        play_to(play, stocked.recording, moment(stocked.recording, line=3))
        after = stock_pixels(play, "top").sum()
    assert before > 50
    assert after == 0


@pytest.mark.seconds("pictures are drawn without a graphics card")
@pytest.mark.parametrize("quality", [DRAFT, dataclasses.replace(DRAFT, passes=3)])
def test_frames_that_are_drawn_ahead_are_those_drawn_one_by_one(
    scene: RenderScene, quality: Quality
) -> None:
    ends = np.linspace(100, 1000, 5).astype(int)
    drawn: list[list[Pixels]] = [[], []]
    with stage(scene, SIZE, quality) as play:
        for chunk, due in deal(scene.recording, ends):
            play.advance(chunk)
            if due:
                drawn[0].append(play.picture("overview"))
    with stage(scene, SIZE, quality) as play:
        begun = None
        for chunk, due in deal(scene.recording, ends):
            play.advance(chunk)
            if due:
                play.refresh()
                if begun is not None:
                    drawn[1].append(begun())
                begun = play.begin_picture("overview")
        assert begun is not None
        drawn[1].append(begun())
    assert np.array_equal(drawn[0], drawn[1])
    assert not np.array_equal(drawn[0][1], drawn[0][3])


def test_the_order_of_drawing_hides_nothing_and_leaves_the_model_as_it_was(
    scene: RenderScene,
) -> None:
    with stage(scene, SIZE, DRAFT) as play:
        play_to(play, scene.recording, 400)
        play.refresh()
        groups = play.model.geom_group.copy()
        first = play.begin_picture("overview")()
        assert np.array_equal(play.model.geom_group, groups)
        for group in SHOWN_GROUPS:
            play.model.geom_group[np.isin(groups, SHOWN_GROUPS)] = group
            assert np.array_equal(play.begin_picture("overview")(), first)
        play.model.geom_group[:] = HIDDEN_GROUP
        assert not np.array_equal(play.begin_picture("overview")(), first)


@pytest.mark.seconds("pictures are drawn without a graphics card")
def test_shadows_fall(scene: RenderScene) -> None:
    pictures = []
    for quality in (DRAFT, dataclasses.replace(DRAFT, passes=4)):
        with stage(scene, SIZE, quality) as play:
            play_to(play, scene.recording, 500)
            pictures.append(play.picture("overview").astype(float))
    darker = pictures[0] - pictures[1] > 8
    assert darker.any(axis=2).sum() > 20


@pytest.mark.seconds("pictures are drawn without a graphics card")
def test_passes_smooth_edges_and_shadows(scene: RenderScene) -> None:
    """Between the levels of a rough picture lie those of a smooth one."""
    levels = []
    for passes in (1, 8):
        with stage(scene, SIZE, dataclasses.replace(DRAFT, passes=passes)) as play:
            play_to(play, scene.recording, 500)
            picture = play.picture("overview")
            again = play.picture("overview")
            assert np.abs(picture.astype(int) - again).mean() < 2, "only the tool and chips turn"
            levels.append(len(np.unique(picture.reshape(-1, 3), axis=0)))
    assert levels[1] > 1.5 * levels[0]


def test_a_still_gets_more_passes_than_a_frame_and_a_draft_one() -> None:
    assert FINAL.for_still.passes > FINAL.passes > 1
    assert FINAL.for_still.drawn_cells == FINAL.drawn_cells
    assert DRAFT.for_still == DRAFT
    assert DRAFT.passes == 1


def test_moments(recording: Recording) -> None:
    assert moment(recording) == 1001
    assert moment(recording, time_s=0.0) == 1
    assert moment(recording, time_s=0.5) == 501
    assert moment(recording, line=1) == 250
    assert moment(recording, line=4) == 1001
