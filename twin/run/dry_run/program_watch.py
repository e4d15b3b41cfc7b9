"""What moves and functions of a program show before anything moves: mistakes that no axis shows."""

import dataclasses
from collections.abc import Iterator

import numpy as np

from twin.cutting.forces.tool_strength import tool_strength
from twin.job.job_file import JobFile, ToolTable
from twin.nc.canonical import Chunk, FloatArray, Function, IntArray, Motion
from twin.nc.functions import (
    OPTIONAL_STOP,
    PROGRAM_ENDS,
    PROGRAM_STOPS,
    SPINDLE_SPEED,
    SPINDLE_STARTS,
    SPINDLE_STOPS,
    TOOL_CHANGE,
    SpindleState,
)
from twin.nc.interpreter import Interpretation
from twin.recording.alarms import Alarm
from twin.run.messages import Notice


@dataclasses.dataclass(frozen=True, slots=True)
class Stop:
    """A place of the program at which it is stopped, the spindle stops, or its tool is changed.

    Attributes:
        place: Number of the next move, and how much of it lies behind.
    """

    place: float
    line: int
    what: str


@dataclasses.dataclass(frozen=True, slots=True)
class ToothFeed:
    """The greatest feed per tooth of a line.

    Attributes:
        value: Of it [mm].
    """

    value: float
    tool: ToolTable

    @property
    def bears(self) -> float:
        """The chip that an edge of the tool bears [mm]."""
        return tool_strength(self.tool).chip


class ProgramWatch:
    """Reads a program along, chunk by chunk.

    Attributes:
        stops: Where program, spindle or tool are stopped in blocks of their own; a cycle knows what it does.
        overspeed: The first time that the spindle turns a tool faster than it bears.
        tools_used: The tools that were in the spindle while something moved, each with the line of its first move.
        first_line: Line of the first move; 0: there is none.
        first_feed: Line of the first move at feed; 0: there is none.
        changed_at: Line of the first tool change; 0: there is none.
        spindle_line: Line of the first function that starts the spindle; 0: there is none.
        taken_to_turn: Nothing starts the spindle or says how fast it turns.
    """

    def __init__(self, job: JobFile, spindle: SpindleState) -> None:
        """Begin with the job's first tool in a spindle that no function has set yet.

        Args:
            job: Its tools are those that the program may bring.
            spindle: As the machine and the control have it.
        """
        self.stops: list[Stop] = []
        self.overspeed: Alarm | None = None
        self.tools_used: dict[int, int] = {}
        self.first_line = 0
        self.first_feed = 0
        self.spindle_line = 0
        self.taken_to_turn = True
        self._tools = {tool.number: tool for tool in job.tools}
        self._tool, self._selected = job.tools[0], job.tools[0].number
        self._state = spindle
        self._moves = 0
        self._line = 0
        self.changed_at = 0
        self._end_line = 0
        self._called: tuple[int, int] | None = None
        """Number and line of the first tool that is called."""
        self._nameless_line = 0
        """Line of a tool change before any tool is called; 0: there is none."""
        self._started_at, self._started_in_cycle = 0, False
        self._tapped: set[int] = set()
        self._tooth_feeds: dict[int, ToothFeed] = {}
        self._counter: dict[int, Notice] = {}
        self._taps: dict[int, Notice] = {}
        self._lists_tools = "tools" in job.model_fields_set

    def add(self, chunk: Chunk) -> None:
        """Take note of moves and functions that follow the last ones."""
        moves = chunk.moves
        first = 0
        for event in chunk.events:
            if not isinstance(event, Function):
                continue
            self._span(chunk, first, event.before)
            first = event.before
            behind = int(moves.line[first]) if first < len(moves) else 0
            self._follow(
                event, self._moves + event.before, in_cycle=behind == event.line == self._line
            )
        self._span(chunk, first, len(moves))
        self._moves += len(moves)

    def _span(self, chunk: Chunk, first: int, end: int) -> None:
        """Look at moves between which nothing else happens."""
        if end <= first:
            return
        moves = chunk.moves[first:end]
        self.first_line = self.first_line or int(moves.line[0])
        self.tools_used.setdefault(self._tool.number, int(moves.line[0]))
        self._line = int(moves.line[-1])
        feeds = np.flatnonzero(moves.motion != Motion.RAPID)
        if not len(feeds):
            return
        line = int(moves.line[feeds[0]])
        self.first_feed = self.first_feed or line
        turning = self._state.turning
        if turning:
            if (turning < 0.0) == (self._tool.hand == "right") and self._started_at:
                self._note_sense()
            moving = feeds[np.any(moves.start[feeds, :3] != moves.end[feeds, :3], axis=1)]
            per_tooth = moves.feed[moving] / (abs(turning) * self._tool.teeth)
            self._note_tooth_feed(moves.line[moving], per_tooth)

    def _note_sense(self) -> None:
        start, tool = self._started_at, self._tool
        if self._started_in_cycle:
            return
        message = (
            f"M4 turns tool {tool.number}, which cuts clockwise, backwards: write M3, "
            'or hand = "left" in its [[tools]] table'
            if tool.hand == "right"
            else f'M3 turns tool {tool.number} of hand = "left" backwards: write M4'
        )
        self._counter.setdefault(start, Notice("counter-clockwise", start, message))

    def _note_tooth_feed(self, line: IntArray, per_tooth: FloatArray) -> None:
        bears = ToothFeed(0.0, self._tool).bears
        for row in np.flatnonzero(per_tooth > bears).tolist():
            known = self._tooth_feeds.get(int(line[row]))
            if known is None or per_tooth[row] > known.value:
                self._tooth_feeds[int(line[row])] = ToothFeed(float(per_tooth[row]), self._tool)

    def _follow(self, event: Function, place: int, *, in_cycle: bool) -> None:
        word, was = event.word, self._state.turns
        if word[:1] == "T" and word[1:].isdigit():
            self._selected = int(word[1:])
            self._called = self._called or (self._selected, event.line)
        elif word == TOOL_CHANGE:
            self.changed_at = self.changed_at or event.line
            if self._called is None:
                self._nameless_line = self._nameless_line or event.line
            if self._selected != self._tool.number:
                self.stops.append(Stop(float(place), event.line, "the tool is changed"))
            self._tool = self._tools.get(self._selected, self._tool)
            self._state = dataclasses.replace(self._state, tool_speed=self._tool.speed)
        if word in PROGRAM_ENDS:
            self._end_line = event.line
            return
        before, self._state = self._state, self._state.after(event)
        if word in SPINDLE_STARTS:
            self._started_at, self._started_in_cycle = event.line, in_cycle
            reversed_in_it = before.counter_clockwise != self._state.counter_clockwise
            if in_cycle and before.started and reversed_in_it:
                self._note_tap(event.line)
            self.spindle_line = self.spindle_line or event.line
        elif word in SPINDLE_STOPS and was and not in_cycle:
            self.stops.append(Stop(place + event.at, event.line, "the spindle stops"))
        elif word in PROGRAM_STOPS and not in_cycle:
            where = ", where its switch is on," if word == OPTIONAL_STOP else ""
            self.stops.append(Stop(place + event.at, event.line, f"{word}{where} holds the axes"))
        self.taken_to_turn &= word not in SPINDLE_STARTS and word != SPINDLE_SPEED
        if word in SPINDLE_STARTS or word in (SPINDLE_SPEED, TOOL_CHANGE):
            self._watch_speed(event.line)

    def _note_tap(self, line: int) -> None:
        """The spindle is reversed within a cycle, which is how a tap comes back."""
        tool = self._tool
        if self._lists_tools and tool.kind != "drill":
            message = (
                f'a tapping cycle runs with tool {tool.number}, which is no tap (kind = "{tool.kind}"); '
                'a tap is listed as kind = "drill"'
            )
            self._taps.setdefault(line, Notice("cutter-in-cycle", line, message))
        self._tapped.add(line)

    def _watch_speed(self, line: int) -> None:
        limit, turning = self._tool.speed_limit, abs(self._state.turning or 0.0)
        if limit is not None and turning > limit and self.overspeed is None:
            message = (
                f"tool {self._tool.number} broke: {turning:.0f} /min were more than the "
                f"{limit:.0f} /min it bears"
            )
            self.overspeed = Alarm("tool-broken", line, 0.0, "", message)

    @property
    def tooth_feeds(self) -> dict[int, ToothFeed]:
        """By line, where a feed per tooth is more than an edge bears; a tap's feed is its pitch."""
        return {line: feed for line, feed in self._tooth_feeds.items() if line not in self._tapped}

    @property
    def last_line(self) -> int:
        """Line at which the program ended, or of its last move."""
        return self._end_line or self._line

    def _tool_notices(self) -> Iterator[Notice]:
        """Calls of tools that bring none, and changes that name none."""
        number, line = self._called or (self._tool.number, 0)
        if self.first_feed and not self.changed_at and number != self._tool.number:
            message = (
                f"tool {number} is called, and no M6 brings it: all is cut by tool "
                f"{self._tool.number}, the job's first"
            )
            yield Notice("tool-never-changed", line, message)
        if self._nameless_line:
            message = f"no T before it says which tool comes: tool {self._tool.number} is taken"
            yield Notice("change-without-tool", self._nameless_line, message)

    def notices(self, interpretation: Interpretation) -> Iterator[Notice]:
        """Warnings about the whole program, once it was interpreted to its end."""
        yield from self._counter.values()
        yield from self._taps.values()
        yield from self._tool_notices()
        for line, call in interpretation.lengths.calls.items():
            if call.spindle is not None and call.number != call.spindle:
                message = (
                    f"the length of tool {call.number} is called, and tool {call.spindle} is in the "
                    "spindle"
                )
                yield Notice("length-of-other-tool", line, message)
        by_code = interpretation.dialect.rules.length_by_code
        if by_code and self.changed_at and not interpretation.lengths.calls:
            yield Notice(
                "length-never-called",
                self.changed_at,
                "a tool comes into the spindle and G43 is never written: a control whose zero "
                "was taken at the spindle nose would drive the tool into the part",
            )
        coverage = interpretation.coverage
        behind = coverage.motion_behind_end()
        if behind:
            message = f"the program ends here, and lines with motion follow (line {behind})"
            yield Notice("ends-before-motion", coverage.ends_at, message)
