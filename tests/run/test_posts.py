"""Programs as posts write them: heads, tool lists and habits of each, with moves of our own.

What the posts write was looked up in programs that people published; none of those is here.
"""

from pathlib import Path
from typing import NamedTuple

import pytest

from twin.errors import UsageError
from twin.run.preparing.assumed_job import with_assumptions
from twin.run.preparing.preparation import prepare


class Post(NamedTuple):
    """What a post writes, and what is made of it: dialect, tools by number, kind and diameter, assumptions."""

    text: str
    dialect: str
    tools: tuple[tuple[int, str, float], ...] = ()
    told: tuple[str, ...] = ()


POSTS: dict[str, Post] = {
    "Fusion 360, fanuc": Post(
        "%\nO01001 (FLANGE)\n(T2 D=8. CR=0. - ZMIN=-6. - FLAT END MILL)\n(T7 D=6.8 CR=0. TAPER=118DEG - ZMIN=-18. - DRILL)\n"
        "N10 G90 G94 G17 G49 G40 G80\nN15 G21\nN20 G28 G91 Z0.\nN25 G90\n(PROFILE)\nN30 T2 M06\nN35 T7\nN40 S4000 M03\n"
        "N45 G54\nN50 M08\nN55 G00 X-40. Y-20.\nN60 G43 Z15. H02\nN65 G00 Z5.\nN70 G01 Z-6. F300.\nN75 X40. F800.\n"
        "N80 G03 X44. Y-16. J4.\nN85 G00 Z15.\nN90 M09\nN95 G28 G91 Z0.\nN100 G90\n(HOLES)\nN105 T7 M06\nN110 S2500 M03\n"
        "N115 G54\nN120 G00 X10. Y10.\nN125 G43 Z15. H07\nN130 G98 G83 X10. Y10. Z-18. R5. Q2. F150.\nN135 X20.\n"
        "N140 G80\nN145 G28 G91 Z0.\nN150 M30\n%\n",
        "fanuc",
        ((2, "flat", 8.0), (7, "drill", 6.8)),
    ),
    "Fusion 360, haas": Post(
        "%\nO08787\n(MACHINE)\n(  VENDOR: HAAS)\n(  MODEL: VF-2)\n(T9 D=2.5 CR=0. TAPER=118DEG - ZMIN=-4.7 - SPOT DRILL)\n"
        "N10 G90 G94 G17\nN15 G21\nN20 G53 G0 Z0.\n(SPOTS)\nN25 T9 M6\nN30 S3000 M3\nN35 G54\nN40 M8\nN45 G0 X5. Y5.\n"
        "N50 G43 Z15. H9\nN55 G0 Z5.\nN60 G98 G81 X5. Y5. Z-4.7 R2. F100.\nN65 X15.\nN70 G80\nN75 M9\nN80 G53 G0 Z0.\nN85 M30\n%\n",
        "haas",
        ((9, "chamfer", 2.5),),
    ),
    "Fusion 360, linuxcnc": Post(
        "%\n(BRACKET)\n(T1 D=0.25 CR=0. - ZMIN=-0.3 - FLAT END MILL)\nN10 G90 G94 G17 G91.1\nN15 G20\nN20 G53 G0 Z0.\n(CONTOUR1)\n"
        "N25 T1 M6\nN30 S3000 M3\nN40 G54\nN45 G64 P0.001\nN50 M8\nN55 G0 X0.2 Y-0.2\nN60 G43 Z0.6 H1\nN65 G1 Z-0.3 F6.\n"
        "N70 Y2.1 F12.\nN75 G0 Z0.6\nN80 M9\nN85 G53 G0 Z0.\nN90 M30\n%\n",
        "linuxcnc",
        ((1, "flat", 6.35),),
    ),
    "Fusion 360, a hobby control's post with whole numbers": Post(
        "(PANEL)\n(T4 D=5 CR=0 - ZMIN=-13 - flat end mill)\nG90 G94\nG17\nG21\n\n(2D Contour1)\nT4\nS5000 M3\nG54\nG0 X14 Y105.5\nZ15\n"
        "G1 Z1 F333.3\nZ-3\nY118.5 F1000\nX8\nG2 X5 Y121.5 I0 J3\nG1 Z15\nM5\nM30\n",
        "fanuc",
        ((4, "flat", 5.0),),
        ("X14 counts whole units",),
    ),
    "Mastercam, MPFAN": Post(
        "%\nO0000(COVER)\n(DATE=DD-MM-YY - 01-02-24 TIME=HH:MM - 10:11)\n(MATERIAL - ALUMINUM MM - 6061)\n( T1 | 10. FLAT ENDMILL | H1 )\n"
        "( T2 | 6.8 DRILL | H2 )\nN100 G21\nN102 G0 G17 G40 G49 G80 G90\nN104 T1 M6\nN106 G0 G90 G54 X-10. Y0. A0. S3000 M3\n"
        "N108 G43 H1 Z25. M8\nN110 Z2.\nN112 G1 Z-5. F200.\nN114 X60. F600.\nN116 G0 Z25.\nN118 M5\nN120 G91 G28 Z0. M9\nN122 M01\n"
        "N124 T2 M6\nN126 G0 G90 G54 X10. Y10. A0. S2000 M3\nN128 G43 H2 Z25. M8\nN130 G99 G81 Z-15. R2. F150.\nN132 X30.\nN134 G80\n"
        "N136 M5\nN138 G91 G28 Z0. M9\nN140 G28 X0. Y0. A0.\nN142 M30\n%\n",
        "fanuc",
        ((1, "flat", 10.0), (2, "drill", 6.8)),
        ("A stays at 0",),
    ),
    "SOLIDWORKS CAM": Post(
        "\nO1001 (CGX-20)\n\n(* TOOL LIST *)\n(T02 ID=002  DIA-0.5000  TOOL END MILL)\n(T05 ID=005  DIA-0.2500  DRILL)\n\nN1 G90 G17 G80 G40 G94 G20 G57\n"
        "M6 T02 (ID=002)\nG90 G0 X-1. Y0.5 S8000 M3\nG43 H002 G0 Z3.\nM8\nZ0.2\nG1 Z-0.3 F20.\nG41 D002 X-0.5 F30.\n"
        "G3 X0. Y1. I0. J0.5\nG1 Y3.\nG40 X-1.\nG0 Z3.\nM5\nM30\n",
        "fanuc",
        ((2, "flat", 12.7),),
        ("G57 lies at program zero",),
    ),
    "FreeCAD, linuxcnc_post": Post(
        "(Exported by FreeCAD)\n(Post Processor: linuxcnc_post)\n(Output Time:2024-01-02 03:04:05)\n(begin preamble)\nG17 G54 G40 G49 G80 G90\nG21\n"
        "(begin operation: TC: 5mm Endmill)\n(TC: 5mm Endmill)\nM5\nM6 T1\nG43 H1\nM3 S10000\n(begin operation: Profile)\nG0 Z15.000\n"
        "G0 X-2.500 Y-2.500\nG1 Z-1.000 F300.000\nG1 Y52.500 F600.000\nG2 X0.000 Y55.000 Z-1.000 I2.500 J0.000\nG0 Z15.000\nM05\nG17 G54 G90 G80 G40\nM2\n",
        "linuxcnc",
        ((1, "flat", 5.0),),
    ),
    "FreeCAD, grbl_post": Post(
        "(Exported by FreeCAD)\n(Post Processor: grbl_post)\n(Output Time:2024-01-02 03:04:05)\n(Begin preamble)\nG17 G90\nG21\n(Begin operation: Profile)\n"
        "G0 Z15.000\nM3 S10000\nG0 X-2.500 Y-2.500\nG1 Z-1.000 F300.000\nG1 Y52.500\nG0 Z15.000\n(Begin postamble)\nM5\nG17 G90\nM2\n",
        "grbl",
    ),
    "PyCAM": Post(
        ";PYCAM-META-DATA: Version: 0.6\n;Estimated machine time: 6 minutes\nG40 (no radius compensation)\nG49 (no length compensation)\nG80\nG54\nG90\nG21 (metric)\n"
        "G61 (exact path)\nF200.00000\nS1000.00000\nT1 M6\nM3\nG0 Z5.00000\nG0 X1.00000 Y1.00000\nG1 Z-1.00000\nG1 X20.50000\nG0 Z5.00000\nM5\nM2\n",
        "fanuc",
    ),
    "CamBam": Post(
        "( Made using CamBam )\n( plate 9/3/2012 3:24:01 PM )\n( T0 : 3.0 )\nG21 G90 G64 G40\nG0 Z3.0\n( T0 : 3.0 )\nT0 M6\n( pocket )\nG17\nM3 S1000\n"
        "G0 X14.9966 Y37.5277\nG1 F300.0 Z-0.3\nG1 F800.0 Y60.0\nG0 Z3.0\nM5\nM30\n",
        "fanuc",
    ),
    "pcb-gcode": Post(
        "(settings)\n(Unit of measure: inch)\n(Inch Mode)\nG20\n(Absolute Coordinates)\nG90\nS15000\nG00 Z0.2500  \nG00 X0.0000  Y0.0000  \nM03\nG04 P0.500000\n"
        "G00 Z0.0500  \nG00 X0.0300 Y0.0300  \nG01 Z-0.0730 F5     \nG01 X0.0300 Y3.1100  F10    \nG00 Z0.2500  \nM05\nM02\n",
        "haas",
        (),
        ("F5 counts whole units",),
    ),
    "dxf2gcode": Post(
        "(Created from file: plate.dxf)\nG21 (Unit in mm)\nG90 (Absolute distance mode)\nG64 P0.01 (Exact Path tol.)\nG17\nG40\nG49\nT1M6\nM8\nS5000M03\n"
        "G0 Z  15.000 \nG0 X  15.000 Y   8.000\nG0 Z   3.000 \nF150\nG1 Z  -2.500\nF400\nG1 X  15.000 Y  14.000\nG1 X   0.000 Y  14.000\nG0 Z  15.000\nM9 M5\nM2\n",
        "linuxcnc",
    ),
    "CIMCO's habit: a comment behind the change": Post(
        "%\nO0001(TEST)\n\nN5(PROFILE)\nT1M6(CUTTER D5)\nG0G54G90X0Y0S5000M3\nG43H1Z100M8\nG0X27.5Y0\nZ2\nG1Z-5F500\nX22.5\nY-10\nG2X20Y-12.5I-2.5J0\nG1X-15\nG0Z15\n"
        "M9\nM5\nG0G91G28Z0\nG28X0\nM30\n%\n",
        "fanuc",
        ((1, "flat", 5.0),),
        ("counts whole units",),
    ),
    "a builder's codes": Post(
        "%\nO2 (B)\n(T3 D=6. CR=3. - ZMIN=-3. - ball end mill)\nN10 G90 G94 G17 G21\nN20 M155\nN30 T3 M6\nN40 S5000 M3\nN50 G54 G0 X0. Y0.\nN60 G43 Z10. H3\n"
        "N70 G1 Z-3. F200.\nN80 X40. F500.\nN90 G0 Z10.\nN100 M256\nN110 M30\n%\n",
        "fanuc",
        ((3, "ball", 6.0),),
        ("M155, M256 do nothing",),
    ),
}  # fmt: skip
FOREIGN = {
    "Vectric, Mach3": "( plate )\n( for Mach2/3 from Vectric )\nN100G00G21G17G90G40G49G80\nN110G71G91.1\nN120T1M06\nN130G00G43Z20.000H1\nN140S12000M03\n",
    "FreeCAD, smoothie_post": "(Exported by FreeCAD)\n(Post Processor: smoothie_post)\nG17 G90\nG21\nM6 T3.0\nM3 S0.0\nG0 Z5.0000\nG1 Z-1.0 F100\n",
    "Slic3r": "; generated by Slic3r 1.3\nM190 S60\nM104 S185\nG28\nG90\nG1 X10 Y10 E1.5 F1200\n",
    "Fusion 360, turning": "%\nO1001\nN10 G98 G18\nN11 G21\nN12 G50 S6000\nN13 G28 U0.\nN15 T0101\nN17 G96 S200 M3\nN18 G0 X60. Z5.\nN19 M30\n%\n",
}


@pytest.mark.parametrize("name", POSTS)
def test_a_post_gets_its_dialect_its_tools_and_a_job(name: str, tmp_path: Path) -> None:
    post, path = POSTS[name], tmp_path / "part.nc"
    path.write_text(post.text)
    made, assumed = with_assumptions(prepare(path, assuming=True), machine=None, strict=False)
    assert made.dialect.name == post.dialect, made.dialect_reason
    tools = tuple((tool.number, tool.kind, round(tool.diameter, 4)) for tool in made.job.file.tools)
    assert not post.tools or tools == post.tools
    assert made.job.file.stock is not None
    for part in post.told:
        assert any(part in line for line in assumed.assumptions), assumed.assumptions
    assert sum(len(chunk.moves) for chunk in made.interpretation().chunks()) > 3


@pytest.mark.parametrize("name", FOREIGN)
def test_a_post_for_another_kind_of_machine_is_named(name: str, tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text(FOREIGN[name])
    with pytest.raises(UsageError, match=r"looks like|its head says"):
        prepare(path, assuming=True)
