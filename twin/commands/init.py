"""``twin init PROGRAM``: a first job file, with what the program itself tells."""

import tomllib
from pathlib import Path

import numpy as np
import typer

from twin.errors import ExitCode, UsageError
from twin.files.atomic import write_text
from twin.job.job_file import JobFile
from twin.machine.description.config import Machine
from twin.machine.model.model import spindle_over_table_mm
from twin.nc.canonical import Function, Moves, concatenate
from twin.nc.text.diagnostics import ProgramError
from twin.run.placement import part_zero
from twin.run.preparation import Preparation, prepare

_MARGIN_MM = 10.0
"""Stock beyond the feed moves, on each side."""
_LEAST_HEIGHT_MM = 10.0
_MACHINE_ZERO_UNKNOWN = "no-machine-zero"
"""The diagnostic of a program that counts from machine zero, where no job says where that lies."""


def init_and_print(
    program: Path, *, dialect: str | None, machine: str | None, force: bool
) -> ExitCode:
    """Write a job file beside a program.

    Args:
        program: The NC program.
        dialect: Its dialect; told by its words by default.
        machine: The machine; ``mill4`` or what ``twin.toml`` says by default.
        force: Replace a job file that is there.

    Raises:
        UsageError: There is a job file already, or the program's dialect cannot be told.
        ProgramError: The program is wrong.
    """
    path = program.with_suffix(".toml")
    if program.suffix == ".toml":
        raise UsageError(f"{program}: give the NC program; its job file is what is written")
    if path.exists() and not force:
        raise UsageError(f"{path}: exists already; --force replaces it")
    try:
        text = job_text(prepare(program, dialect=dialect, machine=machine))
    except ProgramError as error:
        if error.diagnostic.code != _MACHINE_ZERO_UNKNOWN:
            raise
        # What is cut does not depend on where that lies.
        anywhere = prepare(
            program, dialect=dialect, machine=machine, changes=[("job.part_zero.Z", 0.0)]
        )
        text = _placed(job_text(anywhere), anywhere.machine)
    write_text(path, text)
    typer.echo(f"{path}: check the stock and the tools, then: twin run {path}")
    return ExitCode.OK


def job_text(preparation: Preparation) -> str:
    """The text of a job file: the stock around the program's feeds, the tools that it calls."""
    chunks = list(preparation.interpretation().chunks())
    moves = concatenate([chunk.moves for chunk in chunks], preparation.machine.axes)
    words = [e.word for chunk in chunks for e in chunk.events if isinstance(e, Function)]
    tools = {int(word[1:]) for word in words if word[:1] == "T" and word[1:].isdigit()}
    lines = [
        f'program = "{preparation.job.program.name}"',
        f'dialect = "{preparation.dialect.name}"',
        f'machine = "{preparation.job.file.machine}"',
        "",
        *_stock_lines(moves),
        *_tool_lines(sorted(tools - {0})),
        "[tolerance]",
        f"contour_um = {preparation.job.file.tolerance.contour_um}",
        "",
    ]
    return "\n".join(lines)


def _placed(text: str, machine: Machine) -> str:
    """A job's text with the height of program zero, for programs that count from machine zero."""
    file = JobFile.model_validate(tomllib.loads(text))
    height = part_zero(file, machine, spindle_over_table_mm(machine))[machine.axes.index("Z")]
    line = f"part_zero = {{ Z = {height:.3f} }}  # mm: the program counts from machine zero\n"
    head, gap, rest = text.partition("\n\n")
    return f"{head}\n{line}{gap[1:]}{rest}"


def _stock_lines(moves: Moves) -> list[str]:
    """A box around the feeds; none where nothing is fed below program zero."""
    feeds = ~np.isnan(moves.feed)
    points = np.concatenate([moves.start[feeds], moves.end[feeds]])[:, :3]
    if not len(points) or points[:, 2].min() >= 0.0:
        return [
            "# No feed goes below Z0: a [stock] would not be cut. With one it would read:",
            "# [stock]",
            '# shape = "box"',
            "# size = [100.0, 100.0, 20.0]  # mm; its top face lies at program Z0",
            "",
        ]
    low, high = points.min(axis=0), points.max(axis=0)
    size = np.ceil(high - low) + 2.0 * _MARGIN_MM
    size[2] = max(np.ceil(-low[2]) + _MARGIN_MM, _LEAST_HEIGHT_MM)
    center = (low + high) / 2.0
    return [
        "[stock]",
        'shape = "box"',
        f"size = [{size[0]:.1f}, {size[1]:.1f}, {size[2]:.1f}]  # mm",
        f"position = [{center[0]:.3f}, {center[1]:.3f}, 0.0]  # centre of its top face, mm",
        "",
    ]


def _tool_lines(numbers: list[int]) -> list[str]:
    lines = []
    for number in numbers or [1]:
        lines += [
            "[[tools]]",
            f"number = {number}",
            'kind = "flat"  # flat, ball, bull, drill, chamfer',
            "diameter = 10.0  # mm",
            "length = 60.0  # from the spindle nose to the tip, mm",
            "",
        ]
    return lines
