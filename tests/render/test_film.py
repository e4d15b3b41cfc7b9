import dataclasses
import errno
import itertools
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest
from PIL import Image

from twin.errors import RenderError
from twin.job.job_file import VideoTable
from twin.render.film import film
from twin.render.scene.scene import RenderScene

VIDEO = VideoTable(cameras=("overview", "top"), seconds=2.0, fps=10, size=(321, 181))


def test_film_plays_everywhere_and_has_the_asked_length(scene: RenderScene, tmp_path: Path) -> None:
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


def test_tiny_films_of_long_programs_do_not_fail(scene: RenderScene, tmp_path: Path) -> None:
    long = dataclasses.replace(scene, source=["\tG1 X1\x07 " + "Ž" * 500] * 5000)
    small = VideoTable(seconds=0.1, fps=10, size=(64, 64))
    assert film(long, video=small, out=tmp_path / "tiny.mp4").is_file()


def test_a_run_without_stock_is_filmed_too(scene: RenderScene, tmp_path: Path) -> None:
    bare = dataclasses.replace(scene, stock=None)
    assert film(bare, video=VIDEO, out=tmp_path / "air.mp4").is_file()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"cameras": ("side",)}, "has overview, top"),
        ({"cameras": ()}, "no camera is named"),
        ({"quality": "best"}, "there are draft, final"),
        ({"cameras": ("ride",)}, "part, riding"),
        ({"seconds": 1e6}, "raise video.speed"),
    ],
)
def test_what_cannot_be_filmed_is_refused(
    scene: RenderScene, tmp_path: Path, change: dict[str, object], message: str
) -> None:
    before = sorted(tmp_path.iterdir())
    with pytest.raises(RenderError, match=message):
        film(scene, video=VIDEO.model_copy(update=change), out=tmp_path / "run.mp4")
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize("suffix", [".gif", ".webp"])
def test_moving_pictures_for_a_page(scene: RenderScene, tmp_path: Path, suffix: str) -> None:
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


def test_unknown_format_names_the_known(scene: RenderScene, tmp_path: Path) -> None:
    with pytest.raises(RenderError, match=r"\.mp4, \.gif, \.webp"):
        film(scene, video=VIDEO, out=tmp_path / "run.avi")


def test_split_picture_shows_all_cameras_at_once(scene: RenderScene, tmp_path: Path) -> None:
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


def test_unwritable_place_is_said(scene: RenderScene, tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("a file")
    with pytest.raises(RenderError, match=r"cannot be written"):
        film(scene, video=VIDEO, out=tmp_path / "taken" / "run.mp4")


def interrupt(done: int, _: int) -> None:
    if done == 3:
        raise KeyboardInterrupt


def test_interrupted_film_leaves_nothing(scene: RenderScene, tmp_path: Path) -> None:
    before = sorted(tmp_path.iterdir())
    with pytest.raises(KeyboardInterrupt):
        film(scene, video=VIDEO, out=tmp_path / "run.mp4", progress=interrupt)
    assert sorted(tmp_path.iterdir()) == before


def test_full_disk_is_said_and_leaves_nothing(
    scene: RenderScene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("twin.render.encoder.VideoWriter._encode", full)
    before = sorted(tmp_path.iterdir())
    with pytest.raises(RenderError, match=r"run\.mp4: .*the disk is full"):
        film(scene, video=VIDEO, out=tmp_path / "run.mp4")
    assert sorted(tmp_path.iterdir()) == before


def test_the_display_can_be_left_out(scene: RenderScene, tmp_path: Path) -> None:
    frames = []
    for display in (True, False):
        video = VIDEO.model_copy(update={"seconds": 0.2, "display": display})
        with av.open(str(film(scene, video=video, out=tmp_path / "one.mp4"))) as container:
            frames.append(next(container.decode(video=0)).to_ndarray(format="rgb24").astype(int))
    changed = (np.abs(frames[0] - frames[1]).sum(axis=2) > 60).nonzero()
    assert len(changed[0]) > 500
    middle = np.abs(frames[0] - frames[1])[70:100, 140:180]
    assert middle.mean() < 10, "the panels are at the corners"
