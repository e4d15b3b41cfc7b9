"""Radius compensation as a stage of the path: moves one by one, and what is said of those that do not fit."""

from collections.abc import Callable, Mapping
from typing import NoReturn

import numpy as np

from twin.nc.canonical import Event
from twin.nc.path.compensation import leads
from twin.nc.path.compensation.contour import (
    BEGINS_ON_ARC,
    ENDS_ON_ARC,
    FOLLOWING,
    LEAD_IN_CUTS,
    LEAD_OUT_CUTS,
    LEADING_IN,
    LEADING_OUT,
    MAY_CUT,
    MOST_LET_GO,
    NARROW_CORNER,
    NARROW_NECK,
    NO_ROOM_TO_WAIT,
    OFF,
    OUTSIDE_PLANE,
    SMALL_ARC,
    STAGE,
    Contour,
    new_contour,
    waiting_rows,
    with_more_room,
)
from twin.nc.path.compensation.follow import follow
from twin.nc.path.compensation.lookahead import hold_events
from twin.nc.path.move_columns import Segment
from twin.nc.path.rows import Row, Rows

Drive = Callable[[Segment], None]
Happen = Callable[[Event], None]
Refuse = Callable[[Segment, str, str], NoReturn]
"""Told the segment, the code and the message; raises."""
Warn = Callable[[Segment, str, str], None]
"""Told of the segment, the code and the message of a warning."""

_FINDINGS: Mapping[int, tuple[str, str]] = {
    BEGINS_ON_ARC: ("compensation-start", "compensation must start on a line"),
    ENDS_ON_ARC: ("compensation-end", "compensation must end on a line"),
    OUTSIDE_PLANE: (
        "compensation-plane",
        "an arc outside the compensated plane cannot be compensated",
    ),
    SMALL_ARC: (
        "compensation-radius",
        "the tool's radius {radius:g} does not fit into the arc of radius {measured:.4f}",
    ),
    NARROW_CORNER: (
        "compensation-gouge",
        (
            "the tool's radius {radius:g} does not fit into the inside corner: "
            "it would cut into the contour before or after"
        ),
    ),
    NARROW_NECK: (
        "compensation-gouge",
        (
            "the tool's radius {radius:g} does not fit between this element and "
            "that of line {measured:.0f}: the path crosses itself"
        ),
    ),
    LEAD_IN_CUTS: (
        "compensation-lead",
        "on its way to the contour the tool cuts {measured:.3f} mm into it",
    ),
    LEAD_OUT_CUTS: (
        "compensation-lead",
        "on its way from the contour the tool cuts {measured:.3f} mm into it",
    ),
}
"""Code and message of what is wrong with a move."""
_OF_HELD = (NARROW_NECK, LEAD_IN_CUTS)
"""What is wrong with the move that was held."""
_DRIVEN = (LEAD_IN_CUTS, LEAD_OUT_CUTS)
"""What controls drive nevertheless, with a warning."""
_EVENTS_AT_FIRST = 16


class Compensation:
    """Radius compensation of a path.

    Attributes:
        contour: How far it has come; the compiled tier goes on with it.
    """

    def __init__(self, axes: int, drive: Drive, happen: Happen, refuse: Refuse, warn: Warn) -> None:
        """Compensation that is off, for a machine with so many axes."""
        self.contour = new_contour(axes)
        self._counts = self.contour.counts.data
        self._drive = drive
        self._happen = happen
        self._refuse = refuse
        self._warn = warn
        self._events: list[Event] = []
        self._rows = Rows(
            *_room_for_moves(self.contour), np.zeros((_EVENTS_AT_FIRST, 4), np.int64), np.zeros(0)
        )

    @property
    def stage(self) -> int:
        """A ``Stage``."""
        return self._counts[STAGE]

    @property
    def in_force(self) -> bool:
        """It has begun, and not ended."""
        return self.stage not in (OFF, LEADING_OUT)

    @property
    def holds_events(self) -> bool:
        """Events wait for the end of the held move."""
        return bool(self._events)

    def end(self) -> None:
        """The next line leads out."""
        after = leads.end(0, len(self._events), self.contour, self._rows)
        if after < 0:
            self._say(after, self.contour.lookahead.segment)
        self._let_go(after)

    def add(self, move: Segment, position: list[float]) -> None:
        """The next move; the path has come to this position, shape (k,)."""
        self.contour.position[:] = position
        after = self._follow(move)
        if after == NO_ROOM_TO_WAIT:
            self.contour = with_more_room(self.contour)
            moves = _room_for_moves(self.contour)
            self._rows = Rows(*moves, self._rows.events, self._rows.event_values)
            after = self._follow(move)
        if after < 0:
            self._say(after, move)
            self.contour.counts[MAY_CUT] = 1
            after = self._follow(move)
            self.contour.counts[MAY_CUT] = 0
        self._let_go(after)

    def _follow(self, move: Segment) -> int:
        """The number of rows that are let go, or why the move is not followed."""
        self._rows.row(0).put(move)
        events = len(self._events)
        return follow(0, 1, events, events, self.contour, self._rows)

    def _say(self, finding: int, move: Segment) -> None:
        """Warn of what is driven nevertheless, refuse all else."""
        code, message = _FINDINGS[finding]
        radius = abs(self.contour.signed_offset[0])
        message = message.format(radius=radius, measured=self.contour.measured[0])
        blamed = self.contour.lookahead.segment if finding in _OF_HELD else move
        if finding in _DRIVEN:
            self._warn(blamed, code, message)
        else:
            self._refuse(blamed, code, message)

    def event(self, event: Event) -> None:
        """Something that happens where the path has come to."""
        if self.stage not in (LEADING_IN, FOLLOWING):
            self._happen(event)
            return
        self.hold_event(event, 0)
        number = len(self._events) - 1
        hold_events(self.contour, self._rows, number, number + 1)

    def hold_event(self, event: Event, place: int) -> None:
        """An event waits; its place as ``hold_events`` has it."""
        number = len(self._events)
        self._events.append(event)
        if number == len(self._rows.events):
            events = np.zeros((2 * number, 4), np.int64)
            events[:number] = self._rows.events
            self._rows = self._rows._replace(events=events)
        self._rows.events[number, 0] = place

    def _let_go(self, count: int) -> None:
        """Drive so many rows, with the events between them."""
        events, rows = self._events, self._rows
        happening = bool(events) and rows.events[0, 0] >= 0
        places = rows.events[: len(events), 0].tolist() if happening else []
        if happening:
            self._events = []
        happened = 0
        for number in range(count + 1):
            while happened < len(places) and places[happened] <= number:
                self._happen(events[happened])
                happened += 1
            if number < count:
                self._drive(rows.row(number).segment)


def _room_for_moves(contour: Contour) -> Row:
    """Rows for all that may be let go at once."""
    return waiting_rows(len(contour.waiting.codes) + MOST_LET_GO, len(contour.here))
