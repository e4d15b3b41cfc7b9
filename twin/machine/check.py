"""Whether a machine keeps the contract of a model folder: ``twin machine check``.

The contract follows MuJoCo Menagerie: what a folder holds, how its MJCF is laid out, that the model
compiles, holds still at home and survives pseudo-random commands without a warning of MuJoCo.
"""

import dataclasses
import re
from collections.abc import Callable
from xml.etree import ElementTree as ET

import mujoco
import numpy as np

from twin.errors import TwinError
from twin.files.shipped import is_shipped
from twin.machine.description.config import MachineConfig
from twin.machine.description.kinematics import SPINDLE_NOSE, TABLE_TOP
from twin.machine.model.drives import reflected_inertia
from twin.machine.model.model import MachineModel, build_spec, compiled, drives, physics_model
from twin.machine.model.supplied import supply
from twin.machine.simulation.simulate import simulate
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray
from twin.recording.alarms import Alarm, SimulationError

SECTIONS = (
    "compiler", "option", "default", "asset", "worldbody", "contact", "equality", "actuator",
    "sensor", "keyframe",
)  # fmt: skip
"""Order of the parts of an MJCF file."""
_ASSET_LIMIT = 2_000_000
"""Size of all assets [bytes]."""
_PICTURE_LIMIT = 300_000
"""Size of the picture [bytes]."""
_STILL = 1e-3
"""Drift that counts as holding still [mm or deg]."""
_ROUNDED = 0.01
"""Share by which a gain written in the MJCF file may differ from the derived one."""

_NUMBERED_SPINDLE = re.compile(r"spindle[ _-]?(\d+|[a-z])", re.IGNORECASE)
"""Name of the body of one spindle among several."""

_Points = tuple[tuple[str, Callable[[MachineConfig], list[str]]], ...]


@dataclasses.dataclass(frozen=True, slots=True)
class PointResult:
    """One point of the contract.

    Attributes:
        faults: What is wrong; empty where the point is kept.
        notice: Only a machine that ships has to keep it, and this one does not ship.
    """

    point: str
    faults: tuple[str, ...]
    notice: bool = False


def check_machine(machine: MachineConfig) -> tuple[PointResult, ...]:
    """Check every point of the contract.

    Args:
        machine: The machine, its folder that of its machine file.

    Returns:
        One result per point, faults or none; first those of machines that ship.
    """
    of_publication: _Points = (
        ("the folder is complete", _folder),
        ("the README derives its numbers step by step", _readme),
        ("the MJCF file is in order", _layout),
        ("the model leaves nothing to be supplied", _supplied),
        ("gains and inertias in the MJCF file are those that follow", _gains),
    )
    of_every_machine: _Points = (
        ("the model compiles, and every joint is an axis", _compiles),
        ("the machine holds still at home", _holds_still),
        ("the machine survives pseudo-random commands", _survives_shaking),
        ("its axes are those of a mill", _carries_tool_and_part),
    )
    private = not is_shipped(machine.path)
    return (
        *(PointResult(point, _faults(look, machine), private) for point, look in of_publication),
        *(PointResult(point, _faults(look, machine)) for point, look in of_every_machine),
    )


def _faults(look: Callable[[MachineConfig], list[str]], machine: MachineConfig) -> tuple[str, ...]:
    try:
        return tuple(look(machine))
    except (TwinError, OSError, ET.ParseError) as error:
        return (str(error),)


def _folder(machine: MachineConfig) -> list[str]:
    folder, name = machine.path.parent, machine.file.name
    wanted = ("README.md", "CHANGELOG.md", "LICENSE", f"{name}.xml", "scene.xml", f"{name}.png")
    faults = [f"{file} is missing" for file in wanted if not (folder / file).is_file()]
    if folder.name != name:
        faults.append(f"the folder is called '{folder.name}', the machine '{name}'")
    assets = sum(path.stat().st_size for path in (folder / "assets").glob("*"))
    if assets > _ASSET_LIMIT:
        faults.append(f"assets take {assets / 1e6:.1f} MB, more than {_ASSET_LIMIT / 1e6:g}")
    picture = folder / f"{name}.png"
    if picture.is_file() and picture.stat().st_size > _PICTURE_LIMIT:
        faults.append(f"{picture.name} takes more than {_PICTURE_LIMIT // 1000} kB")
    return faults


def _readme(machine: MachineConfig) -> list[str]:
    readme = machine.path.parent / "README.md"
    if not readme.is_file():
        return ["there is no README.md"]
    text = readme.read_text(encoding="utf-8")
    faults = []
    if len(re.findall(r"^\d+\. ", text, re.MULTILINE)) < 5:
        faults.append("no numbered derivation steps")
    return faults + [
        f"no section '{heading}'"
        for heading in ("Derivation", "Quality", "Sources")
        if not re.search(rf"^#+ {heading}", text, re.MULTILINE)
    ]


def _layout(machine: MachineConfig) -> list[str]:
    named = machine.path.parent / f"{machine.file.name}.xml"
    model = named if named.is_file() else machine.model_path
    root = ET.parse(model).getroot()  # noqa: S314 (a model that is about to be run)
    order = [SECTIONS.index(child.tag) for child in root if child.tag in SECTIONS]
    faults = [f"unknown section '{child.tag}'" for child in root if child.tag not in SECTIONS]
    if order != sorted(order):
        faults.append(f"sections are not in the order {', '.join(SECTIONS)}")
    if root.find("./keyframe/key[@name='home']") is None:
        faults.append("there is no keyframe 'home': home is where all joints are 0")
    return faults + _weighed_by_shapes(machine)


def _weighed_by_shapes(machine: MachineConfig) -> list[str]:
    """Moving bodies that weigh what their shapes make of them, where a model says it by ``<inertial>``."""
    spec = mujoco.MjSpec.from_file(str(machine.model_path))
    moving = [body for body in spec.bodies if body.joints and not body.explicitinertial]
    if not moving:
        doubled = any(geom.mass != 0.0 for body in spec.bodies[1:] for geom in body.geoms)
        return ['geoms add to the masses of the bodies; give them mass="0"'] * doubled
    model = compiled(spec, machine)
    return [
        f"moving body '{body.name}' has no inertial of its own: by its shapes it weighs "
        f"{float(model.body_mass[body.id]):.3g} kg"
        for body in moving
    ]


def _supplied(machine: MachineConfig) -> list[str]:
    return supply(mujoco.MjSpec.from_file(str(machine.model_path)), machine)


def _compiles(machine: MachineConfig) -> list[str]:
    compiled(build_spec(machine), machine)
    return _undriven(machine)


def _carries_tool_and_part(machine: MachineConfig) -> list[str]:
    """Axes that carry neither tool nor part, and second spindles; a model that is no mill raises."""
    carried = {machine.axes.names[column] for column in machine.kinematics.column}
    idle = [name for name in machine.axes.names if name not in carried]
    return [f"axis {name} moves neither tool nor part" for name in idle] + [
        f"{what} is a second spindle or table: programs run on '{SPINDLE_NOSE}' and '{TABLE_TOP}', "
        "and nothing looks at another"
        for what in _second_ones(machine)
    ]


def _second_ones(machine: MachineConfig) -> list[str]:
    """Sites and bodies that are called like a second spindle or table: a model says what a body is by its name."""
    spec = mujoco.MjSpec.from_file(str(machine.model_path))
    marks = (SPINDLE_NOSE, TABLE_TOP)
    sites = [
        site.name for site in spec.sites if site.name.startswith(marks) and site.name not in marks
    ]
    on_sites = {spec.site(name).parent.name for name in sites}
    bodies = [
        body.name
        for body in spec.bodies
        if _NUMBERED_SPINDLE.fullmatch(body.name)
        and body.name != spec.site(SPINDLE_NOSE).parent.name
        and body.name not in on_sites
    ]
    return [f"site '{name}'" for name in sites] + [f"body '{name}'" for name in bodies]


def _undriven(machine: MachineConfig) -> list[str]:
    """Joints and actuators that no axis owns: nothing holds the one or moves with the other."""
    spec = mujoco.MjSpec.from_file(str(machine.model_path))
    owned = {machine.axis(name).joint for name in machine.axes.names}
    coupled = {name for equality in spec.equalities for name in (equality.name1, equality.name2)}
    loose = [joint.name for joint in spec.joints if joint.name not in owned | coupled]
    idle = [motor.name for motor in spec.actuators if motor.name not in machine.axes.names]
    return [f"joint '{name}' belongs to no axis: it moves as it likes" for name in loose] + [
        f"actuator '{name}' belongs to no axis" for name in idle
    ]


def _gains(machine: MachineConfig) -> list[str]:
    """Gains of the MJCF file that a run does not use: it tunes each drive to what the axis moves."""
    written = mujoco.MjSpec.from_file(str(machine.model_path))
    loops = drives(machine, physics_model(machine, build_spec(machine)))
    actuators = {actuator.name: actuator for actuator in written.actuators}
    faults = []
    for name, loop in zip(machine.axes.names, loops, strict=True):
        axis = machine.axis(name)
        pairs = [("armature", float(written.joint(axis.joint).armature), reflected_inertia(axis))]
        if name in actuators:
            stiffness, damping = (0.0 - float(actuators[name].biasprm[at]) for at in (1, 2))
            pairs = [
                ("kp", stiffness, loop.moved * loop.natural_frequency**2),
                ("kv", damping, loop.velocity_gain),
                *pairs,
            ]
        faults += [
            f"{name}: {what} is written as {there:g}, but {follows:g} follows and is used"
            for what, there, follows in pairs
            if abs(there - follows) > _ROUNDED * abs(follows)
        ]
    return faults


def _holds_still(machine: MachineConfig) -> list[str]:
    travel = [machine.axis(name).travel or (-np.inf, np.inf) for name in machine.axes.names]
    lowest, highest = np.array(travel).T
    joints = _run(machine, np.tile(np.clip(0.0, lowest, highest), (2000, 1)))
    drift = np.ptp(joints, axis=0)
    return [
        f"{name} drifts by {value:.4f}"
        for name, value in zip(machine.axes.names, drift, strict=True)
        if value > _STILL
    ]


def _survives_shaking(machine: MachineConfig) -> list[str]:
    """Sums of sines with pseudo-random phases about mid travel, rising from rest.

    Their speeds and accelerations together stay below half of what the axes can do.
    """
    period = machine.file.servo_period_s
    time = period * np.arange(3000)[:, None]
    rise = np.sin(np.pi / 2 * np.minimum(time[:, 0] / 0.5, 1.0)) ** 4
    generator = np.random.default_rng(20230411)
    columns = []
    for name in machine.axes.names:
        axis = machine.axis(name)
        low, high = axis.travel or (-90.0, 90.0)
        rates = 2.0 * np.pi * generator.uniform(0.5, 6.0, 5)
        reach = np.minimum(axis.velocity / rates, axis.acceleration / rates**2) / (2.0 * len(rates))
        waves = np.minimum(reach, (high - low) / 20.0) * np.sin(
            rates * time + generator.uniform(0.0, 2.0 * np.pi, 5)
        )
        columns.append((low + high) / 2.0 + waves.sum(axis=1) * rise)
    joints = _run(machine, np.stack(columns, axis=1))
    return [] if np.isfinite(joints).all() else ["the joints left the numbers"]


def _run(machine: MachineConfig, position: FloatArray) -> FloatArray:
    period = machine.file.servo_period_s
    count = len(position)
    velocity = np.gradient(position, period, axis=0)
    acceleration = np.gradient(velocity, period, axis=0)
    none = np.zeros(count, np.int64)
    time = period * np.arange(count, dtype=np.float64)
    points = Setpoints(time, none, none, np.zeros(count), position, velocity, acceleration)
    run = simulate(machine, MachineModel(machine), [points])
    joints = np.concatenate([samples.joint_position for samples in run])
    if run.alarm is not None:
        raise SimulationError(str(run.alarm) + _remedy(machine, run.alarm))
    return joints


def _remedy(machine: MachineConfig, alarm: Alarm) -> str:
    """What lets two bodies overlap that do so wherever the axes are, such as a head and its guides."""
    model = build_spec(machine)
    geoms = {geom.name: geom for geom in model.geoms if geom.name}
    bodies = [geoms[name].parent.name for name in alarm.between if name in geoms]
    if alarm.code != "collision" or alarm.time_s or len(bodies) < 2:
        return ""
    one, two = bodies
    return (
        "; shape them apart, or, where they always overlap, exclude them in the MJCF: "
        f'<contact><exclude body1="{one}" body2="{two}"/></contact>'
    )
