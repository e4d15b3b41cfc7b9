#!/usr/bin/env python3
"""Take the pictures of each shipped machine for its README: ``python scripts/drawing/make_pictures.py [MACHINE ...]``."""

import os
import sys

os.environ.setdefault("MUJOCO_GL", "egl")

import mujoco
import numpy as np
from PIL import Image

from twin.files.shipped import machine_file, machine_names
from twin.machine.circle.circle_plot import write_circle_plot
from twin.machine.circle.circular_test import circular_test
from twin.machine.load import read_machine
from twin.machine.model.model import build_spec

SIZE = (1280, 900)
VIEWS = {
    # look at, distance [m], azimuth, elevation [deg], and where the axes are [mm or deg]
    "mill4": ((0.06, 0.08, 1.22), 4.4, 56.0, -17.0, {"X": 60.0, "Y": -40.0, "Z": -430.0, "C": 25.0}),
    "mill3": ((0.06, 0.08, 1.22), 4.4, 56.0, -17.0, {"X": 60.0, "Y": -40.0, "Z": -430.0}),
    "mill4a": ((0.0, 0.05, 1.15), 2.9, 62.0, -18.0, {"X": 30.0, "Y": -20.0, "Z": -400.0, "A": 25.0}),
    "mill5": ((0.0, 0.05, 1.15), 2.6, 62.0, -18.0, {"X": 20.0, "Y": -20.0, "Z": -380.0, "A": -35.0, "C": 25.0}),
    "mill5h": ((0.0, 0.05, 1.35), 3.7, 56.0, -14.0, {"X": 20.0, "Y": -20.0, "Z": -300.0, "B": 35.0, "C": 25.0}),
    "mill4_light": ((0.0, 0.04, 0.27), 1.45, 52.0, -26.0, {"X": -40.0, "Y": 60.0, "Z": -40.0, "C": 30.0}),
}  # fmt: skip


CIRCLES = {
    # of which machine, at which feed [mm/min]
    "mill4": ("mill4/uncompensated", 3000.0),
    "mill4_light": ("mill4_light", 1500.0),
}


def picture(name: str) -> Image.Image:
    """Render a machine off-screen, somewhere in the middle of its work."""
    machine = read_machine(machine_file(name))
    look_at, distance, azimuth, elevation, stand = VIEWS[name]
    spec = build_spec(machine)
    spec.visual.quality.offsamples = 8
    model = spec.compile()
    data = mujoco.MjData(model)
    for axis, scale in zip(machine.axes.names, machine.joint_scale, strict=True):
        data.joint(machine.axis(axis).joint).qpos[0] = stand[axis] * scale
    mujoco.mj_forward(model, data)
    camera = mujoco.MjvCamera()
    camera.lookat[:] = look_at
    camera.distance, camera.azimuth, camera.elevation = distance, azimuth, elevation
    with mujoco.Renderer(model, SIZE[1], SIZE[0]) as renderer:
        renderer.update_scene(data, camera)
        return Image.fromarray(np.asarray(renderer.render()))


def main(names: list[str]) -> None:
    """Write the pictures of the named machines, or of all."""
    for name in names or machine_names():
        path = machine_file(name).parent / f"{name}.png"
        shot = picture(name).quantize(
            192, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.FLOYDSTEINBERG
        )
        shot.save(path, optimize=True)
        print(f"{path}: {path.stat().st_size / 1000:.0f} kB")
        if name not in CIRCLES:
            continue
        machine, feed = CIRCLES[name]
        plot = path.with_name("circle.png")
        write_circle_plot(circular_test(read_machine(machine_file(machine)), 50.0, feed), plot)
        with Image.open(plot) as drawn:
            drawn.convert("RGB").quantize(64).save(plot, optimize=True)
        print(f"{plot}: {plot.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main(sys.argv[1:])
