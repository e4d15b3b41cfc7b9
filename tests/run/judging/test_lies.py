"""More attempts to get a green light that is a lie: an alarm, a refusal, a failed check or a warning at its line."""

from pathlib import Path

import pytest
import trimesh

from tests.run.judging.test_verdict_scope import CUT, HEAD, codes, run
from twin.errors import ConfigError

CUT_ = HEAD + CUT + "M30\n"
DRILL = "G90 G17 T2 M6\nG43 H2\nS2000 M3\nG0 X0. Y0.\nG0 Z2.\nG1 Z-6. F100.\nG0 Z20.\nM30\n"
STEEL = 'material = "C45"'
NOMINAL = '[nominal]\nfile = "nominal.stl"\n'


def fixture(name: str, size: str, position: str) -> str:
    return f'[[fixtures]]\nname = "{name}"\nsize = {size}\nposition = {position}\n'


TOLD: dict[str, tuple[str, dict[str, str], str, int]] = {
    "rapid into the block": (
        HEAD + "G0 X-30. Y0.\nG0 Z-2.\nG0 X0.\nG0 Z20.\nM30\n", {}, "rapid-into-stock", 6,
    ),
    "rapid down into the block": (
        HEAD + "G0 X0. Y0.\nG0 Z-2.\nG0 Z20.\nM30\n", {}, "rapid-into-stock", 5,
    ),
    "spindle off from the start": (
        "G90 G17 T1 M6\nG43 H1\nS3000 M3\nM5\n" + CUT + "M30\n", {}, "spindle-off", 7,
    ),
    "holder in the block": (
        HEAD + CUT.replace("Z-2.", "Z-9.") + "M30\n", {"tool": "free_length = 7.0"}, "collision", 5,
    ),
    "a part with a kilometre to stand": (
        CUT_, {"more": NOMINAL + "standing_um = 1e9"}, "tolerance-too-wide", 1,
    ),
    "a gouge as deep as the block": (
        CUT_, {"more": NOMINAL + "gouge_um = 41e3"}, "tolerance-too-wide", 1,
    ),
    "beyond the travel": (HEAD + CUT + "G0 X900.\nM30\n", {}, "soft-limit", 8),
    "a clamp in the way": (
        CUT_, {"more": fixture("clamp", "[10, 10, 60]", "[30, 0, 0]")}, "collision", 6,
    ),
    "a clamp in the way of the way back": (
        CUT_, {"more": fixture("clamp", "[10, 10, 90]", "[-30, 0, 0]")}, "collision", 4,
    ),
    "a parallel under the slot": (
        HEAD + "G0 X-30. Y10.\nG0 Z-12.\nG1 X30. F300.\nG0 Z20.\nM30\n", {}, "collision", 6,
    ),
    "through the block and on": (
        HEAD + "G0 X-35. Y0.\nG1 Z-75. F300.\nG0 Z20.\nM30\n", {}, "soft-limit", 5,
    ),
    "an arm turns into the motor": (
        "G90 G17 T1 M6\nG43 H1\nS3000 M3\nG1 C-360. F3600.\nM30\n",
        {
            "top": 'machine = "mill4_light"',
            "more": fixture("stop", "[20, 20, 20]", "[0, 70, 0]"),
        }, "collision", 4,
    ),
    "change of tool down in the slot": (
        HEAD + "G0 X-30. Y0.\nG0 Z-2.\nG1 X0. F600.\nT2 M6\nG43 H2\nG0 Z20.\nM30\n", {}, "collision", 7,
    ),
    "thrust of the drill": (
        DRILL, {"stock": STEEL, "more": "thrust_limit = 20.0"}, "tool-broken", 6,
    ),
    "torque of the drill": (
        DRILL, {"stock": STEEL, "more": "torque_limit = 0.05"}, "tool-broken", 6,
    ),
    "chip of the cutter": (
        CUT_, {"stock": STEEL, "tool": "chip_limit = 0.01"}, "tool-broken", 6,
    ),
    "force on the cutter": (
        CUT_, {"stock": STEEL, "tool": "force_limit = 20.0"}, "tool-broken", 6,
    ),
    "thrust counts as force": (
        DRILL, {"stock": STEEL, "more": "[tolerance]\nforce_n = 200.0"}, "force_n", 6,
    ),
    "a material of its own": (
        CUT_,
        {
            "stock": "specific_force = 9000.0\nexponent = 0.2",
            "more": "[tolerance]\nforce_n = 700.0",
        }, "force_n", 6,
    ),
    "plastic bends a thin tool too": (
        CUT_, {"stock": 'material = "POM"', "more": "[tolerance]\ndeflection_um = 0.01"}, "deflection_um", 6,
    ),
    "power": (CUT_, {"stock": STEEL, "more": "[tolerance]\npower_w = 20.0"}, "power_w", 6),
    "lag of an axis": (CUT_, {"more": "[tolerance]\nfollowing_um = 1.0"}, "following_um", 7),
    "too long": (CUT_, {"more": "[tolerance]\ncycle_time_s = 1.0"}, "cycle_time_s", 0),
    "slot half a millimetre beside its place": (
        CUT_.replace("Y0.", "Y0.5"), {"more": NOMINAL}, "gouge_um", 6,
    ),
    "slot too deep": (CUT_.replace("Z-2.", "Z-2.3"), {"more": NOMINAL}, "gouge_um", 6),
    "slot too flat": (
        CUT_.replace("Z-2.", "Z-1.7"), {"more": NOMINAL + "standing_um = 100.0"}, "standing_um", 0,
    ),
    "slot too short": (
        CUT_.replace("G1 X30.", "G1 X5."), {"more": NOMINAL + "standing_um = 100.0"}, "standing_um", 0,
    ),
    "faster than the spindle": (
        CUT_.replace("S3000", "S99000"), {}, "spindle-limited", 3,
    ),
    "drill that turns backwards": (
        DRILL.replace("S2000 M3", "S2000 M4"), {}, "counter-clockwise", 3,
    ),
    "left-hand cutter that turns clockwise": (CUT_, {"tool": 'hand = "left"'}, "counter-clockwise", 3),
    "length reversed": (CUT_.replace("G43", "G44"), {}, "tool-offset", 2),
    "drill fed by a millimetre": (
        DRILL.replace("F100.", "F4000."), {}, "feed-per-tooth", 6,
    ),
    "stock in the air": (CUT_, {"top": "part_zero = { Z = -250.0 }"}, "stock-floats", 1),
    "stock beside the table": (
        CUT_, {"top": "part_zero = { X = 300.0 }"}, "stock-floats", 1,
    ),
    "a jump over all that cuts": (
        HEAD + "GOTO 90\n" + CUT + "N90 G0 Z30.\nM30\n", {}, "nothing-cut", 3,
    ),
    "a move to a variable that nobody set": (
        HEAD + "G0 X-30. Y0.\nG0 Z-2.\nG1 X#100 F600.\nG0 Z20.\nM30\n", {}, "nothing-cut", 3,
    ),
    "a tool that is called and never comes": (
        "G90 G17 T2\nS3000 M3\n" + CUT + "M30\n", {}, "tool-never-changed", 1,
    ),
    "a change that names no tool": (
        "G90 G17 M6\nG43 H1\nS3000 M3\n" + CUT + "M30\n", {}, "change-without-tool", 1,
    ),
    "blocks behind the end of the tape": (
        "%\nO1\n" + HEAD + "%\n" + CUT + "M30\n%\n", {}, "behind-tape-end", 6,
    ),
    "a variable that the program calls otherwise": (
        CUT_.replace("Z-2.", "Z#101"), {"top": 'variables = { "#1O1" = -2.0 }'}, "value-never-read", 1,
    ),
    "a work offset in small letters": (
        HEAD + "G54\n" + CUT + "M30\n", {"top": "offsets.g54 = { X = 5.0 }"}, "value-never-read", 1,
    ),
    "torque and thrust without a material": (
        CUT_, {"tool": "torque_limit = 1e-4\nthrust_limit = 1e-4"}, "limit-not-judged", 6,
    ),
    "no feed": (CUT_.replace(" F600.", ""), {}, "no-feed", 6),
}  # fmt: skip

REFUSED: dict[str, tuple[dict[str, str], str]] = {
    "force without a material": ({"more": "[tolerance]\nforce_n = 1.0"}, "force_n: .* not simulated"),
    "power without a material": ({"more": "[tolerance]\npower_w = 1.0"}, "power_w: .* not simulated"),
    "bend without a material": (
        {"more": "[tolerance]\ndeflection_um = 1.0"}, "deflection_um: .* not simulated",
    ),
    "chip without a material": ({"more": "[tolerance]\nchip_mm = 1.0"}, "chip_mm: .* not simulated"),
    "mean force alone": (
        {"top": 'cutting_force = "mean"', "stock": STEEL, "more": "[tolerance]\nforce_n = 1.0"},
        "force_n: .* not simulated",
    ),
    "load without a force": ({"top": 'cutting_load = true\ncutting_force = "none"'}, "needs a force"),
    "unknown material": ({"stock": 'material = "C46"'}, "is not known"),
    "half a material": ({"stock": "specific_force = 900.0"}, "given together"),
    "a key with a slip": ({"more": "[tolerance]\ncontour_mm = 0.01"}, "contour_mm"),
    "a tolerance of nothing": ({"more": "[tolerance]\ncontour_um = 0.0"}, "contour_um"),
    "a fixture in the stock": (
        {"more": fixture("jaw", "[20, 40, 45]", "[20, 0, 0]")}, "'jaw' reaches .* into the stock",
    ),
    "a fixture in the faceplate": (
        {"more": fixture("jaw", "[20, 40, 5]", "[50, 0, -2]")}, "'jaw' reaches .* into the",
    ),
    "a fixture in a fixture": (
        {"more": fixture("jaw", "[20, 40, 5]", "[50, 0, 0]") + fixture("bolt", "[5, 5, 9]", "[50, 0, 0]")},
        "reaches .* into the",
    ),
    "two fixtures of one name": (
        {"more": fixture("jaw", "[5, 5, 5]", "[50, 0, 0]") + fixture("jaw", "[5, 5, 5]", "[70, 0, 0]")},
        "named twice",
    ),
    "a fixture that is a part of the machine": (
        {"more": fixture("faceplate", "[5, 5, 5]", "[50, 0, 0]")}, "has the name of a part",
    ),
    "a fixture's file that is none": (
        {"more": '[[fixtures]]\nname = "vise"\nfile = "p.nc"'}, "is not a readable STL|no solid",
    ),
    "a fixture's file in the stock": (
        {"more": '[[fixtures]]\nname = "vise"\nfile = "nominal.stl"\nposition = [0, 0, 52]'},
        "'vise' reaches .* into the stock",
    ),
    "stock in the table": ({"top": "part_zero = { Z = -560.0 }"}, "below the table"),
    "a nominal part that is none": ({"more": '[nominal]\nfile = "p.nc"'}, "is not a readable STL|no solid"),
    "a spindle stop declared a lamp": (
        {"more": '[m_functions]\nM5 = "lamp"'}, r"p\.toml: 'm_functions\.M5': fanuc has M5 itself \(spindle stop\)",
    ),
    "a call declared a clamp": ({"more": '[m_functions]\nM98 = "clamp"'}, "M98 itself"),
    "a code declared twice": ({"more": '[m_functions]\nM77 = "open"\nM077 = "shut"'}, "M77 and M077 are one code"),
    "M3 of a control whose M codes are all the builder's": (
        {"dialect": "codesys", "more": '[m_functions]\nM3 = "clamp"'}, "M3 itself",
    ),
    "increments of a control that has none": (
        {"dialect": "linuxcnc", "top": 'decimal_point = "increments"'}, r"p\.toml: 'decimal_point': .* only fanuc, haas",
    ),
    "a row of a tool that is not there": ({"top": "offset_rows = { 31 = 9 }"}, "no tool of the job has the number 9"),
    "an offset of an axis that is not there": (
        {"top": "offsets.G54 = { Q = 5.0 }"}, r"offsets\.G54\.Q': mill4 has the axes X, Y, Z, C",
    ),
    "a tool twice": ({"more": "[[tools]]\nnumber = 2"}, "each with its own number"),
}  # fmt: skip


@pytest.fixture(autouse=True)
def nominal(tmp_path: Path) -> None:
    """The block with its slot, as ``CUT`` makes it: three boxes on a fourth."""
    parts = [((40.0, 40.0, 8.0), (0.0, 0.0, -6.0))]
    parts += [((40.0, 16.0, 10.0), (0.0, side * 12.0, -5.0)) for side in (-1.0, 1.0)]
    boxes = []
    for size, at in parts:
        box = trimesh.creation.box(extents=size)
        box.apply_translation(at)
        boxes.append(box)
    trimesh.util.concatenate(boxes).export(tmp_path / "nominal.stl")


@pytest.mark.seconds("a program is run whole")
def test_the_right_slot_keeps_its_nominal_part(tmp_path: Path) -> None:
    assert not codes(run(tmp_path, CUT_, {"more": NOMINAL + "standing_um = 100.0"}))


@pytest.mark.parametrize(
    ("scale", "shift", "match"),
    [(1 / 25.4, 0.0, "1.57 x 1.57 x 0.394 mm"), (1.0, 5.0, "5 mm out of the stock along X")],
    ids=["inches", "another zero"],
)
def test_a_nominal_part_that_the_stock_cannot_become(
    scale: float, shift: float, match: str, tmp_path: Path
) -> None:
    mesh = trimesh.load_mesh(tmp_path / "nominal.stl")
    mesh.apply_scale(scale)
    mesh.apply_translation([shift, 0.0, 0.0])
    mesh.export(tmp_path / "nominal.stl")
    found = {each.code: each.message for each in run(tmp_path, CUT_, {"more": NOMINAL}).warnings}
    assert match in found["nominal-misfit"]


def test_a_nominal_part_with_an_open_surface_is_told(tmp_path: Path) -> None:
    mesh = trimesh.load_mesh(tmp_path / "nominal.stl")
    mesh.update_faces(mesh.triangles_center[:, 2] < -1e-6)
    mesh.export(tmp_path / "nominal.stl")
    outcome = run(tmp_path, CUT_ + "", {"more": NOMINAL})
    assert "nominal-misfit" in codes(outcome)


@pytest.mark.parametrize("name", TOLD)
def test_a_lie_is_told_at_its_line(name: str, tmp_path: Path) -> None:
    program, parts, code, line = TOLD[name]
    found = codes(run(tmp_path, program, parts))
    assert found.get(code) == line, found


@pytest.mark.parametrize("name", REFUSED)
def test_a_lie_of_the_job_is_refused(name: str, tmp_path: Path) -> None:
    parts, match = REFUSED[name]
    with pytest.raises(ConfigError, match=match):
        run(tmp_path, CUT_, parts)
