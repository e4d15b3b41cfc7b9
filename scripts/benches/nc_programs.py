"""Programs that compute, loop and call, in our dialects and as LinuxCNC writes the same."""

import random
from collections.abc import Iterator
from typing import NamedTuple

ROUNDS = 20_000
LINES = 200_000


class Computing(NamedTuple):
    """One form.

    Attributes:
        theirs: The same moves for ``rs274``.
        blocks: How many blocks ours runs, those of its loops among them.
    """

    task: str
    dialect: str
    ours: str
    theirs: str
    blocks: int


def programs() -> Iterator[Computing]:
    """Loops and calls of four controls, a cycle, a compensated contour, and long programs that compute now and then."""
    for task, dialect, ours, theirs, blocks in _FORMS:
        filled, same = (text.replace("ROUNDS", str(ROUNDS)) for text in (ours, theirs))
        yield Computing(task, dialect, filled, same, blocks * ROUNDS)
    for task, dialect, start, ours, theirs in _NOW_AND_THEN:
        every = f"{LINES:,} lines, every tenth {task}"
        texts = (_long(start, ours), _long("#101=1\n", theirs).replace("M30", "M2"))
        yield Computing(every, dialect, *texts, LINES)


def _long(start: str, tenth: str) -> str:
    chance = random.Random(3)  # noqa: S311 (programs need no cryptography)
    lines = [f"{start}G90 G1 X0 Y0 F1000"]
    for index in range(LINES):
        x, y, z = (chance.uniform(-100.0, 100.0) for _ in range(3))
        plain = f"G1 X{x:.3f} Y{y:.3f} Z{z:.3f}"
        lines.append(plain if index % 10 else tenth.format(x=f"{x + 200.0:.3f}", y=f"{y:.3f}"))
    return "\n".join([*lines, "M30", ""])


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
    (
        "a loop over holes of G83",
        "fagor8070",
        (
            "P1=0\nG90 G1 F1000\nG83 Z2 I2 J3 X0\n$WHILE P1<ROUNDS\nP1=P1+1\nX[P1*0.01] Y5\n"
            "$ENDWHILE\nG80\nM30\n"
        ),
        (
            "#101=0\nG90 G1 F1000\nG83 Z-4 R2 Q2 X0\no110 while [#101 lt ROUNDS]\n#101=[#101+1]\n"
            "X[#101*0.01] Y5\no110 endwhile\nG80\nM2\n"
        ),
        4,
    ),
    (
        "a contour under G41 in a loop",
        "fagor8070",
        (
            "P1=0\nG90 G1 F1000 X-20 Y-20\n$WHILE P1<ROUNDS\nP1=P1+1\nG41\nX0 Y-5\nY30\n"
            "X[40+P1*0.001]\nY0\nX-5\nG40 X-20 Y-20\n$ENDWHILE\nM30\n"
        ),
        (
            "#101=0\nG90 G1 F1000 X-20 Y-20\no110 while [#101 lt ROUNDS]\n#101=[#101+1]\nG41.1 D4\n"
            "X0 Y-5\nY30\nX[40+#101*0.001]\nY0\nX-5\nG40 X-20 Y-20\no110 endwhile\nM2\n"
        ),
        10,
    ),
)
"""Task, dialect, our program, the same moves for ``rs274``, and how many blocks a round has."""

_NOW_AND_THEN = (
    ("counts", "fagor8070", "P1=1\n", "P1=P1+1", "#101=[#101+1]"),
    ("computes words", "fagor8070", "P1=1\n", "X[P1+{x}] Y[P1*{y}]", "X[#101+{x}] Y[#101*{y}]"),
)
