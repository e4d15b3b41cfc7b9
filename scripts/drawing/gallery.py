"""Draw the pictures that README shows: ``scripts/gallery [NAME ...]``.

Every picture is a moment of a shipped program's run, in final quality, made small enough for a
repository.
"""

import dataclasses
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from panel_picture import take_panel
from PIL import Image

from twin.files.shipped import resource_root
from twin.job.job_file import VideoTable
from twin.recording.reader import open_recording
from twin.render.film import film
from twin.render.still import Shot, stills
from twin.run.preparing.preparation import prepare
from twin.run.progress import no_progress
from twin.run.replay import scene_of
from twin.run.run import Run

RENDERS = Path(__file__).resolve().parents[2] / "renders"
LARGEST_BYTES = 300_000
COLOURS = (256, 192, 128, 96, 64)


PANEL = "training"
"""The picture of the operator's panel in a browser."""
NOTEBOOK = "contour_error"
"""What the first example of the tutorial for Python draws."""
TUTORIAL = RENDERS.parent / "docs" / "tutorials" / "python.md"


@dataclasses.dataclass(frozen=True, kw_only=True)
class Picture:
    """A moment of a program: at a share of the run's time, seen by a camera."""

    program: str
    camera: str
    share: float = 1.0
    machine: str | None = None
    display: bool = True


ROSETTE = "gallery/fagor8070/rosette"
PICTURES = {
    "hero": Picture(program=ROSETTE, camera="part", share=0.78),
    "mill": Picture(program="mefi/helix", camera="overview", share=0.03),
    "helix": Picture(program="mefi/helix", camera="part", share=0.05),
    "scroll": Picture(program="fagor8070/scroll", camera="part", share=0.8),
    "rosette_film": Picture(program=ROSETTE, camera="part"),
    "bolt_hole_ring": Picture(program="fagor8070/bolt_hole_ring", camera="part", share=0.755),
    "turning": Picture(program="gost/recalculation_3", camera="table", share=0.5),
    "light_mill": Picture(
        program="fagor8070/bolt_hole_ring", camera="overview", share=0.8, machine="mill4_light"
    ),
    "arc_in_xz": Picture(program="codesys/arc_in_xz_then_xy", camera="part", share=0.5),
    "cone": Picture(program="fanuc/cone", camera="part", share=0.6),
    "five_sides": Picture(program="haas/five_sides", camera="part", share=0.97),
    "helix_on_bar": Picture(program="linuxcnc/helix_on_bar", camera="part", share=0.8),
    "leaning_contour": Picture(program="sinumerik/leaning_contour", camera="part", share=0.7),
}


FILMS = {
    "rosette_film": VideoTable(
        cameras=("part",), seconds=5.0, fps=10, size=(480, 270), quality="final", display=False
    )
}
"""Of the picture of the same stem's program, as WebP: pages play it."""


def draw(picture: Picture, out: Path) -> None:
    """Run the picture's program and draw its moment, or film it where ``FILMS`` says so."""
    job_file = resource_root("programs") / f"{picture.program}.toml"
    run = Run(prepare(job_file, machine=picture.machine))
    with tempfile.TemporaryDirectory() as folder:
        run.execute(Path(folder), no_progress)
        with open_recording(Path(folder) / "recording.h5") as recording:
            scene = scene_of(recording, run.preparation, run.dry_run.summary)
            if out.stem in FILMS:
                film(scene, video=FILMS[out.stem], out=out)
                return
            end = round(picture.share * len(recording))
            stills(scene, [Shot(out, end)], cameras=(picture.camera,), display=picture.display)
    shrink(out)


def run_notebook(out: Path) -> None:
    """Run the tutorial's first example as it stands, and keep its picture."""
    found = re.search(
        r"^```python\n(.*?)^```", TUTORIAL.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL
    )
    if found is None:
        raise SystemExit(f"{TUTORIAL}: has no example")
    with tempfile.TemporaryDirectory() as folder:
        # By a process of its own, whose working folder and figure are nobody else's.
        subprocess.run(
            [sys.executable, "-c", found[1]],
            cwd=folder,
            check=True,
            env=os.environ | {"MPLBACKEND": "agg"},
        )
        shutil.copy(Path(folder) / out.name, out)


def shrink(path: Path) -> None:
    """Take colours out of a PNG where it is too large, until it is small enough."""
    if path.stat().st_size <= LARGEST_BYTES:
        return
    with Image.open(path) as picture:
        full = picture.convert("RGB")
    for colours in COLOURS:
        full.quantize(
            colours, Image.Quantize.MAXCOVERAGE, kmeans=1, dither=Image.Dither.FLOYDSTEINBERG
        ).save(path, optimize=True)
        if path.stat().st_size <= LARGEST_BYTES:
            return
    raise SystemExit(f"{path}: is still larger than {LARGEST_BYTES} bytes")


def main() -> None:
    """Draw the pictures named on the command line, or all."""
    known = [*PICTURES, PANEL, NOTEBOOK]
    names = sys.argv[1:] or known
    unknown = [name for name in names if name not in known]
    if unknown:
        raise SystemExit(f"no picture {', '.join(unknown)}: there are {', '.join(known)}")
    RENDERS.mkdir(exist_ok=True)
    for name in names:
        out = RENDERS / f"{name}.{'webp' if name in FILMS else 'png'}"
        if name == PANEL:
            take_panel(out)
            shrink(out)
        elif name == NOTEBOOK:
            run_notebook(out)
        else:
            draw(PICTURES[name], out)
        print(f"{out}: {out.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
