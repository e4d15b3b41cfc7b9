"""Files that are no programs of any control here: each is named, and none is taken for a program."""

import re
import struct
from pathlib import Path

import pytest

from tests.nc.running import ROOT, SHIPPED
from twin.errors import UsageError
from twin.nc.dialects.foreign import foreign_files, foreign_kind, require_program, require_text
from twin.nc.dialects.recognition import reading_of
from twin.nc.text.source import source_from_pieces

PROGRAMS = [
    *SHIPPED,
    *(ROOT / "tests" / "golden").rglob("*.nc"),
    *(ROOT / "tests" / "bad").rglob("*.nc"),
    *(ROOT / "twin" / "training" / "scenes").glob("*.nc"),
]

STL = b"made by CAD".ljust(80, b" ") + struct.pack("<I", 2) + b"\0" * 100
FOREIGN: dict[str, list[bytes]] = {
    "PDF": [b"%PDF-1.7\n1 0 obj"],
    "zip": [b"PK\x03\x04\x14\0\0\0"],
    "gzip": [b"\x1f\x8b\x08\0\0\0"],
    "PNG": [b"\x89PNG\r\n\x1a\n"],
    "JPEG": [b"\xff\xd8\xff\xe0"],
    "PLY": [b"ply\nformat binary_little_endian 1.0\nend_header\n\0\1\2\3"],
    "EXPRESS": [b"SCHEMA a;\nENTITY b;\n  c : REAL;\nEND_ENTITY;\nEND_SCHEMA;\n"],
    "DWG": [b"AC1032\0\0"],
    "Windows": [b"MZ\x90\0\x03\0\0\0"],
    "STL": [
        b"solid empty\nendsolid empty\n",
        STL,
        b"made by CAD".ljust(80, b" ")
        + struct.pack("<I", 5000)
        + (b"\0\1\2\x40" * 12 + b"\0\0") * 5000,
        b"solid part\n facet normal 0 0 1\n  outer loop\n",
    ],
    "STEP-NC": [
        b"ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('AP238_MIM'));\n#1=MACHINING_WORKINGSTEP('A');"
    ],
    "STEP file": [b"ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));"],
    "DXF": [b"AutoCAD Binary DXF\r\n\x1a\0", b"0\nSECTION\n2\nHEADER\n", b"  0\r\nSECTION\r\n"],
    "SVG": [b'<?xml version="1.0"?>\n<svg width="10">', b"<svg>"],
    "UTF-16": [
        "\ufeffG21 G90\nG0 X1\n".encode("utf-16-le"),
        "G21 G90\n".encode("utf-16-be"),
        b"\xfe\xff\0G\x002\x001",
    ],
    "binary": [
        b"\x7fCAD\x8e\x0b\0\0\0\0\0\0\x36\0\0\0",
        b"\0\1\2\0data\0\2\3\4" + b"\x9a\0\7" * 90_000,
    ],
    "font": [b"\0\1\0\0cmap\0\2\3\4", b"wOF2\0\1\0\0"],
    "Word": [b"PK\x03\x04\x14\0\6\0[Content_Types].xml word/document.xml"],
    "3MF": [b"PK\x03\x04\x14\0\6\0[Content_Types].xml 3D/3dmodel.model"],
    "NetCDF": [b"CDF\x01\0\0\0\0"],
    "Git LFS": [b"version https://git-lfs.github.com/spec/v1\noid sha256:4d\nsize 1\n"],
    "web server": [b"404: Not Found"],
    "KiCad": [b"(kicad_pcb (version 20221018)\n  (general (thickness 1.6))\n)\n"],
    "OBJ": [b"v 0.0 1.0 2.0\nv 1.0 1.0 2.0\nf 1 2 3\n"],
    "patch": [b"--- a/part.nc\n+++ b/part.nc\n@@ -1 +1 @@\n-G0 X1\n+G0 X2\n"],
    "ShopMill": [b'E_HEAD(0,"G54",90)\nE_CP_CE(1,2,3)\nE_END(1)\n'],
    "Fagor 8025": [b"%P12EXP_22049,MX--,\nN0010 G55\nN0020 T2 D05\n"],
    "WoodWOP": [b'[H\nVERSION="4.0 Alpha"\n<102 \\BohrVert\\\nXA="10"\n'],
    "DSTV": [b"ST\n** E3.nc1\n  PROJECT-1\n  1\nEN\n"],
    "ShopBot": [b"SA\nMS,2,1\nJZ,0.5\nM3,1.0,2.0,-0.1\n"],
    "KAREL": [
        b"PROGRAM tab\nVAR\n  n : INTEGER\nBEGIN\n  n = 1\nEND tab\n",
        b"PROGRAM pick\n%NOLOCKGROUP\n%COMMENT = 'A'\nBEGIN\nEND pick\n",
    ],
    "isel": [b"N10 FASTABS Z0\nN20 MOVEABS X1000 Y2000\n"],
    "tool table": [
        b"; Tools\n\nT0 P0 D0.0 Z0.0 ; none\n",
        b"T1 P1 D0.125 Z+0.5 ;flat\nT2 P2 D0.25 Z+0.1 ;ball\n",
    ],
    "GIF": [b"GIF89a\x10\0\x10\0\xf0\0\0\x01\x02\x03"],
    "BMP": [b"BM\x8e\x0b\0\0\0\0\0\0\x36\0\0\0"],
    "settings": [
        b"[DISPLAY]\nPROGRAM = axis\n",
        b'[package]\nname = "x"\n',
        b"importers:\n  .: 1\npackages:\n  a: 2\n",
    ],
    "Philips": [b"%PM\n\nN9000 (PHILIPS SYSTEM 3000)\nN10 G54\n", b"%5\nN180 G14 N1=80 N2=90\n"],
    "before the 840D": [b"%MPF 90\n( SINUMERIK 850 )\nR11=384.5\n", b"N1 @371 R52 K2 K0\n"],
    "EdingCNC": [b'G90\nMSG "Werkzeug: #1"\nT1 M06\nG0 X1\n', b'warnmsg "clamp it"\nG0 X1\n'],
    "Acramatic": [b': (PGM, NAME="1001")\nG17\nG71\n:T1 M6\n'],
    "proLIGHT": [b"N0; Post Processor: proLIGHT 1000\nN5G05\nN7S1500\n"],
    "merge conflict": [b"<<<<<<< HEAD\nG0 X1\n=======\nG0 X2\n>>>>>>> theirs\n"],
    "review alone": [b"G0 X1\n!!! BLOCKS SKIPPED HERE !!!\nM30\n"],
    "web page": [b"<!DOCTYPE html><html>"],
    "XML": [b'<?xml version="1.0"?><job/>'],
    "APT": [b"PARTNO PLATE\nGOTO / 1.0, 2.0, 3.0\nFEDRAT / 100\n"],
    "HP-GL": [b"IN;SP1;PU0,0;PD100,100;PU;"],
    "Heidenhain": [
        b"%PLATE G71 *\nN10 G30 G17 X+0 Y+0 Z-40 *\nN20 T1 G17 S3000 *\n",
        b"N10 %1001 G71\nN15 G30 G17 X+0. Y+0. Z-20.\nN20 G31 G90 X+100. Y+60. Z+0.\n",
    ],
    "Mazak": [b"T1 M06\nG61.1,K70\nG00 X-30. Y10.\nG61.1,K70\n"],
    "EZ-TRAK": [b"0000 EZTRAK|SX 1 MODE|MM |SAT JAN 1 00:00:00 2011\n0010 RAPID X0\n"],
    "Dynapath": [b"N100(T)1001$\nN103(9)M3S1800T1$\nN106(0)X-30.Y10.$\nN107(0)Z14.$\n"],
    "Mazatrol": [b"UNo. MAT INITIAL-Z ATC MODE\n0 CBN STL 50\nUNo. UNIT TOOL\n"],
    "Okuma": [
        b"OHAND\nIF [VORD[0024] EQ 0] NSKIP\nVDOUT[992]=1001\nNSKIP\nRTS\n",
        b"OHOME\nG0 X60.\nG20 HP=4\nM331\nRTS\n",
        b"$PLATE.MIN%\nG15 H1\nG0 X0 Y0\n",
        b"G15 H1\nCALL O100\nG0 X1\n",
        b"VC1=10\nG15 H1\n",
    ],
    "Marlin": [
        b"G28\nG1 X10 Y10 E1\nG1 X20 E2.5 F900 ; wall\nG1 E-3\n",
        b";FLAVOR:Marlin\nM140 S60\nM104 S200\nG28\n",
        b"M140 S60\nM104 S210\nM109 S210\nG1 X10 Y10 E1.5 F1500\n",
        b"; generated by PrusaSlicer 2.6\nM82\nM104 S200\n",
        b"G21 (metric ftw)\nG90\nM300 S30 (pen down)\nG1 X5 F3500\nM300 S50 (pen up)\nM18 (drives off)\n",
    ],
    "Grbl": [b"$0=10\n$1=25\n$2=0\n$110=500\n"],
    "Mach3": [
        b"G20 G90 G64 G50 G17 G40 G80 G94 G91.1 G49\nG0 X1.\n",
        b"N100G00G17G40\nN110G71G91.1\nN120G0X1Y1\n",
    ],
    "lathe": [
        b"N1G0X380.Z300.T0101M16\nG0G96X[#501]Z50.S250M3\n",
        b"O1001\nG0 G18 G20\nT0303\nM109\nG28 U0.\nM108\n",
        b"O1\nG21 G40\nG28 U0. W0.\nT0101\nG96 S200 M3\nG1 X20. Z-5. F0.2\nM30\n",
        b"O2\nG50 S2000\nT0202\nG0 X50. Z2.\nM30\n",
    ],
    "TinyG": [b'{"sr":null}\nG0 X1\n'],
    "Brother": [b"O1000\nG100 T1 X0 Y0 Z50. G43 H1 S3000 M3\nG1 X10. F100.\nM30\n"],
    "Excellon": [
        b"G90\r\nM72\r\nM48\r\nT105C0.12\r\n%\r\nM30\r\n",
        b"M48\nMETRIC,TZ\nT1C0.800\nT2C1.000\n%\nG90\nG05\nT1\nX10.0Y5.0\nM30\n",
    ],
    "Gerber": [b"%FSLAX46Y46*%\n%MOMM*%\n%ADD10C,0.200*%\nD10*\nX100Y100D02*\nM02*\n"],
    "Fanuc TP": [
        b"/PROG  PICK\n/ATTR\nOWNER = MNEDITOR;\n/MN\n 1:J P[1] 100% FINE ;\n/POS\n/END\n"
    ],
    "KUKA": [b"&ACCESS RVP\nDEF PICK( )\nPTP {A1 0,A2 -90}\nLIN {X 10,Y 5}\nEND\n"],
    "ABB": [b"MODULE Main\nPROC main()\nMoveJ p10, v100, fine, tool0;\nENDPROC\nENDMODULE\n"],
    "JSON": [b'{"moves": [1, 2]}', b"[[1, 2]]"],
    "RML plot": [b"^IN;!MC0;\n^PA;V15.0;\nZ0,0,100;Z100,100,-50;\n"],
    "post processor": [
        b'/**\n  A post.\n*/\ndescription = "Mill";\nvendor = "me";\n',
        b'POST_NAME = "Mill (mm) (*.nc)"\nFILE_EXTENSION = "nc"\n',
    ],
    "Syntec": [b"%@MACRO\n#1 := 10.;\nEND_IF;\nM30\n"],
    "Fadal": [
        b'%\nN1O5(PART\nN2 G0 E1 X0 S3000.1 M3\n#PRINT "DONE"\nM5\n',
        b"N3T1M6\nN4S3000M3E1X1.Y1.\nN5H1M8Z1.\n",
        b"N2 H1 M7 Z.1\nN3 L9101R1+1.R2+3.\n",
    ],
    "OSAI": [b"N1 (UAO,1)\nG0 X0\n(RPT,5)\nG1 X1\n(ERP)\n"],
    "ProtoTRAK": [b"ProtoTRAK MX3\n1 DRILL X0 Y0 T1\n2 MILL XB0 YB0 Z-1\n"],
    "a Centroid": [
        b"; CNC12 - Intercon v5\nT1 M6\nM94/1\nG0 X1\n",
        b'M225 #100 "Check the clamp"\nG0 X1\n',
    ],
    "Swiss": [b"$1\nG600\nT2000\n!2L1\n$2\nG650\n"],
    "Denso": [b"10 OVRD 50\n20 MOV P1\n30 DLY 0.5\n40 END\n", b"TAKEARM\nMOVE L, @0 P2\nGIVEARM\n"],
    "PLC": [b"FUNCTION FC 1 : VOID\nBEGIN\n  U E 0.0;\nEND_FUNCTION\n"],
    "C or C++": [b"#include <stdio.h>\nint main(void) { return 0; }\n"],
    "quoted": [b"# Part\n\n```gcode\nG90\nG1 X1\n```\n", b"> G90\n> G0 X10\n> M30\n"],
    "listing": [b"1: G90\n2: G1 X10\n3: M30\n"],
    "dump": [b"00000000  25 0a 4f 31 30 30 30 0a  |%.O1000.|\n00000008  25 0a  |%.|\n"],
    "attachment": [b"begin 644 part.nc\n#0V%T\n`\nend\n", b"RzIxIEc5MA0KRzEgWDEwIEYx\nTTMwDQo=\n"],
    "set-up sheet": [b"Setup Sheet for 1001\nT1 D=10. - flat end mill\nT2 D=6.8 - drill\n"],
    "answers of a Grbl": [b"ok\nok\n<Idle|MPos:0,0,0|FS:0,0>\nALARM:1\n"],
    "measuring": [b"UNITS=MM\n LOADPROBE/TIP\n MOVESPEED/ 50\nPNT1 =FEAT/CONTACT/POINT\n"],
    "TPA": [b"TPA\\ALBATROS\\EDICAD\\02.00:\nW#2201{ WS=1 }W\n"],
    "PCD": [b"# .PCD v.7\nFIELDS x y z\nSIZE 4 4 4\nDATA ascii\n"],
    "PostScript": [b"\xc5\xd0\xd3\xc6\x1e\0\0\0"],
    "parameters": [b"%\nN00000Q1P01000000\nN00001Q1P00000000\n%"],
    "table of a Heidenhain": [b"BEGIN TOOL .T MM\nT NAME L R R2\n1 D10 100 5 0\n[END]\n"],
    "NUM": [
        b"%100\nE80000=10\nG77 N10 N20\nM02\n",
        b"%10\nN10 L1=5\nN30 G79 L1=0 N50\nM2\n",
        b"%10\nN20 T1 D1 M6\nN50 G81 X20 Y20 ER2 Z-15 F100\nM2\n",
    ],
    "HP-GL/2": [
        b"BPINPS23760,33640;ECNP256PALA1,4,2,4TR0PE<=x;PW0.10PE<qm;",
        b"\x1b%-1BBPINPS1,2;PU;",
    ],
    "HEX": [b":100000000C94B4020C94D1020C94D1020C94D10253\n:00000001FF\n:1000100099\n"],
    "BASIC": [b"10 REM squares\n20 FOR X = 1 TO 9\n30 PRINT X * X\n40 NEXT X\n"],
    "Pascal": [b"PROGRAM cut;\nVAR\n  x : REAL;\nBEGIN\n  x := 1.0;\nEND.\n"],
    "calendar": [b"BEGIN:VCALENDAR\nVERSION:2.0\nDTSTART:20240101\nEND:VCALENDAR\n"],
    "Altium": [b"|HEADER=Protel for Windows|WEIGHT=12\n|RECORD=31|FONTIDCOUNT=1\n"],
    "CNC Simulator": [b'($Message("load the machine first") )\nG92 X40 Y40 T1\nG01 Y12 X-11.5\n'],
    "plasma": [b"S510 ;(DTHC off)\nG0 X1. Y1.\nS502 ;(DTHC delay)\nM3\nG1 X5.\n"],
    "eroding": [b"G92 X0 Y0\nG60\nG38\nG90\nG41 D0\nG1 X9.5 Y3.\nG39\n"],
    "DexArm": [b"; HEADER FOR DEXARM\nM2000\nG0 X1 Y2\n", b"M888 P0\nG0 X1 Y2\n"],
    "PLCopen": [
        b'<?xml version="1.0"?>\n<project xmlns="http://www.plcopen.org/xml/tc6_0201">\n</project>\n'
    ],
    "Maho": [
        b"N1000\nN2 G98 X-10 Y-10 Z10 I120 J120 K-60\nN4 G81 Y2 Z-20\nN5 G79 X10 Y10 Z0\n",
        b"N1 G17\nN4 G195 X-10 Y-10 Z-30 I120 J100 K35\n",
    ],
    "802S": [b"N30 R101=4 R102=2 R103=0 R104=-35\nN40 LCYC82\nN50 M2\n"],
    "8055": [
        b"(P100=1,P101=5)\nG0 X0\n(IF P100 LT P101 GOTO N10)\n(CALL 10)\nM30\n(SUB 10)\n(RET)\n"
    ],
    "TwinCAT": [b"%main\n#VAR\nV.L.A : REAL64 = 5\n#ENDVAR\nL CYCLE [NAME=FACE.ecy @P1=0]\nM30\n"],
    "subroutines": [b"SUB hole\nG81 R2 Z-5\nENDSUB\nGOSUB hole\nM30\n"],
    "Kflop": [b"(BUF,SetBitBuf29)\nG1 X1 F10\nM2\n"],
    "PMAC": [b"CLOSE\n&1\n#1->1000X\nOPEN PROG 1 CLEAR\nX10 Y10\nCLOSE\n"],
    "Aerotech": [b"DVAR $SPEED\nENABLE X Y\nVELOCITY ON\nG1 X10 F5\nLINEAR X20 F$SPEED\n"],
    "Trio": [b"BASE(0,1)\nSPEED=100\nMOVEABS(10,20)\nWAIT IDLE\n"],
    "wire": [
        b"H000 = +000000010 H001 = +000000110 ;\nG54 ; G92 X0Y0 ;\nG01 X10.0 ;\n",
        b"G92 X0 Y0\nM80\nM82\nM84\nG1 X1.\n",
    ],
    "plasma cutter": [b"G21\nG91\nG59 V504 F6.\nM07\nG01 X10.\nM08\n"],
    "ESSI": [b"3\n4\n+500+300\n+1200\n-340+55+12-8+\n7\n+10+20\n+33-10\n"],
    "Trumpf": [b"BD\nSET_METRIC\nBEGIN_EINRICHTEPLAN_INFO\nC\nZA,MM,11\nED\n"],
    "Maestro": [b'SelectWorkplane("Top");\nCreateDrill("D1",32,50,12,8);\n'],
    "IMA": [b'[PGKOPF40]\nFTL="600"\n[VBDMES40]\nDM="8"\n'],
    "BTL": [b"VERSION BTL V10\n[GENERAL]\n[PART]\nPROCESSKEY: 1-010-4 Cut\n"],
    "table": [b"time,X,Y\n0.0,1.0,2.0\n0.1,1.1,2.0\n"],
}
HEADS: dict[str, list[bytes]] = {
    "Mach3": [
        b"(Mach3 Postprocessor)\nG0 X0 Y0\nG1 X10 F100\n",
        b"( for Mach2/3 from Vectric )\nG1 X1 F5\n",
    ],
    "Mazak": [b"(MAZAK VCN-410A)\nG0 X1.\n", b"O1\n(MACHINE MAZAK VARIAXIS)\nG61.1\nG0 X1.\n"],
    "eroding": [b"(WIRE EDM)\nG92 X0 Y0\nT84\nG1 X1.\n"],
    "Mitsubishi": [b"(POST: MITSUBISHI M70)\nG0 X1.\n"],
    "Hurco": [b"(HURCO WINMAX)\nG0 X1.\n"],
    "Centroid": [b"; CENTROID Acorn post\nG0 X1.\n", b";Post Processor: centroid_post\nG0 X1.\n"],
    "Marlin": [b"(Post Processor: marlin_post)\nG21\nG0 X1\n"],
    "prose": [b"Dear colleague, please mill this part tomorrow and tell me when it is ready.\n"],
    "empty": [b"", b"\n\n", b"(ONLY)\n; text\n%\n"],
}


@pytest.mark.parametrize(("name", "data"), [(n, d) for n, all_ in FOREIGN.items() for d in all_])
def test_a_foreign_file_is_named(name: str, data: bytes, tmp_path: Path) -> None:
    found = foreign_kind(data)
    assert found is not None
    assert name in found[0]
    path = tmp_path / "file.nc"
    path.write_bytes(data)
    with pytest.raises(UsageError, match="looks like"):
        require_program(path)


@pytest.mark.parametrize(("name", "data"), [(n, d) for n, all_ in HEADS.items() for d in all_])
def test_a_head_that_names_another_control_is_believed(name: str, data: bytes) -> None:
    assert foreign_kind(data) is None
    with pytest.raises(UsageError) as raised:
        reading_of(source_from_pieces([data], "file.nc"))
    assert any(each.lower() in str(raised.value).lower() for each in name.split("|"))


@pytest.mark.parametrize(
    ("file", "text", "name"),
    [
        ("part.c", "int main(void)\n{\n  return 0;\n}\n", "a program in C or C++"),
        ("part.h", "#pragma once\nvoid cut(void);\nvoid stop(void);\n", "a program in C or C++"),
        ("part.ts", "export const feed = 1;\n", "a program in JavaScript or TypeScript"),
        ("part.m", "function area = b(c)\narea = c;\nend\n", "a program in MATLAB, R or Julia"),
        ("points.csv", "name;x;y\nfirst;1;2\nsecond;3;4\n", "a table of values"),
        ("part.txt", "name,x,y\nfirst,1,2\nsecond,3,4\n", "a table of values"),
        ("part.nc", "int main(void)\n{\n  return 0;\n}\n", "source code"),
        ("part.nc", "Bitte fräse das Teil morgen.\nEs ist eilig.\nViele Grüße!\n", "prose"),
        ("part.nc", "Пожалуйста, обработайте деталь.\nОчень срочно.\nСпасибо вам!\n", "prose"),
        ("part.nc", "one\ntwo\nthree\n", "a text without blocks"),
    ],
)
def test_a_text_without_blocks_is_named_by_its_name_or_its_shape(
    file: str, text: str, name: str
) -> None:
    found = foreign_kind(text.encode(), file)
    assert found is not None
    assert found.name.removesuffix(", by its name") == name


def test_a_dialect_that_is_asked_for_reads_what_looks_foreign(tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text('{"sr":null}\nG21 G90 F100\nG0 X1\nM2\n')
    require_text(path)
    with pytest.raises(UsageError, match="TinyG"):
        require_program(path)


def test_overrides_that_a_program_gives_back_make_no_drill_file_of_it() -> None:
    tool = b"T1 M6\nS5000 M3\nM48\nG0 X1. Y2.\nG1 Z-1. F100.\n"
    assert foreign_kind(b"%\nO1001 (PART)\n" + tool + tool + b"M30\n%\n") is None


def test_the_list_is_whole() -> None:
    kinds = foreign_files()
    for kind in (*kinds.binary, *kinds.program, *kinds.text, *kinds.control):
        assert kind.advice in kinds.advice, kind.name
    for kind in (*kinds.program, *kinds.text, *kinds.control):
        assert re.compile(kind.pattern).match("") is None, kind.name


def test_no_pattern_goes_over_empty_lines_again_for_each_of_them() -> None:
    """``^`` matches at each line, and ``\\s`` goes on over line ends: 5,000 empty lines took 14 s."""
    kinds = foreign_files()
    assert not [kind.name for kind in (*kinds.program, *kinds.text) if r"^\s*" in kind.pattern]


def test_no_program_of_ours_is_taken_for_a_foreign_file() -> None:
    assert len(PROGRAMS) > 1000
    assert not [path for path in PROGRAMS if foreign_kind(path.read_bytes(), path.name)]
