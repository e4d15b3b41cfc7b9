"""What a Fanuc or a LinuxCNC would not do is refused, and a cycle's words do not reach into its neighbours."""

import pytest

from tests.nc.running import WITH_TABLES, run
from twin.nc.canonical import Function

CALLS = "O1\nG0 X0. Y0. Z10.\nG81 X1. Y1. Z-5. R2. F100. {none}\nM98 P{number}\nG80\nM30\n"
PROGRAMS = "O2\nX99.\nM99\nO2000\nX2.\nM99\n"


@pytest.mark.parametrize(("dialect", "none"), [("fanuc", "K0"), ("haas", "L0")])
@pytest.mark.parametrize(("number", "place"), [(2, 99.0), (2000, 2.0)])
def test_a_program_called_within_a_cycle_is_the_one_that_is_named(
    dialect: str, none: str, number: int, place: float
) -> None:
    """M98 P within G81 is the usual way to drill a pattern of holes; P is no dwell there."""
    outcome = run(CALLS.format(number=number, none=none) + PROGRAMS, dialect)
    assert outcome.error is None
    assert outcome.end(-1)["X"] == place


def test_a_block_that_ends_a_cycle_counts_its_own_k() -> None:
    text = "G0 X0. Y0. Z10.\nG81 X1. Y1. Z-5. R2. F100.\nG18 G2 X10. Z10. I4500 K5\nM30"
    outcome = run(text, "fanuc")
    assert outcome.error is None
    assert outcome.moves.center[-1].tolist() == pytest.approx([5.5, 1.0, 10.0], abs=0.01)


@pytest.mark.parametrize(
    ("dialect", "text", "code"),
    [
        ("fanuc", "G41 D1 G1 X10. F100.\nY20.\nG81 X30. Y20. Z-5. R2.", "compensation-change"),
        ("fanuc", "G81 X3. Z-5. R2. F100.\nG41 D1\nX9.", "compensation-change"),
        ("fanuc", "G68 X0. Y0. R90.\nG52 X10.", "rotation-active"),
        ("fanuc", "G68 X0. Y0. R90.\nG92 X0. Y0.", "rotation-active"),
        ("fanuc", "G51.1 X0.\nG55", "rotation-active"),
        ("fanuc", "G51 P2.\nG28 Z0.", "rotation-active"),
        ("fanuc", "G51.1 X0.\nG76 X9. Z-5. R2. Q1. F100.", "rotation-active"),
        ("fanuc", "G83 X9. Z-5. R2. Q1. F100.\nG19\nG84 Y1.", "cycle-plane"),
        ("fanuc", "G81 X9. Z-5. R2. F100.\nG19\nG76 Y1. Q1.", "cycle-plane"),
        ("fanuc", "G93 G1 X10. F2.\nX20.", "no-feed"),
        ("haas", "G12 I10. K5. Q1. D1 F100.", "cycle-size"),
        ("haas", "G12 I10. Q1. D1 F100.", "cycle-word"),
        ("haas", "G18\nG12 I10. D1 F100.", "cycle-plane"),
        ("linuxcnc", "F100\nG0 Z10\nG81 X1 Z-5 R2\nR5", "code-words"),
        ("linuxcnc", "F100\nG0 Z10\nG81 X1 Z-5 R2\nG81", "code-words"),
        ("linuxcnc", "F100\nG0 Z10\nG82 X5 Z-5 R3 P-1", "dwell"),
        ("linuxcnc", "G43.2 H1 Z5", "tool-offset"),
    ],
)
def test_it_is_refused(dialect: str, text: str, code: str) -> None:
    end = "\nM2" if dialect == "linuxcnc" else ""
    outcome = run(text + end, dialect, WITH_TABLES)
    assert outcome.error is not None
    assert outcome.error.code == code


def test_a_variable_that_is_made_vacant_forgets_what_the_job_gave_it() -> None:
    text = "G90\nG1 F100. X#100\n#100=#0\nX#100 Y2.\nIF [#100 EQ #0] THEN #1=9\nZ#1\nM30"
    outcome = run(text, "fanuc", variables={"#100": 5.0})
    assert outcome.error is None
    assert outcome.moves.end[:, :3].tolist() == [[5, 0, 0], [5, 2, 0], [5, 2, 9]]


def test_a_vacant_dwell_is_no_word() -> None:
    hole = "G90 F100.\nG0 X1. Y1. Z5.\nG82 Z-3. R1."
    assert (
        run(f"{hole} P#5\nM30", "fanuc").moves.end.tolist()
        == run(f"{hole}\nM30", "fanuc").moves.end.tolist()
    )


@pytest.mark.parametrize(("word", "name"), [("H-0", "H0"), ("H5", "H5")])
def test_h_is_named_alike_by_both_tiers(word: str, name: str) -> None:
    (event,) = run(f"G1 F100 X1\n{word}", "fagor8070").events
    assert isinstance(event, Function)
    assert event.word == name


@pytest.mark.parametrize("word", ["H1.5", "H-3", "H1234567"])
def test_h_is_a_whole_number(word: str) -> None:
    error = run(word, "fagor8070").error
    assert error is not None
    assert error.code == "number-range"


VACANT = "O1\n#1=#0\nG0 X5. Y5.\nG1 X#1 Y9. F100.\nX[#1+1.] Z#1\nG2 X3. Y11. R2. Z#1 F#1\nG1 G#1 X7.\nM#1\nG81 Z-2. R1. X#1 Y1. Q#1\nX4. Y#1\nG80\nM30"
WITHOUT = "O1\n#1=#0\nG0 X5. Y5.\nG1 Y9. F100.\nX1.\nG2 X3. Y11. R2.\nG1 X7.\n\nG81 Z-2. R1. Y1.\nX4.\nG80\nM30"


@pytest.mark.parametrize("dialect", ["fanuc", "haas"])
def test_a_word_of_a_vacant_variable_is_as_if_it_were_not_written(dialect: str) -> None:
    """Codes, axes, feeds and words of cycles; in a sum the variable counts as 0 (Macro B)."""
    with_words, without = (run(text, dialect, WITH_TABLES) for text in (VACANT, WITHOUT))
    assert with_words.error is None
    assert without.error is None
    assert len(without.moves) == 12
    assert with_words.moves.end.tolist() == without.moves.end.tolist()
    assert with_words.moves.feed.tobytes() == without.moves.feed.tobytes()
