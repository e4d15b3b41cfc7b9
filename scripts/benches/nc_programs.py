"""Programs that compute, loop and call, in our dialects and as LinuxCNC writes the same."""

import random
from collections.abc import Iterator
from typing import NamedTuple

ROUNDS = 20_000
LINES = 200_000


class Computing(NamedTuple):
    """One form.

    Attributes:
        task: What it shows.
        dialect: Ours.
        ours: Our program.
        theirs: The same moves for ``rs274``.
        blocks: How many blocks ours runs, those of its loops among them.
    """

    task: str
    dialect: str
    ours: str
    theirs: str
    blocks: int


def programs() -> Iterator[Computing]:
    """Every form that a dialect has, and long programs that compute now and then."""
    for task, dialect, ours, theirs, blocks in _FORMS:
        filled = _filled(ours, theirs)
        yield Computing(task, dialect, *filled, blocks * ROUNDS)
    for task, ours, theirs, blocks in _IN_LOOPS:
        texts = (_WHILE.format(ours), _THEIR_WHILE.format(theirs))
        filled = _filled(*texts)
        yield Computing(task, "fagor8070", *filled, blocks * ROUNDS)
    holes = _filled(*_HOLES)
    yield Computing("a loop over holes of G83", "fagor8070", *holes, 4 * ROUNDS)
    contour = _filled(*_CONTOUR)
    yield Computing("a contour under G41 in a loop", "fagor8070", *contour, 10 * ROUNDS)
    for task, dialect, ours, theirs, blocks in _CYCLES:
        filled = _filled(ours, theirs)
        yield Computing(task, dialect, *filled, blocks * ROUNDS)
    for task, ours, theirs, blocks in _TURNED:
        filled = _filled(ours, theirs)
        yield Computing(task, "fagor8070", *filled, blocks * ROUNDS)
    for task, dialect, start, ours, theirs in _NOW_AND_THEN:
        every = f"{LINES:,} lines, every tenth {task}"
        texts = (_long(start, ours), _long("#101=1\n", theirs).replace("M30", "M2"))
        yield Computing(every, dialect, *texts, LINES)
    for task, dialect, start, feed in _PACED:
        text = _paced(start, feed)
        yield Computing(f"{LINES:,} lines {task}", dialect, text, text, LINES)


def _filled(ours: str, theirs: str) -> tuple[str, str]:
    """Both programs with the number of rounds."""
    return ours.replace("ROUNDS", str(ROUNDS)), theirs.replace("ROUNDS", str(ROUNDS))


def _long(start: str, tenth: str) -> str:
    chance = random.Random(3)  # noqa: S311 (programs need no cryptography)
    lines = [f"{start}G90 G1 X0 Y0 F1000"]
    for index in range(LINES):
        x, y, z = (chance.uniform(-100.0, 100.0) for _ in range(3))
        plain = f"G1 X{x:.3f} Y{y:.3f} Z{z:.3f}"
        lines.append(plain if index % 10 else tenth.format(x=f"{x + 200.0:.3f}", y=f"{y:.3f}"))
    return "\n".join([*lines, "M30", ""])


def _paced(start: str, feed: str) -> str:
    """Lines in a feed mode, each with its feed."""
    chance = random.Random(4)  # noqa: S311 (programs need no cryptography)
    lines = [f"S1000 M3\nG90 G17 G94 G1 X0 Y0 F1000\n{start}"]
    for _ in range(LINES):
        x, y = chance.uniform(-100.0, 100.0), chance.uniform(-100.0, 100.0)
        lines.append(f"X{x:.3f} Y{y:.3f}{feed}")
    return "\n".join([*lines, "M2", ""])


_PACED = (
    ("G95, a feed per revolution", "gost", "G95 F0.2", ""),
    ("G93, an F in every block", "fanuc", "G93 F10.", " F20."),
)
"""Task, dialect, how it begins, what each line has besides its way."""

_FORMS = (
    (
        "loop around a subprogram",
        "fagor8070",
        (
            "%L STEP\nG1 X[P1*0.01] Y[10*SIN[P1]]\nM17\n%MAIN\nP1=0\nG90 G1 F1000\n$WHILE P1<ROUNDS\n"
            "P1=P1+1\nLL STEP\nG1 Z[P1/1000]\n$ENDWHILE\nM30\n"
        ),
        (
            "o100 sub\nG1 X[#101*0.01] Y[10*sin[#101]]\no100 endsub\n#101=0\nG90 G1 F1000\n"
            "o110 while [#101 lt ROUNDS]\n#101=[#101+1]\no100 call\nG1 Z[#101/1000]\no110 endwhile\nM2\n"
        ),
        6,
    ),
    (
        "$WHILE, points of a circle",
        "fagor8070",
        (
            "P1=0\nG90 G1 F1000\n$WHILE P1<ROUNDS\nG1 X[50*COS[P1]] Y[50*SIN[P1]]\nP1=P1+1\n"
            "$ENDWHILE\nM30\n"
        ),
        (
            "#101=0\nG90 G1 F1000\no110 while [#101 lt ROUNDS]\nG1 X[50*cos[#101]] Y[50*sin[#101]]\n"
            "#101=[#101+1]\no110 endwhile\nM2\n"
        ),
        4,
    ),
    (
        "$FOR, #PCALL with parameters",
        "fagor8070",
        (
            "%L STEP\nG1 X[P0+P1]\nM17\n%MAIN\nG90 G1 F1000\n$FOR P30=1,ROUNDS,1\n"
            "#PCALL STEP A[P30*0.1] B3\n$ENDFOR\nM30\n"
        ),
        (
            "o100 sub\nG1 X[#1+#2]\no100 endsub\n#101=0\nG90 G1 F1000\no110 while [#101 lt ROUNDS]\n"
            "#101=[#101+1]\no100 call [#101*0.1] [3]\no110 endwhile\nM2\n"
        ),
        4,
    ),
    (
        "#RPT, a range again and again",
        "fagor8070",
        "G91 G1 F1000\nN1 X1\nY1\nX-1\nN2\n#RPT[N1,N2,ROUNDS]\nM30\n",
        "G91 G1 F1000\no110 repeat [ROUNDS]\nX1\nY1\nX-1\no110 endrepeat\nM2\n",
        4,
    ),
    (
        "NR, a block again and again",
        "fagor8070",
        "G91 G1 F1000\nP1=0\n$WHILE P1<100\nX1 NR[ROUNDS/100]\nP1=P1+1\n$ENDWHILE\nM30\n",
        "G91 G1 F1000\no110 repeat [ROUNDS]\nX1\no110 endrepeat\nM2\n",
        1,
    ),
    (
        "$IF, $GOTO, a table of parameters",
        "fagor8070",
        (
            "P1=0\nG90 G1 F1000\nN1 P1=P1+1\nP[100+P1 MOD 50]=P1/3\nX[P[100+P1 MOD 50]]\n"
            "$IF P1<ROUNDS $GOTO N1\nM30\n"
        ),
        (
            "#101=0\nG90 G1 F1000\no110 do\n#101=[#101+1]\n#[200+[#101 mod 50]]=[#101/3]\n"
            "X[#[200+[#101 mod 50]]]\no110 while [#101 lt ROUNDS]\nM2\n"
        ),
        4,
    ),
    (
        "G20, $variable$, G0 and G1",
        "codesys",
        (
            "N1 G36 O$i$ D0\nN5 G90 G1 F100\nN10 G0 X($i$*0.01)\nN15 G1 Y(10*SIN($i$))\nN20 G37 O$i$ D1\n"
            "N30 G20 L10 K($i$ < ROUNDS)\nN40 M30\n"
        ),
        (
            "#101=0\nG90 G1 F1000\no110 do\nG0 X[#101*0.01]\nG1 Y[10*sin[#101]]\n#101=[#101+1]\n"
            "o110 while [#101 lt ROUNDS]\nM2\n"
        ),
        4,
    ),
    (
        "SUBPROGRAM with values, LET",
        "codesys",
        (
            "N1 LET #i : LREAL := 0\nN5 G90 G1 F100\nN10 STEP{#i, 0.5}\nN20 #i := #i + 1\n"
            "N30 G20 L10 K(#i < ROUNDS)\nN40 M30\nSUBPROGRAM STEP{#a : LREAL, #b : LREAL}\n"
            "N1 LET #c : LREAL := #a * #b\nN2 G1 X(#c) Y3\nN3 G1 Y0\nEND_SUBPROGRAM\n"
        ),
        (
            "o100 sub\n#3=[#1*#2]\nG1 X#3 Y3\nG1 Y0\no100 endsub\n#101=0\nG90 G1 F1000\no110 do\n"
            "o100 call [#101] [0.5]\n#101=[#101+1]\no110 while [#101 lt ROUNDS]\nM2\n"
        ),
        7,
    ),
    (
        "WHILE, points of a circle",
        "fanuc",
        (
            "O1\n#1=0\nG90 G1 F1000\nWHILE [#1 LT ROUNDS] DO1\nG1 X[50*COS[#1]] Y[50*SIN[#1]]\n#1=#1+1\n"
            "END1\nM30\n"
        ),
        (
            "#101=0\nG90 G1 F1000\no110 while [#101 lt ROUNDS]\nG1 X[50*cos[#101]] Y[50*sin[#101]]\n"
            "#101=[#101+1]\no110 endwhile\nM2\n"
        ),
        4,
    ),
    (
        "WHILE, G65 with arguments",
        "fanuc",
        (
            "O1\n#1=0\nG90 G1 F1000\nWHILE [#1 LT ROUNDS] DO1\n#1=#1+1\nG65 P2 A[#1*0.1] B3.\nEND1\nM30\n"
            "O2\nG1 X[#1+#2]\nM99\n"
        ),
        (
            "o100 sub\nG1 X[#1+#2]\no100 endsub\n#101=0\nG90 G1 F1000\no110 while [#101 lt ROUNDS]\n"
            "#101=[#101+1]\no100 call [#101*0.1] [3]\no110 endwhile\nM2\n"
        ),
        6,
    ),
    (
        "G73, a jump with repeat",
        "mefi",
        "N5 G91 G1 F1000\nN10 G1 X1 Y2\nN20 G2 X10 Y0 I5\nN30 G1 X-11 Y-2 G73 L10 QROUNDS\nN40 M30\n",
        "G91 G1 F1000\no110 repeat [ROUNDS]\nG1 X1 Y2\nG2 X10 Y0 I5\nG1 X-11 Y-2\no110 endrepeat\nM2\n",
        3,
    ),
)

_WHILE = "P1=0\nG90 G1 F1000\n$WHILE P1<ROUNDS\nP1=P1+1\n{}\n$ENDWHILE\nG80\nM30\n"
_THEIR_WHILE = (
    "#101=0\nG90 G1 F1000\no110 while [#101 lt ROUNDS]\n#101=[#101+1]\n{}\no110 endwhile\nG80\nM2\n"
)
_IN_LOOPS = (
    (
        "a dwell in a loop",
        "X[P1*0.01]\nZ1\nG04 K0.1\nZ2",
        "X[#101*0.01]\nZ1\nG4 P0.1\nG1 Z2",
        7,
    ),
    (
        "spindle and coolant in a loop",
        "S1000 M3\nG1 X[P1*0.01]\nM8\nZ1\nM9",
        "S1000 M3\nG1 X[#101*0.01]\nM8\nZ1\nM9",
        8,
    ),
    (
        "a tool change in a loop",
        "T1\nM6\nG1 X[P1*0.01]\nZ1",
        "T1\nM6\nG1 X[#101*0.01]\nZ1",
        7,
    ),
    (
        "work offsets in a loop",
        "G54\nX[P1*0.01]\nG92 X0\nZ1",
        "G54\nX[#101*0.01]\nG92 X0\nZ1",
        7,
    ),
    (
        "G11 and G10, a mirror in a loop",
        "G11\nG1 X[P1*0.01] Y5\nG2 X[P1*0.01+10] Y5 I5 J0\nG10",
        "G1 X[-#101*0.01] Y5\nG3 X[-#101*0.01-10] Y5 I-5 J0",
        7,
    ),
    (
        "G72, a scale in a loop",
        "G72 S[1+P1*0.001]\nX[P1*0.01] Y5\nZ1\nG72",
        "#102=[1+#101*0.001]\nX[#101*0.01*#102] Y[5*#102]\nZ#102",
        7,
    ),
    (
        "G73, a rotation in a loop",
        "G73 Q[P1]\nX[P1*0.01] Y5\nX10 Y3\nG73",
        "G10 L2 P1 R#101\nX[#101*0.01] Y5\nX10 Y3\nG10 L2 P1 R0",
        7,
    ),
    ("polar moves in a loop", "R10 Q[P1]\nR11 Q[P1+1]", "@10 ^[#101]\n@11 ^[#101+1]", 5),
)
"""Ours, theirs and our blocks a round."""
_HOLES = (
    (
        "P1=0\nG90 G1 F1000\nG83 Z2 I2 J3 X0\n$WHILE P1<ROUNDS\nP1=P1+1\nX[P1*0.01] Y5\n"
        "$ENDWHILE\nG80\nM30\n"
    ),
    (
        "#101=0\nG90 G1 F1000\nG83 Z-4 R2 Q2 X0\no110 while [#101 lt ROUNDS]\n#101=[#101+1]\n"
        "X[#101*0.01] Y5\no110 endwhile\nG80\nM2\n"
    ),
)
_CONTOUR = (
    (
        "P1=0\nG90 G1 F1000 X-20 Y-20\n$WHILE P1<ROUNDS\nP1=P1+1\nG41\nX0 Y-5\nY30\n"
        "X[40+P1*0.001]\nY0\nX-5\nG40 X-20 Y-20\n$ENDWHILE\nM30\n"
    ),
    (
        "#101=0\nG90 G1 F1000 X-20 Y-20\no110 while [#101 lt ROUNDS]\n#101=[#101+1]\nG41.1 D4\n"
        "X0 Y-5\nY30\nX[40+#101*0.001]\nY0\nX-5\nG40 X-20 Y-20\no110 endwhile\nM2\n"
    ),
)
_TURNED = (
    (
        "a loop under mirror and rotation",
        (
            "P1=0\nG90 G1 F1000\nG73 Q30\nG11\n$WHILE P1<ROUNDS\nP1=P1+1\nG1 X[P1*0.01] Y5\nZ1\n"
            "G2 X[P1*0.01+10] Y5 I5 J0\nG1 Z0\n$ENDWHILE\nM30\n"
        ),
        (
            "#101=0\nG90 G1 F1000\nG10 L2 P1 R30\no110 while [#101 lt ROUNDS]\n#101=[#101+1]\n"
            "G1 X[-#101*0.01] Y5\nZ1\nG3 X[-#101*0.01-10] Y5 I-5 J0\nG1 Z0\no110 endwhile\nM2\n"
        ),
        7,
    ),
    (
        "a mirrored contour under G41 in a loop",
        _CONTOUR[0].replace("G90 G1", "G11\nG90 G1", 1),
        (
            "#101=0\nG90 G1 F1000 X20 Y-20\no110 while [#101 lt ROUNDS]\n#101=[#101+1]\nG42.1 D4\n"
            "X0 Y-5\nY30\nX[-40-#101*0.001]\nY0\nX5\nG40 X20 Y-20\no110 endwhile\nM2\n"
        ),
        10,
    ),
)

_CYCLES = (
    (
        "G81 called and ended in a loop",
        "fagor8070",
        (
            "P1=0\nG90 G0 Z9 F1000\n$WHILE P1<ROUNDS\nP1=P1+1\nG99 G81 X[P1*0.01] Y5 Z2 I-4\nG80\n"
            "$ENDWHILE\nM30\n"
        ),
        (
            "#101=0\nG90 G0 Z9 F1000\no110 while [#101 lt ROUNDS]\n#101=[#101+1]\n"
            "G99 G81 X[#101*0.01] Y5 Z-4 R2\nG80\no110 endwhile\nM2\n"
        ),
        5,
    ),
    (
        "G83 called and ended in a loop",
        "fagor8070",
        (
            "P1=0\nG90 G0 Z9 F1000\n$WHILE P1<ROUNDS\nP1=P1+1\nG99 G83 X[P1*0.01] Y5 Z2 I2 J3\nG80\n"
            "$ENDWHILE\nM30\n"
        ),
        (
            "#101=0\nG90 G0 Z9 F1000\no110 while [#101 lt ROUNDS]\n#101=[#101+1]\n"
            "G99 G83 X[#101*0.01] Y5 Z-4 R2 Q2\nG80\no110 endwhile\nM2\n"
        ),
        5,
    ),
    (
        "G81, G83 called and ended in a loop",
        "mefi",
        (
            "N5 G90 G0 Z9 F1000\nN10 G81 X1 Y5 Z-4 R2\nN20 X7\nN30 G83 Y9 Z-4 R2 Q2\nN40 G80\n"
            "N50 G0 X0 Y0 G73 L10 QROUNDS\nM30\n"
        ),
        (
            "G90 G0 Z9 F1000\no110 repeat [ROUNDS]\nG81 X1 Y5 Z-4 R2\nX7\nG83 Y9 Z-4 R2 Q2\nG80\n"
            "G0 X0 Y0\no110 endrepeat\nM2\n"
        ),
        5,
    ),
    (
        "a contour under G41 in a loop",
        "codesys",
        (
            "LET #i := 0\nN5 G90 G1 F100 X-20 Y-20\nN10 #i := #i + 1\nG41 D2\nX0 Y-5\nY30\n"
            "X(40+#i*0.001)\nY0\nX-5\nG40 X-20 Y-20\nN90 G20 L10 K(#i < ROUNDS)\nM30\n"
        ),
        (
            "#101=0\nG90 G1 F1000 X-20 Y-20\no110 do\n#101=[#101+1]\nG41.1 D4\nX0 Y-5\nY30\n"
            "X[40+#101*0.001]\nY0\nX-5\nG40 X-20 Y-20\no110 while [#101 lt ROUNDS]\nM2\n"
        ),
        9,
    ),
)

_NOW_AND_THEN = (
    ("counts", "fagor8070", "P1=1\n", "P1=P1+1", "#101=[#101+1]"),
    (
        "computes words",
        "fagor8070",
        "P1=1\n",
        "X[P1+{x}] Y[P1*{y}]",
        "X[#101+{x}] Y[#101*{y}]",
    ),
    ("counts", "codesys", "LET #i := 1\n", "#i := #i + 1", "#101=[#101+1]"),
    (
        "computes words",
        "codesys",
        "LET #i := 1\n",
        "X(#i+{x}) Y(#i*{y})",
        "X[#101+{x}] Y[#101*{y}]",
    ),
)
