"""``twin link linuxcnc``: a real control drives the twin."""

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import typer

from twin.commands.runs.run import print_findings, summary
from twin.compilation.announcement import announce_compilation
from twin.errors import ExitCode, UsageError
from twin.extras import require_extra
from twin.files.atomic import write_text
from twin.files.toml import Change
from twin.job.load import Job, load_job
from twin.machine.load import load_machine
from twin.nc.dialects import recognise
from twin.nc.text.source import read_source
from twin.run.preparing.layout import lay_out
from twin.run.preparing.preparation import Preparation, prepare, prepare_job
from twin.run.progress import shown_progress
from twin.run.results import RESULT_FILES, write_results
from twin.run.run import Run
from twin.run.run_folder import run_folder, without_verdict

if TYPE_CHECKING:
    from twin.link.lockstep import LockstepMotion
    from twin.link.program_reading import Listing

SECONDS_PER_US = 1e-6
LINUXCNC_SUFFIX = ".ngc"
"""Of programs in LinuxCNC's own language."""
OWN_LANGUAGE = "linuxcnc"
"""What results name as the dialect of such a program."""
_BLENDING = re.compile(r"^[^(;]*\bG0*64\b(?!\s*P)", re.IGNORECASE)
"""A block that lets LinuxCNC round corners as far as it likes."""
READ_PROGRAM = "program_as_read.nc"
"""What LinuxCNC's interpreter makes of such a program."""
SESSION = "session.nc"
"""The program of a session at LinuxCNC's screen, which holds nothing: what moves is LinuxCNC's."""


def link_linuxcnc(
    out: Path,
    headless: Path | None,
    *,
    opened: Path | None = None,
    machine: str | None,
    dialect: str | None,
    period_us: int,
    display: str,
    following_error_limit: float | None,
    view: bool = False,
) -> ExitCode:
    """Let LinuxCNC drive the twin, and judge that as any run.

    Args:
        headless: NC program or job file to run without a screen.
        opened: The same, which LinuxCNC's screen opens with; neither: it opens without one.
        period_us: Servo period of both [µs].
        following_error_limit: LinuxCNC's own limit [mm or deg]; None: the machine's.
        view: Whether a page shows the machine meanwhile.

    Raises:
        TwinError: Something is wrong before the run could end; see each error's exit code.
    """
    if headless is not None and opened is not None:
        raise UsageError("--headless runs a program without a screen, --open with one: give one")
    program = headless or opened
    if view:
        require_extra("train", "twin link --view")
    from twin.link.session import Wish, run_on_twin

    announce_compilation()
    changes: list[Change] = [("machine.servo_period_s", period_us * SECONDS_PER_US)]
    with without_verdict(out):
        own = None if dialect or program is None else _linuxcnc_program(program, changes)
    with run_folder(out, RESULT_FILES):
        if headless is None:
            _require_screen(display)
        if program is None:
            write_text(out / SESSION, "M30\n")
            preparation = prepare(out / SESSION, dialect="gost", machine=machine, changes=changes)
        elif own is None:
            preparation = prepare(program, dialect=dialect, machine=machine, changes=changes)
        else:
            preparation = _prepare_as_read(own, machine, out, changes)
        run = Run(preparation)
        wish = Wish(
            own_program=None if own is None else own.listing,
            display=display if headless is None else None,
            opens=opened is not None,
            following_error_limit=following_error_limit,
        )
        with shown_progress() as progress:
            outcome, figures = run_on_twin(
                run,
                out,
                progress,
                wish,
                _say,
                (lambda motion: _shown(run, motion)) if view else (lambda _motion: nullcontext()),
            )
        own_language = {} if own is None else {"dialect": OWN_LANGUAGE}
        write_results(run, outcome, out, {"link": figures, **own_language})
        if own is not None and outcome.verdict.exit_code is ExitCode.FAILED:
            _explain_blending(own.listing)
    print_findings(run, outcome)
    typer.echo(summary(run, outcome, out))
    return outcome.verdict.exit_code


def _say(text: str) -> None:
    typer.echo(text, err=True)


@contextmanager
def _shown(run: Run, motion: "LockstepMotion") -> Iterator[None]:
    """Show a machine that a control drives on the page of ``twin view``."""
    from twin.view.app import open_view
    from twin.view.live_run import LiveRun, MachineMoment

    live = LiveRun(run.preparation, lambda: MachineMoment(*motion.moment))
    with open_view(live, now=live.now) as address:
        _say(f"open {address} in a browser")
        yield


def _explain_blending(listing: "Listing") -> None:
    """Say what a G64 without P does, along with a verdict that fails."""
    for number, line in enumerate(listing.text.splitlines(), 1):
        if _BLENDING.match(line):
            typer.echo(
                f"{listing.path}:{number}: G64 without P lets LinuxCNC round corners as far as its speed wants "
                "it; what it cuts off is contour error here: G64 P0.01 keeps within 0.01 mm, G61 stops "
                "at none and cuts none off",
                err=True,
            )
            return


def _require_screen(display: str) -> None:
    if not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise UsageError(
            f"LinuxCNC's {display} needs a display, and there is none: "
            "--headless PROGRAM runs a program without"
        )


class _OwnProgram(NamedTuple):
    """A program in LinuxCNC's own language."""

    job: Job
    listing: "Listing"


def _linuxcnc_program(path: Path, changes: list[Change]) -> _OwnProgram | None:
    """A program in LinuxCNC's own language; None for one of the twin's dialects.

    A program that no dialect's own words are in is LinuxCNC's.
    """
    from twin.link.program_reading import listing_of

    if not path.is_file():
        return None
    job = load_job(path, changes)
    if job.file.dialect is not None:
        return None
    if job.program.suffix != LINUXCNC_SUFFIX:
        try:
            recognise(read_source(job.program, None))
        except UsageError:
            return _OwnProgram(job, listing_of(job.program))
        return None
    return _OwnProgram(job, listing_of(job.program))


def _prepare_as_read(
    own: _OwnProgram, machine: str | None, out: Path, changes: list[Change]
) -> Preparation:
    """Prepare a program of LinuxCNC's own language, as LinuxCNC's interpreter reads it."""
    from twin.link.program_reading import DIALECT, read_program

    job = own.job
    read = load_machine(job, machine, changes)
    layout = lay_out(job.file, read)
    zero, start = layout.part_zero, layout.start + layout.part_zero
    path = (out / READ_PROGRAM).resolve()
    write_text(path, read_program(own.listing, read.axes, start, zero, job.file))
    file = job.file.model_copy(update={"program": str(path), "dialect": DIALECT})
    return prepare_job(job.with_file(file), machine=machine, changes=changes)
