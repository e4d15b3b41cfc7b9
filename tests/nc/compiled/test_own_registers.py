"""A code with state of its own: declared by its dialect alone, run at full speed."""

import dataclasses

import pytest

from tests.nc.running import SETTINGS
from twin.compilation.speed import Speed
from twin.nc.bytecode import opcodes
from twin.nc.bytecode.assembler import Assembler, Finding
from twin.nc.bytecode.registers import PROGRAMMED_FEED
from twin.nc.canonical import concatenate
from twin.nc.control.codes import Effect, WordEffect
from twin.nc.control.control import Control
from twin.nc.control.executor import Executor
from twin.nc.dialects.fagor8070 import FAGOR8070
from twin.nc.interpreter import Interpretation
from twin.nc.iso.declared import modal
from twin.nc.path.event_columns import AUXILIARY
from twin.nc.text.arithmetic import add, multiply
from twin.nc.text.blocks import Word
from twin.nc.text.diagnostics import ProgramError
from twin.nc.text.source import source_from_text

_RANGE = Finding("feed-range", "{word} is no scale of the feed")


def scale_feeds(control: Control, assembler: Assembler) -> None:
    """G900 K: feeds behind it are multiplied by K."""
    assembler.word_value(control.take("K"), 1.0)
    assembler.check(opcodes.AT_LEAST, _RANGE, 0.1)
    assembler.set_register(control.own_register("feed scale"))


def scaled_feed(control: Control, word: Word, assembler: Assembler) -> None:
    """F."""
    assembler.word_value(word)
    assembler.register(control.own_register("feed scale"))
    assembler.compute(multiply)
    assembler.set_register(PROGRAMMED_FEED)


def count(control: Control, assembler: Assembler) -> None:
    """G901: count."""
    assembler.register(control.own_register("count"))
    assembler.constant(1.0)
    assembler.compute(add)
    assembler.set_register(control.own_register("count"))


def report_count(control: Control, word: Word, assembler: Assembler) -> None:
    """H: report how often G901 was met since the program began, and the value of H."""
    assembler.word_value(word)
    assembler.register(control.own_register("count"))
    assembler.compute(add)
    assembler.emit(opcodes.REPORT, AUXILIARY)


DIALECT = dataclasses.replace(
    FAGOR8070,
    registers={"feed scale": 1.0, "count": 5.0},
    g={
        **FAGOR8070.g,
        900: modal("feed scale", action=Effect(scale_feeds)),
        901: modal("count", action=Effect(count)),
        902: modal("count in increments", action=Effect(count), incremental=True),
    },
    words={**FAGOR8070.words, "F": WordEffect(scaled_feed), "H": WordEffect(report_count)},
    feed_letter="",
)
PROGRAM = """G1 X1 F100
P1=1
N10 G900 K[P1/2]
G1 X[P1] F100
G901 X0
G0 Y1 H10
P1=P1+1
G901
$IF P1<7 $GOTO N10
G1 X9 F20 H0
M30
"""


def run(text: str, compiled_from: int, speed: Speed):
    interpretation = Interpretation(
        source_from_text(text), DIALECT, SETTINGS, compiled_from=compiled_from, speed=speed
    )
    chunks, error = [], None
    try:
        chunks.extend(interpretation.chunks())
    except ProgramError as raised:
        error = raised.diagnostic
    moves = concatenate((chunk.moves for chunk in chunks), SETTINGS.axes)
    return moves, [event for chunk in chunks for event in chunk.events], error


@pytest.mark.parametrize("speed", [Speed.COLD, Speed.HOT], ids=lambda speed: speed.value)
def test_registers_of_a_dialect_act_alike_at_both_tiers_without_the_interpreter(speed, monkeypatch):
    wanted, events, _ = run(PROGRAM, 10**9, Speed.COLD)
    interpreted = []
    interpret = Executor.run

    def listed(control, block):
        interpreted.append(block.line)
        interpret(control, block)

    monkeypatch.setattr(Executor, "run", listed)
    moves, compiled_events, _ = run(PROGRAM, 0, speed)
    assert interpreted == [11]  # M30, which ends the program
    assert moves.feed.tobytes() == wanted.feed.tobytes()
    assert moves.end.tobytes() == wanted.end.tobytes()
    assert compiled_events == events
    assert wanted.feed[:2].tolist() == [100.0, 50.0]
    assert [each.word for each in events][:2] == ["H16", "H18"]
    assert wanted.feed[-1] == 60.0


@pytest.mark.parametrize("compiled_from", [0, 10**9])
def test_a_check_that_does_not_hold_says_so(compiled_from):
    _, _, error = run("P1=0\nG900 K[P1]\nM30\n", compiled_from, Speed.COLD)
    assert error is not None
    assert (error.code, error.line, error.message) == (
        "feed-range",
        2,
        "K0 is no scale of the feed",
    )


@pytest.mark.parametrize("compiled_from", [0, 10**9])
def test_a_code_that_acts_also_puts_into_force_what_it_sets(compiled_from):
    moves, _, error = run("G1 X1 F100\nG902\nX1\nX1\nM30\n", compiled_from, Speed.COLD)
    assert error is None
    assert moves.end[:, 0].tolist() == [1.0, 2.0, 3.0]
