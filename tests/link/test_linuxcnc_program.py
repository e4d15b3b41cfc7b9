"""Canonical moves written for LinuxCNC, and found again in its commands."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from tests.motion.motion_programs import AXES, PERIOD, Program, mill
from tests.nc.linuxcnc.marks import NEEDS_RS274
from tests.nc.linuxcnc.oracle import printed_by_rs274
from twin.columns import join
from twin.errors import UsageError
from twin.link.linuxcnc_program import linuxcnc_program
from twin.link.place import Places
from twin.motion.planner import plan
from twin.nc.canonical import Chunk, Corner, Dwell, Function, Shape

pytestmark = pytest.mark.oracle


def part() -> Program:
    """Lines, arcs of three planes, a helix of turns and the table."""
    return (
        Program(0.0, 0.0, 0.0, 0.0)
        .line(10.0, 0.0, 5.0, 0.0)
        .line(10.0, 0.0, 0.0, 0.0, feed=300.0)
        .arc((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 90.0)
        .arc((0.0, 0.0, 0.0), (0.0, 0.0, -1.0), 900.0, advance=4.0)
        .arc((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 360.0, turn=45.0)
        .line(0.0, 0.0, 0.0, 720.0, feed=1200.0)
    )


def test_the_words_are_linuxcncs():
    program = Program(0.0, 0.0, 0.0, 0.0)
    program.line(1.0, 0.0, 0.0, 0.0)
    program.corner = Corner.EXACT_PATH
    program.line(1.0, 2.0, 0.0, 0.0, feed=300.0)
    program.corner, program.corner_tolerance = Corner.CONTINUOUS, 0.05
    program.arc((0.0, 2.0, 0.0), (0.0, -1.0, 0.0), 540.0, advance=3.0)
    events = [
        Function(1, 2, "M3", {"S": 3000.0}),
        Dwell(2, 3, 0.5),
        Function(3, 4, "M77", {}),
        Function(3, 5, "M30", {}),
    ]
    written = linuxcnc_program([Chunk(program.moves, events)], AXES)
    assert written.text.splitlines() == [
        "G90 G21 G17 G94 G91.1 G40 G49 G80 G54",
        "G61.1",
        "G0 X1 Y0 Z0 C0",
        "M3 S3000",
        "G61",
        "G1 X1 Y2 Z0 C0 F300",
        "G4 P0.5",
        "G64 P0.05 Q0",
        "G18",
        "G2 I-1 K0 P2 X-1 Y-1 Z0 C0 F600",
        "M2",
    ]
    assert written.line_of_move.tolist() == [3, 6, 10]


def test_an_inclined_arc_is_refused():
    program = Program(1.0, 0.0, 0.0, 0.0).arc((0.0, 0.0, 0.0), (0.0, 0.6, 0.8), 90.0)
    with pytest.raises(UsageError, match="inclined"):
        linuxcnc_program([Chunk(program.moves)], AXES)


def test_a_tip_that_is_led_is_refused_with_its_place():
    program = Program(0.0, 0.0, 0.0, 0.0).line(1.0, 0.0, 0.0, 5.0, feed=300.0)
    led = dataclasses.replace(program.moves, shape=np.full(1, Shape.CURVE))
    with pytest.raises(
        UsageError, match=r"^cone\.nc:\d+: the tip of the tool is led while axes turn"
    ):
        linuxcnc_program([Chunk(led)], AXES, "cone.nc:{}".format)


@NEEDS_RS274
def test_linuxcncs_interpreter_reads_the_same_ends_and_turns(tmp_path: Path):
    program = part()
    (tmp_path / "tools.tbl").write_text("T1 P1 D10\n")
    (tmp_path / "variables.var").write_text("")
    path = tmp_path / "part.ngc"
    path.write_text(linuxcnc_program(program.chunks(), AXES).text)
    read = printed_by_rs274(tmp_path, "-g", "-t", "tools.tbl", "-v", "variables.var", path.name)
    calls = [
        line.split(maxsplit=2)[2]
        for line in read.splitlines()
        if any(verb in line for verb in ("STRAIGHT_", "ARC_FEED"))
    ]
    moves = program.moves
    assert len(calls) == len(moves)
    for row, call in enumerate(calls):
        verb, values = call.rstrip(")").split("(")
        numbers = [float(value) for value in values.split(",")]
        if verb == "ARC_FEED":
            x, y, _, _, turns, z, _, _, c = numbers
            sweep = moves.sweep[row] * moves.normal[row].sum()
            assert turns == np.sign(sweep) * np.ceil(abs(sweep) / 360.0 - 1e-9)
        else:
            x, y, z, _, _, c = numbers
        assert [x, y, z, c] == pytest.approx(moves.end[row], abs=1e-4)


def test_every_command_is_found_on_the_move_that_it_belongs_to():
    program = part()
    setpoints = join(
        list(
            plan(
                program.chunks(),
                mill(),
                period_s=PERIOD,
                part_zero=np.zeros(4),
                start=program.start,
            )
        )
    )
    written = linuxcnc_program(program.chunks(), AXES)
    lines = np.where(setpoints.move < 0, 1, written.line_of_move[setpoints.move])
    places = Places(program.moves, written.line_of_move)
    found = [
        places.find(lines[at : at + 300], setpoints.position[at : at + 300])
        for at in range(0, len(lines), 300)
    ]
    move = np.concatenate([part[0] for part in found])
    share = np.concatenate([part[1] for part in found])
    assert np.array_equal(move, setpoints.move)
    assert np.abs(share - setpoints.fraction)[setpoints.move >= 0].max() < 1e-6
    line = np.concatenate([part[2] for part in found])
    expected = program.moves.line[np.maximum(setpoints.move, 0)]
    assert np.array_equal(line, np.where(setpoints.move < 0, 0, expected))


def test_moves_of_one_line_follow_one_another():
    # A drilling cycle goes down and comes back up on its own way, all in one line.
    program = (
        Program(0.0, 0.0, 0.0, 0.0)
        .line(10.0, 0.0, 0.0, 0.0)
        .line(10.0, 0.0, -5.0, 0.0, feed=600.0)
        .line(10.0, 0.0, 0.0, 0.0)
        .line(10.0, 5.0, 0.0, 0.0, feed=600.0)
    )
    setpoints = join(
        list(
            plan(
                program.chunks(), mill(), period_s=PERIOD, part_zero=np.zeros(4),
                start=program.start,
            )
        )
    )  # fmt: skip
    places = Places(program.moves, np.full(4, 7))
    places.find(np.full(len(setpoints) - 20, 7), setpoints.position[:-20])
    assert not places.done
    places = Places(program.moves, np.full(4, 7))
    move, share, _ = places.find(np.full(len(setpoints), 7), setpoints.position)
    began = setpoints.move >= 0
    assert np.mean(move[began] != setpoints.move[began]) < 0.05
    assert np.abs(program.moves.end[3] - setpoints.position[-1]).max() < 1e-9
    assert (move[-1], share[-1]) == (3, pytest.approx(1.0))
    assert places.done
