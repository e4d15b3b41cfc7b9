"""Copies of programs that run: they go on as the original does, and neither hears of the other."""

import contextlib
import enum
import gc
import re
import zlib
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.nc.running import WITH_TABLES
from tests.nc.test_golden import RULES
from twin.copies import _LEAVES, copied
from twin.errors import TwinError
from twin.nc.canonical import Chunk
from twin.nc.control.executor import Executor
from twin.nc.dialects import DIALECTS, dialect_named
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.nc.text.source import read_source
from twin.training.room.room import Room
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.session import checkpoints
from twin.training.session.actions import carry_out
from twin.training.session.checkpoints import never_changes
from twin.training.session.commands import command_from

_CHANGELESS = (*_LEAVES, type(None), np.generic, tuple, frozenset, enum.Enum, re.Pattern, range)


def copy_of(thing: Any) -> Any:
    return copied(thing, never_changes, {})


def reached(thing: object) -> dict[int, object]:
    """All that a thing holds and that could change, by its id."""
    found: dict[int, object] = {}
    waiting = [thing]
    while waiting:
        one = waiting.pop()
        if id(one) in found or never_changes(type(one)) or isinstance(one, _LEAVES):
            continue
        found[id(one)] = one
        waiting += gc.get_referents(one)
        if isinstance(one, np.ndarray):
            waiting.append(one.base)
    return {key: one for key, one in found.items() if not isinstance(one, _CHANGELESS)}


def in_common(one: object, other: object) -> list[object]:
    """What two things hold both."""
    here, there = reached(one), reached(other)
    return [here[key] for key in here.keys() & there.keys()]


def told(chunk: Chunk) -> tuple[Any, ...]:
    moves = chunk.moves
    rows = (
        moves.line,
        moves.start,
        moves.end,
        moves.display,
        moves.feed,
        moves.center,
        moves.sweep,
    )
    return (*(each.tobytes() for each in rows), repr(tuple(chunk.events)))


def step(executor: Executor) -> tuple[Any, ...] | None:
    """What a block makes; None at the program's end."""
    control = executor.control
    if control.ended:
        return None
    try:
        block = control.program_counter.next()
        if block is None:
            executor.finish()
            control.ended = True
        else:
            executor.run(block)
    except ProgramError as error:
        control.ended = True
        return told(control.path.columns.take()), str(error)
    return told(control.path.columns.take())


BLOCKS = 400
"""Of a program: those of the golden files have fewer, but for loops."""


def fresh(path: Path) -> Executor:
    dialect = dialect_named(path.parent.parent.name)
    executor = Executor(dialect, WITH_TABLES, read_source(path, dialect))
    executor.prepare()
    return executor


@pytest.mark.parametrize("name", DIALECTS)
def test_a_copied_control_goes_on_as_the_original_does(name):
    paths = [path for path in RULES if path.parent.parent.name == name]
    assert len(paths) > 10
    for path in paths:
        draw = np.random.default_rng(zlib.crc32(path.stem.encode()))
        control = fresh(path)
        wanted: list[Any] = []
        while len(wanted) < BLOCKS and (made := step(control)) is not None:
            wanted.append(made)
        control, at = fresh(path), int(draw.integers(max(len(wanted), 1)))
        for each in wanted[:at]:
            assert step(control) == each
        other = copy_of(control)
        assert not in_common(control, other)
        for each in wanted[at:]:
            assert step(control) == each, path
            assert step(other) == each, path


ENDLESS = {
    "linuxcnc": "G1 F3000 Z50\no1 while [1]\nM3 S500\nX2 Y0\nG4 P0.05\nG3 X0 Y0 I-1 J0\n#1=[#1+0.01]\n"
    "G64 P0.05\nG1 X[#1]\nY2\nX0\nG41.1 D2\nG1 X10\nY10\nX20\nG40 X30 Y0\nG0 X0 Y0\no1 endwhile\nM2\n",
    "codesys": "N10 G1 F50 E100\nN20 G52\nN30 G1 X2 Y1\nN40 Y3\nN60 G3 X0 Y3 R2\nN65 M3\n"
    "N70 G51\nN80 X0 Y0\nN90 G20 L30\n",
    "fagor8070": "P1=0\nG90 G1 F3000 X0 Y0 Z50\n$WHILE 1\nP1=P1+0.1\nG07\nX[P1+3] Y2\n"
    "X0 Y4\nY0\nM3 S500\n$ENDWHILE\nM30\n",
    "fanuc": "O1\nG90 G1 F3000 Z50.\n#1=0\nWHILE[1EQ1]DO1\n#1=#1+0.1\nX#1 Y2.\nG91 X-1. Y-1.\nG90 G0 X0 Y0\n"
    "END1\nM30\n",
}
"""Programs without an end: compensation, roundings, blends, waits, variables."""
SCENES = {
    "linuxcnc": "linuxcnc_round_corners",
    "codesys": "codesys_arc_or_line",
    "fagor8070": "fagor_first_steps",
    "fanuc": "fanuc_missing_point",
}


def hands(seed: str) -> list[tuple[int, dict[str, Any]]]:
    """Slices, and what is asked for behind them."""
    draw = np.random.default_rng(zlib.crc32(seed.encode()))
    asked: list[dict[str, Any]] = [
        {"do": "override", "dial": "feed", "percent": 30},
        {"do": "override", "dial": "feed", "percent": 120},
        {"do": "feed_hold"},
        {"do": "mode", "mode": "single"},
        {"do": "mode", "mode": "auto"},
    ]
    asked += [{"do": "cycle_start"}] * 5
    return [(int(draw.integers(1, 40)), asked[draw.integers(len(asked))]) for _ in range(16)]


def lived(room: Room, acts: list[tuple[int, dict[str, Any]]]) -> list[tuple[Any, ...]]:
    """How a machine moves under an operator's hands."""
    seen: list[tuple[Any, ...]] = []
    for slices, asked in acts:
        for _ in range(slices):
            room.advance()
            setpoint, run = room.machine.setpoint, room.slot.run
            columns = [getattr(setpoint, each.name).tobytes() for each in fields(setpoint)]
            modal = None if run is None else run.modal(int(setpoint.move[0]))
            seen.append((*columns, room.line, room.slot.held, room.auxiliaries.spindle, modal))
        with contextlib.suppress(TwinError):
            carry_out(room, command_from(asked))
    return seen


@pytest.mark.thorough
@pytest.mark.parametrize("name", ENDLESS)
def test_going_back_in_an_endless_program_is_the_same_to_the_last_bit(name):
    room = Room(read_scene(scene_path(SCENES[name])))
    room.setup.work = None
    room.program.load(ENDLESS[name])
    start = [(1, {"do": "cycle_start"})]
    lived(room, start + hands(name))
    kept = checkpoints.checkpoint(room, 0, ())
    acts = hands(f"{name} again")
    went = lived(room, acts)
    assert room.alarm is None
    assert len({each[4] for each in went}) > 50
    first, second = kept.restored(), kept.restored()
    assert not in_common(first, room)
    assert lived(first, acts) == went
    assert lived(second, acts) == went
