"""The machine compared with the raw ``mujoco.rollout`` of the same model and the same controls."""

import dataclasses
from collections.abc import Iterator

import mujoco
import numpy as np
from benches.row import REPEATS, Row, cpu_seconds_in_turns, median_cpu_seconds
from mujoco.rollout import Rollout

from twin.columns import join
from twin.files.shipped import machine_file, machine_names
from twin.job.fixture import FixtureTable
from twin.job.job_file import ToolTable
from twin.machine.circle.circle_path import CirclePath
from twin.machine.load import read_machine
from twin.machine.model.drives import feedforward_name
from twin.machine.model.model import (
    build_spec,
    clearance_model,
    physics_model,
)
from twin.machine.simulation.live import LiveMachine
from twin.machine.simulation.sampling import (
    held_acceleration,
    held_velocity,
    polyline_node,
)
from twin.machine.simulation.simulate import simulate
from twin.machine.watching.clearance import Clearance
from twin.motion.setpoints.setpoints import Setpoints
from twin.recording.reader import Samples

CHUNK = 16384
"""Setpoints per chunk, as the planner gives them."""
SLICE = 4
"""Servo periods per slice of a machine that is operated."""


def rows() -> Iterator[Row]:
    """The simulation of each shipped machine, and a machine that is operated in slices."""
    for name in machine_names():
        yield _beside_rollout(name)
    yield from _watching()
    yield _operated(SLICE)
    ticks = _operated(1)
    yield dataclasses.replace(
        ticks, task="mill4, one servo period alone", figure=1e3 / ticks.figure, unit="µs"
    )


def _operated(periods: int) -> Row:
    """A machine of 1 ms that is operated so many servo periods at a time."""
    points = _circle("mill4")[: 8000 + periods]
    machine = read_machine(machine_file("mill4"))
    switched_on = [LiveMachine(machine, position=points.position[0]) for _ in range(REPEATS + 1)]

    def operate() -> None:
        live = switched_on.pop()
        for first in range(1, len(points), periods):
            live.follow(points[first : first + periods])

    simulated = len(points) * machine.file.servo_period_s
    task = f"mill4, operated in slices of {periods} ms"
    return Row("machine", task, simulated / median_cpu_seconds(operate), "x real time")


def _beside_rollout(name: str) -> Row:
    machine = read_machine(machine_file(name))
    points = _circle(name)
    model = physics_model(machine, build_spec(machine))
    chunks = [points[i : i + CHUNK] for i in range(0, len(points), CHUNK)]
    ours, raw = cpu_seconds_in_turns(
        lambda: [len(samples) for samples in simulate(machine, model, chunks)],
        lambda: _roll(model, name, chunks),
    )
    count, peer = len(points), f"mujoco.rollout {mujoco.__version__}"
    return Row("machine", f"{name}, circle", count / ours, "steps/s", peer, count / raw)


def _watching() -> Iterator[Row]:
    """What watching for collisions adds to the simulation, close to a vise and with C turning."""
    jaws = tuple(
        FixtureTable(name=f"jaw {side}", size=(120.0, 40.0, 60.0), position=(0.0, side * 76.0, 0.0))
        for side in (-1, 1)
    )
    machine = read_machine(machine_file("mill4"), fixtures=jaws)
    spec = build_spec(machine)
    model = physics_model(machine, spec)
    clearance = Clearance(machine, clearance_model(machine, spec))
    table = -machine.at_zero.spindle_over_table + ToolTable(number=1).length
    for task, turns, z in (("between jaws", 0.0, 30.0), ("over jaws, C turning", 90.0, 61.0)):
        points = _circle("mill4")
        place = points.position.copy()
        place[:, 2] = table + z
        place[:, 3] = turns * (points.time - points.time[0])
        speed = points.velocity.copy()
        speed[:, 3] = turns
        points = dataclasses.replace(points, position=place, velocity=speed)
        chunks = [points[i : i + CHUNK] for i in range(0, len(points), CHUNK)]
        samples = list(simulate(machine, model, chunks))

        def watch(samples: list[Samples] = samples) -> None:
            clearance.begin()
            assert not any(clearance.look(chunk) for chunk in samples)

        watched, bare = cpu_seconds_in_turns(
            watch,
            lambda chunks=chunks: [len(samples) for samples in simulate(machine, model, chunks)],
        )
        share = 100.0 * watched / bare
        yield Row("machine", f"watching for collisions {task}", share, "% of the simulation")


def _circle(name: str) -> Setpoints:
    path = CirclePath(read_machine(machine_file(name)), "XY", 50.0, 400.0, 1)
    return join(list(path.setpoints()))


def _roll(model: mujoco.MjModel, name: str, chunks: list[Setpoints]) -> None:
    """The same steps without anything that belongs to this project but the controls."""
    mujoco.set_mjcb_time(None)  # With its timers, as MuJoCo comes.
    machine = read_machine(machine_file(name))
    data = mujoco.MjData(model)
    scale, period = machine.joint_scale, machine.file.servo_period_s
    servos = [model.actuator(axis).id for axis in machine.axes.names]
    forces = [model.actuator(feedforward_name(axis)).id for axis in machine.axes.names]
    joints = [model.joint(machine.axis(axis).joint).qposadr[0] for axis in machine.axes.names]
    data.qpos[joints] = chunks[0].position[0] * scale
    data.act[model.actuator_actadr[servos]] = (
        polyline_node(chunks[0].position[0], chunks[0].acceleration[0], period) * scale
    )
    kind = mujoco.mjtState.mjSTATE_FULLPHYSICS
    state = np.zeros((1, mujoco.mj_stateSize(model, kind)))
    mujoco.mj_getState(model, data, state[0], kind)
    for chunk in chunks:
        nodes = polyline_node(chunk.position, chunk.acceleration, period)
        velocity = held_velocity(nodes[:-1], nodes[1:], period)
        acceleration = held_acceleration(chunk.velocity[:-1], chunk.velocity[1:], period)
        controls = np.zeros((1, len(velocity), model.nu))
        controls[0, :, model.actuator_ctrladr[servos]] = (velocity * scale).T
        controls[0, :, model.actuator_ctrladr[forces]] = (0.0 * acceleration).T
        with Rollout(nthread=0) as rollout:
            states, _ = rollout.rollout(model, data, state, controls)
        state = states[:, -1].copy()
