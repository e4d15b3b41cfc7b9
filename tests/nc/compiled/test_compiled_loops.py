"""Programs that compute, loop and call: the compiled run against the control, bit for bit."""

import dataclasses
import math
import struct
from collections.abc import Callable
from random import Random
from unittest import mock

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.nc.compiled.loop_programs import MAKERS, program
from tests.nc.compiled.test_both_tiers import ALWAYS, assert_same, seen
from tests.nc.running import SETTINGS, WITH_TABLES, bad
from twin.nc.bytecode import expressions
from twin.nc.control.executor import Executor
from twin.nc.dialects import DIALECTS
from twin.nc.text.expressions import LARGEST_NUMBER
from twin.nc.text.source import source_from_text

JOB = dataclasses.replace(
    WITH_TABLES, step_limit=2000, variables={"P3": 1.5, "P9": 2.0, "$v$": 3.0, "w": 1.0}
)
"""Gives values to some of the variables that the programs read."""


@pytest.mark.parametrize("dialect", MAKERS)
@settings(max_examples=150, derandomize=True, deadline=None)
@given(data=st.data())
def test_both_ways_agree_on_programs_that_compute(dialect: str, data: st.DataObject) -> None:
    random_ = data.draw(st.randoms(use_true_random=False))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("twin.nc.text.lines.PAGE", random_.choice([20, 60, 200, 2000]))
        in_pages = source_from_text(program(dialect, random_))
    assert_same(in_pages, dialect, JOB)


@pytest.mark.parametrize("dialect", MAKERS)
def test_most_of_these_programs_run(dialect: str) -> None:
    """Otherwise the test above compares errors."""
    ran = moves = 0
    for seed in range(100):
        text = program(dialect, Random(seed))  # noqa: S311 (programs need no cryptography)
        result = seen(source_from_text(text), dialect, JOB, ALWAYS)
        ran += result.error is None
        moves += len(result.moves)
    assert 40 < ran < 100
    assert moves > 500


def _same_bits(ours: float, theirs: float) -> bool:
    return struct.pack("d", ours) == struct.pack("d", theirs)


def _value(compute: Callable[..., float], operands: list[float]) -> float | None:
    """What a function gives where it is defined."""
    try:
        value = compute(*operands)
    except (ArithmeticError, ValueError):
        return None
    return value if abs(value) <= LARGEST_NUMBER else None


SPECIAL = [0.0, -0.0, 1.0, -1.0, 0.5, -0.5, 2.5, -1e-9, 1e12, -1e12, 30.0, 45.0, 90.0, 360.0]
OPERAND = st.sampled_from(SPECIAL) | st.floats(-1e12, 1e12) | st.floats(-1.0, 1.0)


def _unary(number: int, a: float) -> float:
    return expressions.unary(number, a)


def _binary(number: int, a: float, b: float) -> float:
    return expressions.binary(number, a, b)


def _ternary(number: int, a: float, b: float, c: float) -> float:
    return expressions.ternary(number, a, b, c)


@pytest.fixture(scope="module")
def compiled() -> list[Callable[..., float]]:
    """Functions of one, two and three values as kernels run them."""
    from twin.compilation.kernel import arithmetic_kernel

    return [arithmetic_kernel(each) for each in (_unary, _binary, _ternary)]


@settings(max_examples=400, derandomize=True, deadline=None)
@given(operands=st.lists(OPERAND, min_size=3, max_size=3))
def test_operators_and_functions_give_the_same_bits(
    compiled: list[Callable[..., float]], operands: list[float]
) -> None:
    for values, functions in enumerate(expressions.FUNCTIONS, start=1):
        run, given_ = compiled[values - 1], operands[:values]
        for number, compute in enumerate(functions):
            expected, found = _value(compute, given_), run(number, *given_)
            if expected is None:
                assert not abs(found) <= LARGEST_NUMBER, compute
            else:
                assert _same_bits(found, expected), (compute, given_)


@pytest.mark.parametrize("dialect", DIALECTS)
def test_every_operator_and_function_is_compiled(dialect: str) -> None:
    syntax = DIALECTS[dialect].syntax.expressions
    if syntax is None:
        return
    of_one, of_two, _ = expressions.FUNCTIONS
    assert all(each.compute in of_two for each in syntax.operators.values())
    assert all(each in of_one for each in syntax.prefixes.values())
    for function in syntax.functions.values():
        assert function.compute in expressions.FUNCTIONS[function.arguments - 1]


FORMS = {
    "while": ("fagor8070", "P1=0\nG1 F100\n$WHILE P1<999\nX[P1*.5]\nP1=P1+1\n$ENDWHILE\nM30"),
    "do": ("fagor8070", "P1=0\nG1 F100\n$DO\nX[P1*.5]\nP1+=1\n$ENDDO P1<999\nM30"),
    "for": ("fagor8070", "G1 F100\n$FOR P1=0,999,.5\nX[SIN[P1]]\n$ENDFOR\nM30"),
    "if": (
        "fagor8070",
        (
            "P1=0\nG1 F100\nN1 P1=P1+1\n$IF P1 MOD 2\nX[P1]\n$ELSEIF P1 MOD 3\nY[P1]\n$ELSE\nZ[P1]\n"
            "$ENDIF\n$IF P1<999 $GOTO N1\nM30"
        ),
    ),
    "switch": (
        "fagor8070",
        (
            "G1 F100\n$FOR P1=0,999,1\n$SWITCH P1 MOD 3\n$CASE 0\nX[P1]\n$BREAK\n$DEFAULT\nY[P1]\n"
            "$ENDSWITCH\n$ENDFOR\nM30"
        ),
    ),
    "local subroutine": (
        "fagor8070",
        "%L A\nX[P1]\nM17\n%M\nG1 F100\n$FOR P1=1,999,1\nLL A\n$ENDFOR\nM30",
    ),
    "own parameters": (
        "fagor8070",
        "%L A\nX[P0+P1]\n#RET\n%M\nG1 F100\n$FOR P30=1,999,1\n#PCALL A A[P30] B1\n$ENDFOR\nM30",
    ),
    "repeated range": ("fagor8070", "G91 G1 F100\nN1 X1\nY1\nN2\n#RPT[N1,N2,999]\nM30"),
    "repeated block": ("fagor8070", "P1=999\nG91 G1 F100\nX1 NR[P1]\nX-1 NR999\nM30"),
    "numbered": (
        "fagor8070",
        "G1 F100\n$FOR P1=100,999,1\nP[P1]=P1*2\nP[P1]+=1\nX[P[P1]]\n$ENDFOR\nM30",
    ),
    "machine functions": (
        "fagor8070",
        "G1 F100\n$FOR P1=0,999,1\nM8\nX[P1] M9\nM7 Y[P1]\n$ENDFOR\nM30",
    ),
    "goto": (
        "codesys",
        (
            "N5 G36 O$i$ D0 N6 G1 F10 X0\nN10 G1 X($i$*2) N15 G0 Y(SIN($i$))\nN20 G37 O$i$ D1\n"
            "N30 G20 L10 K($i$ < 999)\nN40 M30"
        ),
    ),
    "counter": ("codesys", "N5 G36 D-999 N6 G91 G1 F10\nN10 X1\nN20 G37 D1\nN30 G20 L10\nN40 M30"),
    "subprogram": (
        "codesys",
        (
            "N5 LET #i := 0\nN6 G1 F10 X0\nN10 S12{#i, 2}\nN20 #i := (#i + 1)\nN30 G20 L10 K(#i < 999)\n"
            "N40 M30\nSUBPROGRAM S12{#a, #b}\nLET #c := #a*#b\nN1 X(#c)\nEND_SUBPROGRAM"
        ),
    ),
    "restoring subprogram": (
        "codesys",
        (
            "N5 LET #i := 0\nN6 G1 F10 X0\nN10 S12{#i}\nN15 X#i\nN20 #i := #i + 1\n"
            "N30 G20 L10 K(#i < 999)\nN40 M30\nSUBPROGRAM S12{#a} RESTORE\nN1 G91 G0 X1 Y2\n"
            "END_SUBPROGRAM"
        ),
    ),
    "repeats": (
        "mefi",
        "N10 G91 G1 X1 F100\nN20 G2 X0 Y0 I10 G73 L10 Q9\nN30 G1 X-1 G73 L10 Q99\nN40 M30",
    ),
}
"""Every form of a loop, a call or a jump, about a thousand times."""


@pytest.mark.parametrize("form", FORMS)
def test_the_compiled_run_takes_every_form(form: str) -> None:
    dialect, text = FORMS[form]
    job = dataclasses.replace(SETTINGS, step_limit=100_000)
    result = assert_same(source_from_text(text), dialect, job)
    assert result.error is None
    assert len(result.moves) >= 900
    with mock.patch.object(Executor, "run", autospec=True, side_effect=Executor.run) as general:
        seen(source_from_text(text), dialect, job, ALWAYS)
    assert general.call_count < 10


@pytest.mark.parametrize("limit", [0, 1, 2, 3, 500, 900])
@pytest.mark.parametrize("form", FORMS)
def test_the_limit_of_repeated_blocks_counts_alike(form: str, limit: int) -> None:
    dialect, text = FORMS[form]
    job = dataclasses.replace(SETTINGS, step_limit=limit)
    result = assert_same(source_from_text(text), dialect, job)
    assert result.error is not None
    assert result.error.code == "endless-program"


@pytest.mark.parametrize(
    ("dialect", "text"),
    [
        ("fagor8070", "%L A\nP1=P1+1\nLL A\nM17\n%M\nP1=0\nLL A\nM30"),
        ("fagor8070", "%L A\n#PCALL A A[P0+1]\nM17\n%M\n#PCALL A A1\nM30"),
        ("codesys", "S12{1}\nM30\nSUBPROGRAM S12{#a}\nS12{#a+1}\nEND_SUBPROGRAM"),
    ],
)
def test_the_depth_of_calls_counts_alike(dialect: str, text: str) -> None:
    result = assert_same(source_from_text(text), dialect, SETTINGS)
    assert result.error is not None
    assert result.error.code == "call-depth"


@pytest.mark.parametrize("dialect", ["fagor8070", "codesys"])
def test_lines_that_share_a_shape_keep_their_own_numbers(dialect: str) -> None:
    random_ = Random(5)  # noqa: S311 (programs need no cryptography)
    opening, closing = "[]" if dialect == "fagor8070" else "()"
    name = "P1" if dialect == "fagor8070" else "#a"
    lines = ["P1=1" if dialect == "fagor8070" else "LET #a := 1", "G90 G1 X0 F100"]
    for number in range(1500):
        a, b = (f"{random_.uniform(0, 50):.{random_.randrange(4)}f}" for _ in range(2))
        words = [
            f"N{number} X{opening}{name}+{a}{closing} Y-{b}",
            f"G91 X{a} Y{opening}{name}*{b}{closing} F{number + 1}",
            f"G90 Z{opening}-{a}{closing}",
            f"{name}=5+{a}" if dialect == "fagor8070" else f"#a := 5+{a}",
            f"X{a} C{name} (text {b})",
            f"X{a}+{b}",
        ]
        lines.append(random_.choice(words))
    result = assert_same(source_from_text("\n".join([*lines, "M30"])), dialect, SETTINGS)
    assert result.error is None


@pytest.mark.parametrize("dialect", DIALECTS)
def test_functions_keep_their_places_between_moves(dialect: str) -> None:
    random_ = Random(6)  # noqa: S311 (programs need no cryptography)
    blocks = ["X{}", "Y{} M8", "M9 Z{}", "M5", "M7", "M0", "G0 X{} M9", "M3", "M8 M5"]
    if dialect == "codesys":
        blocks += ["M77 Y{}", "M8 K2"]
    lines = ["G1 F100"]
    lines += [random_.choice(blocks).format(number % 90) for number in range(6000)]
    result = assert_same(source_from_text("\n".join([*lines, "M30"])), dialect, SETTINGS)
    assert result.error is None
    assert len(result.events) > 3000


def test_more_functions_than_a_chunk_has_moves() -> None:
    text = "G1 X1 F100\n" + "M8\nM9\n" * 5000 + "X2\nM30"
    result = assert_same(source_from_text(text), "gost", SETTINGS)
    assert len(result.events) == 10_001
    assert {before for before, _ in result.events} == {1, 2}


@pytest.mark.parametrize("dialect", ["gost", "mefi", "fagor8070"])
@pytest.mark.parametrize(("functions", "turns"), [("M3\nM8", True), ("M4\nM5", False)])
def test_a_feed_per_revolution_knows_what_compiled_blocks_did_to_the_spindle(
    dialect: str, functions: str, turns: bool
) -> None:
    """Its first word stands behind many blocks, so that the compiled run has met the spindle's."""
    text = f"G1 X1 F100\nS500\n{functions}\n" + "X1\nX2\n" * 20 + "G95 F0.1\nX9\nM30"
    result = assert_same(source_from_text(text), dialect, SETTINGS)
    assert (result.error is None) == turns


def test_a_run_without_moves_is_not_endless() -> None:
    """It comes back now and then, so that an interruption is heard, and goes on."""
    job = dataclasses.replace(SETTINGS, step_limit=10**6)
    text = "P1=0\n$WHILE P1<250000\nP1=P1+1\n$ENDWHILE\nG1 X[P1*0.001] F100\nM30"
    result = seen(source_from_text(text), "fagor8070", job, ALWAYS)
    assert result.error is None
    assert result.moves.end[-1, 0] == 250000 * 0.001


def test_nothing_of_a_block_that_fails_remains() -> None:
    text = "P1=1\nP1=P1+1 P2=P1/0\nM30"
    error = bad(text, "fagor8070", step_limit=10)
    assert error == seen(source_from_text(text), "fagor8070", SETTINGS, ALWAYS).error
    assert error.code == "undefined-value"


def test_memory_of_compiled_lines_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("twin.nc.bytecode.bytecode.MOST_INSTRUCTIONS", 50)
    lines = ["P1=0", "G1 F100", "$WHILE P1<3", "P1=P1+1"]
    lines += [f"X[P1+{number}] Y[P1*{number}]" for number in range(60)]
    text = "\n".join([*lines, "$ENDWHILE", "M30"])
    assert len(assert_same(source_from_text(text), "fagor8070", SETTINGS).moves) == 180


def test_values_of_the_job_are_not_kept_as_the_programs() -> None:
    text = "%L A\nX[P3]\nP3=9\nM17\n%M\nG1 F1\n#PCALL A A1\nX[P3]\n#PCALL A A1\nM30"
    result = assert_same(source_from_text(text), "fagor8070", JOB)
    assert result.error is None
    assert len(result.moves) == 1
    assert math.isclose(result.moves.end[-1, 0], 1.5)
