"""Programs for the tests of motion, built move by move without any dialect."""

import dataclasses
import itertools
import math

import hypothesis
import numpy as np
from examples import examples
from hypothesis import strategies as st

from twin.columns import join
from twin.motion.limits import MotionLimits
from twin.motion.planner import plan, plan_phases
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import (
    NO_BLOCK_NUMBER,
    Axes,
    Chunk,
    Corner,
    Dwell,
    Event,
    FloatArray,
    Motion,
    Moves,
    Shape,
    concatenate,
)

PERIOD = 0.001
ZERO = np.array([100.0, -50.0, 25.0, 30.0])
SETTINGS = hypothesis.settings(
    derandomize=True,
    deadline=None,
    max_examples=examples(60),
    # Shrinking a program of thousands of setpoints takes minutes and explains little.
    phases=[hypothesis.Phase.explicit, hypothesis.Phase.generate],
)


AXES = Axes(("X", "Y", "Z", "C"), ("linear", "linear", "linear", "rotary"))


def mill(**changes: float | FloatArray) -> MotionLimits:
    """A machine like any other, with some limits changed."""
    values: dict[str, float | FloatArray] = {
        "velocity": np.array([500.0, 400.0, 300.0, 360.0]),
        "acceleration": np.array([3000.0, 2500.0, 2000.0, 4000.0]),
        "jerk": np.array([5e4, 4e4, 3e4, 1e5]),
        "path_acceleration": 2000.0,
        "path_jerk": 4e4,
    }
    return MotionLimits(**(values | changes))  # pyright: ignore[reportArgumentType]


def run(
    program: "Program", machine: MotionLimits, *cuts: int, period_s: float = PERIOD
) -> Setpoints:
    start = program.start + ZERO
    chunks = program.chunks(*cuts)
    return join(list(plan(chunks, machine, period_s=period_s, part_zero=ZERO, start=start)))


def duration(program: "Program", machine: MotionLimits) -> float:
    return list(plan_phases(program.chunks(), machine, start=program.start))[-1].end_time


def circles(radius: float, turns: float, blocks: int = 1, feed: float = 1e6) -> "Program":
    """A circle in X and Y that is run as fast as the machine can, or at a feed [mm/min]."""
    program = Program()
    program.corner = Corner.EXACT_PATH
    for _ in range(blocks):
        program.arc((radius, 0.0, 0.0), (0.0, 0.0, 1.0), 360.0 * turns / blocks, feed=feed)
    return program


def column(value: float) -> FloatArray:
    return np.array([value])


class Program:
    """Moves that follow one another from a start."""

    def __init__(self, *start: float) -> None:
        self.start = np.array(start or (0.0,) * len(AXES))
        self.parts: list[Moves] = []
        self.events: list[Event] = []
        self.corner = Corner.EXACT_STOP
        self.corner_tolerance = math.nan
        self.acceleration = math.nan
        self.deceleration = math.nan

    @property
    def position(self) -> FloatArray:
        return self.parts[-1].end[0] if self.parts else self.start

    @property
    def moves(self) -> Moves:
        return concatenate(self.parts, AXES)

    def dwell(self, seconds: float) -> "Program":
        self.events.append(Dwell(len(self.parts), 1000 + len(self.events), seconds))
        return self

    def line(self, *to: float, feed: float | None = None) -> "Program":
        """A straight move to a position [mm, deg]; without a feed [mm/min] a rapid."""
        return self._add(np.array(to), feed)

    def arc(
        self,
        center: tuple[float, float, float],
        normal: tuple[float, float, float],
        sweep: float,
        *,
        advance: float = 0.0,
        turn: float = 0.0,
        feed: float | None = 600.0,
    ) -> "Program":
        """An arc about ``center`` by ``sweep`` [deg], C turning by ``turn`` [deg] on the way."""
        axis = np.array(normal) / np.linalg.norm(normal)
        spoke = self.position[:3] - center
        center_there = np.array(center) + axis * (axis @ spoke)
        spoke = spoke - axis * (axis @ spoke)
        angle = np.deg2rad(sweep)
        end = self.position.copy()
        end[:3] = center_there + advance * axis
        end[:3] += spoke * np.cos(angle) + np.cross(axis, spoke) * np.sin(angle)
        end[3] += turn
        radius = float(np.linalg.norm(spoke))
        length = float(np.hypot(radius * angle, advance))
        return self._add(
            end, feed, Shape.ARC, length=column(length), center=center_there[None],
            normal=axis[None], radius=column(radius), sweep=column(sweep),
        )  # fmt: skip

    def _add(
        self, end: FloatArray, feed: float | None, shape: Shape = Shape.LINE, **arc: FloatArray
    ) -> "Program":
        start = self.position
        travel = end - start
        length = float(np.linalg.norm(travel[:3])) or abs(float(travel[3]))
        move = Moves(
            axes=AXES,
            motion=np.array([Motion.RAPID if feed is None else Motion.FEED], np.uint8),
            shape=np.array([shape], np.uint8),
            line=np.array([10 + len(self.parts)]),
            block=np.array([NO_BLOCK_NUMBER]),
            start=start[None],
            end=end[None],
            display=end[None],
            feed=column(np.nan if feed is None else feed),
            feed_unit=np.zeros(1, np.uint8),
            length=column(length),
            center=np.full((1, 3), np.nan),
            normal=np.full((1, 3), np.nan),
            radius=column(np.nan),
            sweep=column(0.0),
            corner=np.array([self.corner], np.uint8),
            corner_tolerance=column(self.corner_tolerance),
            acceleration=column(self.acceleration),
            deceleration=column(self.deceleration),
        )
        self.parts.append(dataclasses.replace(move, **arc))
        return self

    def chunks(self, *cuts: int) -> list[Chunk]:
        """The program, cut before the given moves."""
        borders = sorted({0, len(self.parts), *(cut % (len(self.parts) + 1) for cut in cuts)})
        moves = self.moves
        out: list[Chunk] = []
        for first, last in itertools.pairwise(borders):
            events = tuple(
                dataclasses.replace(event, before=event.before - first)
                for event in self.events
                if first <= event.before < last or event.before == last == len(self.parts)
            )
            out.append(Chunk(moves[first:last], events))
        return out or [Chunk(moves, tuple(self.events))]


def limits(most_knee: float = 20.0) -> st.SearchStrategy[MotionLimits]:
    """Machines of all tempers, that step an axis's velocity by so much at most [mm/s or deg/s]; 0: nowhere."""

    def per_axis(low: float, high: float) -> st.SearchStrategy[FloatArray]:
        return st.lists(st.floats(low, high), min_size=4, max_size=4).map(np.array)

    return st.builds(
        MotionLimits,
        velocity=per_axis(5.0, 1000.0),
        acceleration=per_axis(50.0, 20000.0),
        jerk=per_axis(500.0, 1e6),
        path_acceleration=st.floats(50.0, 20000.0),
        path_jerk=st.floats(500.0, 1e6),
        junction_velocity_step=per_axis(0.0, most_knee),
        junction_acceleration_step=per_axis(0.0, 150.0 * most_knee),
        corner_tolerance=st.floats(1e-4, 1.0),
        further_corner_tolerance=st.floats(1e-4, 1.0),
    )


@st.composite
def programs(
    draw: st.DrawFn, most: int = 6, corners: tuple[Corner, ...] = (Corner.EXACT_STOP,)
) -> Program:
    """Lines, arcs, helices in any plane, turns of C alone, dwells, moves of no length."""
    place = st.floats(-40.0, 40.0)
    programmed = st.sampled_from([math.nan, 20.0, 300.0, 5000.0])
    program = Program(*(draw(place) for _ in range(4)))
    for _ in range(draw(st.integers(1, most))):
        feed = draw(st.one_of(st.none(), st.floats(10.0, 50000.0)))
        kind = draw(st.sampled_from(["line", "near", "arc", "turn", "nothing", "dwell", "on"]))
        here = program.position
        program.corner = draw(st.sampled_from(corners))
        program.corner_tolerance = draw(st.sampled_from([math.nan, 0.005, 0.3]))
        if draw(st.integers(0, 3)) == 0:
            program.acceleration, program.deceleration = draw(programmed), draw(programmed)
        if kind == "line":
            program.line(*(draw(place) for _ in range(4)), feed=feed)
        elif kind == "near":
            step = np.array([draw(st.floats(-0.01, 0.01)) for _ in range(4)])
            program.line(*(here + step), feed=feed)
        elif kind == "arc":
            normal = draw(st.sampled_from([(0, 0, 1), (0, 1, 0), (1, 0, 0), (0.36, 0.48, -0.8)]))
            spoke = np.array([draw(st.floats(-20.0, 20.0)) for _ in range(3)])
            spoke += np.where(np.abs(normal) < 0.5, 0.5, 0.0)
            sweep = draw(st.floats(1.0, 800.0)) * draw(st.sampled_from([-1, 1]))
            x, y, z = here[:3] + spoke
            program.arc(
                (x, y, z), normal, sweep, advance=draw(st.floats(-5.0, 5.0)),
                turn=draw(st.floats(-90.0, 90.0)), feed=feed,
            )  # fmt: skip
        elif kind == "on":
            # Along the same line, or round the same bend a little further.
            before = program.parts[-1] if program.parts else None
            step = np.zeros(4) if before is None else (before.end[0] - before.start[0])
            program.line(*(here + draw(st.floats(0.001, 2.0)) * step), feed=feed)
        elif kind == "turn":
            program.line(*here[:3], draw(st.floats(-400.0, 400.0)), feed=feed)
        elif kind == "nothing":
            program.line(*here, feed=feed)
        else:
            program.dwell(draw(st.floats(0.0, 0.2)))
    return program
