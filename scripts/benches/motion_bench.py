"""The planner beside its oracles and peers: Ruckig, TOPP-RA, LinuxCNC; and how fast it is."""

import dataclasses
import importlib
import math
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from importlib.metadata import version
from pathlib import Path

import numpy as np
from benches import linuxcnc_simulator
from benches.row import Row, median_cpu_seconds

from twin.columns import join
from twin.machine.description.motion_limits import motion_limits
from twin.motion.limits import MotionLimits
from twin.motion.phase_planner import plan_phases
from twin.motion.planner import plan
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Chunk, FloatArray
from twin.run.preparation import Preparation, prepare

NO_JERK_LIMIT = 1e9
"""In the place of every jerk limit, for peers that know none."""

PERIOD_S = 0.001
ROOT = Path(__file__).parents[2]
HEAD = "G90 G17 G05"
SHAPES = {
    "square": "G01 X50 F3000\nG01 Y50\nG01 X0\nG01 Y0\n",
    "circle": "G01 X25 F3000\nG03 X25 Y0 I-25 J0\nG01 X0\n",
    "table": "G01 X20 C60 F3000\nG01 X40 C-60\nG01 X20 Y20 C60\nG01 X0 Y0 C0\n",
}
"""Programs that LinuxCNC reads too, but for their first line."""

TOLERANCE_MM = 0.05

ORACLE_PLACES = 240
"""Along an arc, of the time-optimal plan: with twice as many it takes half a percent longer."""

CAMOTICS_LINES, CAMOTICS_ARCS = 78e3, 2.5e3
"""What its planner was once measured at, on short lines and on arcs [blocks/s]: it is not run here."""


def prepared(folder: Path, text: str) -> Preparation:
    """A program on mill4, in the dialect of the Fagor 8070."""
    path = folder / "program.nc"
    path.write_text(text, encoding="utf-8")
    return prepare(path, dialect="fagor8070", machine="mill4")


def cycle_s(chunks: list[Chunk], limits: MotionLimits) -> float:
    """Time of a program that starts at zero."""
    return list(plan_phases(chunks, limits, start=np.zeros(4)))[-1].end_time


def without_jerk_limit(limits: MotionLimits) -> MotionLimits:
    """The machine with jerk limits that never bind."""
    return dataclasses.replace(
        limits, jerk=np.full(4, NO_JERK_LIMIT), path_jerk=math.inf, rotary_path_jerk=math.inf
    )


def rows() -> Iterator[Row]:
    """Rates, and what the planner's times are worth."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        yield from _rates(folder)
        yield from _single_moves(folder)
        yield from _chains()
        yield from _arcs()
        yield from _beside_linuxcnc(folder)


def _rates(folder: Path) -> Iterator[Row]:
    for task, text, peer in (
        ("short lines, exact path", _surface(40_000, "G50"), CAMOTICS_LINES),
        ("short lines, continuous", _surface(40_000, "G05"), CAMOTICS_LINES),
        ("half circles, exact path", _half_circles(2_000, "G50"), CAMOTICS_ARCS),
        ("half circles, continuous", _half_circles(2_000, "G05"), CAMOTICS_ARCS),
        ("half circles at F300, exact path", _half_circles(2_000, "G50", 300), CAMOTICS_ARCS),
        ("helices with C, exact path", _helices(2_000), CAMOTICS_ARCS),
    ):
        preparation = prepared(folder, text)
        chunks = list(preparation.interpretation().chunks())
        limits = motion_limits(preparation.machine)
        blocks = sum(len(chunk.moves) for chunk in chunks)
        seconds = median_cpu_seconds(lambda c=chunks, m=limits: cycle_s(c, m), repeats=3)
        yield Row("motion", task, blocks / seconds, "blocks/s", "CAMotics, stated", peer)


def _surface(count: int, mode: str) -> str:
    """Rows of 50 mm over a wavy surface in chords of 0.05 mm, as CAM writes them."""
    way = np.arange(1, count + 1) * 0.05
    x = np.abs(way % 100.0 - 50.0) - 50.0
    y = np.floor(way / 50.0) * 0.3
    z = 3.0 * np.sin(x / 4.0) + 2.0 * np.cos(y / 3.0) - 2.0
    lines = [f"G01 X{a:.4f} Y{b:.4f} Z{c:.4f}" for a, b, c in zip(x, y, z, strict=True)]
    return "\n".join([f"G90 G17 {mode} F3000", *lines]) + "\n"


def _half_circles(count: int, mode: str, feed: int = 3000) -> str:
    """A wave of half circles of 1 mm, to and fro over 200 mm."""
    lines: list[str] = []
    for number in range(count):
        turn, step = divmod(number, 100)
        x = 2 * (step + 1) if turn % 2 == 0 else 200 - 2 * (step + 1)
        lines.append(f"G0{2 + number % 2} X{x} Y0 I{1 if turn % 2 == 0 else -1} J0")
    return "\n".join([f"G90 G17 {mode} F{feed}", *lines]) + "\n"


def _helices(count: int) -> str:
    """Full turns of 10 mm, up and down by 1 mm, with the table going 30 degrees to and fro."""
    lines = [f"G03 X0 Y0 Z{number % 2} I5 J0 C{30 * (number % 2)}" for number in range(count)]
    return "\n".join(["G90 G17 G50 F3000", *lines]) + "\n"


def _single_moves(folder: Path) -> Iterator[Row]:
    try:
        import ruckig
    except ImportError:
        return
    limits = motion_limits(prepared(folder, "G90\n").machine)
    rng = np.random.default_rng(0)
    lengths = 10.0 ** rng.uniform(-3.0, 2.5, 200)
    generator = ruckig.Ruckig(1)
    task, trajectory = ruckig.InputParameter(1), ruckig.Trajectory(1)
    task.current_position = [0.0]
    task.max_velocity = [50.0]
    task.max_acceleration = [limits.path_acceleration]
    task.max_jerk = [limits.path_jerk]
    worst, ours, theirs = (1.0, 1.0), 0.0, 0.0
    for length in lengths:
        preparation = prepared(folder, f"G90\nG01 X{length:.6f} F3000\n")
        chunks = list(preparation.interpretation().chunks())
        begin = time.perf_counter()
        taken = cycle_s(chunks, limits)
        between = time.perf_counter()
        task.target_position = [round(float(length), 6)]
        generator.calculate(task, trajectory)
        theirs += time.perf_counter() - between
        ours += between - begin
        pair = (taken, float(trajectory.duration))
        worst = max(worst, pair, key=lambda times: abs(times[0] / times[1] - 1.0))
    name = f"Ruckig {version('ruckig')}"
    off = abs(worst[0] / worst[1] - 1.0)
    yield Row(
        "motion",
        f"single move, worst of {len(lengths)}: {off:.0e} off",
        worst[0],
        "s",
        name,
        worst[1],
    )
    rates = len(lengths) / ours, len(lengths) / theirs
    yield Row("motion", "programs of a single move", rates[0], "1/s", name, rates[1])


def _chains() -> Iterator[Row]:
    """The tests' chains of tangent moves beside TOPP-RA's bound, with and without a jerk limit."""
    sys.path.insert(0, str(ROOT / "tests" / "motion"))
    try:
        oracle = importlib.import_module("toppra_bound")
    except ImportError:
        return
    name = f"TOPP-RA {version('toppra')} (no jerk limit)"
    for task, program in (
        ("slot of 20 mm", oracle.slot(1e7, 10.0, 50.0)),
        ("slot of 2 mm", oracle.slot(1e7, 1.0, 5.0)),
        ("wave of arcs", oracle.wave(1e7)),
    ):
        for kind, jerk in (("no jerk limit", 1e10), ("jerk 50000 mm/s³", 5e4)):
            machine = oracle.fast_machine(jerk)
            bound = oracle.bound(program, machine, 1e7 / 60.0)
            taken = cycle_s(program.chunks(), machine)
            yield Row("motion", f"{task}, {kind}", taken, "s", name, bound)


def _arcs() -> Iterator[Row]:
    """Arcs from rest to rest beside the tests' time-optimal plan."""
    sys.path.insert(0, str(ROOT / "tests" / "motion"))
    try:
        oracle = importlib.import_module("jerk_oracle")
        programs = importlib.import_module("motion_programs")
    except ImportError:
        return
    machine = programs.mill(
        velocity=np.full(4, 1e5), acceleration=np.full(4, 4000.0), jerk=np.full(4, 5e4),
        path_acceleration=4000.0, path_jerk=5e4,
    )  # fmt: skip
    for radius, turns, advance, turned in (
        (0.5, 1, 0.0, 0.0), (0.5, 3, 0.0, 0.0), (5.0, 1, 0.0, 0.0), (5.0, 3, 0.0, 0.0),
        (50.0, 1, 0.0, 0.0), (0.5, 0.5, 0.0, 0.0), (50.0, 0.5, 0.0, 0.0), (5.0, 0.25, 0.0, 0.0),
        (5.0, 2, 4.0, 0.0), (20.0, 1, 5.0, 90.0), (5.0, 1, 0.0, 60.0), (5.0, 0.75, 0.0, 60.0),
        (50.0, 0.75, 10.0, 300.0), (50.0, 0.25, 0.0, 360.0), (5.0, 0.5, 0.0, 2000.0),
    ):  # fmt: skip
        center, normal = (radius, 0.0, 0.0), (0.0, 0.0, 1.0)
        program = programs.Program().arc(
            center, normal, 360.0 * turns, advance=advance, turn=turned, feed=1e7
        )
        path = oracle.helix(radius, turns, advance, turned, ORACLE_PLACES)
        shortest = oracle.shortest_time(path, 4000.0, 5e4)
        task = f"R{radius:g}, turns {turns:g}, Z {advance:g} mm, C {turned:g} deg"
        yield Row("motion", task, cycle_s(program.chunks(), machine), "s", "time-optimal", shortest)


def _beside_linuxcnc(folder: Path) -> Iterator[Row]:
    machine = motion_limits(prepared(folder, "G90\n").machine)
    machine = dataclasses.replace(machine, corner_tolerance=TOLERANCE_MM)
    name, found = "LinuxCNC", dict[str, FloatArray]()
    if linuxcnc_simulator.installed():
        head = f"G21 G90 G17 G94 G64 P{TOLERANCE_MM}\n"
        texts = {shape: f"{head}{text}M2\n" for shape, text in SHAPES.items()}
        try:
            found = linuxcnc_simulator.commanded(texts, machine)
        except subprocess.SubprocessError as fault:
            print(f"LinuxCNC left out: {fault}", file=sys.stderr)
    for shape, text in SHAPES.items():
        theirs = found.get(shape)
        peer = None if theirs is None else (len(theirs) - 1) * PERIOD_S
        setpoints = {}
        for kind, limits in (
            ("as mill4", machine),
            ("no jerk limit", without_jerk_limit(machine)),
        ):
            preparation = prepared(folder, f"{HEAD}\n{text}")
            chunks = list(preparation.interpretation().chunks())
            setpoints[kind] = _setpoints(chunks, limits)
            yield Row("motion", f"{shape}: cycle, {kind}", cycle_s(chunks, limits), "s", name, peer)
        ours = setpoints["no jerk limit"].position
        for title, measure in (
            ("corner cut at X50 Y0 (mm)", _corner_cut if shape == "square" else None),
            ("acceleration over its limit", lambda p: _over_limit(p, machine)),
        ):
            if measure is not None:
                other = None if theirs is None else measure(theirs)
                yield Row("motion", f"{shape}: {title}", measure(ours), "", name, other)


def _setpoints(chunks: list[Chunk], limits: MotionLimits) -> Setpoints:
    zero = np.zeros(4)
    return join(list(plan(chunks, limits, period_s=PERIOD_S, part_zero=zero, start=zero)))


def _corner_cut(position: FloatArray) -> float:
    """Distance of the square's first corner from the path between its samples."""
    corner = np.array([50.0, 0.0])
    begin, step = position[:-1, :2], np.diff(position[:, :2], axis=0)
    square = np.maximum(np.sum(step**2, axis=1), 1e-30)
    along = np.clip(np.sum((corner - begin) * step, axis=1) / square, 0.0, 1.0)
    return float(np.linalg.norm(begin + along[:, None] * step - corner, axis=1).min())


def _over_limit(position: FloatArray, limits: MotionLimits) -> float:
    """Largest second difference of any axis, as a share of its acceleration limit."""
    second = np.abs(np.diff(position, 2, axis=0)).max(axis=0) / PERIOD_S**2
    return float((second / limits.acceleration).max())
