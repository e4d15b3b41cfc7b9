"""What the compiled tier through plain blocks knows: tables made of a dialect's declaration.

Nothing is said here of any dialect: a code, a letter or an interpolation that the declaration does
not describe completely is not plain.
"""

import string
from collections.abc import Container, Iterable, Mapping, Sequence

import numpy as np

from twin.nc.bytecode.registers import (
    ACTIVE,
    ARC,
    CODES,
    CYCLE,
    DRILLING,
    EARLY,
    FEED_LINE,
    INTERPOLATION,
    LATE,
    NO_MOTION,
    NOTHING,
    OF_PLAIN_BLOCKS,
    RAPID_LINE,
    BlockTables,
)
from twin.nc.bytecode.token_kinds import (
    AXIS,
    CENTER,
    CODE,
    FEED,
    FUNCTION,
    NUMBER,
    OTHER,
    RADIUS,
    UNSUPPORTED,
    LineTables,
)
from twin.nc.canonical import FloatArray, IntArray
from twin.nc.control.codes import GCode
from twin.nc.control.dialect import Dialect
from twin.nc.control.interpolation import ArcRule, CycleRule, LineRule, MotionMode, MotionRule
from twin.nc.control.modal import Modal
from twin.nc.control.settings import ControlSettings
from twin.nc.geometry.arcs import Bounds
from twin.nc.path.drilling_cycle import Cycle
from twin.nc.text.comments import comment_marks

_NO_ARC = ArcRule(clockwise=False, bounds=Bounds(0.0, 0.0, 0.0, 0.0))


class DecodeTables:
    """The tables of one dialect on one machine.

    Attributes:
        lines: How lines are read.
        blocks: What blocks mean.
        token_kinds: What the letters of plain words are.
        pointed: Letters whose numbers are plain with a decimal point only.
    """

    def __init__(
        self, dialect: Dialect, settings: ControlSettings, modal: Modal, interpreted: Iterable[int]
    ) -> None:
        """Make them.

        Args:
            dialect: What the codes mean.
            settings: What the letters mean.
            modal: Numbers what they put into force.
            interpreted: M codes that only the interpreter tier may run.
        """
        self._modal = modal
        self._rules = [None if each is None else each.rule for each in modal.modes.values()]
        self._interpreted = [number for number in interpreted if number < CODES]
        self.token_kinds = _token_kinds(dialect, settings)
        self.pointed = dialect.pointless(settings)
        self.lines = _line_tables(dialect, self.token_kinds, self.pointed)
        self.blocks = self._block_tables(dialect)

    @property
    def cycle_letters(self) -> set[str]:
        """Letters of the words of drilling cycles."""
        return {
            letter for each in self._rules if isinstance(each, CycleRule) for letter in each.words
        }

    def _block_tables(self, dialect: Dialect) -> BlockTables:
        field = np.full(CODES, UNSUPPORTED, np.int64)
        value = np.zeros(CODES)
        group = np.zeros(CODES, np.int64)
        cycle = np.full(CODES, UNSUPPORTED, np.int64)
        for number, code in dialect.g.items():
            if not isinstance(number, int):
                continue
            if code.group:
                group[number] = self._modal.groups[code.group] - ACTIVE
            if "cycle" in code.sets:
                cycle[number] = self._number_of_cycle(code.sets["cycle"])
            meant = self._meaning(code)
            if meant is not None:
                field[number], value[number] = meant
        arcs = [each if isinstance(each, ArcRule) else _NO_ARC for each in self._rules]
        return BlockTables(
            field=field,
            value=value,
            group=group,
            cycle=cycle,
            cycles=_cycle_rows(self._rules, self.token_kinds),
            function=_functions(dialect, self._interpreted),
            kind=np.array([_kind(each) for each in self._modal.modes.values()]),
            clockwise=np.array([arc.clockwise for arc in arcs]),
            bounds=np.array([arc.bounds for arc in arcs]),
            fits_radius=np.array([arc.fits_radius for arc in arcs]),
            signed_radius=np.array([arc.signed_radius for arc in arcs]),
        )

    def _number_of_cycle(self, cycle: MotionMode | None) -> int:
        """Its number; 0 where the kernel knows none."""
        drills = cycle is not None and isinstance(cycle.rule, CycleRule)
        return int(self._modal.number_of_mode(cycle)) if drills else 0

    def _meaning(self, code: GCode) -> tuple[int, float] | None:
        """Which place a code sets, and to what; None for a code that does more than that."""
        if code.begins_cycle:
            return (NOTHING, 0.0) if self._number_of_cycle(code.sets.get("cycle")) else None
        does = (code.action, code.perform, code.after)
        if any(does) or code.once or code.alone or code.refused or not code.group:
            return None
        places = [each for each in self._modal.places(code.sets) if each[0] != CYCLE]
        if not places:
            return NOTHING, 0.0
        place, number = places[0]
        if len(places) > 1 or place >= OF_PLAIN_BLOCKS:
            return None
        is_known = place != INTERPOLATION or self._rules[int(number)] is not None
        return (place, number) if is_known else None


def _cycle_rows(rules: Sequence[MotionRule | None], token_kinds: Mapping[str, int]) -> FloatArray:
    parts = len(Cycle._fields)
    rows = np.full((len(rules), parts + 1 + max(token_kinds.values())), float(UNSUPPORTED))
    rows[:, :parts] = 0.0
    for row, each in zip(rows, rules, strict=True):
        if isinstance(each, CycleRule):
            row[:parts] = each.cycle
            for letter in each.words.keys() & token_kinds.keys():
                row[parts + token_kinds[letter]] = each.words[letter]
    return rows


def _functions(dialect: Dialect, interpreted: Iterable[int]) -> IntArray:
    """M codes that are only reported."""
    function = np.full(CODES, EARLY if dialect.any_m else UNSUPPORTED, np.int64)
    for number, code in dialect.m.items():
        only_told = code.action is None and not code.silent and not code.ends
        function[number] = (LATE if code.late else EARLY) if only_told else UNSUPPORTED
    for number in interpreted:
        function[number] = UNSUPPORTED
    return function


def _kind(mode: MotionMode | None) -> int:
    if mode is None or mode.rule is None:
        return NO_MOTION
    if isinstance(mode.rule, LineRule):
        return RAPID_LINE if mode.rapid else FEED_LINE
    return ARC if isinstance(mode.rule, ArcRule) else DRILLING


def _line_tables(
    dialect: Dialect, token_kinds: Mapping[str, int], pointed: Container[str]
) -> LineTables:
    by_letter = np.full(26, OTHER, np.int64)
    for letter, token_kind in token_kinds.items():
        by_letter[ord(letter) - ord("A")] = token_kind
    return LineTables(
        by_letter,
        comment_marks(dialect.syntax.comments).columns,
        np.array([letter in pointed for letter in string.ascii_uppercase]),
        dialect.syntax.longest_line,
    )


def _token_kinds(dialect: Dialect, settings: ControlSettings) -> dict[str, int]:
    """Letters with a plain meaning; those that a dialect uses otherwise as well have none."""
    center = {letter: CENTER + index for index, letter in enumerate("IJK")}
    axes = {name: AXIS + index for index, name in enumerate(settings.axes.names)}
    token_kinds = {
        letter: token_kind
        for letter, token_kind in {"R": RADIUS, **center, **axes}.items()
        if letter in dialect.motion_words and (token_kind < AXIS or letter in dialect.axis_letters)
    }
    taken = {*dialect.words, *dialect.references, *dialect.signed, *dialect.series}
    token_kinds = {
        letter: token_kind for letter, token_kind in token_kinds.items() if letter not in taken
    }
    token_kinds.update(dict.fromkeys(dialect.feed_letter, FEED))
    return {**token_kinds, "N": NUMBER, "G": CODE, "M": FUNCTION}
