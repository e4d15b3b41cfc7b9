"""The job that is assumed for a raw program: stock, zero and tools, as its path and its comments show them."""

import dataclasses
import json
import os
import re
import tomllib
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from twin.errors import UsageError
from twin.files.shipped import machine_file, machine_names, variant_names
from twin.job.job_file import JobFile, StockTable
from twin.job.load import ASSUMED, Job, Layer
from twin.machine.description.config import MachineConfig
from twin.nc.canonical import Chunk, FloatArray, Function, Motion, Moves, concatenate
from twin.nc.dialects.recognition import block_pages, raw_text
from twin.nc.functions import SPINDLE_SPEED, SPINDLE_STARTS, TOOL_CHANGE
from twin.nc.interpreter import Interpretation
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.run.preparing.control_settings import IGNORED_AT_ZERO
from twin.run.preparing.layout import lay_out
from twin.run.preparing.preparation import Preparation, anywhere, prepare, prepare_job
from twin.run.preparing.written import (
    at_the_tips,
    tool_calls,
    with_written,
    written_zero_lines,
)
from twin.run.reading.assumed_heights import MARGIN, Cuts, top_of_stock, turns_about_x
from twin.run.reading.assumed_reading import table_lines, unit_lines
from twin.run.reading.assumed_stock import assumed_stock, bar_ends
from twin.run.reading.assumed_tools import BELOW, SPEED_BY_HAND, tool_lines
from twin.run.reading.declared import declared_stock, declared_tools, table_tools
from twin.run.reading.tool_comments import named_tools

_MACHINE_ZERO_UNKNOWN = "no-machine-zero"
"""The finding of a program that counts from machine zero, where no job says where that lies."""
_OFFSET_UNKNOWN = "no-offset"
"""The finding of a program that is fed in several work offsets, where no job says how they lie."""
_PLACE_OF_OFFSETS = (
    "it feeds in several work offsets, and how they lie to each other no program says: "
    "write it into a twin.toml beside it, such as [offsets.G55] and under that X = 100.0"
)
_RELIEF = 1.0
"""So much deeper than the path it is free below a stock that the path goes through [mm]."""
_RAPID_TOLERANCE_UM = 200.0
"""How exactly rapids are to keep their path: no one measures it, and 0.2 mm hits nothing that is watched."""


@dataclasses.dataclass(frozen=True)
class AssumedJob:
    """A job's text, and what of it is no more than assumed.

    Attributes:
        assumptions: What was assumed and from what, for people, a line each.
        guessed_tools: Numbers of the tools whose diameter nothing tells.
    """

    text: str
    assumptions: tuple[str, ...]
    guessed_tools: tuple[int, ...] = ()

    @property
    def tables(self) -> dict[str, object]:
        """The keys of the job file."""
        return tomllib.loads(self.text)


def prepare_run(
    path: Path, *, dialect: str | None = None, machine: str | None = None, strict: bool = False
) -> tuple[Preparation, AssumedJob | None]:
    """All that the run of a job or a program needs; a program without a job gets the one that is assumed for it.

    Args:
        dialect: Overrides the job's dialect.
        machine: Overrides the job's machine; a path is relative to the working folder.

    Returns:
        What is run, and the job that was assumed, if one was.

    Raises:
        UsageError: A file is missing or wrong, or the dialect cannot be recognised.
        ProgramError: A program without a job is wrong.
    """
    preparation = prepare(path, dialect=dialect, machine=machine, strict=strict, assuming=True)
    if preparation.job.path is not None:
        return preparation, None
    try:
        return with_assumptions(preparation, machine=machine, strict=strict)
    except ProgramError as error:
        raise read_as(error, preparation) from None


def with_assumptions(
    preparation: Preparation, *, machine: str | None, strict: bool
) -> tuple[Preparation, AssumedJob]:
    """A raw program with the job that is assumed for it.

    What a ``twin.toml`` above it sets replaces what would be assumed.

    Raises:
        ProgramError: The program is wrong.
        UsageError: The diameter of a tool is a guess, and ``strict`` runs none.
    """
    leniently = dataclasses.replace(preparation.settings, strict=False)
    assumed = assumed_job(dataclasses.replace(preparation, settings=leniently))
    found = preparation.job
    if strict and assumed.guessed_tools and "tools" not in found.file.model_fields_set:
        guessed = ", ".join(f"T{number}" for number in assumed.guessed_tools)
        raise UsageError(
            f"{found.program}: no comment tells the diameter of {guessed}, and --strict runs no guess: "
            f"write one, such as (T{assumed.guessed_tools[0]} D=10. - flat end mill), or a job by twin init"
        )
    given = found.file.model_dump(exclude_unset=True)
    taken = {key: value for key, value in assumed.tables.items() if key not in given}
    file = JobFile.model_validate({**taken, **given, "dialect": preparation.dialect.name})
    job = Job(found.folder, file, layers=(*found.layers, Layer(ASSUMED, taken)))
    made = prepare_job(job, machine=machine, strict=strict)
    made = dataclasses.replace(
        made, dialect_reason=preparation.dialect_reason, reading=preparation.reading
    )
    read = (_reading_line(made),) if made.dialect_reason else ()
    return dataclasses.replace(made, assumptions=(*read, *assumed.assumptions)), assumed


def assumed_job(preparation: Preparation) -> AssumedJob:
    """The job of a program that has none.

    Raises:
        ProgramError: The program is wrong.
    """
    interpretation, chunks, counts_from_machine_zero = _interpreted(preparation)
    written, own = interpretation.written_zero, interpretation.written_tools
    calls = tool_calls(chunks)
    if written or own:
        preparation = with_written(preparation, written, own, [number for number, _, _ in calls])
        interpretation, chunks, counts_from_machine_zero = _interpreted(preparation)
    moves = concatenate([chunk.moves for chunk in chunks], preparation.machine.axes)
    calls_lengths = bool(interpretation.lengths.calls)
    if calls_lengths:
        moves = at_the_tips(moves, calls, preparation.settings.tools)
    inches, lacking = interpretation.programs_in_inches, _lacking_axes(preparation)
    comments = raw_text(preparation.source).comments
    functions = [each for chunk in chunks for each in chunk.events if isinstance(each, Function)]
    named = named_tools(interpretation.tool_names, inches=inches)
    in_table = table_tools(own, [number for number, _, _ in calls], calls_lengths=calls_lengths)
    declared = {**named, **in_table, **declared_tools(functions)}
    length = _least_length(preparation.machine, moves)
    blank = declared_stock(functions)
    starts = any(each.word in SPINDLE_STARTS for each in functions)
    cuts = Cuts(moves, [begin for _, _, begin in calls], interpretation.drilled, starts)
    top = top_of_stock(cuts) if blank is None else float(blank.top[2])
    worn = {number for number, tool in preparation.settings.tools.items() if not tool.radius}
    by_hand = _speed_is_set_by_hand(functions)
    tools = tool_lines(
        calls,
        comments,
        moves,
        declared,
        inches=inches,
        top=top,
        least_length=length,
        worn=worn,
        by_hand=by_hand,
    )
    stock, position, said = blank or assumed_stock(
        cuts, comments, tools.largest / 2.0, inches=inches
    )
    stock, said = _with_relief(stock, said, moves, position)
    lines = [
        f'program = "{preparation.job.program.name}"',
        f'dialect = "{preparation.dialect.name}"',
        f"machine = {json.dumps(_machine_name(preparation.machine))}",
        *_zero_line(
            preparation,
            moves,
            position,
            stock,
            [*stock, *tools.lines] if counts_from_machine_zero else None,
        ),
        *written_zero_lines(written),
        *unit_lines(preparation.reading),
        "",
        *_start_lines(moves, position),
        *stock,
        *tools.lines,
        *table_lines(preparation.reading),
        *(
            ["[axes]", *(f'{word} = "{IGNORED_AT_ZERO}"' for word in lacking), ""]
            if lacking
            else []
        ),
        *_tolerance_lines(moves, preparation.job.file.tolerance.contour_um),
    ]
    notes = tools.notes
    if written:
        place = " ".join(f"{axis}{value:g}" for axis, value in written.items())
        notes.append(f"the zero that the program writes ({place}) lies at part zero")
    left_out = tuple(f"{word} stays at 0: the machine has no such axis" for word in lacking)
    rapids = f"rapids may leave their path by {_RAPID_TOLERANCE_UM:g} µm"
    notes += [rapids] if (moves.motion == Motion.RAPID).any() else []
    rounding = _rounding_um(moves)
    notes += (
        [
            f"feeds may leave their path by {rounding:g} µm more: so far the program lets corners be rounded"
        ]
        if rounding
        else []
    )
    speed = f"the spindle turns at {SPEED_BY_HAND:g} /min, set by hand, where the program starts it: it holds no S"
    notes += [speed] if by_hand else []
    assumptions = (*preparation.reading.notes, said, *notes, *left_out)
    return AssumedJob("\n".join(lines), assumptions, tools.guessed)


def _speed_is_set_by_hand(functions: Iterable[Function]) -> bool:
    """Whether a program starts the spindle and never gives it a speed, as for routers with a dial."""
    started = {each.word for each in functions if each.word in SPINDLE_STARTS}
    speeds = [each for each in functions if each.word == SPINDLE_SPEED or "S" in each.arguments]
    return bool(started) and not speeds


def _least_length(machine: MachineConfig, moves: Moves) -> float:
    """How long a tool must be to reach a part on a table that turns about a level axis; 0 where it does not [mm]."""
    frame, travel = machine.part_frame, machine.axis("Z").travel
    if frame.chain is None or frame.table_about(2) is not None or travel is None or not len(moves):
        return 0.0
    return travel[0] + MARGIN - float(frame.chain.table[2]) - float(moves.end[:, 2].min())


def _with_relief(
    stock: list[str], said: str, moves: Moves, top: FloatArray | None
) -> tuple[list[str], str]:
    """Room below the stock for what goes through it: who writes the program knows where its parallels are."""
    feeds = moves.motion == Motion.FEED
    if top is None or turns_about_x(moves) or not feeds.any():
        return stock, said
    table = StockTable.model_validate(tomllib.loads("\n".join(stock))["stock"])
    deeper = float(top[2]) - table.extent[2] - float(moves.end[feeds, 2].min())
    if deeper <= BELOW or table.lies:
        return stock, said
    relief = float(np.ceil(deeper)) + _RELIEF
    line = f"relief = {relief:.1f}  # mm, a guess: free below it, since the path goes through by {deeper:.3g}"
    return [
        *stock[:-1],
        line,
        "",
    ], f"{said}; {relief:g} mm below it are free, since the path goes through"


def _start_lines(moves: Moves, top: FloatArray | None) -> list[str]:
    """Where the tool is at first, where program zero lies below the top of the stock or in the axis of a table."""
    height = 0.0 if top is None or top[2] <= 0.0 else float(top[2]) + MARGIN
    if top is None and turns_about_x(moves):
        height = float(moves.end[:, 2].max()) + MARGIN
    return ["[start]", f"Z = {height:.3f}", ""] if height > 0.0 else []


def _rounding_um(moves: Moves) -> float:
    """How far a program lets the control round the corners of its feeds, as by G64 P [µm]; 0 where it does not say."""
    stated = moves.corner_tolerance[moves.motion == Motion.FEED]
    return 1e3 * float(np.nanmax(stated)) if np.isfinite(stated).any() else 0.0


def _tolerance_lines(moves: Moves, contour_um: float) -> list[str]:
    """The tolerances, those alone that some move of the program is held to."""
    rapid = moves.motion == Motion.RAPID
    rounding = _rounding_um(moves)
    comment = f"  # {rounding:g} of it the program lets corners be rounded by" if rounding else ""
    total = round(contour_um + rounding, 3)
    feeds = [f"contour_um = {total}{comment}"] if (~rapid).any() or not rapid.any() else []
    rapids = [f"rapid_contour_um = {_RAPID_TOLERANCE_UM}  # a guess"] if rapid.any() else []
    return ["[tolerance]", *feeds, *rapids, ""]


def _interpreted(preparation: Preparation) -> tuple[Interpretation, list[Chunk], bool]:
    """What the program comes to, and whether it depends on where machine zero lies."""
    interpretation = preparation.interpretation()
    try:
        chunks = list(interpretation.chunks())
    except ProgramError as error:
        if error.diagnostic.code != _MACHINE_ZERO_UNKNOWN:
            raise
        chunks = []
    words = {
        event.word for chunk in chunks for event in chunk.events if isinstance(event, Function)
    }
    if chunks and TOOL_CHANGE not in words:
        return interpretation, chunks, False
    somewhere = anywhere(preparation).interpretation()
    placed = list(somewhere.chunks())
    depends = sum(len(chunk.moves) for chunk in placed) != sum(len(each.moves) for each in chunks)
    return (somewhere, placed, True) if depends else (interpretation, chunks, False)


def _lacking_axes(preparation: Preparation) -> list[str]:
    """Words of axes that the machine lacks and the program names at 0."""
    words = "|".join(sorted(preparation.settings.axis_words))
    if not words:
        return []
    written = re.compile(rf"(?<![A-Z\[#])({words})[ \t]*[-+]?[.0-9]", re.IGNORECASE)
    texts = block_pages(preparation.source)
    return sorted({found[1].upper() for text in texts for found in written.finditer(text)})


def _zero_line(
    preparation: Preparation,
    moves: Moves,
    top: FloatArray | None,
    stock: list[str],
    decides_height: list[str] | None,
) -> list[str]:
    """Where program zero lies: the stock in the table's middle, and its height.

    Args:
        top: Centre of the stock's top face; None: there is no stock.
        stock: Its lines.
        decides_height: Lines of stock and tools, where the program counts from machine zero; else None.
    """
    machine = preparation.machine
    zero: dict[str, float] = {}
    rotary = machine.axes.rotary()
    turns = len(moves) > 0 and bool((moves.start[:, rotary] != moves.end[:, rotary]).any())
    if top is not None and not turns and np.abs(top[:2]).max() > BELOW:
        center = machine.part_frame.over_table
        zero["X"], zero["Y"] = float(center[0] - top[0]), float(center[1] - top[1])
    chain = machine.part_frame.chain
    if turns_about_x(moves) and chain is not None:
        begin = bar_ends(moves)[0]
        if top is not None:
            table = StockTable.model_validate(tomllib.loads("\n".join(stock))["stock"])
            begin = min(begin, float(top[0]) - table.extent[0] / 2.0)
        zero["X"] = float(chain.table[0]) - begin
    if decides_height is not None:
        text = "\n".join(['program = "x"', *decides_height])
        zero["Z"] = _height(JobFile.model_validate(tomllib.loads(text)), machine)
    if not zero:
        return []
    values = ", ".join(f"{name} = {value:.3f}" for name, value in zero.items())
    return [f"part_zero = {{ {values} }}  # mm in machine coordinates"]


def _machine_name(machine: MachineConfig) -> str:
    """As a job beside the program may call it: a shipped machine by its name, another by its path."""
    for name in (*machine_names(), *variant_names()):
        if machine_file(name) == machine.path:
            return name
    return machine.path.resolve().as_posix()


def _height(file: JobFile, machine: MachineConfig) -> float:
    return float(lay_out(file, machine).part_zero[machine.axes.index("Z")])


def text_beside(path: Path, assumed: AssumedJob, program: Path) -> str:
    """The job's text for a file that may lie in another folder than its program."""
    relative = Path(os.path.relpath(program.resolve(), path.resolve().parent)).as_posix()
    return f'program = "{relative}"\n{assumed.text.partition(chr(10))[2]}'


def reading_notes(preparation: Preparation, assumptions: Iterable[str]) -> Iterator[str]:
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
    place = _PLACE_OF_OFFSETS if finding.code == _OFFSET_UNKNOWN else None
    hint = "; ".join(filter(None, (place or finding.hint, said)))
    return ProgramError(dataclasses.replace(finding, hint=hint))


def _reading_line(preparation: Preparation) -> str:
    return f"read as {preparation.dialect.name}: {preparation.dialect_reason}"
