"""What the interpreter made of a program, as lines of JSON or of text.

``start`` and ``end`` of a move are where the axes are: the coordinates of the job's part zero, for the tip of the
job's first tool, whose length the part zero was taken with. A work offset and a tool length in force move them:
with a tool that is 35 mm longer than the first under G43, a programmed Z2 ends at Z37. ``display``, where it is
not ``end``, is what the control's screen shows, which is what the program says: Z2. The text for people shows that
alone. Moves under radius compensation are those of the tool centre, and have ``tool_center``.
"""

import itertools
import json
from collections.abc import Container, Generator, Iterator
from typing import Any

import numpy as np

from twin.nc.canonical import (
    FEED_UNIT_NAMES,
    NO_BLOCK_NUMBER,
    Chunk,
    Dwell,
    Event,
    FeedUnit,
    Motion,
    Moves,
    Shape,
)
from twin.nc.interpreter import Interpretation
from twin.nc.text.diagnostics.diagnostics import Diagnostic, ProgramError

Record = dict[str, Any]


def records(interpretation: Interpretation) -> Iterator[Record]:
    """All results of the program, one record each, in program order: the lines of JSON, read.

    Raises:
        ProgramError: After its diagnostic has been yielded as the last record.
    """
    return map(json.loads, json_lines(interpretation))


def text_lines(interpretation: Interpretation) -> Iterator[str]:
    """The records for a person, one a line, but for the diagnostics, which have a form of their own."""
    for record in records(interpretation):
        if record["type"] in _TEXT:
            yield _TEXT[record["type"]](record)


def json_lines(interpretation: Interpretation) -> Iterator[str]:
    """The records as JSON, one object a line: moves chunk by chunk, the rest record by record."""
    axes = interpretation.settings.axes
    count, length, turn, reported = 0, 0.0, 0.0, 0
    try:
        for chunk in interpretation.chunks():
            yield from _chunk_lines(chunk, interpretation.compensated)
            count += len(chunk.moves)
            turning = chunk.moves.feed_unit == FeedUnit.DEG_PER_MIN
            length += float(chunk.moves.length[~turning].sum())
            turn += float(chunk.moves.length[turning].sum())
            reported = yield from _new_warnings(interpretation, reported)
    except ProgramError as error:
        yield from _new_warnings(interpretation, reported)
        yield _json(_diagnostic(error.diagnostic))
        raise
    end: Record = {
        "type": "end",
        "position": axes.named(interpretation.position),
        "display": axes.named(interpretation.display),
        "moves": count,
        "length": length,
        "turn": turn,
    }
    yield _json(end)


def _new_warnings(interpretation: Interpretation, reported: int) -> Generator[str, None, int]:
    warnings = interpretation.diagnostics
    for diagnostic in warnings[reported:]:
        yield _json(_diagnostic(diagnostic))
    return len(warnings)


def _chunk_lines(chunk: Chunk, compensated: Container[int]) -> Iterator[str]:
    moves, row = _move_lines(chunk.moves, compensated), 0
    for event in chunk.events:
        yield from itertools.islice(moves, event.before - row)
        row = event.before
        yield _json(_event(event))
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


def _move_lines(moves: Moves, compensated: Container[int]) -> Iterator[str]:
    """The records of moves as JSON, written column by column.

    What the control's screen shows at the end, ``display``, is there where it differs from ``end``: the
    program's coordinates under a work offset, a tool length or a relabelled axis.
    """
    others = (np.abs(moves.display - moves.end).max(axis=1, initial=0.0) > _SAME).tolist()
    shown = moves.display.tolist()
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
        rate = "null" if feed != feed else repr(feed)
        arc = f', "arc": {json.dumps(_arc(moves, row))}' if shape == Shape.ARC else ""
        further = f', "display": {places % tuple(shown[row])}' if others[row] else ""
        if line in compensated:
            further += ', "tool_center": true'
        yield (
            f'{motions[motion]}{_SHAPES[shape]}, "line": {line}, "block": {label}, '
            f'"start": {places % start}, "end": {places % end}, "length": {length!r}, '
            f'"feed": {rate}, "feed_unit": {_FEED_UNITS[unit]}{arc}{further}}}'
        )


_SAME = 1e-9
"""Positions that differ by no more are the same [mm or deg]."""
_SHAPES = [json.dumps(shape.name.lower()) for shape in Shape]
_FEED_UNITS = [json.dumps(FEED_UNIT_NAMES[unit]) for unit in FeedUnit]


def _arc(moves: Moves, row: int) -> Record:
    return {
        "center": moves.center[row].tolist(),
        "normal": moves.normal[row].tolist(),
        "radius": float(moves.radius[row]),
        "sweep": float(moves.sweep[row]),
    }


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
    rate = [] if record["motion"] == "feed" else ["rapid"]
    if feed is not None:
        rate.append(f"F{feed:.10g} {record['feed_unit']}")
    arc = record.get("arc")
    bend = "" if arc is None else f"  R{arc['radius']:.10g} sweep {arc['sweep']:.10g}"
    center = "  tool centre" if "tool_center" in record else ""
    shown = _named(record.get("display", record["end"]))
    return f"{line}  {record['shape']:4s}  {shown}  {' '.join(rate)}{bend}{center}"


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
