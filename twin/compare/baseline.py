"""Baselines: what a program came to when it was last approved.

A later run is held to it: every block that differs is named with its program line, and so is every
key of the job, and every figure of the run and of its cut.
"""

import dataclasses
import itertools
from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from twin.compare.baseline_text import (
    BaselineEntry,
    Head,
    RunFigures,
    entries,
    number,
    read_entries,
    read_head,
    text,
    write,
)
from twin.compare.block_difference import block_differences, same_end
from twin.compare.changed_lines import (
    changed_codes,
    changed_lines,
    differences_by_line,
    numbered,
)
from twin.compare.verdict import Reason
from twin.errors import UsageError
from twin.files.atomic import complete_or_absent
from twin.job.tolerance import BaselineTable
from twin.nc.canonical import Axes, Chunk
from twin.nc.text.diagnostics.diagnostics import ProgramError

MOST_LISTED = 50
"""Blocks that are named one by one; how many more differ is reported behind them."""
_LOOK_AHEAD = 24
"""Blocks that may be inserted or lost in one place and the rest be recognised again."""
_SMALLEST_TIME = 1e-6
"""A cycle time that differs by no more than this is the same [s]: what the file resolves."""
_CUT_FIGURES = {
    "removed_mm3": "removes {} mm³ in all",
    "air_share": "share of the feed's path in air {}",
    "gouges_count": "gouges {}",
    "rapid_into_stock_count": "rapids into stock {}",
    "spindle_off_count": "feeds into stock with the spindle off {}",
}
"""Figures of the cut in words; all others are a tool's volume."""


def write_baseline(
    path: Path,
    figures: RunFigures,
    axes: Axes,
    chunks: Iterable[Chunk],
    settings: Mapping[str, str] | None = None,
    source: Sequence[str] = (),
) -> None:
    """Store a baseline, complete or not at all.

    Args:
        source: Lines of the program without comments.
    """
    with complete_or_absent(path) as temporary, temporary.open("w", encoding="utf-8") as file:
        head = Head(figures, axes.names, settings or {}, numbered(source)[1])
        write(file, head, entries(chunks))


def compare_baseline(
    path: Path,
    figures: RunFigures | None,
    axes: Axes,
    chunks: Iterable[Chunk],
    limits: BaselineTable,
    settings: Mapping[str, str] | None = None,
    source: Sequence[str] = (),
) -> list[Reason]:
    """Hold a run to its baseline.

    Args:
        figures: What the run came to; None when it did not come to its end.
        chunks: The program; where it no longer interprets, the baseline tells what was there.
        source: Lines of the program without comments, of which the changed ones are named.

    Returns:
        A reason for every key of the job, every block and every figure that differs too much.

    Raises:
        UsageError: The file is not a baseline.
    """
    if not path.is_file():
        message = f"there is no baseline {path}; --update-baseline stores one"
        return [Reason("baseline-missing", message, 0, 0.0)]
    try:
        with path.open(encoding="utf-8") as file:
            head, lines = read_head(file)
            reasons = _settings_reasons(head.settings, settings or {})
            if axes.names != head.axes:
                message = f"axes {' '.join(axes.names)}, baseline {' '.join(head.axes)}"
                reasons.append(Reason("baseline-path", message, 0, 0.0))
            else:
                pairs = _Pairs(read_entries(lines, head.axes), entries(chunks), limits)
                changed = changed_lines(head.source, source) if head.source else []
                found = _program_reasons(pairs, head.axes, limits)
                differing = list(differences_by_line(found, changed))
                known = {reason.line for reason in differing}
                differing += [
                    each for each in _code_reasons(head.source, source) if each.line not in known
                ]
                reasons += _first_of(iter(differing))
    except (ValueError, IndexError, TypeError) as error:
        message = f"{path}: is not a baseline of this twin: {error}; --update-baseline stores one"
        raise UsageError(message) from error
    return reasons + ([] if figures is None else _figure_reasons(head.figures, figures, limits))


def _code_reasons(stored: Sequence[str], now: Sequence[str]) -> Iterator[Reason]:
    """Other codes and offsets, where nothing moves differently for them."""
    for line, message in changed_codes(stored, now) if stored else ():
        yield Reason("baseline-function", message, line, 0.0)


def _settings_reasons(stored: Mapping[str, str], now: Mapping[str, str]) -> list[Reason]:
    reasons = []
    for key in sorted(stored.keys() | now.keys()):
        here, there = now.get(key, "not set"), stored.get(key, "not set")
        if here != there:
            message = f"{key} is {here}, baseline {there}"
            reasons.append(Reason("baseline-job", message, 0, 0.0))
    return reasons


def _figure_reasons(stored: RunFigures, now: RunFigures, limits: BaselineTable) -> list[Reason]:
    reasons = []
    allowed = limits.cycle_time_percent / 100.0 * stored.cycle_time_s + _SMALLEST_TIME
    if abs(now.cycle_time_s - stored.cycle_time_s) > allowed:
        message = (
            f"cycle time {now.cycle_time_s:.3f} s, baseline {stored.cycle_time_s:.3f} s: "
            f"differs by more than {limits.cycle_time_percent:g} %"
        )
        reasons.append(Reason("baseline-cycle-time", message, 0, now.cycle_time_s))
    if now.contour_um - stored.contour_um > limits.contour_um:
        message = (
            f"contour error {now.contour_um:.1f} µm, baseline {stored.contour_um:.1f} µm: "
            f"grew by more than {limits.contour_um:g} µm"
        )
        reasons.append(Reason("baseline-contour", message, 0, 0.0))
    for name in sorted(stored.cut.keys() | now.cut.keys()):
        here, there = now.cut.get(name, 0.0), stored.cut.get(name, 0.0)
        # Counts must be equal; volumes and shares, which are not whole, may differ a little.
        share = 0.0 if name.endswith("_count") else limits.cut_percent / 100.0
        if abs(here - there) > share * max(abs(there), 1e-3):
            what = _CUT_FIGURES.get(name) or f"tool {name.removeprefix('tool.')} removes {{}} mm³"
            message = f"cut: {what.format(number(here))}, baseline {number(there)}"
            reasons.append(Reason("baseline-cut", message, 0, 0.0))
    return reasons


def _first_of(reasons: Iterator[Reason]) -> list[Reason]:
    listed = list(itertools.islice(reasons, MOST_LISTED))
    more = sum(1 for _ in reasons)
    if more:
        listed.append(Reason("baseline-path", f"{more} more differences of blocks", 0, 0.0))
    return listed


class _Pair(NamedTuple):
    """A pair that was matched: a stored block, a block of the program, or both."""

    before: BaselineEntry | None
    now: BaselineEntry | None
    line: int


class _Pairs:
    """Stored blocks and those of the program, side by side, found again behind a lost or new one."""

    def __init__(
        self,
        stored: Iterator[BaselineEntry],
        program: Iterator[BaselineEntry],
        limits: BaselineTable,
    ) -> None:
        self._sources = (stored, program)
        self._ahead: tuple[deque[BaselineEntry], deque[BaselineEntry]] = (deque(), deque())
        self._tolerance = limits.path_um / 1e3
        self._line = 0
        self._broken: ProgramError | None = None

    def expected(self) -> BaselineEntry | None:
        """The stored block that comes next."""
        self._fill(0, 1)
        return self._ahead[0][0] if self._ahead[0] else None

    def __iter__(self) -> Iterator[_Pair]:
        stored, program = self._ahead
        while True:
            self._fill(0, 1)
            self._fill(1, 1)
            if not program and self._broken is not None:
                raise self._broken
            if not stored and not program:
                return
            if stored and program and same_end(stored[0], program[0], self._tolerance):
                yield self._taken(1, 1)
                continue
            lost, new = self._found_again()
            for _ in range(min(lost, new)):
                yield self._taken(1, 1)
            for _ in range(lost - new):
                yield self._taken(1, 0)
            for _ in range(new - lost):
                yield self._taken(0, 1)

    def _taken(self, stored: int, program: int) -> _Pair:
        before = self._ahead[0].popleft() if stored else None
        now = self._ahead[1].popleft() if program else None
        # What is lost is reported at the line before which it stood.
        found_at = now or (self._ahead[1][0] if self._ahead[1] else None)
        self._line = self._line if found_at is None else found_at.line
        return _Pair(before, now, self._line)

    def _found_again(self) -> tuple[int, int]:
        """How many stored blocks and blocks of the program lie before the next that are alike."""
        self._fill(0, _LOOK_AHEAD)
        self._fill(1, _LOOK_AHEAD)
        stored, program = self._ahead
        for away in range(1, _LOOK_AHEAD * 2):
            for lost in sorted(range(away + 1), key=lambda lost, away=away: abs(2 * lost - away)):
                new = away - lost
                if (
                    lost < len(stored)
                    and new < len(program)
                    and same_end(stored[lost], program[new], self._tolerance)
                ):
                    return lost, new
        return len(program) if self._broken else len(stored), len(program)

    def _fill(self, side: int, count: int) -> None:
        while len(self._ahead[side]) < count:
            try:
                entry = next(self._sources[side], None)
            except ProgramError as error:
                # Reported when all that came before it has been compared.
                self._broken = error
                return
            if entry is None:
                return
            self._ahead[side].append(entry)


def _program_reasons(
    pairs: _Pairs, names: tuple[str, ...], limits: BaselineTable
) -> Iterator[Reason]:
    apart = False
    try:
        for before, now, line in pairs:
            if before is not None and now is not None and before.kind == now.kind:
                found = block_differences(before, now, names, limits, begins_apart=apart)
                apart = any(code == "baseline-path" for code, _ in found)
                yield from (Reason(code, message, line, 0.0) for code, message in found)
                continue
            apart = True
            whichever = before or now
            what = "baseline-function"
            if whichever is None or whichever.is_path:
                what = "baseline-path"
            yield Reason(what, _instead(before, now, names), line, 0.0)
    except ProgramError as error:
        message = f"no longer interprets, baseline {_text_of(pairs.expected(), names)}"
        yield Reason("baseline-path", message, error.diagnostic.line, 0.0)


def _instead(
    before: BaselineEntry | None, now: BaselineEntry | None, names: tuple[str, ...]
) -> str:
    if now is None:
        return f"lost here: {_text_of(before, names)}"
    if before is None:
        return f"new, and not in the baseline: {_text_of(now, names)}"
    stored = dataclasses.replace(before, shown=now.shown) if before.is_path else before
    return f"{_text_of(now, names)}, baseline {_text_of(stored, names)}"


def _text_of(entry: BaselineEntry | None, names: tuple[str, ...]) -> str:
    if entry is None:
        return "its end"
    shown = entry.as_shown
    return text(shown, names, shown.start, shown.feed)
