"""Interpreters: blocks a second from the file to moves and events in memory, ours and the peers'.

Ours and nc-gcode-interpreter are called from Python and read the file; rs274 is a process that
reads it and writes canonical text, its start taken off. Programs are made here, the same for all.
Times are those of the processor, of one core; of a peer that uses several, the shorter of that and
of the time that passed.
"""

import json
import math
import os
import random
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

from benches.nc_programs import LINES, ROUNDS, programs
from benches.row import REPEATS, Row, median_cpu_seconds

from twin.nc.canonical import Axes
from twin.nc.control.settings import ControlSettings, ToolData
from twin.nc.dialects import dialect_named
from twin.nc.interpreter import Interpretation
from twin.nc.line_kernel.plain_state import usual_kernel
from twin.nc.text.source import read_source

PEERS = Path(__file__).resolve().parents[2] / ".peers"
"""Where ``scripts/bench --peers`` puts them."""
BLOCKS = LINES
_HEAD = ("G90 G17", "G1 X0 Y0 Z0 F1000")
_AXES = Axes(("X", "Y", "Z", "C"), ("linear", "linear", "linear", "rotary"))
_SETTINGS = ControlSettings(
    axes=_AXES,
    step_limit=10 * ROUNDS,
    tools={1: ToolData(radius=2.0, length=60.0)},
    decimal_point="calculator",
)
_SAME_LANGUAGE = ("gost", "fanuc", "linuxcnc", "sinumerik")
"""Dialects that read these programs as they stand."""


def rows() -> Iterator[Row]:
    """Lines and arcs with helices in several dialects against each peer; programs that compute against ``rs274``."""
    with tempfile.TemporaryDirectory() as folder:
        for task, path in _programs(Path(folder)):
            peers = [measure(path) for measure in (_nc_gcode_interpreter, _rs274)]
            for dialect in _SAME_LANGUAGE:
                rate = BLOCKS / median_cpu_seconds(lambda p=path, d=dialect: _interpret(p, d))
                for peer in peers:
                    yield _row(f"{task}, {dialect}", rate, BLOCKS, *peer)
            if "lines" in task:
                klartext = Path(folder, "klartext.h")
                klartext.write_text("\n".join(_klartext()))
                seconds = median_cpu_seconds(lambda p=klartext: _interpret(p, "heidenhain"))
                for peer in peers:
                    yield _row(f"{task}, heidenhain (L)", BLOCKS / seconds, BLOCKS, *peer)
            yield _cold_row(task, path, BLOCKS)
        for each in programs():
            ours, theirs = Path(folder, "ours.nc"), Path(folder, "theirs.ngc")
            ours.write_text(each.ours)
            theirs.write_text(each.theirs)
            seconds = median_cpu_seconds(lambda o=ours, e=each: _interpret(o, e.dialect))
            task = f"{each.dialect}: {each.task}"
            yield _row(task, each.blocks / seconds, each.blocks, *_rs274(theirs))


def _cold_row(task: str, path: Path, blocks: int) -> Row:
    """Python alone."""
    seconds = median_cpu_seconds(lambda: _interpret(path, "gost", compiled=False))
    return Row("nc", f"{task}, nothing compiled", blocks / seconds, "blocks/s")


def _row(task: str, rate: float, blocks: int, peer: str, seconds: float | None) -> Row:
    figure = None if seconds is None else blocks / seconds
    return Row("nc", task, rate, "blocks/s", peer, figure)


def _programs(folder: Path) -> Iterator[tuple[str, Path]]:
    """Programs of plain blocks, the same for all."""
    for task, lines in (
        (f"{BLOCKS:,} lines G1 X Y Z", _lines()),
        (f"{BLOCKS * 9 // 10:,} arcs, {BLOCKS // 10:,} helices", _arcs()),
    ):
        path = folder / f"{len(task)}.ngc"
        path.write_text("\n".join([*_HEAD, *lines, "M2", ""]))
        yield task, path


def _lines() -> Iterator[str]:
    chance = random.Random(1)  # noqa: S311 (programs need no cryptography)
    for _ in range(BLOCKS):
        x, y, z = (chance.uniform(-100.0, 100.0) for _ in range(3))
        yield f"G1 X{x:.3f} Y{y:.3f} Z{z:.3f}"


def _klartext() -> Iterator[str]:
    """The same lines in Klartext, with the numbers of their blocks."""
    yield from ("0 BEGIN PGM LINES MM", "1 L X+0 Y+0 Z+0 F1000")
    for number, line in enumerate(_lines(), 2):
        words = line.removeprefix("G1 ").split()
        signed = (word if word[1] == "-" else f"{word[0]}+{word[1:]}" for word in words)
        yield f"{number} L {' '.join(signed)}"
    yield "END PGM LINES MM"


def _arcs() -> Iterator[str]:
    """Quarter circles of whole millimetres; every tenth block climbs as well."""
    chance = random.Random(2)  # noqa: S311 (the same)
    x = y = z = 0
    for index in range(BLOCKS):
        across, along = chance.choice([(1, 0), (0, 1), (-1, 0), (0, -1)])
        radius, clockwise = chance.randrange(5, 50), chance.random() < 0.5
        i, j = across * radius, along * radius
        if abs(x + i) > 300 or abs(y + j) > 300:
            i, j = -i, -j
        x, y = (x + i - j, y + j + i) if clockwise else (x + i + j, y + j - i)
        height = ""
        if index % 10 == 9:
            z = z - 1 if z > -50 else 0
            height = f" Z{z}"
        yield f"G{2 if clockwise else 3} X{x}.000 Y{y}.000{height} I{i}.000 J{j}.000"


def _interpret(path: Path, dialect: str, *, compiled: bool = True) -> int:
    kernel = usual_kernel if compiled else lambda _lines: None
    language = dialect_named(dialect)
    interpretation = Interpretation(read_source(path), language, _SETTINGS, kernel=kernel)
    return sum(len(chunk.moves) for chunk in interpretation.chunks())


def _nc_gcode_interpreter(path: Path) -> tuple[str, float | None]:
    """Name and median time in a process of its own, which holds its packages [s]."""
    name = "nc-gcode-interpreter"
    python = PEERS / "venv" / "bin" / "python"
    if not python.exists():
        return name, None
    code = (
        "import json, statistics, sys, time\n"
        "from importlib.metadata import version\n"
        "from nc_gcode_interpreter import nc_to_dataframe\n"
        "times = []\n"
        f"for _ in range({REPEATS} + 1):\n"
        "    start, cpu = time.perf_counter(), time.process_time()\n"
        "    nc_to_dataframe(open(sys.argv[1]).read())\n"
        "    times.append(min(time.perf_counter() - start, time.process_time() - cpu))\n"
        "print(json.dumps([version('nc-gcode-interpreter'), statistics.median(times[1:])]))\n"
    )
    done = subprocess.run(  # noqa: S603 (the peer that --peers installed)
        [python, "-c", code, path], capture_output=True, text=True, check=False
    )
    if done.returncode != 0:
        return f"{name}: fails", None
    found, seconds = json.loads(done.stdout)
    return f"{name} {found}", float(seconds)


def _rs274(path: Path) -> tuple[str, float | None]:
    name = "LinuxCNC rs274 -g"
    unpacked = PEERS / "linuxcnc" / "usr"
    program = shutil.which("rs274") or str(unpacked / "bin" / "rs274")
    if not Path(program).exists():
        return name, None
    libraries = f"{unpacked / 'lib'}:{unpacked / 'lib' / 'x86_64-linux-gnu'}"
    with tempfile.TemporaryDirectory() as folder:
        tools, empty = Path(folder, "tool.tbl"), Path(folder, "empty.ngc")
        tools.write_text("T1 P1 D4.0\n")
        empty.write_text("M2\n")

        def run(what: Path) -> Callable[[], object]:
            command = [program, "-g", "-t", str(tools), str(what), os.devnull]
            surroundings = {**os.environ, "LD_LIBRARY_PATH": libraries}
            return lambda: subprocess.run(  # noqa: S603 (the peer that --peers unpacked)
                command, env=surroundings, cwd=folder, check=True, capture_output=True
            )

        return name, max(
            median_cpu_seconds(run(path)) - median_cpu_seconds(run(empty)), math.ulp(1.0)
        )
