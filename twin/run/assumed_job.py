"""The job that is assumed for a raw program: stock, zero and tools, as its path and its comments show them."""

import dataclasses
import json
import os
import re
import tomllib
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from twin.files.shipped import machine_file, machine_names, variant_names
from twin.job.job_file import JobFile
from twin.job.load import ASSUMED, Job, Layer
from twin.machine.description.config import Machine
from twin.nc.canonical import Chunk, FloatArray, Function, Motion, Moves, concatenate
from twin.nc.dialects.recognition import HEAD_LINES, comments_of, without_comments
from twin.nc.functions import TOOL_CHANGE
from twin.nc.interpreter import Interpretation
from twin.nc.text.diagnostics import ProgramError
from twin.run.layout import lay_out
from twin.run.preparation import IGNORED_AT_ZERO, Preparation, anywhere, prepare_job
from twin.run.reading.assumed_reading import AssumedReading
from twin.run.reading.assumed_tools import BELOW, tool_lines
from twin.run.reading.declared import declared_stock, declared_tools

_MACHINE_ZERO_UNKNOWN = "no-machine-zero"
"""The finding of a program that counts from machine zero, where no job says where that lies."""
MARGIN = 10.0
"""Stock beyond the feed moves, on each side [mm]."""
_LEAST_HEIGHT = 10.0
_MOST_CLIPPED = 0.5
"""Share of the stock's area that may be taken from it so that no rapid plunges into it; beyond that there is none."""
_RAPID_TOLERANCE_UM = 200.0
"""How exactly rapids are to keep their path: no one measures it, and 0.2 mm hits nothing that is watched."""

_NUMBER = r"\s*[:=-]?\s*([0-9]+(?:\.[0-9]*)?)"
_STOCK_WORDS = r"(?:STOCK(?:/BLOCK)?|BLOCK SIZE|BLANK|MATERIAL(?: SIZE)?|WORKPIECE SIZE|ROHTEIL)"
_STOCKS = (
    re.compile(
        rf"{_STOCK_WORDS}\b[^XYZ]{{0,40}}\bX{_NUMBER}\D{{0,12}}?Y{_NUMBER}\D{{0,12}}?Z{_NUMBER}",
        re.DOTALL,
    ),
    re.compile(
        rf"{_STOCK_WORDS}\b[^0-9]{{0,20}}([0-9.]+)\s*(?:MM)?\s*[X*]\s*([0-9.]+)\s*(?:MM)?\s*[X*]\s*([0-9.]+)",
        re.DOTALL,
    ),
)


@dataclasses.dataclass(frozen=True)
class AssumedJob:
    """A job's text, and what of it is no more than assumed.

    Attributes:
        text: The job file.
        assumptions: What was assumed and from what, for people, a line each.
    """

    text: str
    assumptions: tuple[str, ...]

    @property
    def tables(self) -> dict[str, object]:
        """The keys of the job file."""
        return tomllib.loads(self.text)


def with_assumptions(
    preparation: Preparation, *, machine: str | None, strict: bool
) -> tuple[Preparation, AssumedJob]:
    """A raw program with the job that is assumed for it.

    What a ``twin.toml`` above it sets replaces what would be assumed.

    Args:
        preparation: Of the program.
        machine: Overrides the job's machine.
        strict: Warnings of the interpreter are errors.

    Raises:
        ProgramError: The program is wrong.
    """
    assumed, found = assumed_job(preparation), preparation.job
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
    moves = concatenate([chunk.moves for chunk in chunks], preparation.machine.axes)
    calls = _tool_calls(chunks)
    inches, lacking = interpretation.programs_in_inches, _lacking_axes(preparation)
    comments = list(_comments(preparation))
    functions = [each for chunk in chunks for each in chunk.events if isinstance(each, Function)]
    declared = declared_tools(functions)
    tools, told, diameter = tool_lines(calls, comments, moves, declared, inches=inches)
    stock, position, said = declared_stock(functions) or _stock(
        moves, comments, diameter / 2.0, inches=inches
    )
    lines = [
        f'program = "{preparation.job.program.name}"',
        f'dialect = "{preparation.dialect.name}"',
        f"machine = {json.dumps(_machine_name(preparation.machine))}",
        *_zero_line(
            preparation,
            moves,
            position,
            [*stock, *tools] if counts_from_machine_zero else None,
        ),
        *_unit_lines(preparation.reading),
        "",
        *_start_lines(position),
        *stock,
        *tools,
        *_reading_lines(preparation.reading),
        *(
            ["[axes]", *(f'{word} = "{IGNORED_AT_ZERO}"' for word in lacking), ""]
            if lacking
            else []
        ),
        *_tolerance_lines(moves, preparation.job.file.tolerance.contour_um),
    ]
    left_out = tuple(f"{word} stays at 0: the machine has no such axis" for word in lacking)
    rapids = f"rapids may leave their path by {_RAPID_TOLERANCE_UM:g} µm"
    told += [rapids] if (moves.motion == Motion.RAPID).any() else []
    return AssumedJob("\n".join(lines), (*preparation.reading.notes, said, *told, *left_out))


def _start_lines(top: FloatArray | None) -> list[str]:
    """Where the tool is at first, where program zero lies below the top of the stock."""
    return [] if top is None or top[2] <= 0.0 else ["[start]", f"Z = {top[2] + MARGIN:.3f}", ""]


def _tolerance_lines(moves: Moves, contour_um: float) -> list[str]:
    """The tolerances, those alone that some move of the program is held to."""
    rapid = moves.motion == Motion.RAPID
    feeds = [f"contour_um = {contour_um}"] if (~rapid).any() or not rapid.any() else []
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


def _tool_calls(chunks: list[Chunk]) -> list[tuple[int, int, int]]:
    """Number, line and next move of every tool that comes: by M6, in a program without it by T alone."""
    selected: list[tuple[int, int, int]] = []
    changed: list[tuple[int, int, int]] = []
    done = 0
    for chunk in chunks:
        for event in chunk.events:
            if not isinstance(event, Function):
                continue
            if event.word[:1] == "T" and event.word[1:].isdigit():
                selected.append((int(event.word[1:]), event.line, done + event.before))
            elif event.word == TOOL_CHANGE and selected:
                changed.append((selected[-1][0], event.line, done + event.before))
        done += len(chunk.moves)
    return changed or selected


def _unit_lines(reading: AssumedReading) -> list[str]:
    """The units, and what a number without a point counts, where that was assumed."""
    point, units = reading.keys.get("decimal_point"), reading.keys.get("units")
    lines = [] if point is None else [f'decimal_point = "{point}"  # increments: X10 is 0.010 mm']
    return lines if units is None else [*lines, f'units = "{units}"']


def _reading_lines(reading: AssumedReading) -> list[str]:
    """Tables of the work offsets and M codes that were assumed."""
    lines: list[str] = []
    offsets, functions = reading.keys.get("offsets"), reading.keys.get("m_functions")
    rows = reading.keys.get("offset_rows")
    if isinstance(offsets, dict):
        lines += [line for name in offsets for line in (f"[offsets.{name}]", "")]
    if isinstance(rows, dict):
        lines += ["[offset_rows]", *(f"{row} = {tool}" for row, tool in rows.items()), ""]
    if isinstance(functions, dict):
        lines += ["[m_functions]", *(f'{code} = "{does}"' for code, does in functions.items()), ""]
    return lines


def _lacking_axes(preparation: Preparation) -> list[str]:
    """Words of axes that the machine lacks and the program names at 0."""
    words = "|".join(sorted(preparation.settings.axis_words))
    if not words:
        return []
    written = re.compile(rf"(?<![A-Z\[#])({words})[ \t]*[-+]?[.0-9]", re.IGNORECASE)
    lines = map(without_comments, preparation.source.lines)
    return sorted({found[1].upper() for line in lines for found in written.finditer(line)})


def _comments(preparation: Preparation) -> Iterator[tuple[int, str]]:
    """Every comment with its line, from 1, as long as lists of tools and tool changes may stand there."""
    for number, line in enumerate(preparation.source.lines, 1):
        for comment in comments_of(line):
            yield number, comment


# --- stock and zero


def _stock(
    moves: Moves, comments: list[tuple[int, str]], radius: float, *, inches: bool
) -> tuple[list[str], FloatArray | None, str]:
    """Lines of the stock, the centre of its top face, and how it came about."""
    feeds = moves.motion == Motion.FEED
    points = np.concatenate([moves.start[feeds], moves.end[feeds]])[:, :3]
    if not len(points):
        return _no_stock("the program feeds nowhere")
    low, high = points.min(axis=0), points.max(axis=0)
    head = "\n".join(text for line, text in comments if line <= HEAD_LINES).upper()
    told = next((match for pattern in _STOCKS if (match := pattern.search(head))), None)
    if told is not None:
        size = np.array([float(value) for value in told.groups()]) * (25.4 if inches else 1.0)
        if (size > 0.0).all():
            center = _center_of(size, low, high)
            top = 0.0 if low[2] < 0.0 else float(size[2])
            return _box(size, np.array([*center, top]), "a comment in the program's head")
    if low[2] >= -BELOW:
        drop = moves.end[:, 2] - moves.start[:, 2]
        flat, plunges = feeds & (np.abs(drop) < BELOW), (feeds & (drop < -BELOW)).any()
        top = float(moves.end[flat, 2].max()) if plunges and flat.any() else 0.0
        if top <= BELOW:
            return _no_stock("no feed goes below Z0")
        bottom = 0.0
    else:
        top, bottom = 0.0, float(low[2]) - MARGIN
    corner, far, plunges = _clipped(moves, low[:2] - MARGIN, high[:2] + MARGIN, top, radius)
    whole = np.prod(high[:2] - low[:2] + 2.0 * MARGIN)
    if (far <= corner).any() or np.prod(far - corner) < (1.0 - _MOST_CLIPPED) * whole:
        return _no_stock("rapids plunge wherever it could lie")
    size = np.array([*(far - corner), max(np.ceil(top - bottom), _LEAST_HEIGHT)])
    size[:2] = np.floor(size[:2] * 10.0) / 10.0
    around = f"the path and {MARGIN:g} mm around it"
    if plunges:
        several = "lines" if len(plunges) > 1 else "line"
        around += (
            f", less where the rapids of {several} {', '.join(map(str, plunges[:5]))}"
            f"{' ...' if len(plunges) > 5 else ''} go below its top: what they would hit there is not judged"
        )
    return _box(size, np.array([*((corner + far) / 2.0), top]), around)


def _clipped(
    moves: Moves, corner: FloatArray, far: FloatArray, top: float, radius: float
) -> tuple[FloatArray, FloatArray, list[int]]:
    """The box without what rapids would plunge into, and their lines; holes that were fed before are none of that."""
    lines: list[int] = []
    fed: dict[tuple[float, float], float] = {}
    rapid, ends = moves.motion == Motion.RAPID, moves.end[:, :3].round(3)
    starts = moves.start[:, 2]
    below = ends[:, 2] < top - BELOW
    for row in np.flatnonzero(below):
        x, y, z = ends[row].tolist()
        if not rapid[row]:
            fed[x, y] = min(z, fed.get((x, y), z))
            continue
        if starts[row] <= z + BELOW or fed.get((x, y), top) <= z + 1.0:
            continue
        if (corner < (x + radius, y + radius)).all() and (far > (x - radius, y - radius)).all():
            lines.append(int(moves.line[row]))
            width, depth = (far - corner).tolist()
            losses = {
                (0, "low"): (x + radius - corner[0]) * depth,
                (0, "high"): (far[0] - x + radius) * depth,
                (1, "low"): (y + radius - corner[1]) * width,
                (1, "high"): (far[1] - y + radius) * width,
            }
            (axis, side), _ = min(losses.items(), key=lambda pair: pair[1])
            place = (x, y)[axis]
            corner, far = corner.copy(), far.copy()
            if side == "low":
                corner[axis] = place + radius + _CLEAR
            else:
                far[axis] = place - radius - _CLEAR
    return corner, far, list(dict.fromkeys(lines))


_CLEAR = 0.5
"""Between the stock and a tool that plunges beside it [mm]."""


def _center_of(size: FloatArray, low: FloatArray, high: FloatArray) -> tuple[float, float]:
    """Where stock of a known size lies: from a corner at zero, around zero, or around the path."""
    slack = MARGIN
    if (low[:2] >= -slack).all() and (high[:2] <= size[:2] + slack).all():
        return float(size[0]) / 2.0, float(size[1]) / 2.0
    if (np.abs(low[:2]) <= size[:2] / 2.0 + slack).all() and (
        np.abs(high[:2]) <= size[:2] / 2.0 + slack
    ).all():
        return 0.0, 0.0
    return float(low[0] + high[0]) / 2.0, float(low[1] + high[1]) / 2.0


def _box(size: FloatArray, top: FloatArray, source: str) -> tuple[list[str], FloatArray, str]:
    measures = ", ".join(f"{value:.1f}" for value in size)
    lines = [
        "[stock]",
        'shape = "box"',
        f"size = [{measures}]  # mm: from {source}",
        f"position = [{top[0]:.3f}, {top[1]:.3f}, {top[2]:.3f}]  # centre of its top face, mm",
        "",
    ]
    return (
        lines,
        top,
        f"stock {' x '.join(f'{value:g}' for value in size.round(1))} mm, top at Z{top[2]:g}: from {source}",
    )


def _no_stock(reason: str) -> tuple[list[str], None, str]:
    lines = [
        f"# No stock: {reason}. With one it would read:",
        "# [stock]",
        '# shape = "box"',
        "# size = [100.0, 100.0, 20.0]  # mm; its top face lies at program Z0",
        "",
    ]
    return lines, None, f"no stock: {reason}, so that nothing is cut"


def _zero_line(
    preparation: Preparation,
    moves: Moves,
    top: FloatArray | None,
    decides_height: list[str] | None,
) -> list[str]:
    """Where program zero lies: the stock in the table's middle, and its height.

    Args:
        preparation: Of the program.
        moves: What it makes.
        top: Centre of the stock's top face; None: there is no stock.
        decides_height: Lines of stock and tools, where the program counts from machine zero; else None.
    """
    machine = preparation.machine
    zero: dict[str, float] = {}
    rotary = machine.axes.rotary()
    turns = len(moves) > 0 and bool((moves.start[:, rotary] != moves.end[:, rotary]).any())
    if top is not None and not turns and np.abs(top[:2]).max() > BELOW:
        center = machine.part_frame.over_table
        zero["X"], zero["Y"] = float(center[0] - top[0]), float(center[1] - top[1])
    if decides_height is not None:
        text = "\n".join(['program = "x"', *decides_height])
        zero["Z"] = _height(JobFile.model_validate(tomllib.loads(text)), machine)
    if not zero:
        return []
    values = ", ".join(f"{name} = {value:.3f}" for name, value in zero.items())
    return [f"part_zero = {{ {values} }}  # mm in machine coordinates"]


def _machine_name(machine: Machine) -> str:
    """As a job beside the program may call it: a shipped machine by its name, another by its path."""
    for name in (*machine_names(), *variant_names()):
        if machine_file(name) == machine.path:
            return name
    return machine.path.resolve().as_posix()


def _height(file: JobFile, machine: Machine) -> float:
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
    hint = f"{finding.hint}; {said}" if finding.hint else said
    return ProgramError(dataclasses.replace(finding, hint=hint))


def _reading_line(preparation: Preparation) -> str:
    return f"read as {preparation.dialect.name}: {preparation.dialect_reason}"
