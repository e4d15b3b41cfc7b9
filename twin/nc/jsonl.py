"""What the interpreter made of a program, as lines of JSON or of text."""

import itertools
import json
import math
from collections.abc import Callable, Generator, Iterator
from typing import Any, TypeVar

from twin.nc.canonical import (
    FEED_UNIT_NAMES,
    NO_BLOCK_NUMBER,
    Axes,
    Chunk,
    Dwell,
    Event,
    FeedUnit,
    Motion,
    Moves,
    Shape,
)
from twin.nc.interpreter import Interpretation
from twin.nc.text.diagnostics import Diagnostic, ProgramError

Record = dict[str, Any]
ItemT = TypeVar("ItemT")


def records(interpretation: Interpretation) -> Iterator[Record]:
    """Everything the program comes to, one record each, in program order.

    Raises:
        ProgramError: After its diagnostic has been yielded as the last record.
    """
    return _items(interpretation, _move_records, lambda record: record)


def json_lines(interpretation: Interpretation) -> Iterator[str]:
    """The records as JSON, one object a line.

    Raises:
        ProgramError: As in ``records``.
    """
    return _items(interpretation, _move_lines, _json)


def text_lines(interpretation: Interpretation) -> Iterator[str]:
    """The records for a person, one a line, but for the diagnostics, which have a form of their own.

    Raises:
        ProgramError: As in ``records``.
    """
    for record in records(interpretation):
        if record["type"] in _TEXT:
            yield _TEXT[record["type"]](record)


def _items(
    interpretation: Interpretation,
    of_moves: Callable[[Moves], Iterator[ItemT]],
    of_record: Callable[[Record], ItemT],
) -> Iterator[ItemT]:
    """Everything the program comes to: moves told by the chunk, the rest record by record."""
    axes = interpretation.settings.axes
    count, length, turn, told = 0, 0.0, 0.0, 0
    try:
        for chunk in interpretation.chunks():
            yield from _chunk_items(chunk, of_moves, of_record)
            count += len(chunk.moves)
            turning = chunk.moves.feed_unit == FeedUnit.DEG_PER_MIN
            length += float(chunk.moves.length[~turning].sum())
            turn += float(chunk.moves.length[turning].sum())
            told = yield from _new_warnings(interpretation, told, of_record)
    except ProgramError as error:
        yield from _new_warnings(interpretation, told, of_record)
        yield of_record(_diagnostic(error.diagnostic))
        raise
    end: Record = {
        "type": "end",
        "position": axes.named(interpretation.position),
        "display": axes.named(interpretation.display),
        "moves": count,
        "length": length,
        "turn": turn,
    }
    yield of_record(end)


def _new_warnings(
    interpretation: Interpretation, told: int, of_record: Callable[[Record], ItemT]
) -> Generator[ItemT, None, int]:
    warnings = interpretation.diagnostics
    for diagnostic in warnings[told:]:
        yield of_record(_diagnostic(diagnostic))
    return len(warnings)


def _chunk_items(
    chunk: Chunk,
    of_moves: Callable[[Moves], Iterator[ItemT]],
    of_record: Callable[[Record], ItemT],
) -> Iterator[ItemT]:
    moves, row = of_moves(chunk.moves), 0
    for event in chunk.events:
        yield from itertools.islice(moves, event.before - row)
        row = event.before
        yield of_record(_event(event))
    yield from moves


def _event(event: Event) -> Record:
    if isinstance(event, Dwell):
        return {"type": "dwell", "line": event.line, "seconds": event.seconds}
    record: Record = {
        "type": "function",
        "line": event.line,
        "word": event.word,
        "arguments": dict(event.arguments),
    }
    if event.at > 0.0:
        record["at"] = event.at
    return record


def _json(record: Record) -> str:
    return json.dumps(record, ensure_ascii=False, allow_nan=False)


def _move_records(moves: Moves) -> Iterator[Record]:
    return (_move(moves, row) for row in range(len(moves)))


def _move_lines(moves: Moves) -> Iterator[str]:
    """What ``_json`` makes of the records of moves, written column by column, ten times as fast."""
    places = "{" + ", ".join(f"{json.dumps(name)}: %r" for name in moves.axes.names) + "}"
    motions = [f'{{"type": "move", "motion": "{each.name.lower()}", "shape": ' for each in Motion]
    rows = zip(
        moves.motion.tolist(),
        moves.shape.tolist(),
        moves.line.tolist(),
        moves.block.tolist(),
        map(tuple, moves.start.tolist()),
        map(tuple, moves.end.tolist()),
        moves.length.tolist(),
        moves.feed.tolist(),
        moves.feed_unit.tolist(),
        strict=True,
    )
    for row, (motion, shape, line, block, start, end, length, feed, unit) in enumerate(rows):
        label = "null" if block == NO_BLOCK_NUMBER else f'"N{block}"'
        pace = "null" if feed != feed else repr(feed)
        arc = f', "arc": {json.dumps(_arc(moves, row))}' if shape == Shape.ARC else ""
        yield (
            f'{motions[motion]}{_SHAPES[shape]}, "line": {line}, "block": {label}, '
            f'"start": {places % start}, "end": {places % end}, "length": {length!r}, '
            f'"feed": {pace}, "feed_unit": {_FEED_UNITS[unit]}{arc}}}'
        )


_SHAPES = [json.dumps(shape.name.lower()) for shape in Shape]
_FEED_UNITS = [json.dumps(FEED_UNIT_NAMES[unit]) for unit in FeedUnit]


def _arc(moves: Moves, row: int) -> Record:
    return {
        "center": moves.center[row].tolist(),
        "normal": moves.normal[row].tolist(),
        "radius": float(moves.radius[row]),
        "sweep": float(moves.sweep[row]),
    }


def _move(moves: Moves, row: int) -> Record:
    axes: Axes = moves.axes
    block, feed = int(moves.block[row]), float(moves.feed[row])
    record: Record = {
        "type": "move",
        "motion": Motion(moves.motion[row]).name.lower(),
        "shape": Shape(moves.shape[row]).name.lower(),
        "line": int(moves.line[row]),
        "block": None if block == NO_BLOCK_NUMBER else f"N{block}",
        "start": axes.named(moves.start[row]),
        "end": axes.named(moves.end[row]),
        "length": float(moves.length[row]),
        "feed": None if math.isnan(feed) else feed,
        "feed_unit": FEED_UNIT_NAMES[FeedUnit(moves.feed_unit[row])],
    }
    if moves.shape[row] == Shape.ARC:
        record["arc"] = _arc(moves, row)
    return record


def _diagnostic(diagnostic: Diagnostic) -> Record:
    return {
        "type": "diagnostic",
        "severity": diagnostic.severity,
        "code": diagnostic.code,
        "line": diagnostic.line,
        "column": diagnostic.column,
        "message": diagnostic.message,
        "hint": diagnostic.hint,
    }


def _named(values: dict[str, float]) -> str:
    return " ".join(f"{name}{value:.10g}" for name, value in values.items())


def _move_text(record: Record) -> str:
    line, feed = f"{record['line']:6d}", record["feed"]
    pace = [] if record["motion"] == "feed" else ["rapid"]
    if feed is not None:
        pace.append(f"F{feed:.10g} {record['feed_unit']}")
    arc = record.get("arc")
    bend = "" if arc is None else f"  R{arc['radius']:.10g} sweep {arc['sweep']:.10g}"
    return f"{line}  {record['shape']:4s}  {_named(record['end'])}  {' '.join(pace)}{bend}"


def _function_text(record: Record) -> str:
    place = f"at {record['at']:.10g} of the move" if "at" in record else ""
    words = (record["word"], _named(record["arguments"]), place)
    return f"{record['line']:6d}  {'  '.join(word for word in words if word)}"


def _end_text(record: Record) -> str:
    return f"   end  {_named(record['position'])}  ({record['moves']} moves, {record['length']:.10g} mm)"


_TEXT = {
    "move": _move_text,
    "dwell": lambda record: f"{record['line']:6d}  dwell {record['seconds']:.10g} s",
    "function": _function_text,
    "end": _end_text,
}
