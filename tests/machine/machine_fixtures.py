"""Setpoints and machines that the tests of this room share."""

import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

from twin.files.shipped import machine_file, resource_root
from twin.job.fixture import FixtureTable
from twin.machine.description.config import MachineConfig
from twin.machine.description.machine_file import MachineFile
from twin.machine.load import read_machine
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray

PERIOD = 0.001


def shipped_machine(**axis_changes: Any) -> MachineConfig:
    """``mill4`` without integral action, with the given fields changed on every axis.

    Its loops are of second order then, and what they do has closed forms.
    """
    path = machine_file("mill4")
    data = tomllib.loads(path.read_text(encoding="utf-8"))
    for axis in data["axes"].values():
        axis.update({"reset_time_s": 0.0} | axis_changes)
    return MachineConfig(path, MachineFile.model_validate(data))


def with_fixtures(machine: MachineConfig, *fixtures: FixtureTable) -> MachineConfig:
    """A machine with more on its table."""
    both = (*machine.file.fixtures, *fixtures)
    return MachineConfig(machine.path, machine.file.model_copy(update={"fixtures": both}))


def setpoints(position: FloatArray, velocity: FloatArray, acceleration: FloatArray) -> Setpoints:
    n = len(position)
    return Setpoints(
        PERIOD * np.arange(n, dtype=np.float64),
        np.arange(n) // 10,
        np.zeros(n, np.int64),
        np.linspace(0.0, 1.0, n),
        position,
        velocity,
        acceleration,
    )


def ramp_up(
    time: FloatArray, speed: float, rise: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Distance, speed and acceleration of a start whose acceleration is a smooth sin² hump."""
    t = np.minimum(time, rise)
    wave = 2 * np.pi / rise
    acceleration = np.where(time < rise, speed / rise * (1 - np.cos(wave * time)), 0.0)
    velocity = speed / rise * (t - np.sin(wave * t) / wave)
    distance = speed / rise * (t**2 / 2 + (np.cos(wave * t) - 1) / wave**2)
    return distance + speed * (time - t), velocity, acceleration


def line(axis: int, speed: float, seconds: float, k: int = 4, rise: float = 0.2) -> Setpoints:
    """One axis along a line, from rest, smoothly up to a constant speed."""
    time = np.arange(0, seconds, PERIOD)
    columns = [np.zeros((len(time), k)) for _ in range(3)]
    for column, value in zip(columns, ramp_up(time, speed, rise), strict=True):
        column[:, axis] = value
    return setpoints(*columns)


def circle(radius: float, feed: float, seconds: float, k: int = 4, rise: float = 0.3) -> Setpoints:
    """A circle in X Y about (-radius, 0), from rest, smoothly up to a feed [mm/min]."""
    time = np.arange(0, seconds, PERIOD)
    angle, rate, change = (value / radius for value in ramp_up(time, feed / 60.0, rise))
    cosine, sine = np.cos(angle), np.sin(angle)
    columns = [np.zeros((len(time), k)) for _ in range(3)]
    columns[0][:, 0], columns[0][:, 1] = radius * cosine - radius, radius * sine
    columns[1][:, 0], columns[1][:, 1] = -radius * sine * rate, radius * cosine * rate
    columns[2][:, 0] = -radius * (cosine * rate**2 + sine * change)
    columns[2][:, 1] = radius * (cosine * change - sine * rate**2)
    return setpoints(*columns)


def write_machine(folder: Path, text: str) -> Path:
    """A machine file beside a link to the shipped models, so that its model is found."""
    path = folder / "machine.toml"
    path.write_text(text.replace('model = "', f'model = "{resource_root("models")}/mill4/'))
    return path


def three_axis_machine(folder: Path) -> MachineConfig:
    """``mill4`` without its rotary table's axis, written into a folder."""
    folder_of_mill4 = machine_file("mill4").parent
    model = (folder_of_mill4 / "mill4.xml").read_text(encoding="utf-8")
    model = re.sub(r'<(joint|intvelocity|jointpos) name="C".*', "", model)
    model = model.replace('meshdir="assets"', f'meshdir="{folder_of_mill4 / "assets"}"')
    model = model.replace('qpos="0 0 0 0"', 'qpos="0 0 0"')
    (folder / "three.xml").write_text(model, encoding="utf-8")
    text = machine_file("mill4").read_text(encoding="utf-8")
    text = re.sub(r"\[(axes\.C|table)\]\n(.+\n)*", "", text)
    text = text.replace('"mill4"', '"three"').replace("scene.xml", "three.xml")
    (folder / "three.toml").write_text(text, encoding="utf-8")
    return read_machine(folder / "three.toml")
