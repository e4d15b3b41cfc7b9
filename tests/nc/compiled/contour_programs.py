"""Programs with compensated contours made at random: gentle and sharp, with what happens between."""

import math
from random import Random

BETWEEN = (
    "Z{}|Z1|M8|M9|S100|G4 {dwell}1|T1|X0.0000001|F{}|G91 X3 Y1\nG90|G54|G92 Z3|G0 Z5\nG1|M3|X5 C{}"
    "|G17|M6|G91\nG90|G70\nG71|G42|G40 X0\nG41 D1 X9 Y9|G1|C5|G2 X1 Y1 R50|G3 R3 X4"
)
SWITCHES = ("G40", "G41", "G42 X{}", "G40 Y{}", "G40 S500 M3", "G3 X{} Y{} R40", "T2", "/M8")
"""What begins or ends compensation where it may or may not."""


def program(dialect: str, random_: Random) -> str:
    """One contour, or several in a loop where the dialect has one."""
    dwell = {"codesys": "T", "fagor8070": "K"}.get(dialect, "P")
    lines = ["G90 G1 F100 X-20 Y-20", f"G4{random_.choice([1, 2])} D1"]
    if dialect == "fagor8070" and random_.random() < 0.5:
        lines.insert(0, random_.choice(["G136", "G137", "G138"]))
    x, y, heading = 0.0, 0.0, random_.uniform(0.0, 6.0)
    lines.append("X0 Y0")
    sharp = random_.choice([0.1, 0.2, 0.5, 2.0])
    rare = random_.choice([0.0, 0.05, 0.3])
    for _ in range(random_.randrange(5, 60)):
        heading += random_.uniform(-sharp, sharp) if random_.random() < 0.9 else 0.0
        length = random_.choice([3.0, 8.0, 20.0]) * random_.uniform(0.5, 2.0)
        if random_.random() < 0.3:
            lines.append(_arc(random_, x, y, heading, length))
            heading += math.pi / 2.0 if lines[-1].startswith("G3") else -math.pi / 2.0
            side = 1.0 if lines[-1].startswith("G3") else -1.0
            x += length * (math.cos(heading - side * math.pi / 2) + math.cos(heading))
            y += length * (math.sin(heading - side * math.pi / 2) + math.sin(heading))
        else:
            x += length * math.cos(heading)
            y += length * math.sin(heading)
            lines.append(
                f"G1 X{x:.3f} Y{y:.3f}" + random_.choice(["", "", f" Z{length:.2f}", " M8"])
            )
        if random_.random() < rare:
            text = random_.choice(BETWEEN.split("|"))
            lines += text.format(*[f"{random_.uniform(1, 9):.2f}"] * 2, dwell=dwell).split("\n")
    lines += ["G1 X100", "G40", "X-50 Y-70"]
    if dialect == "fagor8070" and random_.random() < 0.6:
        return "\n".join(["P1=0", "$WHILE P1<3", "P1=P1+1", *lines, "$ENDWHILE", "M30"])
    return "\n".join([*lines, "M30"])


def switched(dialect: str, random_: Random) -> str:
    """Contours that are switched on and off, again and again where the dialect has a loop."""
    dwell = {"codesys": "T", "fagor8070": "K"}.get(dialect, "P")
    lines: list[str] = []
    for _ in range(random_.randrange(1, 4)):
        width, height = random_.uniform(15.0, 40.0), random_.uniform(15.0, 40.0)
        over = random_.uniform(-1.0, 8.0)
        begin = random_.choice(["G41", "G42", "G41 D1", "G42 D2", "G41 M8", "G41 X-5 Y-5"])
        if dialect in ("fanuc", "haas"):  # where D is needed
            begin = random_.choice(["G41 D1", "G42 D2", "G41 D1 M8", "G41 D2 X-5 Y-5"])
        if dialect == "codesys" and random_.random() < 0.5:
            begin = random_.choice(["G41 D2.5", "G42 D(#i+1)", "G41 D0", "G42 D-1", "G41 D1 F50"])
        end = random_.choice(["G40 X-20 Y-20", "G40\nX-20 Y-20", "G40 Z5\nM9\nX-9", "G40 M9", ""])
        way = ["X0", f"Y{-over:.2f}", f"Y{height:.2f}", f"X{width:.2f}", "Y0", f"X{-over:.2f}"]
        for block in (begin, *way, end):
            if random_.random() < 0.2:
                text = random_.choice([*BETWEEN.split("|"), *SWITCHES])
                numbers = [f"{random_.uniform(1, 30):.2f}"] * 2
                lines += text.format(*numbers, dwell=dwell).split("\n")
            lines += block.split("\n")
    first = ["G90 G1 F100 X-20 Y-20"]
    if dialect == "codesys":
        passes = random_.choice([1, 2, 40])
        head = ["LET #i := 0", *first, "G41 D2", "G40", "N10 #i := #i + 1"]
        return "\n".join([*head, *lines, f"N20 G20 L10 K(#i < {passes})", "M30"])
    if dialect != "fagor8070":
        return "\n".join([*first, *lines, "M30"])
    first.append(random_.choice(["G136", "G137", "G138"]))
    passes = random_.choice([2, 40])
    return "\n".join([*first, "P1=0", f"$WHILE P1<{passes}", "P1=P1+1", *lines, "$ENDWHILE", "M30"])


def _arc(random_: Random, x: float, y: float, heading: float, radius: float) -> str:
    """A quarter circle that leaves along the heading."""
    side = random_.choice([1.0, -1.0])
    i, j = -side * radius * math.sin(heading), side * radius * math.cos(heading)
    end_x = x + radius * math.cos(heading) + i
    end_y = y + radius * math.sin(heading) + j
    code = "G3" if side > 0.0 else "G2"
    return f"{code} X{end_x:.3f} Y{end_y:.3f} I{i:.3f} J{j:.3f}"
