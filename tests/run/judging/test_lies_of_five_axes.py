"""Attempts to get a green light that is a lie where the tool tilts, and by words of other controls than Fanuc's."""

from pathlib import Path

import pytest

from tests.run.judging.test_verdict_scope import codes
from twin.errors import ConfigError
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.run.judging.outcome import Outcome
from twin.run.preparing.preparation import prepare
from twin.run.progress import no_progress
from twin.run.run import Run

JOB = """
program = "p.nc"
dialect = "{dialect}"
machine = "{machine}"
{top}
[start]
Z = {start}
[stock]
shape = "box"
size = {size}
cell = 0.8
{stock}
[[tools]]
number = 1
diameter = 8.0
length = 100.0
flute = 20.0
{tool}
[[tools]]
number = 2
kind = "drill"
diameter = 6.0
length = 100.0
flute = 30.0
{more}
"""
TRUNNION = {
    "dialect": "fanuc", "machine": "mill5", "top": "part_zero = { Z = -440.0 }", "start": "200.0",
    "size": "[60.0, 60.0, 50.0]",
}  # fmt: skip
HEAD = {
    "dialect": "sinumerik", "machine": "mill5h", "start": "150.0", "size": "[60.0, 60.0, 30.0]",
}  # fmt: skip
PLATE = {"machine": "mill4", "start": "60.0", "size": "[40.0, 40.0, 10.0]"}

BEGIN = "G21 G90 G94 G17\nT1 M6\nG54 G43 H1\nS6000 M3\nG0 X0. Y0. Z120. A0. C0.\n"
LEAN = "G0 A-90.\nG52 Y-40. Z-35.\n"
IN = "G0 X-45. Y0.\nG0 Z-2.\n"
OUT = "G0 Z60.\nG52 Y0. Z0.\nG0 Z120.\nG0 A0.\nM5\nM30\n"
SIDE = BEGIN + LEAN + IN + "G1 X45. F600.\n" + OUT
DRILL = BEGIN.replace("T1", "T2").replace("H1", "H2") + LEAN + "G0 X0. Y0.\nG0 Z2.\nG1 Z-6. F100.\n"
SLOT = "G90 G94 T1 M6\nG43 H1\nS3000 M3\nG0 X-35. Y0.\nG0 Z-2.\nG1 X35. F600.\nG0 Z20.\n"
HOLE = "T2 M6\nS2000 M3\nG0 X0. Y10.\nG0 Z2.\nG1 Z-4. F100.\nG0 Z20.\nG49\nM30\n"
SWIVEL = "G17 G90 G71 G54\nT1 M6\nS6000 M3\nG0 X75 Y0 Z60 B0 C0 D1\n"
LED = (
    SWIVEL + "TRAORI\nG0 B-15\nG0 Z4\nG1 Z-6 F2000\nG1 X-45 F800\nG0 Z60\nG0 B0\nTRAFOOF\nM5\nM30\n"
)


def klartext(cut: str, tool: str = "TOOL CALL 1 Z S6000", start: str = "M3") -> str:
    begin = f"BEGIN PGM P MM\n{tool}\nL X-35 Y+0 Z+50 R0 FMAX {start}\n"
    return f"{begin}L Z-2 R0 FMAX\n{cut}L Z+50 FMAX\nM30\nEND PGM P MM\n"


def grbl(cut: str, start: str = "M3 S6000") -> str:
    return f"G21 G90 G94 G17\n{start}\nG0 X-35 Y0\n{cut}M30\n"


TOLD: dict[str, tuple[str, dict[str, str], str, int]] = {
    "rapid into a side": (SIDE.replace("G1 X45. F600.", "G0 X45."), {}, "rapid-into-stock", 10),
    "a rapid turns the part into the tool": (
        BEGIN + "G0 Z1.\nG0 A-30.\nM30\n", {}, "rapid-into-stock", 7,
    ),
    "spindle off on a side": (
        SIDE.replace(IN, "M5\n" + IN), {}, "spindle-off", 11,
    ),
    "spindle stopped in a side": (
        BEGIN + LEAN + IN + "G1 X0. F600.\nM5\n" + OUT, {}, "stops-in-cut", 11,
    ),
    "tool changed in a side": (
        BEGIN + LEAN + IN + "G1 X0. F600.\nT2 M6\nG43 H2\n" + OUT, {}, "stops-in-cut", 11,
    ),
    "end in a side": (BEGIN + LEAN + IN + "G1 X0. F600.\nM30\n", {}, "ends-in-cut", 11),
    "drill sideways in a side": (DRILL + "G1 X9. F50.\n" + OUT, {}, "drill-sideways", 11),
    "four teeth straight into a side": (
        DRILL.replace("T2", "T1").replace("H2", "H1") + OUT, {"tool": "teeth = 4"}, "blunt-plunge", 10,
    ),
    "begin in the block": (
        "G90 G94 T1 M6\nG54 G43 H1\nS6000 M3\nG1 X45. F600.\nG0 Z120.\nG0 A-90.\nM30\n",
        {"start": "-4.0"}, "starts-in-stock", 4,
    ),
    "beyond the travel of A": (BEGIN + "G0 A45.\nM30\n", {}, "soft-limit", 6),
    "holder in a side": (SIDE.replace("Z-2.", "Z-22."), {"tool": "free_length = 21.0"}, "collision", 9),
    "shank in a side": (SIDE.replace("Z-2.", "Z-30."), {}, "collision", 10),
    "a clamp turned into the way": (
        SIDE, {"more": '[[fixtures]]\nname = "post"\nsize = [20, 20, 120]\nposition = [42, 40, 0]'},
        "collision", 10,
    ),
    "direction too strict": (SIDE, {"more": "[tolerance]\ndirection_mdeg = 0.001"}, "direction_mdeg", 14),
    "direction without a tilt": (
        "G90 G94 T1 M6\nG43 H1\nS6000 M3\nG0 X-35. Y0.\nG0 Z-2.\nG1 X35. F600.\nG0 Z20.\nM30\n",
        {**PLATE, "top": "", "more": "[tolerance]\ndirection_mdeg = 5.0"}, "direction_mdeg", 0,
    ),
    "force limit of a tilted tool": (
        SIDE, {"stock": 'material = "C45"', "tool": "force_limit = 5.0"}, "tool-broken", 10,
    ),
    "force of a tilted tool": (
        SIDE, {"stock": 'material = "C45"', "more": "[tolerance]\nforce_n = 5.0"}, "force_n", 10,
    ),
    "chips of a tilted tool": (SIDE.replace("F600.", "F9000."), {"tool": "chip_limit = 0.05"}, "feed-per-tooth", 10),
    "backwards": (SIDE.replace("S6000 M3", "S6000 M4"), {}, "counter-clockwise", 4),
    "the tip led by another tool's length": (
        BEGIN.replace(" G43 H1", "") + "G43.4 H2\nG0 X-45. Y0. Z40.\nG0 A-15.\nG1 Z-2. F2000.\nG1 X45. F600.\n"
        "G0 Z60.\nG0 A0.\nG49\nM30\n", {}, "length-of-other-tool", 6,
    ),
    "stock above the table": (
        SIDE, {"top": "part_zero = { Z = -300.0 }", "start": "60.0"}, "stock-floats", 1,
    ),
    "D0 before the cut": (
        LED.replace("TRAORI\nG0 B-15\n", "D0\n").replace("G0 B0\nTRAFOOF\n", ""), HEAD, "length-lost", 8,
    ),
    "D0 in the block of the change": (
        LED.replace("TRAORI\nG0 B-15\n", "").replace("G0 B0\nTRAFOOF\n", "").replace("T1 M6", "T1 D0 M6").replace(" D1", ""),
        HEAD, "length-lost", 7,
    ),
    "motion behind the end": (LED + "G1 X5 F100\n", HEAD, "ends-before-motion", 14),
    "M3 without a speed": (LED.replace("S6000 ", ""), HEAD, "spindle-off", 9),
    "beyond the travel of B": (SWIVEL + "G0 B115\nM30\n", HEAD, "soft-limit", 5),
    "G49 before the cut": (
        "G90 G94 T1 M6\nG43 H1\nS6000 M3\nG0 Z40.\nG49\nG0 X-35. Y0.\nG0 Z-2.\nG1 X35. F600.\nG0 Z20.\nM30\n",
        {**PLATE, "top": ""}, "length-lost", 8,
    ),
    "the drill with the cutter's length": (
        SLOT + HOLE,
        {**PLATE, "top": ""}, "length-lost", 12,
    ),
    "FMAX through the plate": (klartext("L X+35 FMAX\n"), {"dialect": "heidenhain", **PLATE}, "rapid-into-stock", 5),
    "no M3 in Klartext": (klartext("L X+35 F600\n", start=""), {"dialect": "heidenhain", **PLATE}, "spindle-off", 5),
    "TOOL CALL in the slot": (
        klartext("L X+0 F600\nTOOL CALL 2 Z S3000\n"), {"dialect": "heidenhain", **PLATE}, "stops-in-cut", 6,
    ),
    "DL over the plate": (
        klartext("L X+35 F600\n", tool="TOOL CALL 1 Z S6000 DL+3"), {"dialect": "heidenhain", **PLATE}, "nothing-cut", 5,
    ),
    "grbl backwards": (
        grbl("G0 Z-2\nG1 X35 F600\nG0 Z20\n", "M4 S6000"), {"dialect": "grbl", **PLATE}, "counter-clockwise", 2,
    ),
    "grbl without a speed": (
        grbl("G0 Z-2\nG1 X35 F600\nG0 Z20\n", "M3 S0"), {"dialect": "grbl", **PLATE}, "spindle-off", 5,
    ),
    "grbl ends in the slot": (grbl("G0 Z-2\nG1 X0 F600\n"), {"dialect": "grbl", **PLATE}, "ends-in-cut", 6),
    "grbl shifted over the plate": (
        grbl("G92 Z30\nG0 Z-2\nG1 X35 F600\nG0 Z50\n"), {"dialect": "grbl", **PLATE}, "nothing-cut", 6,
    ),
}  # fmt: skip

REFUSED: dict[str, tuple[str, dict[str, str], str]] = {
    "a plane that the tool does not stand across": (
        BEGIN + "G68.2 X0. Y0. Z0. I0. J30. K0.\n" + IN + "M30\n", {}, "does not stand across",
    ),
    "across no plane": (BEGIN + "G53.1\nM30\n", {}, "none is in force"),
    "a tip led by no axis": (SWIVEL.replace(" B0 C0", "") + "TRAORI\nM30\n", {**HEAD, "machine": "mill3"}, "tool-center"),
    "PLANE without its move": (
        klartext("PLANE SPATIAL SPA+0 SPB+20 SPC+0 STAY\nL X+35 F600\n"),
        {**TRUNNION, "dialect": "heidenhain"}, "does not stand across",
    ),
    "laser mode": (grbl("$32=1\n"), {"dialect": "grbl", **PLATE}, "console"),
}  # fmt: skip


def run(folder: Path, program: str, parts: dict[str, str]) -> Outcome:
    keys = {**TRUNNION, "stock": "", "tool": "", "more": "", **parts}
    keys["top"] = parts.get("top", "" if parts.get("machine", "mill5") != "mill5" else keys["top"])
    (folder / "p.nc").write_text(program)
    (folder / "p.toml").write_text(JOB.format(**keys))
    chain = Run(prepare(folder / "p.toml"))
    return chain.execute(None, no_progress)


@pytest.mark.seconds("programs are run whole")
@pytest.mark.parametrize("name", TOLD)
def test_a_lie_is_told_at_its_line(name: str, tmp_path: Path) -> None:
    program, parts, code, line = TOLD[name]
    found = codes(run(tmp_path, program, parts))
    assert found.get(code) == line, found


@pytest.mark.parametrize("name", REFUSED)
def test_a_lie_is_refused(name: str, tmp_path: Path) -> None:
    program, parts, match = REFUSED[name]
    with pytest.raises((ConfigError, ProgramError), match=match):
        run(tmp_path, program, parts)


GOOD: dict[str, tuple[str, dict[str, str]]] = {
    "a side": (SIDE, {}),
    "a hole in a side": (DRILL + OUT, {}),
    "down the flank of a side": (
        BEGIN + LEAN + IN + "G1 X-25. F600.\nG1 Y20.\nG1 X-45.\n" + OUT, {"tool": "teeth = 4"},
    ),
    "a led tip": (LED, HEAD),
    "Klartext": (klartext("L X+35 F600\n"), {"dialect": "heidenhain", **PLATE}),
    "grbl": (grbl("G0 Z-2\nG1 X35 F600\nG0 Z20\n"), {"dialect": "grbl", **PLATE}),
    "two tools, each with its length": (
        SLOT + "G49\n" + HOLE.replace("M6", "M6\nG43 H2"),
        {**PLATE, "top": ""},
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", GOOD)
def test_what_is_right_draws_nothing(name: str, tmp_path: Path) -> None:
    assert codes(run(tmp_path, *GOOD[name])) == {}
