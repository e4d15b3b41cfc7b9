"""``twin doctor --compile``: every kernel compiled before anybody waits for it."""

from collections.abc import Callable, Sequence
from pathlib import Path

from numba.core import config as numba_config

from twin.check.discovery import program_of
from twin.compilation.content import REQUIREMENTS, compilers
from twin.compilation.folders import SHIPPED, keep_in, writable_folder
from twin.compilation.inventory import inventory, note_complete
from twin.errors import UsageError
from twin.files.shipped import is_installed, machine_file, resource_root

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


def compile_into_reach() -> Path:
    """Compile every kernel where later processes of this installation find it.

    An installation that can be written to gets kernels for every processor of its architecture, so
    that an image of it needs no other folder; else, and in a checkout, the user's folder gets them.

    Returns:
        The folder that holds them.

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
    from twin.nc.line_kernel.choice import compiled_kernel
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
    from twin.machine.description.motion_limits import motion_limits
    from twin.motion.report.summary import summarize
    from twin.run.preparation import prepare

    made = prepare(job)
    chunks = made.interpretation().chunks()
    summarize(chunks, motion_limits(made.machine), start=made.start, axes=made.machine.axes)


def _circle() -> None:
    from twin.machine.circle.circular_test import circular_test
    from twin.machine.description.config import read_machine

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
