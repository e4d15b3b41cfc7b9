"""What a caller may give as a program: a path, a shipped program's name, a text, or a job."""

import contextlib
import re
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

from twin.job.job_file import JobFile
from twin.job.load import Job
from twin.run.preparing.assumed_job import prepare_run
from twin.run.preparing.preparation import Preparation, prepare, prepare_job

Program = str | Path | JobFile
"""A path, the name of a shipped program (``mefi/helix``), NC text, or a job."""

TEXT_NAME = "program.nc"
_TEXT = re.compile(r"\n|\S[ \t]+\S")
_SUFFIX = re.compile(r"\.[A-Za-z]\w*\s*$")


def is_text(program: str) -> bool:
    """Whether a string is NC text and no path: it has several lines, or several words and no file's suffix."""
    if "\n" in program:
        return True
    return (
        bool(_TEXT.search(program)) and not _SUFFIX.search(program) and not Path(program).exists()
    )


def prepared(
    program: Program,
    folder: Path,
    *,
    dialect: str | None,
    machine: str | None,
    assuming: bool = False,
) -> tuple[Preparation, tuple[str, ...]]:
    """Read a program and all that it names; what was assumed for one without a job.

    Args:
        folder: Where NC text is written to.
        assuming: Stock, tools and zero of a program without a job are assumed, as ``twin run`` does.

    Raises:
        UsageError: A file is missing or wrong, or the dialect cannot be determined.
        ProgramError: The program is wrong.
    """
    if isinstance(program, JobFile):
        job = _job(program, folder)
        return prepare_job(job, dialect=dialect, machine=machine), ()
    if isinstance(program, str) and is_text(program):
        program = _written(program, folder)
    path = Path(program)
    if not assuming:
        found = prepare(path, dialect=dialect, machine=machine, assuming=True)
        return found, found.reading.notes
    made, assumed = prepare_run(path, dialect=dialect, machine=machine)
    return made, made.reading.notes if assumed is None else assumed.assumptions


def _job(file: JobFile, folder: Path) -> Job:
    """A job whose relative paths are relative to the working folder."""
    if is_text(file.program):
        written = str(_written(file.program, folder).resolve())
    else:
        written = str(Path(file.program).resolve())
    return Job(Path.cwd(), file.model_copy(update={"program": written}))


def _written(text: str, folder: Path) -> Path:
    path = folder / TEXT_NAME
    path.write_text(text if text.endswith("\n") else f"{text}\n", encoding="utf-8")
    return path


@contextlib.contextmanager
def scratch_folder() -> Iterator[Path]:
    """A folder that goes away."""
    folder = Path(tempfile.mkdtemp(prefix="twin-"))
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
