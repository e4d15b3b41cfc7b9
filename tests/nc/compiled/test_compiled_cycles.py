"""Drilling cycles: the compiled run against the control, bit for bit."""

import dataclasses
from random import Random

import pytest

from tests.nc.compiled.cycle_programs import program
from tests.nc.compiled.test_both_tiers import assert_same, general_blocks
from tests.nc.running import WITH_TABLES
from twin.nc.text.source import source_from_text

JOB = dataclasses.replace(WITH_TABLES, step_limit=2000)
DRILL = ("fagor8070", "gost", "mefi")
"""Dialects that have cycles."""


@pytest.mark.parametrize("dialect", DRILL)
def test_both_ways_agree_on_cycles(dialect: str) -> None:
    ran = moves = 0
    for seed in range(200):
        text = program(dialect, Random(seed))  # noqa: S311 (programs need no cryptography)
        result = assert_same(source_from_text(text), dialect, JOB)
        ran += result.error is None
        moves += len(result.moves)
    assert 30 < ran < 200
    assert moves > 3000


LOOPS = {
    "fagor8070": "P1=0\nG0 Z9 F100\n$WHILE P1<300\nP1=P1+1\n{}\nX[P1*0.1] Y3\nG80\n$ENDWHILE\nM30",
    "mefi": "G0 Z9 F100\nN5 G90\n{}\nX7 Y3\nG80\nN20 G0 X0 Y0 G73 L5 Q300\nM30",
}
CALLS = {
    "fagor8070": (
        "G81 X[P1] Z2 I-5",
        "G99 G81 Z2 I-5 K1",
        "G98 G82 X1 Z2 I-9 B2 D0.5 R0.8 L1 H1 J2 C0.5 K1 F90",
        "G91 G83 Z-1 I2 J3 S200\nG90",
        "G17 G84 X1 Y2 Z2 I[-P1*0.001-1]",
        "G84 X1 Z2 I-7 B-2 H1 R1 J1 K1 S200 M4",
        "G1 G85 Z2 I-5 M8",
        "G86 R5 Q[P1] Z2 I-4",
        "G83 Z2 I2 J2\nG81 Z2 I-3\nG17",
    ),
    "mefi": (
        "G81 X1 Z-5 R2",
        "G82 Z-5 R2 P1 F90",
        "G83 Y3 Z-5 R2 Q2",
        "G91 G84 X1 Z-5 R-2\nG90",
        "G1 G85 Z-3 R2 M8",
        "G86 Z-3 R2\nX9 Z-4\nR3",
        "G89 Z-3 R2 P2\nG83 Q1\nG81 Z-2\nG17",
    ),
}


@pytest.mark.parametrize(
    ("dialect", "call"), [(dialect, call) for dialect in CALLS for call in CALLS[dialect]]
)
def test_a_cycle_in_a_loop_never_leaves_the_compiled_run(
    dialect: str, call: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = LOOPS[dialect].format(call)
    job = dataclasses.replace(JOB, step_limit=100_000)
    result = assert_same(source_from_text(text), dialect, job)
    assert result.error is None
    assert len(result.moves) > 1000
    assert general_blocks(text, dialect, job, monkeypatch) < 5


TAPS = {
    "fanuc": "G83 X1. Z-5. R2. Q2. F100.\nG84 X2. Z-6.\nX3. Y1.\nG74 X4. Q0.7 R1.\nX5. Q1.\nX6.\nX7.",
    "haas": "G84 X1. Z-5. R2. J3 F100.\nX2. Y1.\nX3. J2.\nG74 X4.\nX5. J1.\nX6. R1.\nX7.",
}


@pytest.mark.parametrize("dialect", TAPS)
def test_taps_go_in_passes_and_come_back_faster_at_both_tiers(dialect: str) -> None:
    text = f"O1\nS500 M3\nG0 X0. Y0. Z10.\n{TAPS[dialect]}\nG80\nM30"
    result = assert_same(source_from_text(text), dialect, JOB)
    assert result.error is None
    assert len(result.moves) > 20


WRONG = {
    "cycle-word": ("gost", "G81 X1 Z-5"),
    "cycle-depth": ("gost", "G83 X1 Z-5 R2 Q-1"),
    "dwell": ("gost", "G82 X1 Z-5 R2 P-1"),
    "cycle-plane": ("gost", "G81 X1 Z-5 R2\nG18\nX3"),
    "unused-word": ("gost", "G81 X1 Z-5 R2 Q1"),
    "unsupported-word": ("fagor8070", "G84 Z2 I-3 R2"),
    "code-words": ("linuxcnc", "G94 G81 X1 Z-5 R2 F100\nX2\nX3\nG93 X4 F2"),
    "no-such-axis": ("fagor8070", "G81 Z1 I-3 U5"),
}


@pytest.mark.parametrize("code", WRONG)
def test_what_is_wrong_with_a_cycle_is_said_alike(code: str) -> None:
    dialect, call = WRONG[code]
    text = f"G0 Z9 F100\nX1\nX2\nX3\nX4\nX5\nX6\n{call}\nX9\nM30"
    result = assert_same(source_from_text(text), dialect, JOB)
    assert result.error is not None
    assert result.error.code == code


def test_more_pecks_than_a_chunk_has_room_for() -> None:
    text = "G0 Z9 F100\n" + "G83 X1 Y1 Z-30 R2 Q0.05\nX2\nX3\nG83 X5 Q0.2\nX6\nX7\nX8\nG80\n" * 8
    result = assert_same(source_from_text(text), "gost", JOB)
    assert result.error is None
    assert len(result.moves) > 30_000


def test_lines_that_share_a_shape_keep_their_own_numbers() -> None:
    random_ = Random(4)  # noqa: S311 (the same)
    lines = ["G0 Z9 F100"]
    for number in range(600):
        x, z, q = (f"{random_.uniform(1, 9):.2f}" for _ in range(3))
        lines += [
            random_.choice(
                [
                    f"N{number} G83 X{x} Y{z} Z-{z} R2 Q{q} F{number + 1}",
                    f"G82 P{q} X{x} R{q} Z-{z}",
                    f"G99 G83 Q2 X{x} R2 Z-{z}",
                    "G80",
                ]
            )
        ]
    result = assert_same(source_from_text("\n".join([*lines, "M30"])), "gost", JOB)
    assert result.error is None
