"""What people are told of how a raw program is read, by every command that takes one."""

import dataclasses
from collections.abc import Iterable

import typer

from twin.nc.text.diagnostics import ProgramError
from twin.run.preparation import Preparation


def tell_reading(preparation: Preparation, assumptions: Iterable[str]) -> None:
    """Say on stderr which dialect was taken and why, where nobody named one, and what was assumed."""
    if preparation.dialect_reason:
        typer.echo(_reading_line(preparation), err=True)
    for line in assumptions:
        typer.echo(f"assumed: {line}", err=True)


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
