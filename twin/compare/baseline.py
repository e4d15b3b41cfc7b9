"""Baselines: what a program came to when it was last approved, as text that diffs well.

A baseline holds the canonical moves, one a line, the cycle time and the greatest contour error. A
later run is held to it: the first block whose path differs is named with its program line.
"""

import dataclasses
import itertools
import math
from collections.abc import Iterable, Iterator
from pathlib import Path

from twin.compare.verdict import Reason
from twin.errors import UsageError
from twin.files import complete_or_absent
from twin.job import BaselineTable
from twin.nc.canonical import Motion, Moves, Shape

_HEADING = "twin baseline 1"
_DECIMALS = 6
"""Of coordinates in the file: a nanometre, far below any tolerance."""


@dataclasses.dataclass(frozen=True, slots=True)
class RunFigures:
    """What a baseline keeps beside the path.

    Attributes:
        cycle_time_s: Machine time of the program [s].
        contour_um: Greatest contour error [µm].
    """

    cycle_time_s: float
    contour_um: float


@dataclasses.dataclass(frozen=True, slots=True)
class _Block:
    """One canonical move as a baseline knows it; lines without an arc have no ``arc`` numbers."""

    line: int
    kind: str
    start: tuple[float, ...]
    end: tuple[float, ...]
    arc: tuple[float, ...]


_KINDS = {
    (motion, shape): f"{motion.name.lower()} {shape.name.lower()}"
    for motion in Motion
    for shape in Shape
}


def write_baseline(path: Path, figures: RunFigures, chunks: Iterable[Moves]) -> None:
    """Store a baseline, complete or not at all.

    Args:
        path: The file.
        figures: What the run came to.
        chunks: The canonical moves of the program, in order.
    """
    with complete_or_absent(path) as temporary, temporary.open("w", encoding="utf-8") as file:
        file.write(f"{_HEADING}\n")
        file.write(f"cycle_time_s {figures.cycle_time_s:.6f}\n")
        file.write(f"contour_um {figures.contour_um:.3f}\n")
        names: tuple[str, ...] = ()
        for chunk in chunks:
            if not names:
                names = chunk.axes.names
                file.write(f"axes {' '.join(names)}\n")
            file.writelines(f"{_text(block)}\n" for block in _blocks(chunk))


def compare_baseline(
    path: Path, figures: RunFigures, chunks: Iterable[Moves], limits: BaselineTable
) -> list[Reason]:
    """Hold a run to its baseline.

    Args:
        path: The stored file.
        figures: What the run came to now.
        chunks: Its canonical moves now.
        limits: How far they may differ.

    Returns:
        One reason each for path, cycle time and contour error, where they differ too much; the
        path's names the first block that differs.

    Raises:
        UsageError: The file is not a baseline.
    """
    if not path.is_file():
        message = f"there is no baseline {path}; --update-baseline stores one"
        return [Reason("baseline-missing", message, 0, 0.0)]
    with path.open(encoding="utf-8") as file:
        try:
            stored = _read_figures(file)
            names = _read_axes(file)
            difference = _first_difference(_read_blocks(file), chunks, names, limits.path_um)
        except (ValueError, IndexError) as error:
            raise UsageError(f"{path}: is not a baseline of this twin: {error}") from error
    reasons = [] if difference is None else [difference]
    change = figures.cycle_time_s - stored.cycle_time_s
    if abs(change) > limits.cycle_time_percent / 100.0 * stored.cycle_time_s + 1e-9:
        message = (
            f"cycle time {figures.cycle_time_s:.3f} s, baseline {stored.cycle_time_s:.3f} s: "
            f"differs by more than {limits.cycle_time_percent:g} %"
        )
        reasons.append(Reason("baseline-cycle-time", message, 0, figures.cycle_time_s))
    if figures.contour_um - stored.contour_um > limits.contour_um:
        message = (
            f"contour error {figures.contour_um:.1f} µm, baseline {stored.contour_um:.1f} µm: "
            f"grew by more than {limits.contour_um:g} µm"
        )
        reasons.append(Reason("baseline-contour", message, 0, 0.0))
    return reasons


def _blocks(moves: Moves) -> Iterator[_Block]:
    for row in range(len(moves)):
        shape = Shape(moves.shape[row])
        arc = ()
        if shape is Shape.ARC:
            arc = (*moves.center[row].tolist(), *moves.normal[row].tolist(), moves.sweep[row])
        yield _Block(
            line=int(moves.line[row]),
            kind=_KINDS[Motion(moves.motion[row]), shape],
            start=tuple(moves.start[row].tolist()),
            end=tuple(moves.end[row].tolist()),
            arc=tuple(float(value) for value in arc),
        )


def _text(block: _Block) -> str:
    parts = [str(block.line), block.kind, _numbers(block.start), _numbers(block.end)]
    return " | ".join([*parts, _numbers(block.arc)] if block.arc else parts)


def _numbers(values: tuple[float, ...]) -> str:
    return " ".join(_number(value) for value in values)


def _number(value: float) -> str:
    text = f"{value:.{_DECIMALS}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _read_figures(lines: Iterator[str]) -> RunFigures:
    if next(lines, "").strip() != _HEADING:
        raise ValueError(f"the first line is not '{_HEADING}'")
    values = dict(line.split() for line in itertools.islice(lines, 2))
    if set(values) != {"cycle_time_s", "contour_um"}:
        raise ValueError("cycle_time_s and contour_um are missing")
    return RunFigures(float(values["cycle_time_s"]), float(values["contour_um"]))


def _read_axes(lines: Iterator[str]) -> tuple[str, ...]:
    words = next(lines, "axes").split()
    if words[:1] != ["axes"]:
        raise ValueError("the line of axes is missing")
    return tuple(words[1:])


def _read_blocks(lines: Iterator[str]) -> Iterator[_Block]:
    for text in lines:
        line, kind, *numbers = (part.strip() for part in text.split("|"))
        start, end, *arc = (tuple(float(word) for word in part.split()) for part in numbers)
        yield _Block(int(line), kind, start, end, arc[0] if arc else ())


def _first_difference(
    stored: Iterator[_Block], chunks: Iterable[Moves], names: tuple[str, ...], path_um: float
) -> Reason | None:
    now_blocks = (block for chunk in chunks for block in _blocks(chunk))
    for before, now in itertools.zip_longest(stored, now_blocks):
        what = _difference(before, now, names, path_um / 1e3)
        if what is not None:
            line = now.line if now is not None else 0
            return Reason("baseline-path", f"the path differs from the baseline: {what}", line, 0.0)
    return None


def _difference(
    before: _Block | None, now: _Block | None, names: tuple[str, ...], tolerance: float
) -> str | None:
    if now is None:
        return f"the program ends before what was line {before.line if before else 0}"
    if before is None:
        return "a move that the baseline does not have"
    if now.kind != before.kind:
        return f"{now.kind}, baseline {before.kind} (line {before.line})"
    if len(now.end) != len(names):
        return f"{len(now.end)} axes, baseline {len(names)}"
    for what, one, other in (("starts", now.start, before.start), ("ends", now.end, before.end)):
        for name, here, there in zip(names, one, other, strict=True):
            if abs(here - there) > tolerance:
                return f"{what} at {name}{_number(here)}, baseline {name}{_number(there)}"
    return _arc_difference(before.arc, now.arc, tolerance)


def _arc_difference(
    before: tuple[float, ...], now: tuple[float, ...], tolerance: float
) -> str | None:
    if not now:
        return None
    if math.dist(now[:3], before[:3]) > tolerance:
        return f"arc about ({_numbers(now[:3])}), baseline ({_numbers(before[:3])})"
    same_side = sum(a * b for a, b in zip(now[3:6], before[3:6], strict=True))
    # The end point tells a wrong angle within the turn; the sign and whole turns it cannot tell.
    if abs(now[6] * same_side - before[6]) > 0.5:
        return f"arc of {_number(now[6])} degrees, baseline {_number(before[6])}"
    return None
