"""``twin render``, as a shell would call it, on a small job of two tools."""

import json
import math
from pathlib import Path

import av
import pytest
import trimesh
from command_line import Twin
from PIL import Image

from twin.render.drawing import renderer as renderers
from twin.render.drawing.gl import FILAMENT, Probe, probe

PROGRAM = """S2000 M3
G0 X-20 Z2
G1 Z-3 F800
G1 X20
G0 Z20
T2 M6
G43 M3
G0 X0 Y10
G1 Z-5 F300
G0 Z20
M30
"""
JOB = """program = "two.nc"
dialect = "gost"
[start]
Z = 20.0
[stock]
shape = "box"
size = [60.0, 40.0, 12.0]
cell = 0.5
[[tools]]
number = 1
[[tools]]
number = 2
kind = "drill"
diameter = 6.0
length = 70.0
flute = 30.0
[[fixtures]]
name = "stop"
diameter = 12.0
height = 30.0
position = [45.0, 0.0, 0.0]
[video]
cameras = ["part"]
size = [320, 180]
seconds = 0.4
fps = 10
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("job")
    (folder / "two.nc").write_text(PROGRAM)
    (folder / "two.toml").write_text(JOB)
    return folder


@pytest.fixture
def recorded(folder: Path, twin: Twin) -> Path:
    """The recording, made once."""
    path = folder / "out" / "recording.h5"
    if not path.is_file():
        done = twin("run", folder / "two.toml", "--out", path.parent)
        assert done.code == 0, done.stderr
    return path


@pytest.mark.seconds("a run is filmed")
def test_a_recording_is_filmed_with_the_jobs_own_settings(recorded: Path, twin: Twin) -> None:
    done = twin("render", recorded, "--seconds", 0.5)
    assert done.code == 0, done.stderr
    with av.open(str(recorded.parent / "video.mp4")) as container:
        assert sum(1 for _ in container.decode(video=0)) == 5
    assert str(recorded.parent / "video.mp4") in done.stdout
    assert "film: 100%" in done.stderr


def test_stills_at_times_lines_and_events(recorded: Path, twin: Twin, tmp_path: Path) -> None:
    arguments = ("--at", 0.5, "--line", 4, "--event", "end", "--event", "worst")
    done = twin("render", recorded, "--out", tmp_path, *arguments, "--size", "160x90")
    assert done.code == 0, done.stderr
    names = {"still-0.5s.png", "still-line-4.png", "still-end.png", "still-worst.png"}
    assert {path.name for path in tmp_path.iterdir()} == names
    for name in names:
        with Image.open(tmp_path / name) as picture:
            assert picture.size == (160, 90)


def test_a_split_film_for_a_page_without_display(
    recorded: Path, twin: Twin, tmp_path: Path
) -> None:
    cameras = ("--camera", "part", "--camera", "riding", "--split", "--no-display")
    length = ("--seconds", 0.4, "--fps", 10, "--size", "160x90", "--format", "gif")
    done = twin("render", recorded, "--out", tmp_path, *cameras, *length)
    assert done.code == 0, done.stderr
    with Image.open(tmp_path / "video.gif") as picture:
        assert picture.size == (160, 90)
        assert getattr(picture, "n_frames", 1) == 4
        left, right = (picture.convert("L").crop((x, 5, x + 75, 85)) for x in (2, 83))
    assert left.tobytes() != right.tobytes()


@pytest.mark.thorough
def test_filament_draws_by_choice(recorded: Path, twin: Twin, tmp_path: Path) -> None:
    if probe(FILAMENT).error:
        pytest.skip("no Vulkan driver for Filament here: see twin doctor")
    arguments = ("--renderer", "filament", "--at", 0.5, "--film", "--inspect", "commanded")
    done = twin("render", recorded, "--out", tmp_path, *arguments, "--size", "160x90")
    assert done.code == 0, done.stderr
    names = {"still-0.5s.png", "video.mp4", "inspection.png", "inspection.json"}
    assert {path.name for path in tmp_path.iterdir()} == names
    assert all("film:" in line for line in done.stderr.splitlines() if line)


def test_filament_without_a_driver_is_refused(
    recorded: Path, twin: Twin, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(renderers, "probe", lambda name: Probe(name, error="no driver"))
    done = twin("render", recorded, "--out", tmp_path, "--renderer", "filament", "--at", 0.5)
    assert done.code == 2
    assert "apt-get install libvulkan1 mesa-vulkan-drivers" in done.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.seconds("a run is filmed")
def test_the_part_is_written_and_measured(recorded: Path, twin: Twin, tmp_path: Path) -> None:
    arguments = ("--glb", "--inspect", "commanded", "--tolerance", 10)
    done = twin("render", recorded, "--out", tmp_path, *arguments)
    assert done.code == 0, done.stderr
    part = trimesh.load(tmp_path / "part.glb", force="mesh")
    assert isinstance(part, trimesh.Trimesh)
    assert part.is_watertight
    figures = json.loads((tmp_path / "inspection.json").read_text())
    assert figures["within_share"] == 1.0
    assert (tmp_path / "inspection.png").is_file()
    too_strict = twin("render", recorded, "--out", tmp_path, *arguments[:-1], 1e-9)
    assert too_strict.code == 1


def test_a_nominal_part_in_program_coordinates(recorded: Path, twin: Twin, tmp_path: Path) -> None:
    block = trimesh.creation.box((60.0, 40.0, 12.0))
    block.apply_translation((0.0, 0.0, -6.0))
    block.export(tmp_path / "nominal.stl")
    done = twin("render", recorded, "--out", tmp_path, "--inspect", tmp_path / "nominal.stl")
    assert done.code == 0, done.stderr
    figures = json.loads((tmp_path / "inspection.json").read_text())
    slot = (40.0 + 7.85) * 10.0 * 3.0
    assert figures["missing_mm3"] == pytest.approx(slot, rel=0.1), "slot and hole are missing"
    assert figures["min_um"] == pytest.approx(-3000.0, abs=1.0), "what is left is so far off"
    assert figures["standing_mm3"] == 0.0


def test_the_second_tool_cuts_at_its_own_length(recorded: Path) -> None:
    result = json.loads((recorded.parent / "result.json").read_text())
    hole = next(block for block in result["cut"]["blocks"] if block["line"] == 9)
    cone = 3.0 / math.tan(math.radians(59.0))
    exact = math.pi * 9.0 * (5.0 - cone * 2 / 3)
    assert hole["removed_mm3"] == pytest.approx(exact, rel=0.03)
    assert result["cut"]["gouges"] == []


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--format", "avi"), "mp4, gif, webp"),
        (("--camera", "side"), "no camera 'side'"),
        (("--event", "birthday"), "end, worst, alarm, rapid, gouge"),
        (("--event", "alarm"), "has no 'alarm' to show"),
        (("--line", 77), "line 77 of the program moved nothing"),
        (("--size", "big"), "--size"),
        (("--fps", 0), "--fps"),
        (("--quality", "best"), "--quality"),
        (("--renderer", "pencil"), "--renderer: Input should be 'opengl' or 'filament'"),
        (("--speed", -1), "--speed"),
        (("--inspect", "nowhere.stl"), "give 'commanded' or an STL file"),
        (("--machine", "lathe"), "no machine 'lathe'"),
        (("--dialect", "mefi"), "a recording holds its own"),
    ],
)
def test_what_cannot_be_made_is_refused(
    recorded: Path, twin: Twin, tmp_path: Path, arguments: tuple[object, ...], message: str
) -> None:
    done = twin("render", recorded, "--out", tmp_path / "none", *arguments)
    assert done.code == 2
    assert message in done.stderr
    assert not (tmp_path / "none").exists()


def test_what_is_no_recording_is_refused(twin: Twin, tmp_path: Path) -> None:
    torn = tmp_path / "torn.h5"
    torn.write_bytes(b"\x89HDF\r\n\x1a\n, but no more")
    for path, message in ((torn, "is not a readable recording"), (tmp_path / "no.h5", "no such")):
        done = twin("render", path)
        assert done.code == 2
        assert message in done.stderr


@pytest.mark.seconds("a run is filmed")
def test_a_job_is_run_first(folder: Path, twin: Twin, tmp_path: Path) -> None:
    done = twin("render", folder / "two.toml", "--out", tmp_path / "a", "--at", 0.2)
    assert done.code == 0, done.stderr
    assert (tmp_path / "a" / "still-0.2s.png").is_file()
    assert (tmp_path / "a" / "recording.h5").is_file()
