"""Plain lines in the kernel and in Python: the same moves, events, diagnostics and positions, to the bit."""

import dataclasses
import math
import random
from typing import Literal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.nc.running import MILL, SETTINGS, SHIPPED, WITH_TABLES
from tests.nc.test_golden import RULES, interpretation_of
from twin.nc.canonical import NO_BLOCK_NUMBER, concatenate
from twin.nc.control.executor import Executor
from twin.nc.control.settings import ControlSettings
from twin.nc.dialects import DIALECTS, dialect_named
from twin.nc.interpreter import Interpretation
from twin.nc.line_kernel.kernel import run_lines
from twin.nc.line_kernel.plain_state import LineKernel, compiled_kernel, line_format
from twin.nc.line_kernel.reading import AXIS, NOT_PLAIN, NUMBER, read_line
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.nc.text.diagnostics.reporter import Reporter
from twin.nc.text.lexer import Lexer
from twin.nc.text.source import Source, source_from_text

POINTED = dataclasses.replace(WITH_TABLES, decimal_point="calculator")
CHANGES = {
    "gost": "G70|G71|G91|G90|G18|G17|G61|G9|G102 C360|G102 C0|G41 D1|G40|G54|G92 X1|G95|G94|G81 X1 Z-2 R1|G80",
    "mefi": "G70|G71|G91|G90|G19|G17|Z1.05 G10|G09|G98|G54|G92 X1 Y2|G42|G40",
    "codesys": "G91|G90|G98|G99|G18|G17|G51 D1|G50|PC360|G43 K5|FF5|E5|FX3|EF3|G41 D2|G40|G61|G60",
    "fagor8070": "G70|G71|G91|G90|G261|G262|G264|G265|G73 Q30|G73|G11|G10|R9 Q30|G20 X1 Z2|G17|G93|G94|G53|G54",
    "grbl": "G20|G21|G91|G90|G18|G17|G93|G94|F200|G80|G92 X1|G92.1|G43.1 Z2|G49|G10 L2 P2 X1|G55|G28 Z0|C5",
    "linuxcnc": "G20|G21|G91|G90|G90.1|G91.1|G64 P0.1|G61|G93|G94|G41 D1|G40|G10 L2 P1 R30|G43 H1|G49",
    "sinumerik": "G70|G71|G700|G710|G91|G90|TRANS X5|ROT RPL=30|SCALE X2|SCALE X2 Y2 Z2|MIRROR X0|TRANS|AP=30 RP=9|RNDM=1|RNDM=0|G18|G17|G93|G94"
    "|X=IC(2)|G60|G64|G641 ADIS=1|MCALL CYCLE81(9,0,1,-2)|MCALL|G41|G40|G54|G55",
    "fanuc": "G20|G21|G91|G90|G68 X0 Y0 R30.|G69|G51.1 X0|G50.1 X0|G16|G15|G93|G94|G95|G43 H1|G49|G18|G17",
    "haas": "G20|G21|G91|G90|G68 X0 Y0 R30.|G69|G93|G94|G187 P1|G19|G17|G54|G92 X1.",
}
"""What changes the meaning of plain lines."""
WITH_CODES = [name for name, dialect in DIALECTS.items() if dialect.codes.g]
"""Dialects whose motion is G codes, which the kernel knows."""
ALL = "M3 S1000|M5|S500|T1|M6|M8|G4 P1|N7|G1|G0|F300.|(comment)|/X5.|M30"


def outcome(
    source: Source, dialect: str, settings: ControlSettings, kernel: LineKernel | None
) -> tuple[object, ...]:
    """All that comes out of a program."""
    run = Interpretation(source, dialect_named(dialect), settings, kernel=lambda _lines: kernel)
    chunks, error = [], None
    try:
        chunks.extend(run.chunks())
    except ProgramError as raised:
        error = raised.diagnostic
    moves = concatenate((chunk.moves for chunk in chunks), settings.axes)
    columns = [np.asarray(each).tolist() for each in moves.table().values()]
    events = [repr(event) for chunk in chunks for event in chunk.events]
    ends = run.position.tolist(), run.display.tolist()
    return repr(columns), events, run.diagnostics, error, ends


def number(chance: random.Random, value: float) -> str:
    return chance.choice(
        (
            f"{value:.3f}",
            f"{value:.3f}",
            f"{value:.0f}.",
            f"{value:+.6f}",
            f"{value:.13f}",
            f"{value * 1000:.0f}",
        )
    )


def plain_line(chance: random.Random) -> str:
    """A line as a post-processor writes it."""
    kind = chance.random()
    words = [f"N{chance.randrange(9999)}"] if chance.random() < 0.3 else []
    if kind < 0.6:
        words += [chance.choice(("G1", "G0", "G01", "g1", "", ""))]
        words += [
            axis + number(chance, chance.uniform(-50.0, 50.0))
            for axis in "XYZC"
            if chance.random() < (0.1 if axis == "C" else 0.6)
        ]
    else:
        begin, sweep, radius = (
            chance.uniform(0, 6.28),
            chance.uniform(0.1, 6.2),
            chance.uniform(1, 30),
        )
        sense = chance.choice((1.0, -1.0))
        x, y = (radius * (f(begin + sense * sweep) - f(begin)) for f in (math.cos, math.sin))
        words += [f"G91 G{3 if sense > 0.0 else 2}"] if chance.random() < 0.5 else ["G3"]
        words += [f"X{number(chance, x)}", f"Y{number(chance, y)}"]
        if chance.random() < 0.6:
            words += [f"I{-radius * math.cos(begin):.5f}", f"J{-radius * math.sin(begin):.5f}"]
        else:
            words += [f"R{radius if sweep < math.pi else -radius:.5f}"]
        words += [f"Z{number(chance, chance.uniform(-1.0, 1.0))}"] if chance.random() < 0.2 else []
    words += [f"F{chance.randrange(10, 3000)}."] if chance.random() < 0.2 else []
    return chance.choice((" ", " ", "", "\t")).join(filter(None, words))


def cam_program(chance: random.Random, dialect: str) -> str:
    """Plain lines, now and then a change of what they mean, and sometimes a slip."""
    changes = [*CHANGES[dialect].split("|"), *ALL.split("|")]
    lines = ["G1 X0 Y0 Z0 F500."]
    lines += [
        plain_line(chance) if chance.random() < 0.85 else chance.choice(changes)
        for _ in range(chance.randrange(5, 50))
    ]
    text = "\n".join([*lines, "M30", ""])
    if chance.random() < 0.3:
        at, slip = chance.randrange(len(text)), chance.choice("GXYZ-.0123 IJRF([;/%é\t")
        text = text[:at] + slip + text[at + chance.randrange(2) :]
    return text


@pytest.mark.parametrize("dialect", WITH_CODES)
@given(seed=st.integers(0, 2**32))
def test_random_lines_mean_the_same_in_the_kernel(dialect: str, seed: int) -> None:
    chance = random.Random(seed)  # noqa: S311 (programs need no cryptography)
    source = source_from_text(cam_program(chance, dialect))
    settings = chance.choice((SETTINGS, WITH_TABLES, POINTED))
    python = outcome(source, dialect, settings, None)
    assert outcome(source, dialect, settings, run_lines) == python


KLARTEXT = (
    "CC X+0 Y+0|C X+0 Y+0 DR+|CYCL DEF 7.1 X+5|CYCL DEF 8.1 X|CYCL DEF 10.1 IROT+30|CYCL DEF 11.1 SCL 0.5|M136|M137|M126"
    "|M127|L X+1 RL F100|L X+9 Y-9 R0|L FU0.2|F200|F0|S500 M3|TOOL CALL 1 Z S900 DL+1|LBL 1|CALL LBL 1 REP 1|; a ~|* - b"
    "|CYCL DEF 32.1 T0.05|CYCL DEF 200 DRILL Q200=2 Q201=-3 Q206=100 Q202=3 Q203=0|M89|M99|L M140 MB 2|L IX+1|X+4 Y+5|L"
    "|12 Z+3|L X+1,5 Y+2|/ L X+3|L C+30|Q1 = 5|L X+Q1|LN X+1|L Z-5 FMAX M91|L X+5 FMAX|APPR LT X+1 Y+1 LEN2 R0|DEP LT LEN2"
)


def klartext_program(chance: random.Random) -> str:
    """The same in Klartext."""
    lines = [
        "BEGIN PGM P MM" if chance.random() < 0.9 else "BEGIN PGM P INCH",
        "L X+0 Y+0 Z+0 R0 F500",
    ]
    for row in range(chance.randrange(5, 50)):
        words = [
            f"{axis}{chance.uniform(-50.0, 50.0):+.3f}" for axis in "XYZ" if chance.random() < 0.6
        ]
        words += [f"F{chance.randrange(10, 3000)}"] if chance.random() < 0.2 else []
        words += (
            [chance.choice(("R0", "FMAX", "R0 FMAX", "; c", "~"))] if chance.random() < 0.1 else []
        )
        begin = [f"{row}"] if chance.random() < 0.7 else []
        line = chance.choice((" ", " ", "  ", "\t")).join([*begin, "L", *words])
        lines.append(line if chance.random() < 0.85 else chance.choice(KLARTEXT.split("|")))
    text = "\n".join([*lines, "END PGM P MM", ""])
    if chance.random() < 0.3:
        at, slip = chance.randrange(len(text)), chance.choice("LXYZ-+.,0123 QRFIC([;~/%é\t")
        text = text[:at] + slip + text[at + chance.randrange(2) :]
    return text


@given(seed=st.integers(0, 2**32))
def test_random_lines_of_klartext_mean_the_same_in_the_kernel(seed: int) -> None:
    chance = random.Random(seed)  # noqa: S311 (the same)
    source = source_from_text(klartext_program(chance))
    python = outcome(source, "heidenhain", WITH_TABLES, None)
    assert outcome(source, "heidenhain", WITH_TABLES, run_lines) == python


@pytest.mark.seconds("compiles the kernel where it was not compiled before")
@pytest.mark.parametrize("dialect", WITH_CODES)
def test_the_compiled_kernel_computes_the_same_bits(dialect: str) -> None:
    chance = random.Random(dialect)  # noqa: S311 (the same)
    for _ in range(20):
        source = source_from_text(cam_program(chance, dialect))
        settings = chance.choice((WITH_TABLES, POINTED))
        python = outcome(source, dialect, settings, None)
        assert outcome(source, dialect, settings, compiled_kernel()) == python


@pytest.mark.seconds("compiles the kernel where it was not compiled before")
def test_the_compiled_kernel_computes_the_same_bits_of_klartext() -> None:
    chance = random.Random(1)  # noqa: S311 (the same)
    for _ in range(20):
        source = source_from_text(klartext_program(chance))
        python = outcome(source, "heidenhain", WITH_TABLES, None)
        assert outcome(source, "heidenhain", WITH_TABLES, compiled_kernel()) == python


@pytest.mark.seconds("interprets every golden program twice")
@pytest.mark.parametrize("dialect", DIALECTS)
def test_golden_programs_mean_the_same_in_the_kernel(dialect: str) -> None:
    paths = [path for path in (*SHIPPED, *RULES) if dialect in path.parts[-3:-1]]
    assert len(paths) > 10
    for path in paths:
        run = interpretation_of(path)
        given = (run.source, dialect, run.settings)
        assert outcome(*given, run_lines) == outcome(*given, None), path


LONG = {
    "linuxcnc": "G1 X{x:.3f} Y{y:.3f}",
    "grbl": "X{x:.3f}Y{y:.3f}",
    "fanuc": "G1 X{x:.3f} Y{y:.3f}",
    "haas": "N10 X{x:.3f} Y{y:.3f} (c)",
    "gost": "G1 X{x:.3f} Y{y:.3f}",
    "mefi": "G01X{x:.3f}Y{y:.3f}",
    "codesys": "N10 G1 X{x:.3f} Y{y:.3f}",
    "fagor8070": "X{x:.3f} Y{y:.3f} ; c",
    "sinumerik": "N10 G1 X{x:.3f} Y{y:.3f} ; c",
}


def moves_in_the_kernel(text: str, dialect: str, settings: ControlSettings = SETTINGS) -> int:
    """How many moves of a program the kernel makes; all are those of Python."""
    source, ran = source_from_text(text), 0

    def counting(*arguments: object) -> int:
        nonlocal ran
        made = run_lines(*arguments)  # pyright: ignore[reportArgumentType]  # handed on
        ran += made
        return made

    assert outcome(source, dialect, settings, counting) == outcome(source, dialect, settings, None)
    return ran


@pytest.mark.parametrize("dialect", WITH_CODES)
def test_a_file_of_lines_runs_in_the_kernel_in_every_dialect(dialect: str) -> None:
    lines = [LONG[dialect].format(x=row % 97, y=row % 89) for row in range(1000)]
    centers = ("I-0.500 J0", "I0.500 J0") if dialect == "sinumerik" else ("R5.000", "R5.000")
    arcs = (f"G2 X{row % 2}.000 Y0.000 {centers[row % 2]}" for row in range(1000))
    lines = [*lines, "X1.000 Y0.000", *arcs]
    text = "\n".join(["G90 G17", "G1 X5. F100.", *lines, "M30"])
    assert moves_in_the_kernel(text, dialect) >= 1990


def test_a_file_of_klartext_runs_in_the_kernel() -> None:
    lines = [f"{row} L X{row % 97:+.3f} Y{row % 89:+.3f}" for row in range(1000)]
    text = "\n".join(["BEGIN PGM P MM", "L Z+5 F100", *lines, "END PGM P MM"])
    assert moves_in_the_kernel(text, "heidenhain") >= 990


@pytest.mark.parametrize("decimal_point", ["increments", "calculator"])
@pytest.mark.parametrize("dialect", ["fanuc", "haas"])
@pytest.mark.parametrize("begin", ["G21 G94", "G20 G94", "G21 G95 M3 S1000", "G20 G95 M3 S1000"])
def test_numbers_without_a_point_run_in_the_kernel(
    dialect: str, decimal_point: Literal["increments", "calculator"], begin: str
) -> None:
    settings = dataclasses.replace(WITH_TABLES, decimal_point=decimal_point)
    lines = [f"X{row % 97} Y-{row % 89 + 1} F{500 + row % 7}" for row in range(500)]
    text = "\n".join([begin, "G1 X5 F100.", *lines, "G3 X9 Y-9 R50", "X-0 Y5", "M30"])
    assert moves_in_the_kernel(text, dialect, settings) >= 495


def test_the_kernel_goes_on_behind_a_change_of_the_length() -> None:
    part = [f"X{row % 97}. Y{row % 89}." for row in range(100)]
    lines = [line for _ in range(5) for line in ("G43 H1 Z50.", *part, "G49", *part)]
    text = "\n".join(["G90 T1 M6", "G1 X5. F100.", *lines, "M30"])
    assert moves_in_the_kernel(text, "fanuc", WITH_TABLES) >= 980  # a change costs a line or two


KLARTEXT_LETTERS = st.text("LlXYF1205.+- \t;~,CR", max_size=16)


@given(KLARTEXT_LETTERS)
def test_what_the_kernel_reads_of_klartext_the_reader_reads_as_well(line: str) -> None:
    assert_read_alike("heidenhain", line)


LETTERS = st.text("XYyG1205.+-( *)/%\t#é\v\f\x01", max_size=16)


@given(LETTERS)
def test_what_the_kernel_reads_the_reader_reads_as_well(line: str) -> None:
    assert_read_alike("codesys", line)  # it has comments of every kind


def assert_read_alike(name: str, line: str) -> None:
    dialect = dialect_named(name)
    control = Executor(dialect, SETTINGS, source_from_text(line))
    values, data = np.zeros(AXIS + len(MILL)), np.frombuffer(line.encode(), np.uint8)
    form = line_format(control)
    seen = read_line(data, 0, len(data), form, np.ones(26), values)
    if seen == NOT_PLAIN:
        return
    blocks = Lexer(dialect, Reporter(source_from_text(line), strict=False)).blocks(line, 1)
    words = [word for block in blocks for word in block.words]
    read = {int(form.roles[ord(word.address) - ord("A")]): word.value for word in words}
    if form.keyword >= 0:  # its block number is no word
        for block in blocks:
            if block.number != NO_BLOCK_NUMBER:
                read[NUMBER] = block.number
    assert read == {role: values[role] for role in range(len(values)) if seen >> role & 1}
