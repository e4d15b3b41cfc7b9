"""Compilation of kernels ahead of their first use.

``twin doctor --compile`` compiles every kernel. A run that finds one missing compiles one after the other as its
stages come to them, the planner's first, then those of drives, cut and comparison: these last ones are compiled in a
second process meanwhile, which calls them with setpoints that no planner made. Both keep what they compile in one folder,
and wait there for each other (``twin.compilation.cache``).
"""

import contextlib
import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np
from numba.core import config as numba_config

from twin.check.discovery import program_of
from twin.compilation.content import REQUIREMENTS, compilers
from twin.compilation.folders import SHIPPED, keep_in, lasts, writable_folder
from twin.compilation.inventory import inventory, note_complete
from twin.errors import TwinError, UsageError
from twin.files.shipped import is_installed, machine_file, resource_root
from twin.job.job_file import StockTable
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray, Motion
from twin.processor import available_cores
from twin.run.dry_run.dry_run import InterpretedProgram, interpreted
from twin.run.pipeline import ProgramMotion, cutting_forces
from twin.run.preparing.assumed_job import prepare_run
from twin.run.preparing.preparation import prepare
from twin.run.progress import no_progress
from twin.run.run import Run

JOBS = (
    "mefi/helix.toml",
    "fagor8070/bolt_hole_ring.toml",
    "fagor8070/rounded_polygon.toml",
    "fagor8070/scroll.toml",
    "fagor8070/three_planes.toml",
    "gost/recalculation_1.toml",
    "codesys/arc_in_xz_then_xy.toml",
    "gallery/fagor8070/rosette.toml",
)
"""Shipped jobs that together call what a run calls: each control, corner mode, plane and kind of tool."""

SCENE = "mefi_lead"

SETPOINTS = 64
"""That are enough for every kernel behind the planner."""
BELOW_MM = 0.5
"""Of the blank's top, where they begin."""
STEP_MM = np.array([0.005, 0.005, -0.01])
"""From one to the next: slow enough for any machine."""


def compile_into_reach() -> Path:
    """Compile every kernel where later processes of this installation find it.

    An installation that can be written to gets kernels for every processor of its architecture, so
    that an image of it needs no other folder; else, and in a checkout, the user's folder gets them.

    Raises:
        UsageError: Kernels cannot be kept anywhere.
    """
    found = inventory()
    if found.complete:
        return SHIPPED if found.shipped else found.folder
    if is_installed() and _can_be_written(SHIPPED):
        compile_for_every_processor(SHIPPED)
        return SHIPPED
    if not found.lasts:
        raise UsageError(
            "there is no folder to keep compiled kernels in: set NUMBA_CACHE_DIR to a folder that "
            "belongs to you and that others cannot write to"
        )
    compile_kernels()
    return found.folder


def compile_for_every_processor(folder: Path) -> None:
    """Compile every kernel into a folder that others may read, for any processor of the architecture."""
    keep_in(folder)
    for name, value in (("CPU_NAME", "generic"), ("CPU_FEATURES", "")):
        setattr(numba_config, name, value)
    # What is installed compiles for no shipped program.
    jobs = sorted(resource_root("programs").rglob("*.toml"))
    compile_kernels([job for job in jobs if program_of(job) is not None])
    text = "".join(f"{line}\n" for line in compilers())
    (folder / REQUIREMENTS).write_text(text, encoding="utf-8")
    for path in [folder, *folder.rglob("*")]:
        path.chmod(0o755 if path.is_dir() else 0o644)


def compile_kernels(more: Sequence[Path] = ()) -> None:
    """Let Numba compile what the commands call, or load it where it is compiled already.

    Args:
        more: Jobs that are run too, for what only they call.
    """
    programs = resource_root("programs")
    jobs = [*(programs / name for name in JOBS), *more]
    steps: list[Callable[[], object]] = [_read_lines]
    steps += [lambda job=job: _run(job) for job in jobs]
    steps += [lambda: _plan(jobs[0]), _circle, _train]
    for step in steps:
        step()
    note_complete(writable_folder())


def _read_lines() -> None:
    """Plain lines, which long programs have."""
    from twin.nc.canonical import Axes
    from twin.nc.control.settings import ControlSettings
    from twin.nc.dialects import dialect_named
    from twin.nc.interpreter import Interpretation
    from twin.nc.line_kernel.plain_state import compiled_kernel
    from twin.nc.text.source import source_from_text

    source = source_from_text("G0 X1\nX2\nM30\n")
    settings = ControlSettings(axes=Axes(("X", "Y", "Z"), ("linear", "linear", "linear")))
    interpretation = Interpretation(
        source, dialect_named("gost"), settings, kernel=lambda _lines: compiled_kernel()
    )
    for _ in interpretation.chunks():
        pass


def _run(job: Path) -> None:
    from twin.check.runner import check_program
    from twin.check.task import CheckSettings

    check_program(job, CheckSettings())


def _plan(job: Path) -> None:
    from twin.motion.report.summary import summarize

    made = prepare(job)
    program = interpreted(made)
    summarize(
        program.chunks(), made.machine.motion_limits, start=program.start, axes=made.machine.axes
    )


def _circle() -> None:
    from twin.machine.circle.circular_test import circular_test
    from twin.machine.load import read_machine

    circular_test(read_machine(machine_file("mill4")), 20.0, 6000.0)


def _train() -> None:
    from twin.training.scene.scene_file import read_scene, scene_path
    from twin.training.session.script import rehearse

    rehearse(read_scene(scene_path(SCENE)))


def _can_be_written(folder: Path) -> bool:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        probe = folder / ".probe"
        probe.touch()
        probe.unlink()
    except OSError:
        return False
    return True


def start_compiling(path: Path, dialect: str | None, machine: str | None) -> None:
    """Begin to compile in another process, where a second core and a common folder for kernels are there.

    The process ends with this one.

    Args:
        path: NC program or job file that is run.
    """
    if available_cores() < 2 or not lasts():
        return
    context = multiprocessing.get_context("spawn")
    context.Process(
        target=_compile_later_stages, args=(path, dialect, machine), daemon=True
    ).start()


def _compile_later_stages(path: Path, dialect: str | None, machine: str | None) -> None:
    """Go through the later stages; what is wrong with the job is reported by the run itself."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    sys.stdout = sys.stderr = Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115 (until the process ends)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    with contextlib.suppress(TwinError):
        run = Run(prepare_run(path, dialect=dialect, machine=machine)[0])
        run.execute(None, no_progress, later_motion(run))


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(0)


def later_motion(run: Run) -> ProgramMotion:
    """A sloping motion into the middle of the blank, without a planner."""
    summary = run.dry_run.summary
    forces = cutting_forces(run.preparation, summary)
    return ProgramMotion(_aslant(run, run.dry_run.program), run.model, summary, forces)


def _aslant(run: Run, program: InterpretedProgram) -> Iterator[Setpoints]:
    before = 0
    for chunk in program.timed_chunks():
        moves = chunk.moves
        feeds = np.flatnonzero(moves.motion == Motion.FEED)
        if not len(feeds):
            before += len(moves)
            continue
        # Two moves, for what is done where one ends.
        ticks = np.arange(SETPOINTS)
        move = np.minimum(feeds[0] + ticks // (SETPOINTS // 2), len(moves) - 1)
        step = np.zeros(moves.start.shape[1])
        step[:3] = STEP_MM
        position = np.tile(moves.end[feeds[0]], (SETPOINTS, 1))
        position[:, :3] = _into_the_blank(run.preparation.job.file.stock)
        period = run.machine.file.servo_period_s
        yield Setpoints(
            time=ticks * np.float64(period),
            line=moves.line[move],
            move=before + move,
            fraction=ticks % (SETPOINTS // 2) / (SETPOINTS // 2),
            position=position + run.part_zero + np.outer(ticks, step),
            velocity=np.tile(step / period, (SETPOINTS, 1)),
            acceleration=np.zeros((SETPOINTS, len(step))),
        )
        return


def _into_the_blank(stock: StockTable | None) -> FloatArray:
    """Just below its top, in the middle of what is not bored, part coordinates, shape (3,) [mm]."""
    if stock is None:
        return np.zeros(3)
    aside = 0.0 if stock.bore is None else 0.25 * (stock.extent[0] + stock.bore)
    return np.add(stock.position, (aside, 0.0, -BELOW_MM))
