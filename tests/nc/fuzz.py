"""Throws nonsense at the interpreter: it must answer with moves or a diagnostic, never otherwise.

``scripts/fuzz 100000 7`` runs as many tries with that seed and reports the first that fails.
"""

import collections
import dataclasses
import random
import sys
import time

import numpy as np

from tests.nc.running import ROOT, SETTINGS
from twin.nc.canonical import Chunk, Moves, Shape
from twin.nc.control.dialect import Dialect
from twin.nc.control.settings import ToolData
from twin.nc.dialects import DIALECTS
from twin.nc.interpreter import Interpretation
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.nc.text.source import source_from_pieces

FUZZ_SETTINGS = dataclasses.replace(
    SETTINGS,
    step_limit=500,
    tools={1: ToolData(2.0, 60.0), 2: ToolData(3.0, 50.0)},
    offsets={"G55": {"X": 10.0}},
    machine_zero={"Z": 300.0},
)
LONGEST_SECONDS = 1.0
SECONDS_PER_MOVE = 2e-4
"""Processor time that a program may take, and each move that it makes: a spline is one of many."""
RAN = "ran to its end"

PIECES = {
    "gost": "G102 C360|G102 C0|G9|G61|G64|G99|$ текст|C721|C-721|G83 Q2|...",
    "codesys": "T90|T720|G16|G20 L1|K0|LET #a : LREAL := 2|#a|#a:=#a+1|$v$|G36 O#a D3|G37 D1|G6"
    "|G8|G5|G10|G51 D2|G52 D3|G50|G61|G60|EF3|EF-4|D2|H1|O0.5|L-1|SUBPROGRAM S{#x}|END_SUBPROGRAM|S{1}|L?4|L!4|PC360|FF5|(x)|//|E5|E-5|FX3|N2|G71 L6|G70 L6|G70|G92 X3|C40",
    "fagor8070": "Q90|R30|Q360|G30|G31|G08|G09|G263=20|R1=30|X20I|X1=5|NR3|P1=2|P[P1]=3|[P1+2]"
    "|$IF P1==2|$ELSE|$ENDIF|$WHILE P1<5|$ENDWHILE|$FOR P2=1,3,1|$ENDFOR|$GOTO N1|#RPT[N1,N2,2]"
    "|%L SUB|M17|LL SUB|#PCALL SUB A1|#MCALL SUB|#MDOFF|G73 Q30|G72 S2|G11|G10|G14 X-1|G20 X1 Z2"
    "|;|$SWITCH P1|$CASE 2|$ENDSWITCH|$BREAK|#TIME [1]|G04 1|SIN[30]|G06|G136|G36 I2|G39 I1|G138|G139|G264|G82 Z1 I-5 B2|G87 J9 K7 I-3 B2|G88 J8 I-3 B1|G158 X3|G159=2",
    "grbl": "$H|$X|$J=X1|G10 L2 P2 X5|G10 L20 P1 X0|G28|G28.1|G30|G43.1 Z5|G49|G53|G61|G91.1|G92.1|G93|G20|G21"
    "|G38.2|G59|P3|L2|G80|;|(a|T300",
    "linuxcnc": "#1=5|#<a>=[#1+2]|X#1|X[#1*2]|o1 if [#1 GT 2]|o1 else|o1 endif|o2 while [#1 LT 5]"
    "|o2 endwhile|o3 sub|o3 endsub|o3 call [1]|o4 repeat [2]|o4 endrepeat|o2 break|G5 X5 Y5 I1 J1 P1 Q1"
    "|G5.2 P1|G5.3|G10 L2 P1 X5 R30|G10 L20 P2 X3|G28|G33 K1|G38.3|G41|G42.1 D3|G43 H1|G43.1 Z5|G49"
    "|G52 X1|G59.3|G61.1|G64 P0.1|G73 R1 Q1|G82 P1 R1|G87 I1 J1 K1 R2|G90.1|G91.1|G92.1|G92.3|G93|G95"
    "|G98|G99|@5 ^30|M66 P1 L0|M70|M72|M73|M98 P1|M99|%|(msg, hi)|;|G53|L2|O100|ATAN[1]/[2]|EXISTS[#<a>]",
    "fanuc": "O1|O2|M98 P2|M98 P00021|M99|M99 P5|#1=2|#1=#2|X#1|#[#1+1]=3|Y[#1*2]|IF [#1 EQ 2] GOTO 5"
    "|IF [#1 NE #0] THEN #2=1|WHILE [#1 LT 9] DO1|END1|DO2|END2|GOTO 5|N5|G65 P2 A1. I2. I3.|G66 P2|G67|#500=1"
    "|X#5001|#5221=3|#11001=5|G68 X0 Y0 R30.|G69|G51 P2.|G50|G51.1 X0|G50.1|G16|G15|G28 Z0|G53 Z1.|G52 X1.|G92 X0"
    "|G54.1 P1|G10 L2 P1 X1.|G43 H1|G49|G73 Z-2. R1. Q.5|K3|H1|D1|G20|G21|G93|/2|ATAN[1]/[2]|ROUND[1.5]|,R1.|,C1.|G107 C5.",
    "sinumerik": "X=IC(5)|Y=AC(2)|C=DC(90)|CR=8|AR=90|TURN=2|AP=30|RP=10|G110 X1|G111 X0 Y0|G112 X1|CIP X5 I1=2 J1=3|CT X5 Y5|TRANS X5"
    "|ATRANS Y2|ROT Z30|AROT RPL=20|SCALE X2 Y2|MIRROR X0|TRANS|SUPA|G500|G505|G153|RND=1|CHR=1|CHF=1|RNDM=1|RNDM=0|ANG=30|OFFN=1|G450|G451"
    "|NORM|KONT|G641 ADIS=1|R1=2|R1=R1+1|R[R1]=3|X=R1|DEF REAL DEPTH=2|DEF INT TAB[2,2]|TAB[1,1]=3|Z=-DEPTH|IF R1==2|ELSE|ENDIF|WHILE R1<5|ENDWHILE"
    "|FOR R2=1 TO 3|ENDFOR|REPEAT|UNTIL R1>3|LOOP|ENDLOOP|GOTOF AB|GOTOB AB|GOTOC AB|AB:|CASE R1 OF 2 GOTOF AB|REPEATB AB P=2|REPEAT AB P=2"
    "|%_N_SUB_SPF|PROC SUB(REAL A1, VAR REAL B1)|M17|RET|SUB(1,R1)|SUB(2,DEPTH)|L10|L10 P2|MCALL SUB(1,R1)|MCALL CYCLE81(10,0,1,-3)|MCALL"
    "|CYCLE83(9,0,1,-9,,-3,,1,0.1,0.1,1,1)|CYCLE84(9,0,1,-5,,0,3,6,,0,300,300)|CYCLE85(9,0,1,-5)|HOLES1(0,0,30,2,3,3)|HOLES2(0,0,9,0,0,4)"
    '|T="MILL"|G4 F1|G4 S3|G700|G70|G95|G93|F=R1|FB=50|M=QU(8)|H5|D0|MSG("x")|STOPRE|SIN(30)|G1|$P_EP[X]|R3=$AA_IW[X]|$P_UIFR[1,X,TR]=5|BRISK|SOFT|:5|/2',
    "heidenhain": "L X+10 R0 FMAX|L IX+5 F200|CC X+5 Y+5|CC|C X+10 Y+10 DR+|C DR-|CR X+9 Y+9 R+20 DR-|CT X+20 Y+5|LP PR+10 PA+30"
    "|CP IPA+90 DR+|CP IPA+720 IZ-3 DR+|CTP PR+5 PA+10|RND R2|CHF 1|APPR LT X+0 Y+0 LEN5 RL F90|APPR LCT X+0 Y+0 R3 RR|APPR CT X+1 Y+1 CCA90 R2 RL"
    "|DEP LN LEN4|DEP LCT X-9 Y-9 R2|DEP CT CCA90 R2|L X+30 RL|L Y+30 R0|TOOL CALL 1 Z S1000 F200 DR+0.1|TOOL DEF 2 L+0 R+3|BLK FORM 0.1 Z X+0 Y+0 Z-9"
    "|BLK FORM 0.2 X+9 Y+9 Z+0|LBL 1|LBL 0|LBL \"A\"|CALL LBL 1|CALL LBL 1 REP 2|CALL LBL \"A\"|FN 0: Q1 = +5|FN 4: Q2 = +Q1 DIV +2|FN 9: IF +Q1 EQU +5 GOTO LBL 1"
    "|Q3 = SIN Q1 * ( 2 + Q2 )|L X+Q1 FQ1|QS1 = \"A\" \\|\\| QS2|IF Q1 IS DEFINED GOTO LBL \"A\"|CYCL CALL|CYCL CALL PAT|CYCL CALL POS X+1 Y+1 Z+1|L M99|L M89"
    "|CYCL DEF 200 ~\n Q200=2 ~\n Q201=-5 ~\n Q206=90 ~\n Q202=2 ~\n Q203=0|CYCL DEF 207\nQ200=1\nQ201=-4\nQ239=1\nQ203=0|CYCL DEF 7.1 X+3|CYCL DEF 10.1 IROT+20"
    "|CYCL DEF 252 ~\nQ223=20 ~\nQ201=-2 ~\nQ202=1 ~\nQ203=0 ~\nQ200=2 ~\nQ206=9 ~\nQ207=90 ~\nQ366=1|CYCL DEF 208\nQ200=1\nQ201=-3\nQ206=9\nQ334=1\nQ203=0\nQ335=9"
    "|CYCL DEF 8.1 X|CYCL DEF 8.1|CYCL DEF 11.1 SCL 0.5|CYCL DEF 9.1 T1|CYCL DEF 32.1 T0.1|CYCL DEF 262 ~\nQ335=9 ~\nQ239=1 ~\nQ201=-3 ~\nQ200=1 ~\nQ203=0 ~\nQ207=9"
    "|CYCL DEF 220\nQ216=0\nQ217=0\nQ244=9\nQ245=0\nQ246=360\nQ247=0\nQ241=3|PATTERN DEF POS1 (X+1 Y+2 Z+0)|PATTERN DEF CIRC1 (X+1 Y+2 D+9 START+0 NUM3 Z+0)"
    "|L Z-5 FMAX M91|M140 MB MAX|M140 MB 5|M126|L C+400|M94|M136|STOP|END PGM A MM|PLANE RESET|12|~|; text ~|* - a|L M3 M8|L F AUTO|L FU0.1|TRANS DATUM AXIS X+1",
    "mefi": 'G10 Z1|G09|G98|G73 L1 Q2|G73 L2|L1|Q3|"text|I100',
}  # fmt: skip
PIECES["haas"] = (
    f"{PIECES['fanuc']}|M97 P5|G154 P1|G110|G13 I5. K9. Q2. D1|G12 I5.|G101 X0|G100|G187 P1|L2|G70 I5. L3|THEN G1 X2."
)
COMMON = (
    "G0|G1|G2|G3|G1|G4 P1|G17|G18|G19|G40|G41|G42|G54|G55|G53|G70|G71|G80|G81 Z-2 R1|G90|G91|G92"
    "|G94|G95|X10|Y-5|Z2.5|C90|X0|Y0|X7|Y9|I5|J-5|K2|R10|R-10|F100|F50|S500|T1|M3|M5|M6|X1e5"
)
JUNK = [
    "X99999999999999999",
    "X..5",
    "-",
    "+",
    "(",
    ")",
    "[",
    "]",
    "=",
    "%",
    "/",
    "\x00",
    "\x7f",
    "Х",
    "é",
    "A1",
    "B2",
    "G999",
    "M99",
    "M30",
]


def _texts(dialect: Dialect) -> list[bytes]:
    paths = [*(ROOT / "programs" / dialect.name).glob("*.[nhm]*")]
    paths += (ROOT / "tests" / "golden" / dialect.name).glob("*/*.nc")
    return [path.read_bytes() for path in sorted(paths)]


REAL = {name: _texts(dialect) for name, dialect in DIALECTS.items()}


def program(random_: random.Random, dialect: Dialect) -> bytes:
    """Random bytes, a mutated or spliced real program, or words of the dialect in any order."""
    kind = random_.random()
    if kind < 0.1:
        return random_.randbytes(random_.randrange(200))
    if kind < 0.4:
        return spliced(random_, REAL[dialect.name])
    if kind < 0.7:
        of = dialect.name if random_.random() < 0.9 else random_.choice(list(REAL))
        return mutated(random_, random_.choice(REAL[of]))
    own, common = PIECES[dialect.name].split("|"), COMMON.split("|")
    lines = ["G1 X1 Y2 F100"]
    for number in range(random_.randrange(1, 12)):
        words = [
            random_.choice(JUNK if random_.random() < 0.01 else random_.choice([own, common]))
            for _ in range(random_.randrange(1, 4))
        ]
        label = f"N{number} " if random_.random() < 0.3 else ""
        lines.append(label + " ".join(words))
    return "\n".join(lines).encode()


def spliced(random_: random.Random, programs: list[bytes]) -> bytes:
    """Lines of several programs, in the order of each: plausible blocks in an unplanned state."""
    lines = [line for text in random_.sample(programs, 3) for line in text.splitlines()]
    kept = [line for line in lines if random_.random() < 0.7]
    return b"\n".join([b"F100", *kept])


def mutated(random_: random.Random, data: bytes) -> bytes:
    """A program with bytes changed, removed, repeated or swapped."""
    changed = bytearray(data)
    for _ in range(random_.randrange(1, 6)):
        at, size = random_.randrange(len(changed) + 1), random_.randrange(1, 12)
        change = random_.randrange(4)
        if change == 0:
            changed[at : at + size] = b""
        elif change == 1:
            changed[at:at] = changed[at : at + size * 4]
        elif change == 2:
            changed[at : at + 1] = bytes([random_.randrange(256)])
        else:
            changed[at:at] = random_.choice(
                [b"G", b"X", b"-", b"9" * size, b"\n", b"Q", b"$", b"["]
            )
    return bytes(changed)


def check(data: bytes, dialect: Dialect) -> str:
    """Interpret; complain of anything but consistent moves and a diagnostic; the latter's code.

    A program that takes too long is interpreted once more: the first one at the compiled tier pays for
    loading it.
    """
    outcome, is_slow = _interpreted(data, dialect)
    assert not is_slow or not _interpreted(data, dialect)[1], "too slow"
    return outcome


def _interpreted(data: bytes, dialect: Dialect) -> tuple[str, bool]:
    """Code of a program's diagnostic, and whether it took too long."""
    begin = time.process_time()
    source = source_from_pieces([data], "fuzz.nc", dialect)
    interpretation = Interpretation(source, dialect, FUZZ_SETTINGS)
    before, moves = None, 0
    try:
        for chunk in interpretation.chunks():
            before = check_chunk(chunk, before)
            moves += len(chunk.moves)
    except ProgramError as error:
        line, outcome = error.diagnostic.line if str(error) else 0, error.diagnostic.code
    else:
        line, outcome = 1, RAN
    assert 1 <= line <= max(1, len(source.lines))
    longest = LONGEST_SECONDS + moves * SECONDS_PER_MOVE
    return outcome, time.process_time() - begin >= longest


def check_chunk(chunk: Chunk, before: np.ndarray | None) -> np.ndarray | None:
    """Check a chunk's moves; where they end, or where those before did."""
    moves = chunk.moves
    if not len(moves):
        return before
    ends = moves.end if before is None else np.concatenate([before[None], moves.end])
    np.testing.assert_array_equal(moves.start[before is None :], ends[:-1])
    assert np.isfinite(moves.end).all()
    assert (moves.length > 0.0).all()
    arcs = moves[moves.shape == Shape.ARC]
    if len(arcs):
        check_arcs_end_where_they_say(arcs)
    return moves.end[-1]


def check_arcs_end_where_they_say(arcs: Moves) -> None:
    assert np.isfinite(arcs.center).all()
    np.testing.assert_allclose(np.linalg.norm(arcs.normal, axis=1), 1.0, atol=1e-9)
    start, end, normal = arcs.start[:, :3], arcs.end[:, :3], arcs.normal
    angle, spoke = np.deg2rad(arcs.sweep)[:, None], start - arcs.center
    turned = (
        spoke * np.cos(angle)
        + np.cross(normal, spoke) * np.sin(angle)
        + normal * _along(normal, spoke) * (1.0 - np.cos(angle))
    )
    reached = arcs.center + turned + _along(end - start, normal) * normal
    off = np.abs(reached - end).max(axis=1)
    assert (off <= 2e-6 * (1.0 + np.abs(spoke).max(axis=1))).all()


def _along(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return (a * b).sum(axis=1)[:, None]


def main(tries: int, seed: int = 1) -> dict[str, int]:
    """Run as many tries.

    Returns:
        How many programs were run to their end, and how many were refused with each code.

    Raises:
        AssertionError: A try failed; the program is printed.
    """
    random_ = random.Random(seed)  # noqa: S311 (nonsense needs no cryptography)
    outcomes: collections.Counter[str] = collections.Counter()
    for number in range(tries):
        dialect = random_.choice(list(DIALECTS.values()))
        data = program(random_, dialect)
        try:
            outcomes[check(data, dialect)] += 1
        except BaseException:
            sys.stderr.write(f"try {number}, {dialect.name}: {data!r}\n")
            raise
    return dict(outcomes.most_common())


if __name__ == "__main__":
    arguments = [int(argument) for argument in sys.argv[1:]]
    tries, seed = [*arguments, *[100_000, 1][len(arguments) :]]
    begin = time.perf_counter()
    found = main(tries, seed)
    seconds = time.perf_counter() - begin
    sys.stdout.write(
        f"{tries} programs in {seconds:.0f} s, seed {seed}: {found.pop(RAN, 0)} ran, the others:\n"
    )
    sys.stdout.writelines(f"{count:7d}  {code}\n" for code, count in found.items())
