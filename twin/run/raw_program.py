"""What people are told of how a raw program is read, by every command that takes one."""

import dataclasses
from collections.abc import Iterable, Iterator

from twin.nc.text.diagnostics import ProgramError
from twin.run.preparation import Preparation


def told_of_reading(preparation: Preparation, assumptions: Iterable[str]) -> Iterator[str]:
    """Which dialect was taken and why, where nobody named one, and what was assumed, a line each."""
    if preparation.dialect_reason:
        yield _reading_line(preparation)
    yield from (f"assumed: {line}" for line in assumptions)


def read_as(error: ProgramError, preparation: Preparation) -> ProgramError:
    """An error of a raw program, with the dialect that it was read in where nobody named one."""
    if not preparation.dialect_reason:
        return error
    finding = error.diagnostic
    said = f"{_reading_line(preparation)}; another control: --dialect NAME"
    hint = f"{finding.hint}; {said}" if finding.hint else said
    return ProgramError(dataclasses.replace(finding, hint=hint))


def _reading_line(preparation: Preparation) -> str:
    return f"read as {preparation.dialect.name}: {preparation.dialect_reason}"
