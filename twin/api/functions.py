"""Interpret, plan and run: what the commands of these names do, without printing."""

import contextlib
from pathlib import Path

from twin.api.program import Program, prepared, scratch_folder
from twin.api.result import Result
from twin.columns import join
from twin.errors import UsageError
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Moves, concatenate
from twin.run.dry_run.dry_run import interpreted
from twin.run.pipeline import planned
from twin.run.progress import no_progress
from twin.run.results import RESULT_FILES, write_results
from twin.run.run import Run
from twin.run.run_folder import run_folder, without_verdict

MOST_SAMPLES = 10_000_000
"""Setpoints that ``plan`` returns at most: with five axes they take 1.5 GB, and half as much again while they are joined."""


def interpret(program: Program, *, dialect: str | None = None, machine: str | None = None) -> Moves:
    """The canonical moves of a program or job, as columns in part coordinates.

    Args:
        program: NC program, job file, a shipped program's name (``mefi/helix``), NC text, or a ``twin.Job``.
        dialect: One of ``twin dialects``; recognised from the program by default.
        machine: A shipped machine's name, or a machine file; the job's by default.

    Returns:
        n moves over k axes. ``start``, ``end``: shape (n, k) [mm or deg]; ``feed``: shape (n,)
        [mm/min or deg/min], NaN for rapids; ``line``: shape (n,); arcs with ``center`` and ``normal``,
        shape (n, 3), ``radius`` [mm] and ``sweep`` [deg]. ``pandas.DataFrame(moves)`` has a column for
        each, ``start`` and ``end`` by axis.

    Raises:
        ProgramError: The program is wrong; the message has the line and a caret.
        UsageError: A file is missing or wrong.

    Examples:
        >>> moves = twin.interpret("G1 X20.5 Y-4.25 F600", dialect="haas")
        >>> moves.end[-1]
        array([20.5 , -4.25,  0.  ,  0.  ])
    """
    with scratch_folder() as folder:
        preparation, _ = prepared(program, folder, dialect=dialect, machine=machine)
        chunks = preparation.interpretation().chunks()
        return concatenate([chunk.moves for chunk in chunks], preparation.machine.axes)


def plan(program: Program, *, dialect: str | None = None, machine: str | None = None) -> Setpoints:
    """The setpoints of a program or job at the servo period, in machine coordinates.

    Args:
        program: NC program, job file, a shipped program's name, NC text, or a ``twin.Job``.
        dialect: One of ``twin dialects``; recognised from the program by default.
        machine: A shipped machine's name, or a machine file; the job's by default.

    Returns:
        n samples over k axes, with ``time`` [s] and ``line``, shape (n,); ``position`` [mm or deg],
        ``velocity`` [per s] and ``acceleration`` [per s²], shape (n, k).

    Raises:
        ProgramError: The program is wrong.
        UsageError: A file is missing or wrong, or the program takes hours: more than ``MOST_SAMPLES``.

    Examples:
        >>> setpoints = twin.plan("part.nc")
        >>> setpoints.time[-1]  # the cycle time [s]
        2.31
    """
    with scratch_folder() as folder:
        preparation, _ = prepared(program, folder, dialect=dialect, machine=machine)
        chunks: list[Setpoints] = []
        count = 0
        for chunk in planned(interpreted(preparation), preparation):
            count += len(chunk)
            if count > MOST_SAMPLES:
                hours = MOST_SAMPLES * preparation.machine.file.servo_period_s / 3600.0
                raise UsageError(
                    f"the program takes more than {hours:.1f} h, whose setpoints would fill the memory: "
                    "use `twin plan`, or twin.run, whose result is read in pieces"
                )
            chunks.append(chunk)
        return join(chunks)


def run(
    program: Program,
    *,
    out: str | Path | None = None,
    dialect: str | None = None,
    machine: str | None = None,
) -> Result:
    """Simulate, compare and cut a program or job.

    Args:
        program: NC program, job file, a shipped program's name, NC text, or a ``twin.Job``. Stock, tools and
            zero of a program without a job are assumed, as ``twin run`` does (``Result.assumptions``).
        out: Folder for what ``twin run`` writes: result, report, recording, part, and for the program where
            that is text; made when missing. None: one that goes away with the result.
        dialect: One of ``twin dialects``; recognised from the program by default.
        machine: A shipped machine's name, or a machine file; the job's by default.

    Raises:
        ProgramError: The program is wrong.
        UsageError: A file is missing or wrong, or another run holds the folder.

    Examples:
        >>> result = twin.run("part.toml")
        >>> result.ok, result["contour_um"].max()
        (True, 3.4)
    """
    with contextlib.ExitStack() as unless_finished:
        if out is None:
            folder = unless_finished.enter_context(scratch_folder())
        else:
            folder = Path(out)
            folder.mkdir(parents=True, exist_ok=True)
        unless_finished.enter_context(without_verdict(folder))
        preparation, assumptions = prepared(
            program, folder, dialect=dialect, machine=machine, assuming=True
        )
        chain = Run(preparation)
        with run_folder(folder, RESULT_FILES):
            outcome = chain.execute(folder, no_progress)
            write_results(chain, outcome, folder)
        return Result(chain, outcome, folder, assumptions, unless_finished.pop_all())
