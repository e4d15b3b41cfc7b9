"""How long every kind of move takes, by what F counts: each program says the time by its control's rule."""

import dataclasses
import math
import random
import re
from itertools import product
from pathlib import Path

import pytest

from tests.nc.linuxcnc.marks import NEEDS_RS274
from tests.nc.linuxcnc.oracle import printed_by_rs274
from tests.nc.running import ROOT, SETTINGS, good
from twin.nc.canonical import Axes, Motion
from twin.nc.dialects import OWN
from twin.nc.dialects.feed_tables import KINDS, feed_rows

MILL_A = Axes(("X", "Y", "Z", "A"), ("linear", "linear", "linear", "rotary"))
PROGRAMS = sorted((ROOT / "tests" / "golden").glob("*/feeds/*.nc"))


def seconds(text: str, dialect: str, **changes: object) -> float:
    moves = good(text, dialect, **changes).moves
    return float((moves.length / moves.feed).sum() * 60.0)


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: f"{path.parts[-3]}/{path.stem}")
def test_a_move_takes_the_time_of_its_controls_rule(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    written = re.search(r"TIME ([0-9.]+) s", text)
    assert written is not None
    taken = seconds(text, path.parts[-3])
    assert math.isclose(taken, float(written[1]), abs_tol=1e-6)


@pytest.mark.parametrize("name", OWN)
def test_every_cell_of_the_table_has_its_program(name: str) -> None:
    rows = feed_rows(name)
    kinds = [kind for kind in KINDS if name != "grbl" or "rotary" not in kind]
    assert [row.kind for row in rows] == kinds
    feeds = [f"G{number:g}" for number in (93, 94, 95) if number in OWN[name].codes.g] or ["F"]
    shown = {path.stem for path in PROGRAMS if path.parts[-3] == name}
    assert shown == {
        f"{mode}_{file}" for mode, file in product(feeds, map(KINDS.__getitem__, kinds))
    }


def test_the_example_of_the_manual_takes_its_time() -> None:
    taken = seconds("O1\nG91 G1 X20. C40. F300.\nM30", "fanuc")
    assert round(taken / 60.0, 5) == 0.14907


def test_in_inches_a_degree_counts_an_inch() -> None:
    taken = seconds("O1\nG20 G91 G1 X20. C40. F300.\nM30", "fanuc")
    assert round(taken / 60.0, 5) == 0.14907


def test_a_parameter_lets_f_of_a_helix_count_the_path() -> None:
    text = "O1\nG2 X20. Y0. Z-5. C40. I10. F300.\nM30"
    way = math.hypot(10.0 * math.pi, 5.0, 40.0)
    assert math.isclose(seconds(text, "fanuc", helical_feed="path"), way / 5.0)


def test_inverse_time_of_an_arc_counts_the_path_by_the_same_parameter() -> None:
    text = "O1\nG93 G2 X20. Y0. Z-5. I10. F2.\nM30"
    way = math.hypot(10.0 * math.pi, 5.0)
    assert math.isclose(seconds(text, "fanuc", helical_feed="path"), way / 20.0 * 60.0)


def test_a_haas_counts_the_surface_of_its_setting() -> None:
    surface = math.pi * 80.0 / 4.0
    assert math.isclose(
        seconds("O1\nG1 C90. F300.\nM30", "haas", rotary_diameter=80.0), surface / 5.0
    )
    way = math.hypot(20.0, surface)
    text = "O1\nG1 X20. C90. F300.\nM30"
    assert math.isclose(seconds(text, "haas", rotary_diameter=80.0), way / 5.0)
    inches = "O1\nG20 G1 C90. F10.\nM30"
    taken = seconds(inches, "haas", rotary_diameter=80.0)
    assert math.isclose(taken, surface / 254.0 * 60.0)


def test_feednd_lets_a_fagor_count_all_axes() -> None:
    text = "G94\nG1 X20 C40 F300\nM30"
    way = math.hypot(20.0, 40.0)
    assert math.isclose(seconds(text, "fagor8070", feed_of_all_axes=True), way / 5.0)


def test_the_keys_of_a_machine_file_are_those_of_the_control() -> None:
    from twin.machine.description.machine_file import ControlTable

    known = {field.name for field in dataclasses.fields(SETTINGS)}
    keys = {"helical_feed", "rotary_diameter", "feed_of_all_axes", "length_returns"}
    assert keys <= known & set(ControlTable.model_fields)


@NEEDS_RS274
@pytest.mark.parametrize("kind", KINDS.values())
def test_inverse_time_has_the_rate_of_linuxcnc_itself(kind: str, tmp_path: Path) -> None:
    path = ROOT / "tests" / "golden" / "linuxcnc" / "feeds" / f"G93_{kind}.nc"
    printed = printed_by_rs274(tmp_path, "-g", path)
    rates = re.findall(r"SET_FEED_RATE\(([0-9.]+)\)", printed)
    moves = good(path.read_text(encoding="utf-8"), "linuxcnc").moves
    assert math.isclose(float(rates[0]), float(moves.feed[0]), abs_tol=1e-4)


@NEEDS_RS274
@pytest.mark.parametrize("mode", ["G93", "G94", "G95"])
def test_a_rotary_axis_a_moves_and_feeds_as_linuxcnc_itself(mode: str, tmp_path: Path) -> None:
    """Lines, arcs and rapids with and without A, seeded: places, kinds and rates; G95 counts a turn of the spindle."""
    drawn, speed = random.Random(mode), 800.0  # noqa: S311 (no cryptography)
    lines = ["G21 G90 G17", f"{mode} M3 S{speed:g}", "G0 X1 Y1 Z1"]
    for _ in range(60):
        x, y, z, a = (round(drawn.uniform(-80.0, 80.0), 3) for _ in range(4))
        kind = drawn.choice(["G0", "G1", "G1", "G1", "G2 R90"])
        words = f"X{x} Y{y} Z{z}" if drawn.random() < 0.7 or "R" in kind else ""
        turned = f" A{a}" if drawn.random() < 0.6 or not words else ""
        lines.append(
            f"{kind} {words}{turned}{'' if kind == 'G0' else f' F{drawn.uniform(0.1, 9.0):.3f}'}"
        )
    path = tmp_path / "part.ngc"
    path.write_text("\n".join([*lines, "M2", ""]))
    printed = printed_by_rs274(tmp_path, "-g", path)
    moves = good(path.read_text(), "linuxcnc", axes=MILL_A, periodic=frozenset({"A"})).moves
    rate, row = math.nan, 0
    for call, text in re.findall(r"(SET_FEED_RATE|STRAIGHT_\w+|ARC_FEED)\(([^)]*)\)", printed):
        values = [float(each) for each in text.split(",")]
        if call == "SET_FEED_RATE":
            rate = values[0] * (speed if mode == "G95" else 1.0)
            continue
        place = [
            values[0],
            values[1],
            values[5 if call == "ARC_FEED" else 2],
            values[6 if call == "ARC_FEED" else 3],
        ]
        assert moves.end[row].tolist() == pytest.approx(place, abs=1e-4)
        assert (moves.motion[row] == Motion.RAPID) == (call == "STRAIGHT_TRAVERSE")
        if call != "STRAIGHT_TRAVERSE":
            assert moves.feed[row] == pytest.approx(rate, rel=1e-3, abs=1e-3)
        row += 1
    assert row == len(moves) == 61
