"""The compiled tier through plain blocks against the control, bit for bit."""

import dataclasses
import random
from pathlib import Path

import numpy as np
import pytest

from tests.nc.fuzz import REAL, mutated
from tests.nc.running import ROOT, SETTINGS, WITH_TABLES
from twin.compilation.speed import Speed
from twin.nc import interpreter
from twin.nc.canonical import Chunk, Event, Moves, concatenate
from twin.nc.compiled import virtual_machine
from twin.nc.control.executor import Executor
from twin.nc.control.settings import ControlSettings
from twin.nc.dialects import DIALECTS, dialect_named
from twin.nc.interpreter import Interpretation
from twin.nc.text.blocks import Block
from twin.nc.text.diagnostics import Diagnostic, ProgramError
from twin.nc.text.source import Source, read_source, source_from_bytes, source_from_text

NEVER, ALWAYS = 10**9, 0
CALCULATOR = dataclasses.replace(WITH_TABLES, decimal_point="calculator")
GOLDEN = sorted((ROOT / "tests").glob("*/*/**/*.nc")) + sorted((ROOT / "programs").glob("*/*.nc"))

SOUND = [
    "X{} Y{}",
    "X{}",
    "Y{} Z{}",
    "X{} Y{} Z{} C{}",
    "C{}",
    "Z{}",
    "X+5",
    "x{}y{}",
    "X-0",
    "",
    "",
]
RARE = {
    "gost": "G102 C360|G102 C0|$ text|(a) G1 X1 (b)|G9 G1 X3|M3 S100|G41 D1|G40|% heading"
    "|G4 P2|S100|T2 M6|T1|G54|G55 X3|G92 X1|G43 H2|G49|G18|G17|M3 S5 M8|M8 M5|G53|G81 Z-9 R8|G80",
    "codesys": "(* a *) G1 X1|// X2|FX3|LET #a : LREAL := 2|G1 X(1+2)|N1 X1 N2 X2|FF5|E5|M7 K2",
    "fagor8070": "G1 R5 Q30|P1=2|G1 XP1|G1 X20I|; text|G73|G11|G10|G1 X5 NR3|[HERE]",
    "fanuc": "#1=2.5|G1 X#1|X[#1*2]|#[1+1]=#1|X#2|Y#9|(text)|/X1.|/2 Y3.|M98 P2|G4 P20|M3 S500|G54 X3.|G92 X1."
    "|G52 Y2.|G41 D1|G40|G43 H2|G49|G81 Z-9. R8.|X3. K2|G80|G68 X0 Y0 R30.|G69|IF [#1 GT 2] THEN #1=1.5"
    "|G84 Z-9. R8. Q7. F9.",
    "linuxcnc": "#1=2.5|G1 X#1|X[#1*2]|#[1+1]=#1|#<w>=#1|Y#<w>|(text)|; text|/X1|G4 P2|M3 S500|G54|G92 X1|G92.1"
    "|G52 Y2|G41.1 D4|G40|G43 H2|G49|G98 G81 Z-9 R8|X3 L2|G80|G1 @3 ^30|G10 L2 P2 X3|T2 M6|G61|G64 P0.1",
    "mefi": '"text|G1 X1 "behind|Z1 G10|M5|S200|G4 P2|T2 M6|G54|G55 X3|G92 X1|G43 H2|G49|M3 S5 M8',
}
RARE["haas"] = f"{RARE['fanuc']}|G154 P1|G13 I5. D1|G91 X2. L3|G70 I5. L3|IF [#1 GT 2] THEN G1 X4."
"""What the interpreter tier must run in between."""
WRONG = {
    "gost": "(open",
    "codesys": "T90|PC360|G16 I1",
    "fagor8070": "$FOR P2=1,3,1|$ENDFOR|G263=20|G31",
    "fanuc": "M99 P5|GOTO 7|G65 P3|#0=1|END1|G31 X1.",
    "linuxcnc": "G90 G91|o1 endif|#5500=1|G38.2 X1|G7|X#<nothing>|G1 F0 X3",
    "mefi": "G09|G98|G73 L1 Q2",
}
WRONG["haas"] = f"{WRONG['fanuc']}|M97 P99|G150"
WRONG_ANYWHERE = "X{} U5|I{} J{}|K{}|R{}|R-{}|G{}|F-1|G1 G0 X1|X1 X2|X1.2.3|X|Y12345678|G18|N1 X1|Ü"
NUMBERS = ["0", ".5", "5.", "00.250", "-7", "-.125", "0.000001", "-0", "123456"]


@dataclasses.dataclass(frozen=True)
class Seen:
    """All that a program came to."""

    moves: Moves
    events: list[tuple[int, Event]]
    warnings: tuple[Diagnostic, ...]
    error: Diagnostic | None
    place: bytes


def seen(
    source: Source,
    dialect: str,
    settings: ControlSettings,
    compiled_from: int,
    speed: Speed = Speed.HOT,
) -> Seen:
    interpretation = Interpretation(
        source, dialect_named(dialect), settings, compiled_from=compiled_from, speed=speed
    )
    chunks: list[Chunk] = []
    error = None
    try:
        chunks.extend(interpretation.chunks())
    except ProgramError as raised:
        error = raised.diagnostic
    events, before = [], 0
    for chunk in chunks:
        events += [
            (before + event.before, dataclasses.replace(event, before=0)) for event in chunk.events
        ]
        before += len(chunk.moves)
    moves = concatenate((chunk.moves for chunk in chunks), settings.axes)
    place = interpretation.position.tobytes() + interpretation.display.tobytes()
    return Seen(moves, events, interpretation.diagnostics, error, place)


def assert_same(
    source: Source,
    dialect: str,
    settings: ControlSettings = WITH_TABLES,
    speed: Speed = Speed.HOT,
) -> Seen:
    general = seen(source, dialect, settings, NEVER)
    fast = seen(source, dialect, settings, ALWAYS, speed)
    assert fast.error == general.error
    assert fast.warnings == general.warnings
    assert fast.events == general.events
    assert len(fast.moves) == len(general.moves)
    for field in dataclasses.fields(Moves):
        if field.name != "axes":
            ours, theirs = getattr(fast.moves, field.name), getattr(general.moves, field.name)
            assert ours.dtype == theirs.dtype
            assert ours.tobytes() == theirs.tobytes(), field.name
    assert fast.place == general.place
    return fast


def general_blocks(
    text: str, dialect: str, job: ControlSettings, monkeypatch: pytest.MonkeyPatch
) -> int:
    """How many blocks the interpreter tier runs where the compiled tier is taken from the start."""
    lines: list[int] = []
    general = Executor.run

    def counted(control: Executor, block: Block) -> None:
        lines.append(block.line)
        general(control, block)

    monkeypatch.setattr(Executor, "run", counted)
    seen(source_from_text(text), dialect, job, ALWAYS)
    return len(lines)


@pytest.mark.parametrize("speed", [Speed.COLD, Speed.HOT], ids=lambda speed: speed.value)
@pytest.mark.parametrize("path", GOLDEN, ids=lambda path: f"{path.parts[-2]}/{path.stem}")
def test_both_tiers_agree_on_every_program_at_both_speeds(path: Path, speed: Speed) -> None:
    dialect = next(part for part in path.parts if part in DIALECTS)
    assert_same(read_source(path, dialect_named(dialect)), dialect, speed=speed)


def number(random_: random.Random) -> str:
    kind = random_.randrange(6)
    if kind == 0:
        return str(random_.randrange(0, 50))
    if kind == 1:
        return f"{random_.uniform(0, 100):.{random_.randrange(1, 19)}f}"
    if kind == 2:
        return random_.choice(NUMBERS)
    return f"{random_.uniform(-60, 60):.3f}"


def arc(random_: random.Random) -> str:
    """A quarter or full circle, sometimes a helix."""
    clockwise = random_.random() < 0.5
    x, y = random_.randrange(-20, 20) or 3, random_.randrange(-20, 20)
    end_x, end_y = (x - y, y + x) if clockwise else (x + y, y - x)
    if random_.random() < 0.2:
        end_x = end_y = 0
    off = random_.choice([0.0, 0.0, 0.0, 0.0004])
    height = f" Z{random_.randrange(-5, 5)}" if random_.random() < 0.3 else ""
    center = f"I{x + off} J{y}"
    if random_.random() < 0.3 and end_x:
        center = f"R{random_.choice(['', '-'])}{(x * x + y * y) ** 0.5 + off:.3f}"
    return f"G91 G{2 if clockwise else 3} X{end_x} Y{end_y}{height} {center}"


def filled(random_: random.Random, words: str) -> str:
    while "{}" in words:
        words = words.replace("{}", number(random_), 1)
    return words


def block(random_: random.Random, dialect: str, wildness: float) -> str:
    if random_.random() < wildness:
        return filled(
            random_, random_.choice([*WRONG[dialect].split("|"), *WRONG_ANYWHERE.split("|")])
        )
    kind = random_.random()
    if kind < 0.3:
        return arc(random_)
    if kind < 0.35:
        return random_.choice(RARE[dialect].split("|"))
    codes = ["G1", "G0", "G90 G1", "G1 G91", "G17 G1", "G55 G1", "G54 G1"]
    if dialect != "codesys":
        inches = 20 if dialect in ("fanuc", "haas", "linuxcnc") else 70
        codes += [f"G{inches} G1", f"G{inches + 1} G1"]
    feed = random_.choice(["", "", "", " F500", " F0.2"])
    return f"{random_.choice(codes)} {filled(random_, random_.choice(SOUND))}{feed}"


def program(random_: random.Random, dialect: str) -> str:
    wildness = random_.choice([0.0, 0.0, 0.01, 0.05])
    comment = '"b' if dialect == "mefi" else "(b)"
    lines = ["P1=3"] if dialect == "fagor8070" else []
    lines += [random_.choice(["G1 X1 F200", "G1 X1", "G0 X5 Y5 Z5", "G17"])]
    for index in range(random_.randrange(5, 60)):
        label = f"N{index} " if random_.random() < 0.3 else ""
        end = random_.choice(["", "", " ", "\t", f"\t{comment}"])
        lines.append(label + block(random_, dialect, wildness) + end)
    if random_.random() < 0.5 or DIALECTS[dialect].must_end:
        lines.append("M30")
    return random_.choice(["\n", "\r\n", "\r"]).join(lines)


@pytest.mark.parametrize("dialect", DIALECTS)
def test_both_ways_agree_on_random_programs(dialect: str) -> None:
    random_ = random.Random(8)  # noqa: S311 (programs need no cryptography)
    moves = errors = 0
    for _ in range(250):
        settings = random_.choice([WITH_TABLES, CALCULATOR])
        result = assert_same(source_from_text(program(random_, dialect)), dialect, settings)
        moves += len(result.moves)
        errors += result.error is not None
    assert moves > 1000
    assert 20 < errors < 200


@pytest.mark.parametrize("dialect", DIALECTS)
def test_pages_may_end_at_any_line(dialect: str, monkeypatch: pytest.MonkeyPatch) -> None:
    random_ = random.Random(7)  # noqa: S311 (the same)
    for _ in range(40):
        text = program(random_, dialect)
        with monkeypatch.context() as patch:
            patch.setattr("twin.nc.text.lines.PAGE", random_.randrange(20, 200))
            in_pages = source_from_text(text)
        assert_same(in_pages, dialect)


@pytest.mark.parametrize("dialect", DIALECTS)
def test_both_ways_agree_on_mutated_programs(dialect: str) -> None:
    random_ = random.Random(9)  # noqa: S311 (the same)
    settings = dataclasses.replace(SETTINGS, step_limit=300)
    for _ in range(150):
        data = mutated(random_, random_.choice(REAL[dialect]))
        assert_same(source_from_bytes(data, "p.nc", dialect_named(dialect)), dialect, settings)


@pytest.mark.parametrize("dialect", DIALECTS)
def test_long_runs_cross_the_border_of_chunks(dialect: str) -> None:
    random_ = random.Random(3)  # noqa: S311 (the same)
    lines = ["G90 G1 X0 Y0 F100"]
    lines += [
        arc(random_) if index % 3 else f"G90 G1 X{index % 7} Y{index}.5" for index in range(9000)
    ]
    lines.append("M30")
    if dialect == "mefi":  # which refuses the larger arc
        lines = [line.replace("R-", "R") for line in lines]
    result = assert_same(source_from_text("\n".join(lines)), dialect, CALCULATOR)
    assert result.error is None
    assert len(result.moves) > 8000


def test_the_compiled_tier_is_taken() -> None:
    """Otherwise the tests above compare the interpreter tier with itself."""
    from twin.nc.compiled.entries import COLD
    from twin.nc.compiled.virtual_machine import VirtualMachine

    text = "G90 G1 X0 F100\n" + "G1 X1 Y2 (a)\n\nG2 X11 Y2 I5 J0\n" * 50
    for dialect in ("gost", "codesys", "fagor8070", "fanuc"):
        source = source_from_text(text)
        interpretation = Interpretation(source, dialect_named(dialect), CALCULATOR)
        interpretation._control.prepare()
        assert VirtualMachine(interpretation._control, COLD).run()
        assert interpretation._control.program_counter.location.line == 151, dialect


@pytest.mark.parametrize("dialect", sorted(DIALECTS))
def test_a_run_changes_over_when_its_kernels_are_ready(
    dialect: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    looks = iter([True, True, False])
    monkeypatch.setattr(interpreter, "_LOOK_AGAIN", 10)
    monkeypatch.setattr(virtual_machine, "compiles_beside", lambda _machine: next(looks))
    lines = ["G90 G1 X0 F100", *(f"G1 X{number} Y2" for number in range(100))]
    source = source_from_text("\n".join(lines))
    cold = seen(source, dialect, SETTINGS, NEVER)
    ready = seen(source, dialect, SETTINGS, ALWAYS, Speed.WHEN_READY)
    assert next(looks, None) is None
    assert ready.moves.end.tobytes() == cold.moves.end.tobytes()
    assert ready.place == cold.place


def test_a_process_that_has_run_the_kernels_takes_them_early() -> None:
    lines = ["G90 G1 X0 F100", *(f"G1 X{number} Y2" for number in range(200))]
    source = source_from_text("\n".join(lines))
    seen(source, "gost", SETTINGS, ALWAYS)
    next_run = Interpretation(source, dialect_named("gost"), SETTINGS, speed=Speed.HOT)
    moves = sum(len(chunk.moves) for chunk in next_run.chunks())
    assert moves == 200
    assert next_run.compiled_after is not None
    assert next_run.compiled_after <= interpreter.AT_HAND_FROM + 1


RESTORED = """N10 G16 I1 K1
N20 STEP{2}
N30 G3 I10 K-10 T360 F10
N40 G17 G90 G1 X5 Y5
N50 G36 O$i$ D3
N60 STEP{1}
N70 G1 X1 Y2 E50
N80 G37 O$i$ D-1
N90 G20 L60 K$i$>0
N95 M30
SUBPROGRAM STEP{#x : LREAL} RESTORE
N1 G17 G91 G1 X#x Y1 F10
N2 G1 X#x Y2
N3 G98 G2 X3 Y0 I1 J1
N4 G18
RETURN
END_SUBPROGRAM
"""
"""Subprograms that end what is in force, the first called in a plane that the compiled tier does not know."""


@pytest.mark.parametrize("speed", [Speed.COLD, Speed.HOT], ids=lambda speed: speed.value)
def test_what_is_in_force_is_restored_alike(speed: Speed) -> None:
    made = assert_same(source_from_text(RESTORED), "codesys", speed=speed)
    assert made.error is None
    turns = abs(made.moves.sweep) == 360.0
    assert made.moves.normal[turns] == pytest.approx(np.array([[0.5**0.5, 0.0, 0.5**0.5]]))
