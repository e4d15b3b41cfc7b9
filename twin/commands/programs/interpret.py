"""``twin interpret``: the canonical moves of a program, as text or as JSON lines."""

import sys
from pathlib import Path

from twin.errors import UsageError
from twin.nc.jsonl import json_lines, text_lines
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.run.preparing.assumed_job import read_as, reading_notes
from twin.run.preparing.preparation import prepare

FORMATS = {"text": text_lines, "jsonl": json_lines}


def print_interpretation(
    program: Path, *, dialect: str | None, machine: str | None, form: str, strict: bool
) -> None:
    """Print the program's moves, dwells and functions to stdout, its warnings to stderr behind them.

    Raises:
        UsageError: The format is unknown, or the program cannot be prepared.
        ProgramError: The program is wrong; what came before the error was printed.
    """
    if form not in FORMATS:
        raise UsageError(f"no format '{form}': known formats are {', '.join(FORMATS)}")
    preparation = prepare(program, dialect=dialect, machine=machine, strict=strict, assuming=True)
    for note in reading_notes(preparation, preparation.reading.notes):
        sys.stderr.write(f"{note}\n")
    interpretation = preparation.interpretation()
    try:
        for line in FORMATS[form](interpretation):
            sys.stdout.write(f"{line}\n")
    except ProgramError as error:
        raise read_as(error, preparation) from None
    finally:
        sys.stdout.flush()
        for warning in interpretation.diagnostics:
            sys.stderr.write(f"{warning}\n")
