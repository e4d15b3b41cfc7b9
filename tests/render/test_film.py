import errno
import itertools
import subprocess
import sys
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import mujoco
import numpy as np
import pytest
from PIL import Image

from tests.render.conftest import RAPID_MOVES, SOURCE, STOCK, TOOL
from twin.errors import RenderError
from twin.job import VideoTable
from twin.machine.config import Machine
from twin.recording import Recording
from twin.render.film import film, still

VIDEO = VideoTable(cameras=("overview", "top"), seconds=2.0, fps=10, size=(321, 181))


def test_film_plays_everywhere_and_has_the_asked_length(scene: Scene, tmp_path: Path) -> None:
    seen = []
    out = film(
        scene,
        video=VIDEO,
        out=tmp_path / "run.mp4",
        progress=lambda done, of: seen.append((done, of)),
    )
    with av.open(str(out)) as container:
        stream = container.streams.video[0]
        assert stream.codec_context.name == "h264"
        assert stream.codec_context.pix_fmt == "yuv420p"
        assert (stream.width, stream.height) == (320, 180)
        assert stream.average_rate == Fraction(10)
        frames = [
            frame.to_ndarray(format="rgb24").astype(int) for frame in container.decode(stream)
        ]
    assert len(frames) == 20
    assert seen[0] == (1, 20)
    assert seen[-1] == (20, 20)
    assert [path.name for path in tmp_path.iterdir() if path.suffix == ".mp4"] == ["run.mp4"]
    change = [np.abs(b - a).mean() for a, b in itertools.pairwise(frames)]
    assert int(np.argmax(change)) == 9, "the second camera takes over in the middle"
    assert all(frame.std() > 20 for frame in frames)


def test_still_shows_the_running_block(scene: Scene, tmp_path: Path) -> None:
    pictures = [
        np.asarray(Image.open(still(**options, out=tmp_path / f"{line}.png", line=line)))
        for line in (2, 3)
    ]
    plain = still(**options, out=tmp_path / "plain.png", line=3, display=False)
    assert pictures[0].shape == (720, 1280, 3)
    accent = [np.all(np.abs(p[:, :300].astype(int) - [0, 96, 143]) < 12, axis=2) for p in pictures]
    rows = [np.flatnonzero(mask.sum(axis=1) > 100).mean() for mask in accent]
    assert 15 < rows[1] - rows[0] < 35, "the mark is one line further down"
    without = np.asarray(Image.open(plain))
    assert np.abs(without[560:, 20:300].astype(int) - pictures[1][560:, 20:300]).mean() > 20


def test_tiny_pictures_and_long_programs_do_not_fail(scene: Scene, tmp_path: Path) -> None:
    options["source"] = ["\tG1 X1\x07 " + "Ž" * 500] * 5000
    small = VideoTable(seconds=0.1, fps=10, size=(64, 64))
    assert film(scene, video=small, out=tmp_path / "tiny.mp4").is_file()
    options["source"] = ()
    assert still(**options, out=tmp_path / "s.png", size=(65, 67), quality="draft").is_file()


def test_a_run_without_stock_is_filmed_too(scene: Scene, tmp_path: Path) -> None:
    options["stock"] = None
    assert film(scene, video=VIDEO, out=tmp_path / "air.mp4").is_file()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"video": VIDEO.model_copy(update={"cameras": ("side",)})}, "has overview, top"),
        ({"video": VIDEO.model_copy(update={"cameras": ()})}, "no camera is named"),
        ({"quality": "best"}, "there are draft, final"),
        ({"video": VIDEO.model_copy(update={"cameras": ("ride",)})}, "part, riding"),
    ],
)
def test_what_cannot_be_filmed_is_refused(
    scene: Scene, tmp_path: Path, change: Options, message: str
) -> None:
    before = sorted(tmp_path.iterdir())
    with pytest.raises(RenderError, match=message):
        film(**{**options, "video": VIDEO, "out": tmp_path / "run.mp4", **change})
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize("suffix", [".gif", ".webp"])
def test_moving_pictures_for_a_page(scene: Scene, tmp_path: Path, suffix: str) -> None:
    out = film(scene, video=VIDEO, out=tmp_path / f"run{suffix}")
    with Image.open(out) as pictures:
        assert getattr(pictures, "n_frames", 1) == 20
        assert pictures.size == (320, 180)
        assert pictures.info["loop"] == 0
        first = np.asarray(pictures.convert("RGB")).astype(int)
        pictures.seek(19)
        last = np.asarray(pictures.convert("RGB")).astype(int)
    assert first.std() > 20
    assert np.abs(last - first).mean() > 5


def test_unknown_format_names_the_known(scene: Scene, tmp_path: Path) -> None:
    with pytest.raises(RenderError, match=r"\.mp4, \.gif, \.webp"):
        film(scene, video=VIDEO, out=tmp_path / "run.avi")


def test_split_picture_shows_all_cameras_at_once(scene: Scene, tmp_path: Path) -> None:
    video = VIDEO.model_copy(update={"layout": "split", "speed": 1.0})
    out = film(scene, video=video, out=tmp_path / "run.mp4")
    with av.open(str(out)) as container:
        frames = [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]
    assert len(frames) == 10, "a run of a second at its own speed"
    left, right = frames[5][40:120, :158].astype(int), frames[5][40:120, 162:].astype(int)
    assert left.std() > 20
    assert right.std() > 20
    assert np.abs(left - right).mean() > 5
    assert frames[5][60:120, 159].mean() > 180, "a line parts the fields"


def test_unwritable_place_is_said(scene: Scene, tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("a file")
    for make in (
        lambda: film(scene, video=VIDEO, out=tmp_path / "taken" / "run.mp4"),
        lambda: still(**options, out=tmp_path / "taken" / "run.png", size=(64, 64)),
    ):
        with pytest.raises(RenderError, match=r"cannot be written"):
            make()


def interrupt(done: int, _: int) -> None:
    if done == 3:
        raise KeyboardInterrupt


def test_interrupted_film_leaves_nothing(scene: Scene, tmp_path: Path) -> None:
    before = sorted(tmp_path.iterdir())
    with pytest.raises(KeyboardInterrupt):
        film(scene, video=VIDEO, out=tmp_path / "run.mp4", progress=interrupt)
    assert sorted(tmp_path.iterdir()) == before


def test_contour_error_is_shown_where_it_is_known(
    scene: Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    readings = []
    draw: Callable[..., Any] = __import__("twin.render.hud").render.hud.Display.draw

    def watched(self: Any, frame: Any, reading: Any) -> Any:
        readings.append(reading)
        return draw(self, frame, reading)

    monkeypatch.setattr("twin.render.hud.Display.draw", watched)
    small = {"out": tmp_path / "s.png", "size": (64, 64), "quality": "draft", "time_s": 0.6}
    still(**options, **small)
    still(**options, **small, contour_um=np.arange(1001.0))
    lag, contour = readings
    assert lag.error_um == pytest.approx(5.0)
    assert contour.error_um == 600.0
    assert lag.line == 3
    assert lag.feed == pytest.approx(80.0 / 0.25 * 60.0, rel=1e-6)
    np.testing.assert_allclose(lag.position, [-40 + 80 * 100 / 250, 0, -5, 0], atol=0.01)


def test_alarms_and_warnings_are_shown_while_they_hold(scene: Scene, tmp_path: Path) -> None:
    def red(name: str, **more: object) -> int:
        out = still(**{**options, "out": tmp_path / name, "quality": "draft", **more})
        chip = np.asarray(Image.open(out))[18:56, 400:880].astype(int)
        return int(np.all(np.abs(chip - [196, 40, 27]) < 10, axis=2).sum())

    alarms = [(0.5, "following error of X")]
    assert red("before.png", time_s=0.4, alarms=alarms) == 0
    assert red("after.png", time_s=0.6, alarms=alarms) > 1000
    options["rapid_moves"] = np.ones(4, np.bool_)
    assert red("warned.png", time_s=0.6) > 1000
    assert red("air.png", time_s=0.1) == 0


def test_full_disk_is_said_and_leaves_nothing(
    scene: Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("twin.render.encoder.VideoWriter._encode", full)
    before = sorted(tmp_path.iterdir())
    with pytest.raises(RenderError, match=r"run\.mp4: .*No space left on device"):
        film(scene, video=VIDEO, out=tmp_path / "run.mp4")
    assert sorted(tmp_path.iterdir()) == before


def test_osmesa_draws_the_same_scene(tmp_path: Path) -> None:
    from twin.render.gl import probe

    if probe("osmesa").error:
        pytest.skip("OSMesa is not installed here")
    code = (
        "import sys, pytest; "
        "sys.exit(pytest.main(['-q', '-p', 'no:cacheprovider', "
        f"'--basetemp={tmp_path / 'osmesa'}', "
        "'tests/render/test_stage.py::test_tool_tip_is_where_the_recording_says']))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        env={"MUJOCO_GL": "osmesa", "PYTHONPATH": ":".join(sys.path), "PATH": "/usr/bin:/bin"},
        cwd=Path(__file__).parents[2],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout
