"""What the compiled tier through plain blocks knows: tables made of a dialect's declaration.

Nothing is said here of any dialect: a code, a letter or an interpolation that the declaration does
not describe completely is not plain.
"""

import string
from collections.abc import Container, Iterable, Mapping

import numpy as np

from twin.nc.bytecode.registers import (
    ARC,
    CENTER_ABSOLUTE,
    CODES,
    CORNER,
    CYCLE,
    EARLY,
    FEED_LINE,
    FEED_MODE,
    INCREMENTAL,
    INTERPOLATION,
    LATE,
    MODAL,
    NO_MOTION,
    NOTHING,
    PLANE,
    RAPID_LINE,
    TO_REFERENCE,
    UNIT,
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
from twin.nc.control.interpolation import ArcRule, CycleRule, MotionMode
from twin.nc.control.modal import Modal
from twin.nc.control.settings import ControlSettings
from twin.nc.geometry.arcs import Bounds
from twin.nc.geometry.planes import PLANE_ORDER
from twin.nc.path.drilling_cycle import Cycle
from twin.nc.text.comments import comment_marks

_FIELDS: Mapping[str, int] = {
    "interpolation": INTERPOLATION,
    "incremental": INCREMENTAL,
    "center_absolute": CENTER_ABSOLUTE,
    "unit": UNIT,
    "corner": CORNER,
    "feed_mode": FEED_MODE,
    "return_to_reference": TO_REFERENCE,
}
"""The fields of ``Modal`` that plain codes may set, and their places."""


_NO_ARC = ArcRule(clockwise=False, bounds=Bounds(0.0, 0.0, 0.0, 0.0))


class DecodeTables:
    """The tables of one dialect on one machine.

    Attributes:
        lines: How lines are read.
        blocks: What blocks mean.
        groups: The modal groups in the order of their numbers in ``blocks``.
        token_kinds: What the letters of plain words are.
        pointed: Letters whose numbers are plain with a decimal point only.
    """

    def __init__(
        self, dialect: Dialect, settings: ControlSettings, interpreted: Iterable[int]
    ) -> None:
        """Make them; ``interpreted`` are M codes that only the interpreter tier may run."""
        self.groups = tuple(sorted({code.group for code in dialect.g.values()}))
        self._interpolations = _interpolations(dialect)
        self._places = {id(each): float(at) for at, each in enumerate(self._interpolations)}
        self._cycles = _cycles(dialect)
        self._interpreted = [number for number in interpreted if number < CODES]
        self.token_kinds = _token_kinds(dialect, settings)
        self.pointed = dialect.pointless(settings)
        self.lines = _line_tables(dialect, self.token_kinds, self.pointed)
        self.blocks = self._block_tables(dialect)

    def modal(self, modal: Modal) -> FloatArray:
        """The modal state as the kernel keeps it, shape (``MODAL``,)."""
        state = np.zeros(MODAL)
        if modal.plane in PLANE_ORDER:
            state[PLANE] = PLANE_ORDER.index(modal.plane)
        state[CYCLE] = float(self._number_of_cycle(modal.cycle))
        for name, place in _FIELDS.items():
            value = self._number(name, getattr(modal, name))
            state[place] = 0.0 if value is None else value
        return state

    def cycle(self, number: float) -> MotionMode | None:
        """The drilling cycle with a number."""
        return self._cycles[int(number)]

    @property
    def cycle_letters(self) -> set[str]:
        """Letters of the words of drilling cycles."""
        plain = [each.rule for each in self._cycles if each is not None]
        return {letter for each in plain if isinstance(each, CycleRule) for letter in each.words}

    def knows_cycle(self, cycle: MotionMode | None) -> bool:
        """Whether the kernel can drill it."""
        return any(each is cycle for each in self._cycles)

    def _number_of_cycle(self, cycle: object) -> int:
        """Its number; 0 where the kernel knows none."""
        return next((at for at, each in enumerate(self._cycles) if each is cycle), 0)

    def _number(self, name: str, value: object) -> float | None:
        """A value of the modal state as a number; None where the kernel has none for it."""
        if name == "interpolation":
            return self._places.get(id(value))
        assert isinstance(value, (bool, int, float))
        return float(value)

    def _block_tables(self, dialect: Dialect) -> BlockTables:
        field = np.full(CODES, UNSUPPORTED, np.int64)
        value = np.zeros(CODES)
        group = np.zeros(CODES, np.int64)
        cycle = np.full(CODES, UNSUPPORTED, np.int64)
        for number, code in dialect.g.items():
            if not isinstance(number, int):
                continue
            group[number] = self.groups.index(code.group)
            if "cycle" in code.sets:
                cycle[number] = self._number_of_cycle(code.sets["cycle"])
            meant = self._meaning(code)
            if meant is not None:
                field[number], value[number] = meant
        plain = [each.rule if each else None for each in self._interpolations]
        arcs = [each if isinstance(each, ArcRule) else _NO_ARC for each in plain]
        return BlockTables(
            field=field,
            value=value,
            group=group,
            cycle=cycle,
            cycles=_cycle_rows(self._cycles, self.token_kinds),
            function=_functions(dialect, self._interpreted),
            kind=np.array([_kind(each) for each in self._interpolations]),
            clockwise=np.array([arc.clockwise for arc in arcs]),
            bounds=np.array([arc.bounds for arc in arcs]),
            fits_radius=np.array([arc.fits_radius for arc in arcs]),
            signed_radius=np.array([arc.signed_radius for arc in arcs]),
        )

    def _meaning(self, code: GCode) -> tuple[int, float] | None:
        """Which place a code sets, and to what; None for a code that does more than that."""
        if code.begins_cycle:
            return (NOTHING, 0.0) if self._number_of_cycle(code.sets.get("cycle")) else None
        does = (code.action, code.perform, code.after)
        if any(does) or code.once or code.alone or code.refused or not code.group:
            return None
        sets = {name: value for name, value in code.sets.items() if name != "cycle"}
        if len(sets) > 1:
            return None
        for name, value in sets.items():
            number = self._number(name, value) if name in _FIELDS else None
            return None if number is None else (_FIELDS[name], number)
        return NOTHING, 0.0


def _interpolations(dialect: Dialect) -> list[MotionMode | None]:
    """None, which stands for any that is not plain, then the plain ones of the dialect."""
    found: list[MotionMode | None] = [None]
    for code in dialect.g.values():
        value = code.sets.get("interpolation")
        if (
            isinstance(value, MotionMode)
            and value.rule is not None
            and all(value is not each for each in found)
        ):
            found.append(value)
    return found


def _cycles(dialect: Dialect) -> list[MotionMode | None]:
    """None, then the drilling cycles of the dialect."""
    begun = (code.sets.get("cycle") for code in dialect.g.values())
    return [None, *(each for each in begun if isinstance(each, MotionMode) and _drills(each))]


def _drills(interpolation: MotionMode) -> bool:
    return isinstance(interpolation.rule, CycleRule)


def _cycle_rows(cycles: list[MotionMode | None], token_kinds: Mapping[str, int]) -> FloatArray:
    parts = len(Cycle._fields)
    rows = np.full((len(cycles), parts + 1 + max(token_kinds.values())), float(UNSUPPORTED))
    rows[:, :parts] = 0.0
    for row, each in zip(rows, cycles, strict=True):
        if each is not None and isinstance(each.rule, CycleRule):
            row[:parts] = each.rule.cycle
            for letter in each.rule.words.keys() & token_kinds.keys():
                row[parts + token_kinds[letter]] = each.rule.words[letter]
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


def _kind(interpolation: MotionMode | None) -> int:
    if interpolation is None:
        return NO_MOTION
    if isinstance(interpolation.rule, ArcRule):
        return ARC
    return RAPID_LINE if interpolation.rapid else FEED_LINE


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
