"""What stays in force from block to block."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Generic, TypedDict, TypeVar, cast

import numpy as np

from twin.nc.bytecode.registers import (
    ACTIVE,
    CENTER_ABSOLUTE,
    CORNER,
    CORNER_TOLERANCE,
    CORRECT_CENTER,
    CYCLE,
    FEED_MODE,
    FREE_PLANE,
    INCREMENTAL,
    INDIRECT_LEADS,
    INTERPOLATION,
    PLANE,
    SQUARE_CORNERS,
    TO_REFERENCE,
    UNIT,
    Cells,
    cells,
)
from twin.nc.canonical import Corner, FloatArray
from twin.nc.control.interpolation import MotionMode
from twin.nc.geometry.planes import OWN_PLANE, PLANE_ORDER, Plane, vector_of
from twin.nc.path.paces import FeedMode


class ModalChanges(TypedDict, total=False):
    """Fields of ``Modal`` and what they become, as a G code sets them."""

    interpolation: MotionMode | None
    cycle: MotionMode | None
    return_to_reference: bool
    plane: Plane
    incremental: bool
    center_absolute: bool
    unit: float
    feed_mode: FeedMode
    corner: Corner
    corner_tolerance: float
    square_corners: bool
    indirect_leads: bool
    correct_center: bool


Value = TypeVar("Value")
Places = Iterable[tuple[int, float]]
"""Places of the modal state, each with a number."""


class _Field(property, Generic[Value]):
    """A field that stands in one place, as a number."""

    def __init__(
        self,
        place: int,
        read: Callable[["Modal"], Value],
        number: Callable[["Modal", Value], float],
    ) -> None:
        super().__init__(read, lambda modal, value: modal.put(self.places(modal, value)))
        self._place = place
        self._number = number

    if TYPE_CHECKING:

        def __get__(  # pyright: ignore[reportIncompatibleMethodOverride]  # it has a type
            self, modal: "Modal", _kind: type | None = None
        ) -> Value: ...
        def __set__(self, modal: "Modal", value: Value) -> None: ...

    def places(self, modal: "Modal", value: Value) -> Places:
        """What stands where, if the field has a value."""
        return ((self._place, float(self._number(modal, value))),)


def _numbered(values: Sequence[Value]) -> Mapping[float, Value]:
    return {float(number): value for number, value in enumerate(values)}


def _choice(place: int, values: Mapping[float, Value]) -> _Field[Value]:
    """A field that is one of some values."""
    numbers = {value: number for number, value in values.items()}
    return _Field(place, lambda modal: values[modal.cells[place]], lambda _, value: numbers[value])


def _number(place: int) -> _Field[float]:
    """A field that is a number."""
    return _Field(place, lambda modal: modal.cells[place], lambda _, value: value)


def _mode(place: int) -> _Field[MotionMode | None]:
    """A field that is a way to move, or None."""
    return _Field(
        place,
        lambda modal: modal.modes[modal.cells[place]],
        lambda modal, mode: modal.number_of_mode(mode),
    )


class _PlaneField(_Field[Plane]):
    """The working plane, which need not lie along the axes."""

    def __init__(self) -> None:
        super().__init__(PLANE, _plane, lambda _, plane: PLANE_ORDER.index(plane))

    def places(self, modal: "Modal", value: Plane) -> Places:
        """What stands where, if the plane is this one."""
        if value in PLANE_ORDER:
            return super().places(modal, value)
        directions = enumerate(np.ravel(value.directions).tolist(), FREE_PLANE)
        return ((PLANE, float(len(PLANE_ORDER))), *directions)


def _plane(modal: "Modal") -> Plane:
    plane = _PLANES.get(modal.cells[PLANE])
    if plane is None:
        abscissa, ordinate, normal = modal.column[FREE_PLANE:ACTIVE].reshape(3, 3).tolist()
        plane = Plane(OWN_PLANE, vector_of(abscissa), vector_of(ordinate), vector_of(normal))
    return plane


_NO_YES, _PLANES = _numbered((False, True)), _numbered(PLANE_ORDER)
CORNERS, FEED_MODES = _numbered(tuple(Corner)), _numbered(tuple(FeedMode))
"""Values of fields by their numbers."""


class ActiveCodes:
    """The number of the G code in force in each modal group."""

    def __init__(self, codes: Cells, groups: Mapping[str, int]) -> None:
        self._cells = codes
        self._groups = groups

    def get(self, group: str, default: float = math.nan) -> float:
        """The code in force in a group, or a default where there is none."""
        place = self._groups.get(group)
        code = math.nan if place is None else self._cells[place]
        return code if code == code else default

    def put(self, group: str, code: float) -> None:
        """Put a code into force, or none: NaN."""
        self._cells[self._groups[group]] = code

    def numbers(self) -> tuple[float, ...]:
        """The codes of all groups that have one."""
        return tuple(code for code in self._cells[ACTIVE:].tolist() if code == code)


class Modal:
    """What is in force, besides the values of words such as F: a view of a column of the state.

    Attributes:
        column: The column, shape (``ACTIVE`` + g,).
        cells: The same, one by one.
        modes: The ways to move by their numbers; None is 0.
        groups: Where the code of each modal group stands.
        active: The code in force in each.
    """

    interpolation = _mode(INTERPOLATION)
    cycle = _mode(CYCLE)
    """A canned cycle; while it is in force it stands in the place of the interpolation."""
    return_to_reference = _choice(TO_REFERENCE, _NO_YES)
    """Cycles end at their reference plane, not at the height where they were called."""
    plane = _PlaneField()
    incremental = _choice(INCREMENTAL, _NO_YES)
    center_absolute = _choice(CENTER_ABSOLUTE, _NO_YES)
    unit = _number(UNIT)
    """Of programmed lengths [mm]."""
    feed_mode = _choice(FEED_MODE, FEED_MODES)
    corner = _choice(CORNER, CORNERS)
    corner_tolerance = _number(CORNER_TOLERANCE)
    square_corners = _choice(SQUARE_CORNERS, _NO_YES)
    """Compensation extends lines at outside corners instead of rolling around them."""
    indirect_leads = _choice(INDIRECT_LEADS, _NO_YES)
    """Compensation begins and ends around the contour's first and last point."""
    correct_center = _choice(CORRECT_CENTER, _NO_YES)
    """A centre that start and end are not equally far from is moved to fit."""

    def __init__(
        self, column: FloatArray, modes: dict[float, MotionMode | None], groups: Mapping[str, int]
    ) -> None:
        """See a column."""
        self.column = column
        self.cells = cells(column)
        self.modes = modes
        self.groups = groups
        self.active = ActiveCodes(self.cells, groups)

    def number_of_mode(self, mode: MotionMode | None) -> float:
        """The number of a way to move; one that has none gets the next."""
        for number, each in self.modes.items():
            if each is mode:
                return number
        self.modes[number := float(len(self.modes))] = mode
        return number

    def places(self, changes: ModalChanges) -> list[tuple[int, float]]:
        """What stands where behind changes; the names of ``ModalChanges`` are those of the fields."""
        fields = cast("Mapping[str, _Field[object]]", vars(Modal))
        return [at for name, value in changes.items() for at in fields[name].places(self, value)]

    def standing(self, changes: ModalChanges) -> Places:
        """What stands where in the fields that changes name."""
        return [(place, self.cells[place]) for place, _ in self.places(changes)]

    def put(self, places: Places) -> None:
        """Put numbers into places."""
        for place, number in places:
            self.cells[place] = number

    def saved(self) -> "Modal":
        """A copy, to be restored later."""
        return Modal(self.column.copy(), self.modes, self.groups)

    def restore(self, saved: "Modal") -> None:
        """Put back into force what ``saved`` gave, for a program of the same dialect."""
        self.column[:] = saved.column
        self.interpolation, self.cycle = saved.interpolation, saved.cycle


def new_modal(modes: Iterable[MotionMode], groups: Iterable[str]) -> Modal:
    """Nothing is in force yet.

    Args:
        modes: Ways to move that have a number from the beginning.
        groups: The modal groups.
    """
    places = {group: place for place, group in enumerate(groups, ACTIVE)}
    column = np.zeros(ACTIVE + len(places))
    column[[CORNER_TOLERANCE, *places.values()]] = math.nan
    modal = Modal(column, {0.0: None}, places)
    for mode in modes:
        modal.number_of_mode(mode)
    modal.unit, modal.corner, modal.correct_center = 1.0, Corner.EXACT_PATH, True
    return modal
