"""Programs as post-processors and people write them, with ends that were worked out by hand."""

import dataclasses

import numpy as np
import pytest

from tests.nc.running import SETTINGS, Outcome, run
from twin.nc.canonical import Motion, Shape
from twin.nc.control.settings import ToolData

JOB = dataclasses.replace(
    SETTINGS,
    tools={1: ToolData(5.0, 50.0), 2: ToolData(2.0, 60.0), 3: ToolData(3.0, 40.0)},
    offsets={"G54": {}, "G55": {"X": 100.0}, "G54.1 P1": {"Y": 7.0}, "G154 P1": {"Y": 7.0}},
    machine_zero={"X": 0.0, "Y": 0.0, "Z": 200.0, "C": 0.0},
)


@dataclasses.dataclass(frozen=True)
class Probe:
    """A program and what it must come to.

    Attributes:
        dialect: Its control.
        text: The program.
        end: Where it ends, part coordinates [mm or deg].
        feeds: How many moves have a feed.
        lowest: Least Z that any of them reaches [mm].
        refused: Code of its error, instead of all that.
    """

    dialect: str
    text: str
    end: dict[str, float] = dataclasses.field(default_factory=dict)
    feeds: int = 0
    lowest: float = 0.0
    refused: str = ""


POCKET = """%
O01001 (POCKET)
(T1 D=10. CR=0. - ZMIN=-5. - FLAT END MILL)
N10 G90 G94 G17 G49 G40 G80
N15 G21
N20 G28 G91 Z0.
N25 G90
N30 T1 M06
N35 S5000 M03
N40 G54
N45 M08
N50 G00 X12.5 Y-3.
N55 G43 Z15. H01
N60 G00 Z5.
N65 G01 Z1. F300.
N70 G02 X12.5 Y3. Z-2. I0. J3. F500.
N75 X12.5 Y-3. Z-5. J-3.
N80 G03 X15.5 Y0. I0. J3.
N85 G01 X20.
N90 G00 Z15.
N95 M09
N100 M05
N105 G28 G91 Z0.
N110 G90
N115 G53 G0 X0. Y0.
N120 M30
%
"""
DRILLING = """%
O1002
G90 G94 G17 G21
T2 M6
S2000 M3
G54 G0 X10. Y10.
G43 H2 Z25. M8
G98 G81 X10. Y10. Z-12. R5. F150.
X30.
Y30.
X10.
G80
M30
%
"""
HAAS_PECKS = """%
O02001
G00 G17 G40 G49 G80 G90 G54
T1 M06
S3000 M03
G00 G90 G54 X5. Y5.
G43 H01 Z10. M08
G83 G98 X5. Y5. Z-20. R2. Q5. F100.
X25.
G80 M09
G53 G49 Z0.
M30
%
"""
FREECAD = """(Exported by FreeCAD)
G17 G90
G21
G54
M6 T1
G43 H1
M3 S1000
G0 Z15.000
G0 X-5.000 Y-5.000
G1 X-5.000 Y-5.000 Z-1.000 F200.000
G1 X25.000 Y-5.000 Z-1.000
G2 X30.000 Y0.000 Z-1.000 I-0.000 J5.000{}
G0 Z15
M5
G17 G54 G90 G80 G40
M2
"""
INCHES = """%
(AXIS,stop)
G17 G20 G90 G94 G54 G40 G80 G49
G64 P0.001
T1 M6
G43 H1
S1000 M3
G0 Z0.25
X1 Y1
G1 Z-0.1 F10
G2 X1 Y1 I0.5 J0 F20
G0 Z0.25
M5
M30
%
"""
HOLES = """F100
o<hole> sub
G0 X#1 Y#2
G1 Z-[#3]
G0 Z2
o<hole> endsub
o<hole> call [10] [20] [3]
o<hole> call [15] [20] [4]
M2
"""
HAAS_CONTOUR = """%
O01001 (BRACKET)
(T1 D=10. CR=0. - ZMIN=-2. - FLAT END MILL)
N10 G90 G94 G17
N15 G21
N20 G53 G0 Z0.
N25 T1 M6
N30 S5000 M3
N40 G54
N45 M11
N50 G0 C0.
N55 M10
N60 M8
N65 G187 P1
N70 G0 X10. Y-3.
N75 G43 Z15. H1
N80 G0 Z5.
N85 G1 Z1. F300.
N90 G3 X15. Y2. Z-2. I0. J5. F500.
N95 G1 X20. Y7.
N100 G0 Z15.
N105 G187
N110 M9
N115 M5
N120 G53 G0 Z0.
N125 G53 G0 X0. Y0.
N130 M30
%
"""
HAAS_DRILLING = """%
O03
T2 M6
S2000 M3
G54
G0 X10. Y10.
G43 Z25. H2
G0 Z5.
G98 G83 X10. Y10. Z-12. R5. I4. J1. K1.5 F150.
X30.
G80
G98 G73 X10. Y10. Z-12. R5. Q3. P500 F150.
G80
G98 G84 X10. Y10. Z-12. R5. F1500. J2
G80
G0 Z25.
M5
G53 G0 Z0.
M30
%
"""
MASTERCAM = """%
O0000(MASTERCAM)
(T2 | 4. FLAT ENDMILL | H2 | XY STOCK TO LEAVE - 0.)
N100 G21
N110 G0 G17 G40 G49 G80 G90
N120 T2 M6
N130 G0 G90 G54 X0. Y0. C0. S3000 M3
N140 G43 H2 Z25. M8
N150 Z5.
N160 G1 Z-2. F100.
N170 X20. F300.
N180 G3 X20. Y10. R5.
N190 G1 X0.
N200 G3 Y0. R5.
N210 G0 Z25.
N220 M5
N230 G91 G28 Z0. M9
N240 G28 X0. Y0. C0.
N250 M30
%
"""
SOLIDCAM = """%
O5000 (SOLIDCAM)
G21
G0 G40 G80 G49 G17 G54 G90
G91 G28 Z0
G90 M01
N1 M6 T1
(TOOL -1- MILL DIA 10.0 R0. MM )
G90 G00 G40 G54
G43 H1 D31 G0 X-20. Y0. Z50. S1000 M3
M8
X-20. Y0. Z10.
Z2.
G1 Z-3. F33
X20. F100
G0 Z10.
M98 P2
M9
M5
G91 G28 Z0
G28 X0 Y0
M30
O2
G90 G0 X5. Y5.
M99
%
"""

HAAS_BOLT_HOLES = """%
O60701 (G70 BOLT HOLE CIRCLE) ;
(G54 X0 Y0 is center of the circle) ;
T1 M06 (Select tool 1) ;
G00 G90 G40 G49 G54 (Safe startup) ;
G00 G54 X0 Y0 ;
S1000 M03 ;
G43 H01 Z2. ;
M08 ;
G81 G98 Z-10. R1. F150. L0 (Begin G81) ;
G70 I50. J15. L12 (Begin G70) ;
G80 ;
G00 Z2. M09 ;
G53 G49 Z0 M05 ;
M30 ;
%
"""
HAAS_THREAD = """T2 M6
G91 G01 Z-5. F100.
G41 X10. Y-10. D02
G03 X10. Y10. I0 J10. Z0.2
I-20. J0 Z1. L5
X-10. Y10. I-10. J0 Z0.2
G40 G01 X-10. Y-10.
M30
"""
HAAS_MACRO = """%
O00015 (TOP FACE)
G00 G17 G40 G49 G80 G90
G52 X [ 0. ] Y [ 0. ] Z [ 0. ]
#33= 2 (TOOL)
T#33 D#33 M06
G43 H#33 Z200.
#10110= 700. (FEED)
#1= 2.5
#2= 0.
#3= 0.5
#4= 0. / 2.
#7= - #4 -85.
#9= #4 + 85.
G00 X [ #7 ] Y [ #4 ]
G01 Z#1 F#110
WHILE [ #1 GT #2 ] DO1
#1= #1 - #3 * 2.
IF [ #1 LT #2 ] THEN #1= #2
G00 Z [ #1 + #3 ]
G01 X [ #9 ]
G00 Z [ #1 ]
G01 X [ #7 ]
END1
IF [ #1 EQ #2 ] THEN G00 Z200. M09
M30
%
"""
FANUC_HOLES_BY_MACRO = """%
O1(MAIN)
G65P3003A0.B-3.S1.D10.R2.E1F300.X50.Y20.
M30
O3003(MILLING HOLES);
IF[#1LT#2]GOTO1;
#3=#19(STEP Z);
#4=#7/2.(R.);
G90G0X#24Y#25;
G0Z#18;
G1Z#1F500;
G91G#8X-#4Y0.F#9;
IF[#1EQ#2]GOTO2;
#1=#1-#3;
WH[[#1GE#2]OR[#1EQ#2]]DO1;
#1=#1-#3;
G3X0Y0I#4J0Z-#3F#9;
END1;
N2G3X0Y0I#4J0F#9;
G90G40G1X#24Y#25;
G0Z#18;
N1M99;
%
"""
FANUC_THREAD_MILL = """O7(THREAD M20X2.5)
T1 M6
G43 H1 Z5.
G0 Z-10.
G41 D1 G1 X2. Y-8. F300.
G3 X10. Y0. R8. Z-9.375
G3 X10. Y0. I-10. J0. Z-6.875
G3 X2. Y8. R8. Z-6.25
G40 G1 X0. Y0.
G0 Z50.
M30
"""
PCB2GCODE = """( pcb2gcode )
G94 ( Millimeters per minute feed rate. )
G21 ( Units == Millimeters. )
G90 ( Absolute coordinates. )
G00 S10000 ( RPM spindle speed. )
G64 P0.01016 ( set maximum deviation from commanded toolpath )
G01 F100.00000 ( Feedrate. )
G00 Z25.00000 (Retract to tool change height)
T1
M5      (Spindle stop.)
G04 P1.00000
(MSG, Change tool bit to cutter diameter 1.5mm)
M6
M0
M3
o200 sub ( Main subroutine )
G04 P0 ( dwell for no time -- G64 should not smooth over this point )
G00 X-6.0 Y3.0
G00 Z2.00000
G01 Z-0.5 F50
G01 X4 F100
G00 Z2.0
o200 endsub
o200 call
G92 X0
o200 call
M9
M2
"""

PROBES = {
    "fanuc pocket": Probe("fanuc", POCKET, {"X": 0, "Y": 0, "Z": 200}, 5, -5.0),
    "fanuc drilling": Probe("fanuc", DRILLING, {"X": 10, "Y": 30, "Z": 35}, 4, -2.0),
    "fanuc pecks along a row": Probe(
        "fanuc",
        "G21 G90\nG0 Z10.\nG99 G83 X5. Y0. Z-10. R2. Q4. F100.\nG91 X10. K3\nG80\nM30",
        {"X": 35, "Z": 2},
        12,
        -10.0,
    ),
    "fanuc rigid tapping": Probe(
        "fanuc",
        "S500 M3\nG0 Z10.\nM29 S500\nG84 X5. Z-8. R3. F500.\nX10.\nG80\nM5\nM30",
        {"X": 10, "Z": 10},
        4,
        -8.0,
    ),
    "fanuc counted subprogram": Probe(
        "fanuc", "M98 P30200\nM30\nO200\nG91 G1 X5. F100.\nM99", {"X": 15}, 3
    ),
    "fanuc macro": Probe(
        "fanuc",
        "G65 P9010 X10. Y5. A2. L2\nM30\nO9010\nG91 G1 X#24 Y[#25+#1] F100.\nM99",
        {"X": 20, "Y": 14},
        2,
    ),
    "fanuc loop by GOTO": Probe(
        "fanuc",
        "#1=5.\nN10IF[#1LE0]GOTO20\nG91G1X2.F100.\n#1=#1-1.\nGOTO10\nN20M30",
        {"X": 10},
        5,
    ),
    "fanuc holes by polar coordinates": Probe(
        "fanuc",
        "G16 G81 X20. Y30. Z-5. R2. F100.\nY90.\nY150.\nG15 G80\nM30",
        {"X": -17.320508, "Y": 10},
        3,
        -5.0,
    ),
    "fanuc rotation": Probe("fanuc", "G68 X0 Y0 R90.\nG1 X10. F100.\nG69\nM30", {"Y": 10}, 1),
    "fanuc mirror": Probe("fanuc", "G51.1 X0\nG1 X10. Y5. F100.\nG50.1 X0\nM30", {"X": -10}, 1),
    "fanuc scale": Probe("fanuc", "G51 X0 Y0 Z0 P2000\nG1 X10. F100.\nG50\nM30", {"X": 20}, 1),
    "fanuc further work offset": Probe("fanuc", "G54.1 P1\nG0 X1. Y1.\nM30", {"X": 1, "Y": 8}),
    "fanuc compensation": Probe(
        "fanuc", "G41 D1 G1 X10. Y0 F100.\nX50.\nG40 Y-20.\nM30", {"X": 50, "Y": -20}, 3
    ),
    "fanuc least increments": Probe("fanuc", "G0 X10\nM30", {"X": 0.01}),
    "fanuc indexed holes": Probe(
        "fanuc",
        "G0 C90.\nG81 X20. Y0. Z-3. R2. F100.\nC180.\nC270.\nG80\nM30",
        {"C": 270, "X": 20},
        3,
        -3.0,
    ),
    "fanuc holes milled by a macro": Probe(
        "fanuc", FANUC_HOLES_BY_MACRO, {"X": 50, "Y": 20, "Z": 2}, 7, -3.0
    ),
    "fanuc thread milling": Probe("fanuc", FANUC_THREAD_MILL, {"X": 0, "Y": 0, "Z": 50}, 5, -10.0),
    "fanuc length in G91": Probe("fanuc", "G90 G0 Z100.\nG91 G43 Z-50. H2\nM30", {"Z": 60}),
    "fanuc rotation about a scaled centre": Probe(
        "fanuc", "G51 X0 Y0 P2000\nG68 X10. Y0 R90.\nG1 X20. Y0 F9.\nM30", {"X": 20, "Y": 20}, 1
    ),
    "fanuc local system, scale and rotation": Probe(
        "fanuc",
        "G52 X10. Y10.\nG51 X0 Y0 Z0 P2000\nG68 X0 Y0 R90.\nG1 X5. Y0 F9.\nM30",
        {"X": 10, "Y": 20},
        1,
    ),
    "fanuc pecks from the last height in G91": Probe(
        "fanuc",
        "G0 Z20.\nG91 G99 G83 X10. Z-15. R-18. Q5. F100. K3\nG80\nM30",
        {"X": 30, "Z": 2},
        9,
        -13.0,
    ),
    "fanuc cycle without a hole, then a subprogram of holes": Probe(
        "fanuc",
        "G0 Z9.\nG99 G81 R2. Z-3. F90. K0\nM98 P7\nG80\nM30\nO7\nX7.\nX39.\nY38.\nM99",
        {"X": 39, "Y": 38, "Z": 2},
        3,
        -3.0,
    ),
    "fanuc arguments of both kinds": Probe(
        "fanuc",
        "G65 P9 A1. B2. I-3. I4. D5.\nM30\nO9\nG1 X#7 Y#4 Z[#1+#2] F9.\nM99",
        {"X": 5, "Y": -3, "Z": 3},
        1,
        3.0,
    ),
    "fanuc tapping in passes": Probe(
        "fanuc",
        "S99 M3\nG0 Z5.\nM29 S99\nG98 G84 X0 Y0 Z-10. R2. Q5. F99.\nG91 X10. K2\nG80\nM30",
        {"X": 20, "Z": 5},
        18,
        -10.0,
    ),
    "fanuc passes stay in force until G80": Probe(
        "fanuc",
        "S99 M3\nG99 G84 Z-9. R1. Q5. F99.\nG84 X9.\nG80\nG84 X0 Z-9. R1. F99.\nG80\nM30",
        {"X": 0, "Z": 1},
        10,
        -9.0,
    ),
    "fanuc tapping in passes of nothing": Probe(
        "fanuc", "S99 M3\nG84 Z-10. R2. Q0 F99.\nM30", refused="cycle-depth"
    ),
    "fanuc tapping in passes without R": Probe(
        "fanuc", "S99 M3\nG84 Z-10. Q5. F99.\nM30", refused="cycle-word"
    ),
    "fanuc tapping upwards in passes": Probe(
        "fanuc", "S99 M3\nG84 Z-10. R-20. Q5. F99.\nM30", refused="cycle-depth"
    ),
    "fanuc tapping in too many passes": Probe(
        "fanuc", "S99 M3\nG84 Z-900. R2. Q.001 F99.\nM30", refused="cycle-depth"
    ),
    "fanuc high-precision contour control": Probe(
        "fanuc", "G05 P10000\nG1 X5. F100.\nG05 P0\nM30", {"X": 5}, 1
    ),
    "fanuc other modes of G5": Probe("fanuc", "G05 P2\nM30", refused="unsupported-g"),
    "fanuc two signs": Probe("fanuc", "G1 X--5. F9.\nM30", refused="expression"),
    "fanuc sign before a bracket": Probe("fanuc", "G1 X-[-5.] F9.\nM30", {"X": 5}, 1),
    "fanuc skip until a signal": Probe("fanuc", "G31 Z-5. F50.\nM30", refused="unsupported-g"),
    "fanuc inverse time": Probe("fanuc", "G93 G1 X10. F2.\nX20.\nM30", refused="no-feed"),
    "haas pecks": Probe("haas", HAAS_PECKS, {"X": 25, "Z": 200}, 10, -20.0),
    "haas local subprogram": Probe(
        "haas", "G0 Z5.\nM97 P100 L3\nM30\nN100\nG91 G1 X2. F50.\nM99", {"X": 6}, 3, 5.0
    ),
    "haas pocket": Probe("haas", "G0 Z1.\nG12 I20. D1 Z-2. F200.\nM30", {"Z": -2}, 4, -2.0),
    "haas drilling as its newer controls": Probe("haas", HAAS_DRILLING, {"X": 10, "Y": 10, "Z": 200}, 26, -2.0),
    "haas contour with retracts by G53": Probe(
        "haas", HAAS_CONTOUR, {"X": 0, "Y": 0, "Z": 200, "C": 0}, 3, -2.0
    ),
    "haas probing": Probe("haas", "G65 P9832\nM30", refused="unknown-subprogram"),
    "fanuc from Mastercam": Probe("fanuc", MASTERCAM, {"X": 0, "Y": 0, "Z": 200, "C": 0}, 5, 8.0),
    "fanuc from SolidCAM": Probe("fanuc", SOLIDCAM, {"X": 0, "Y": 0, "Z": 200}, 2, -3.0),
    "haas bolt holes on a circle": Probe(
        "haas", HAAS_BOLT_HOLES, {"X": 48.296291, "Y": -12.940952, "Z": 200}, 12, -10.0
    ),
    "haas bolt holes on an arc, around the block's point": Probe(
        "haas",
        "G0 Z1.\nG81 G99 Z-3. R1. F150. L0\nG71 X5. I10. K30. L3\nG80\nM30",
        {"X": 10, "Y": 8.660254, "Z": 1},
        3,
        -3.0,
    ),
    "haas bolt holes without a cycle": Probe("haas", "G70 I5. L3\nM30", refused="cycle-word"),
    "haas L repeats a motion": Probe("haas", HAAS_THREAD, {"X": 0, "Y": 0, "Z": 200.4}, 10, 195.0),
    "haas macro": Probe("haas", HAAS_MACRO, {"X": -85, "Y": 0, "Z": 210}, 7, 10.0),
    "haas all axes home": Probe(
        "haas", "G0 X1. Y2. Z3. C4.\nG28\nM30", {"X": 0, "Y": 0, "Z": 200, "C": 0}
    ),
    "haas code of its work offset": Probe("haas", "G55\n#1=#4012\nG1 X#1 F9.\nM30", {"X": 155}, 1),
    "haas holds no G54 in group 14": Probe("haas", "#1=#4014\nM30", refused="control-variable"),
    "haas rotation while one is in force": Probe(
        "haas", "G68 X0 Y0 R60.\nG91 G68 X0 Y0 R90.\nG90 G1 X10. F9.\nG69\nM30", {"Y": 10}, 1
    ),
    "haas words behind a false condition": Probe(
        "haas", "IF [#1 NE #0] THEN G01 X10. F50.\nM30", {"X": 0}
    ),
    "haas jump behind THEN": Probe("haas", "IF [#1 EQ #0] THEN GOTO 5\nN5 M30", refused="structure"),
    "haas work offset": Probe("haas", "G154 P1 G0 X1. Y1.\nM30", {"X": 1, "Y": 8}),
    "haas mirror": Probe("haas", "G101 X0\nG1 X10. F100.\nG100 X0\nM30", {"X": -10}, 1),
    "linuxcnc in inches": Probe("linuxcnc", INCHES, {"X": 25.4, "Z": 6.35}, 2, -2.54),
    "linuxcnc from FreeCAD": Probe(
        "linuxcnc", FREECAD.format(""), {"X": 30, "Y": 0, "Z": 15}, 3, -1.0
    ),
    "linuxcnc refuses K in G17": Probe(
        "linuxcnc", FREECAD.format(" K0.000"), refused="unused-word"
    ),
    "linuxcnc subroutine": Probe("linuxcnc", HOLES, {"X": 15, "Y": 20, "Z": 2}, 2, -4.0),
    "linuxcnc three turns": Probe("linuxcnc", "F100\nG3 X10 Z4 I5 P3\nM2", {"Z": 4}, 1, 4.0),
    "linuxcnc turned system": Probe(
        "linuxcnc", "G10 L2 P1 X10 R90\nG0 X5 Y0\nM2", {"X": 10, "Y": 5}
    ),
    "linuxcnc system set here": Probe(
        "linuxcnc", "G0 X10\nG10 L20 P1 X0\nG0 X5\nM2", {"X": 15}
    ),
    "linuxcnc from pcb2gcode": Probe("linuxcnc", PCB2GCODE, {"X": 8, "Y": 3, "Z": 2}, 4, -0.5),
    "linuxcnc program called twice": Probe(
        "linuxcnc", "F60\nM98 P100 L2\nM2\nO100\nG91 G1 X5\nM99", {"X": 10}, 2
    ),
    "linuxcnc polar": Probe("linuxcnc", "G0 @10 ^90\nM2", {"X": 0, "Y": 10}),
    "fagor8070 drilling": Probe(
        "fagor8070",
        "G0 X0 Y0 Z20\nG81 G98 X10 Y10 Z2 I-10 F100\nX30\nG80\nM30",
        {"X": 30, "Y": 10, "Z": 20},
        2,
        -10.0,
    ),
    "fagor8070 retract": Probe("fagor8070", "G0 X10 Z20\n#MCS G0 Z0\nM30", {"X": 10, "Z": 200}),
    "fagor8070 repeats": Probe("fagor8070", "G91 G1 X5 F100 NR3\nM30", {"X": 15}, 3),
    "fagor8070 rotation": Probe("fagor8070", "G73 Q90\nG1 X10 F100\nG73\nM30", {"Y": 10}, 1),
    "fagor8070 hole under compensation": Probe(
        "fagor8070",
        "T2 M6 D1\nG41 G1 X10 F99\nX20\nG81 X25 Z1 I-2\nM30",
        refused="compensation-change",
    ),
    "fagor8070 other plane under compensation": Probe(
        "fagor8070", "T2 M6 D1\nG41 G1 X10 F99\nX20\nG20 X1 Z2\nM30", refused="compensation-plane"
    ),
    "gost hole under compensation": Probe(
        "gost",
        "T2 M6\nG41 D2 G1 X10 F99\nX20\nG81 X25 Z-1 R1\nM30",
        refused="compensation-change",
    ),
    "gost plane said again under compensation": Probe(
        "gost", "T2 M6\nG41 D2 G1 X10 F99\nX20\nG17 X30\nG40 X40\nM30", {"X": 40, "Y": 0}, 4
    ),
    "mefi other plane under compensation": Probe(
        "mefi", "T2 M6\nG41 D2 G1 X10 F99\nX20\nG19\nM30", refused="compensation-plane"
    ),
    "mefi hole under compensation": Probe(
        "mefi",
        "T2 M6\nG41 D2 G1 X10 F99\nX20\nG83 X25 Z-1 R1 Q1\nM30",
        refused="compensation-change",
    ),
    "fanuc plane in every arc of a compensated contour": Probe(
        "fanuc",
        "G41 D2 G1 X10. F99.\nG17 G3 X20. Y10. R10.\nG17 G1 Y30.\nG40 X40.\nM30",
        {"X": 40, "Y": 30},
        4,
    ),
    "haas round pocket under compensation": Probe(
        "haas", "G41 D2 G1 X10. F99.\nX20.\nG12 I9.\nM30", refused="compensation-change"
    ),
    "fagor8070 other program": Probe(
        "fagor8070", '#EXEC ["OTHER.NC"]\nM30', refused="unsupported-statement"
    ),
}  # fmt: skip


def _lowest(outcome: Outcome) -> float:
    cuts = outcome.moves.motion == Motion.FEED
    return min((float(end[2]) for end in outcome.moves.end[cuts]), default=0.0)


@pytest.mark.parametrize("name", PROBES)
def test_probe(name: str) -> None:
    probe = PROBES[name]
    outcome = run(probe.text, probe.dialect, JOB)
    if probe.refused:
        assert outcome.error is not None
        assert outcome.error.code == probe.refused
        return
    assert outcome.error is None
    ends = {axis: outcome.position[axis] for axis in probe.end}
    assert ends == pytest.approx(probe.end, abs=1e-6)
    assert (outcome.moves.motion == Motion.FEED).sum() == probe.feeds
    assert _lowest(outcome) == pytest.approx(probe.lowest, abs=1e-6)


def test_a_helix_has_one_arc_for_each_block() -> None:
    moves = run(POCKET, "fanuc", JOB).moves
    arcs = moves.end[moves.shape == Shape.ARC]
    assert arcs[:, 2].tolist() == [-2.0, -5.0, -5.0]


def test_a_tolerance_of_nought_is_none_as_g64_alone() -> None:
    outcome = run("G21 G64 P0.05\nG1 X10 F600\nG64 P0\nY10\nG64\nX0\nM2", "linuxcnc")
    assert outcome.error is None
    assert outcome.moves.corner_tolerance[0] == 0.05
    assert np.isnan(outcome.moves.corner_tolerance[1:]).all()
