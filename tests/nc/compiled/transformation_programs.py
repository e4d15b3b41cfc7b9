"""Programs at random that mirror, scale and rotate, around and between all that else moves."""

from random import Random

SETTING = (
    "G10|G11|G12|G13|G11 G12|G14 X-1|G14 X-1 Y1|G14 Y[1-2*[P1 MOD 2]]|G14 Z-1|G72|G72 S2|G72 S0.5"
    "|G72 S[1+P1/8]|G73|G73|G73|G73 Q30|G73 Q90|G73 Q[P1*20] I5 J[P1]|G73 Q-45.5 I1|G73 Q360"
    "|G10 X{} Y{}|G11 G0 X{}|G12 F{}|G73 Q15 M8|G91 G73 Q5\nG90|G70 G73 Q1 I1 J1\nG71"
)
"""What sets and ends them, in a block of its own or with more in it."""
ALONE = ("G73 Q", "G17", "G18", "G19", "G20")
"""What a rotation in force forbids."""
WRONG = "G72 S0|G72 S-1|G14 X2|G14|G14 C-1|G73 I5|G73 Q1 I1 J1 K1|G73 Q0\nG73 Q0|G11 X1 X2|G13 U1"
MOVING = (
    "G1 X{} Y{}|G1 X{} Y{} Z{}|G0 X{} Y{}|G1 Z{}|C{}|G0 C{} X{}|X{}|G91 G1 X{} Y{}\nG90"
    "|G91 G3 X0 Y0 I{} J3\nG90|G91 G2 X10 Y0 I5 J0\nG90|G91 G2 X10 Y10 Z3 I10 J0\nG90\nG1"
    "|G91 G3 X3 Y0 R{}\nG90\nG1|G1 R{} Q{}|G1 Q{}|G30\nR{} Q40|G30 I{} J3|G1 R5 Q[P1*7] Z{}"
    "|G1 X[P1*3] Y[P1]|G1 X0 Y0|G1 X5 Y5 NR2"
)
BETWEEN = (
    "G54|G55|G55 X{}|G53|G92 X{} Y1|G158 X{}|G158|T1 M6|T2 M6|D0|D1|S100 M3|M8|G4 K1|G17|G18|G19"
    "|G81 Z2 I-5\nX{} Y{}\nX{} Y9\nG80\nG1|G83 Z1 I2 J3\nX{} Y{}\nG80\nG1|G98|G99|F{}|G70\nG1 X1\nG71"
    "|G20 X1 Y2|G61 X{}|G8 X{} Y3|G36 I1|LL PART|#PCALL PART A{}"
)
CONTOUR = "G1 X-20 Y-20|{side}|X0 Y-5|Y30|G91 {arc} X5 Y5 {center}|G90 G1 X40|Z{}|M8|Y0 Z2|X-5|G40 X-20 Y-20"


def program(random_: Random) -> str:
    """A program for the Fagor CNC 8070, most of it in loops and subroutines."""
    wild = random_.choice([0.0, 0.0, 0.05])
    part = ["%L PART", *_blocks(random_, 3, wild), "M17", "%MAIN"]
    lines = ["P1=0", "P0=1", "G90 G1 X1 Y2 F500"]
    for _ in range(random_.randrange(1, 4)):
        lines += _blocks(random_, random_.randrange(0, 4), wild)
        body = _blocks(random_, random_.randrange(2, 10), wild)
        if random_.random() < 0.4:
            body += _contour(random_, wild)
        times = random_.choice([1, 2, 3, 20])
        lines += ["P1=0", f"$WHILE P1<{times}", "P1=P1+1", *body, "$ENDWHILE"]
    return "\n".join([*part, *lines, "M30"])


def _blocks(random_: Random, count: int, wild: float) -> list[str]:
    lines: list[str] = []
    for _ in range(count):
        kind = random_.random()
        if kind < wild:
            block = _one(random_, WRONG)
        elif kind < 0.4:
            block = _one(random_, SETTING)
        else:
            block = _one(random_, MOVING if kind < 0.8 else BETWEEN)
        if any(alone in " ".join(block) for alone in ALONE) and random_.random() < 0.97:
            lines.append("G73")
        lines += block
    return lines


def _contour(random_: Random, wild: float) -> list[str]:
    """A contour, left or right, with what may and may not stand in it."""
    lines = ["G73", "G17", "G54", "G158", "G80", *_one(random_, SETTING)]
    side = random_.choice(["G41", "G42"])
    lines.append(random_.choice(["G136", "G137", "G138"]))
    for block in CONTOUR.split("|"):
        arc, center = random_.choice([("G2", "I5 J0"), ("G3", "I0 J5")])
        text = block.format(random_.randrange(9), side=side, arc=arc, center=center)
        lines += _filled(random_, text)
        if random_.random() < wild:
            lines += _one(random_, SETTING if random_.random() < 0.3 else BETWEEN)
    return lines


def _one(random_: Random, choices: str) -> list[str]:
    return _filled(random_, random_.choice(choices.split("|")))


def _filled(random_: Random, text: str) -> list[str]:
    while "{}" in text:
        text = text.replace("{}", f"{random_.uniform(0, 40):.{random_.randrange(4)}f}", 1)
    return text.split("\n")
