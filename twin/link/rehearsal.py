"""A run's chain once beforehand, so that nothing is compiled while LinuxCNC waits for an answer.

Kernels are compiled when they are first called, which takes a minute in an installation that has never run,
and LinuxCNC's component takes a twin that is silent for two seconds for gone.
"""

import contextlib

from twin.compilation.inventory import inventory
from twin.job.job_file import ToolTable
from twin.machine.simulation.live import LiveMachine
from twin.nc.canonical import FloatArray
from twin.run.dry_run import DryRun
from twin.run.run import Run


class _EnoughError(Exception):
    """The chain has been gone through."""


def rehearse(run: Run, dry_run: DryRun, tool: ToolTable, position: FloatArray) -> None:
    """Call what a linked run will call, unless all of it is compiled anyway; nothing of it is kept.

    Args:
        run: The prepared job.
        dry_run: What its dry run found.
        tool: What the spindle holds at the start.
        position: Where the axes stand, machine coordinates, shape (k,) [mm or deg].

    Raises:
        SimulationError: The twin's own run of the program fails.
    """
    if inventory().complete:
        return
    with contextlib.suppress(_EnoughError):
        Run(run.preparation).execute(dry_run, None, _enough)
    live = LiveMachine(run.machine, tool, position, run.model.blank)
    live.stand_at(position)
    live.follow(live.setpoint)
    live.brake(1)
    live.clear()


def _enough(_stage: str, _share: float) -> None:
    raise _EnoughError
