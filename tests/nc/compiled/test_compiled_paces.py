"""What F counts, at both tiers: programs made at random in every feed mode that a dialect has."""

from random import Random

import pytest

from tests.nc.compiled.test_both_tiers import ALWAYS, CALCULATOR, assert_same, general_blocks, seen
from twin.nc.path.paces import FeedMode, feed_per_minute
from twin.nc.text.source import source_from_text

MODES = {
    "gost": ("G94", "G95"),
    "mefi": ("G94", "G95"),
    "fagor8070": ("G93", "G94", "G95"),
    "fanuc": ("G93", "G94", "G95"),
    "haas": ("G93", "G94", "G95"),
    "linuxcnc": ("G93", "G94", "G95"),
}
MOVES = (
    "G1 X{} Y{}",
    "G90 G1 X{} Z{}",
    "G0 X{} Y{}",
    "G1 C{}",
    "G1 X{} C{}",
    "G91 G2 X{} I{} J0",
    "G90 G1",
)
SPINDLE = ("S1000 M3", "M4 S250", "S800", "M3", "M5", "S0", "M3 S0")


def program(random_: Random, dialect: str) -> str:
    """A program that changes its feed mode now and then; in some the spindle stands, or F lacks."""
    careful = random_.random() < 0.7
    starts = SPINDLE[:3] if careful else SPINDLE
    lines = ["G90 G0 X0 Y0 Z0", SPINDLE[0] if careful else "G17", f"{MODES[dialect][0]} G1 F0.5"]
    for _ in range(random_.randrange(5, 50)):
        if random_.random() < 0.1:
            lines.append(random_.choice(starts))
        mode = random_.choice(MODES[dialect]) + " " if random_.random() < 0.1 else ""
        numbers = [f"{random_.uniform(0.5, 60.0):.3f}" for _ in range(2)]
        move = random_.choice(MOVES).format(*numbers).replace(f"I{numbers[1]}", _center(numbers[0]))
        feed = f" F{random_.uniform(0.1, 9.0):.2f}" if careful or random_.random() < 0.8 else ""
        lines.append(f"{mode}{move}{feed}")
    return "\n".join([*lines, "M30", ""])


def _center(chord: str) -> str:
    """The word of a half circle's centre, given how far its end lies along X."""
    return f"I{float(chord) / 2.0:.4f}"


@pytest.mark.parametrize("dialect", MODES)
def test_both_tiers_agree_on_programs_in_every_feed_mode(dialect: str) -> None:
    random_ = Random(5)  # noqa: S311 (programs need no cryptography)
    moves = errors = 0
    for _ in range(40):
        result = assert_same(source_from_text(program(random_, dialect)), dialect, CALCULATOR)
        moves += len(result.moves)
        errors += result.error is not None
    assert moves > 500
    assert 0 < errors < 30


@pytest.mark.parametrize(
    ("dialect", "mode", "paces"),
    [
        ("mefi", "G95", [100.0, 50.0, 50.0]),
        ("fanuc", "G95", [100.0, 50.0, 50.0]),
        ("fagor8070", "G93", [6000.0, 6000.0, 24000.0]),
        ("linuxcnc", "G93", [1.0, 0.25, 1.0]),
    ],
)
def test_the_compiled_tier_knows_what_f_counts(
    dialect: str, mode: str, paces: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of 10, 5 and 20 mm with F0.1, 0.05 and 0.05, where the spindle makes 1000 turns a minute."""
    rounds = ["G1 X10. F0.1", "G1 X15. F0.05", "G1 X-5. F0.05", "G0 X0."] * 20
    text = "\n".join(["G90 G17 G0 X0.", "S1000 M3", f"{mode} G1 F1.", *rounds, "M30", ""])
    moves = seen(source_from_text(text), dialect, CALCULATOR, ALWAYS).moves
    cuts = moves.feed[moves.motion == 1].tolist()
    assert cuts == pytest.approx(paces * 20)
    assert general_blocks(text, dialect, CALCULATOR, monkeypatch) < 12


def test_a_feed_counts_what_its_mode_says() -> None:
    """The pace of 8 mm with F2, in inches where lengths count, and a spindle of 500 turns a minute."""

    def pace(mode: FeedMode, *, turning: bool = False) -> float:
        return feed_per_minute(2.0, mode, 8.0, turning, 25.4, 500.0, (1.0, 1.0))

    assert pace(FeedMode.PER_MINUTE) == 50.8
    assert pace(FeedMode.PER_MINUTE, turning=True) == 2.0
    assert pace(FeedMode.PER_SECOND) == 50.8 * 60.0
    assert pace(FeedMode.PER_REVOLUTION) == 50.8 * 500.0
    assert pace(FeedMode.SECONDS_PER_BLOCK) == 240.0
    assert pace(FeedMode.BLOCKS_PER_MINUTE) == 16.0
