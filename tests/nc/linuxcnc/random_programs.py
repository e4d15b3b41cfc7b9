"""Programs made at random that hold all that the dialect knows."""

import math
import random

LONGEST = 240
"""Characters of a line: rs274 refuses those of 256."""


class Author:
    """Writes one program."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)  # noqa: S311 (programs need no cryptography)
        self.lines: list[str] = []
        self.labels = 100

    def number(self, low: float = -20.0, high: float = 20.0) -> str:
        """A number, plain or computed."""
        value = f"{self.random.uniform(low, high):.{self.random.randrange(4)}f}"
        kind = self.random.random()
        if kind < 0.8:
            return value
        if kind < 0.87:
            return f"[{value} + #{self.random.randrange(1, 6)} * 0]"
        if kind < 0.94:
            return f"[{self.expression()} * 0 + {value}]"
        return f"-[0 - {value}]"

    def expression(self, depth: int = 0) -> str:
        """An expression that has a value."""
        choose = self.random.random()
        if depth > 2 or choose < 0.3:
            return f"{self.random.uniform(0.0, 9.0):.3f}"
        if choose < 0.4:
            return f"#{self.random.randrange(1, 6)}"
        if choose < 0.7:
            operator = self.random.choice(
                ["+", "-", "*", "MOD", "EQ", "NE", "GT", "GE", "LT", "LE", "AND", "OR", "XOR"]
            )
            right = "[2 + ABS[" + self.expression(depth + 1) + "]]"
            return f"[{self.expression(depth + 1)} {operator} {right}]"
        if choose < 0.8:
            return f"[{self.expression(depth + 1)} / [1 + ABS[{self.expression(depth + 1)}]]]"
        if choose < 0.85:
            return f"ATAN[{self.expression(depth + 1)}]/[1 + ABS[{self.expression(depth + 1)}]]"
        if choose < 0.95:
            function = self.random.choice(
                ["ABS", "COS", "SIN", "FIX", "FUP", "ROUND", "FIX[-1*", "FUP[-1*"]
            )
            inner = f"{function}[" if "[" not in function else f"{function}"
            return f"{inner}{self.expression(depth + 1)}]"
        positive = f"[1 + ABS[{self.expression(depth + 1)}]]"
        return self.random.choice(
            [
                f"SQRT[{positive}]",
                f"LN[{positive}]",
                f"EXP[1 / {positive}]",
                f"ACOS[1 / {positive}]",
                f"ASIN[-1 / {positive}]",
                f"TAN[30 / {positive}]",
                f"[{positive} ** 1.5]",
                f"[2 ** [-2] * {positive}]",
                "EXISTS[#<x>]",
                "[1 + 2 * 3 ** 2 - 7 MOD 4 / 2]",
                "[1 LT 2 AND 3 GE 3 XOR 0]",
            ]
        )

    def point(self, letters: str = "XYZ", chance: float = 0.6) -> str:
        """Some axis words."""
        words = [f"{each}{self.number()}" for each in letters if self.random.random() < chance]
        return " ".join(words) or f"{letters[0]}{self.number()}"

    def line(self) -> None:
        """A straight move."""
        code = self.random.choice(["G0", "G1", "G1", "G1"])
        axes = "XYZC" if self.random.random() < 0.3 else "XYZ"
        polar = self.random.random()
        if polar < 0.08:
            self.lines.append(f"{code} @{self.number(1, 20)} ^{self.number(-200, 200)}")
        elif polar < 0.1:
            self.lines.append(f"{code} ^{self.number(-200, 200)} Z{self.number()}")
        else:
            self.lines.append(f"{code} {self.point(axes)}")

    def arc(self) -> None:
        """An arc or a helix in any plane, by centre or radius, of several turns."""
        plane, axes, centers = self.random.choice(
            [("G17", "XYZ", "IJ"), ("G18", "ZXY", "KI"), ("G19", "YZX", "JK")]
        )
        code = self.random.choice(["G2", "G3"])
        turns = f" P{self.random.randrange(1, 4)}" if self.random.random() < 0.3 else ""
        rise = f" {axes[2]}{self.number()}" if self.random.random() < 0.4 else ""
        if self.random.random() < 0.5:
            radius = self.random.uniform(5.0, 15.0)
            begin, sweep = (self.random.uniform(-math.pi, math.pi) for _ in range(2))
            i, j = -radius * math.cos(begin), -radius * math.sin(begin)
            u = i + radius * math.cos(begin + sweep)
            v = j + radius * math.sin(begin + sweep)
            if self.random.random() < 0.15:
                u = v = 0.0
            self.lines += [
                f"{plane} G91",
                (
                    f"{code} {axes[0]}{u:.8f} {axes[1]}{v:.8f} {centers[0]}{i:.8f} {centers[1]}{j:.8f}"
                    f"{rise}{turns}"
                ),
                "G90",
            ]
        else:
            u, v = (self.random.uniform(-10.0, 10.0) for _ in range(2))
            radius = math.hypot(u, v) * self.random.uniform(0.51, 2.0)
            sign = self.random.choice(["", "-"])
            self.lines += [
                f"{plane} G91",
                f"{code} {axes[0]}{u:.8f} {axes[1]}{v:.8f} R{sign}{radius:.8f}{rise}{turns}",
                "G90",
            ]
        if plane != "G17":
            self.lines.append("G17")

    def cycle(self) -> None:
        """A canned cycle, its holes, and its end."""
        code = self.random.choice([73, 81, 81, 82, 83, 84, 85, 86, 87, 89])
        words = f" R{self.random.uniform(1, 5):.2f} Z{self.random.uniform(-9, 0):.2f}"
        if code in (73, 83):
            words += f" Q{self.random.uniform(0.5, 4):.2f}"
        if code in (82, 86, 89):
            words += f" P{self.random.uniform(0, 2):.2f}"
        if code == 87:
            words += f" I{self.random.uniform(-2, 2):.2f} J1 K{self.random.uniform(-1, 0):.2f}"
        repeats = f" L{self.random.randrange(1, 4)}" if self.random.random() < 0.3 else ""
        self.lines.append("S100 M3")
        back = self.random.choice(["G98", "G99"])
        mode = self.random.choice(["G90", "G90", "G91"])
        if mode == "G91":
            words = words.replace("Z", "Z-").replace("--", "-").replace("K-", "K")
        self.lines.append(f"{back} {mode} G{code} {self.point('XY', 0.8)}{words}{repeats}")
        for _ in range(self.random.randrange(3)):
            more = f" L{self.random.randrange(1, 3)}" if self.random.random() < 0.2 else ""
            self.lines.append(f"{self.point('XY', 0.7)}{more}")
        self.lines.append(self.random.choice(["G80", "G0 X0"]))
        self.lines.append("G90")

    def cycle_elsewhere(self) -> None:
        """A drilling cycle in a plane, perhaps in inches, with pecks, dwells and repeats."""
        plane, first, second, across = self.random.choice(
            [("G17", "X", "Y", "Z"), ("G18", "Z", "X", "Y"), ("G19", "Y", "Z", "X")]
        )
        code = self.random.choice([73, 81, 82, 83, 85, 89])
        words = f"R{self.random.uniform(1, 5):.2f} {across}{self.random.uniform(-9, 0):.2f}"
        words += f" Q{self.random.uniform(0.6, 4):.2f}" if code in (73, 83) else ""
        words += " P0.5" if code in (82, 89) else ""
        self.lines += [
            f"G94 F100 {plane} G80",
            f"G0 {across}{self.number(-5, 9)}",
            f"{self.random.choice(['G98', 'G99'])} G{code} {self.point(first + second)} {words}",
            f"{self.point(first + second)} {self.random.choice(['', 'G98', 'G99', 'L2'])}",
            f"{self.random.choice(['G80', 'G80 G0', 'G0'])}",
            "G17",
        ]

    def exact_arc(self) -> None:
        """An arc about an absolute centre, or one whose end lies beside it."""
        radius, begin, sweep = (self.random.uniform(*each) for each in ((4, 15), (-3, 3), (0.3, 6)))
        x, y = (self.random.uniform(-9, 9) for _ in range(2))
        beside = self.random.choice([0.0, 0.0, 0.0, 0.3, 2.0])
        start = f"X{x + radius * math.cos(begin):.8f} Y{y + radius * math.sin(begin):.8f}"
        end = begin + sweep
        self.lines += [
            "G90.1 G21",
            f"G0 {start}",
            (
                f"G3 X{x + (radius + beside) * math.cos(end):.8f} Y{y + (radius + beside) * math.sin(end):.8f} I{x:.8f}"
                f" J{y:.8f}{self.random.choice(['', ' Z1', ' P2', ' C5'])}"
            ),
            "G91.1",
        ]

    def mixed(self) -> None:
        """Several codes in one block, blanks in numbers, codes alone."""
        self.lines.append(
            self.random.choice(
                [
                    f"G90 G1 G94 G17 F1 00 {self.point('XYZ')} M8",
                    f"g 0 x 1 . 5 y- 2 . {self.random.randrange(10)}",
                    f"G0 G54 G40 G49 G80 {self.point('XY')}",
                    f"F200 S100 M3 G0 {self.point('XYZC')}",
                    f"G80 G0 {self.point('XY')}",
                    f"G91 G1 {self.point('XYZ')} F50\nG90",
                    f"G53 G0 {self.point('Z')} M9",
                    f"G93 G1 {self.point('XYZC')} F{self.number(1, 5)}\nG94 F100",
                    "G1",
                    "G2",
                    "G80",
                    "G33 K1",
                    f"G33 {self.point('Z')} K1.5",
                    f"G33.1 {self.point('Z')} K0.5",
                    f"G64 P0.0{self.random.randrange(1, 9)} Q0.01",
                    f"#<p>={self.number()} #7={self.number()}\nG0 X#<p> Y#7",
                    f"#<_g{self.random.randrange(3)}>={self.number()}",
                    f"#[30 + {self.random.randrange(5)}]={self.number()} G1 Y[#30 + #31 + #32]",
                    f"G0 Z[{self.expression()} * 0 + {self.number()}] (after)",
                    f"G92 {self.point('XYZC')}\nG92.{self.random.randrange(1, 4)}",
                    f"M70\nG20 G91 F10\nG1 {self.point('XY')}\nM72",
                ]
            )
        )

    def offset(self) -> None:
        """Coordinate systems, presets, tool lengths."""
        systems = ["G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"]
        choice = self.random.randrange(14)
        turn = f" R{self.random.uniform(-90, 90):.2f}" if self.random.random() < 0.3 else ""
        texts = [
            self.random.choice(systems),
            f"G10 L2 P{self.random.randrange(0, 10)} {self.point('XYZC')}{turn}",
            f"G10 L20 P{self.random.randrange(0, 10)} {self.point('XYZC')}",
            f"G92 {self.point('XYZC')}",
            "G92.1",
            "G92.2",
            "G92.3",
            f"G52 {self.point('XYZ')}",
            f"G21\nT{self.random.choice([1, 2, 99])} M6\nG43",
            f"G43 H{self.random.choice([1, 2, 99])}",
            f"G43.1 Z{self.number(0, 20)}",
            "G49",
            f"G43.2 H{self.random.choice([1, 2])}",
            (
                f"G10 L{self.random.choice([1, 10, 11])} P{self.random.choice([1, 2])}"
                f" Z{self.number(0, 20)}"
            ),
        ]
        self.lines.append(texts[choice])

    def machine(self) -> None:
        """Machine coordinates and stored positions."""
        choice = self.random.randrange(6)
        texts = [
            f"G53 G0 {self.point('XYZC')}",
            f"G53 G1 {self.point('XYZ')}",
            f"G28 {self.point('XYZ')}",
            "G30",
            "G28.1",
            f"G30 {self.point('Z')}",
        ]
        self.lines.append(texts[choice])

    def mode(self) -> None:
        """Units, distances, corners, feeds."""
        texts = [
            "G20",
            "G21",
            "G91",
            "G90",
            "G64 P0.01",
            "G61",
            "G61.1",
            f"F{self.number(50, 500)}",
            "G94 F200",
            "G4 P0.5",
            "M3 S500",
            "M5",
            "M8",
            "M9",
            "G97",
            "(a comment) ; another",
            "M70",
            "G93 G1 X5 F2\nG94 F100",
        ]
        self.lines.append(self.random.choice(texts))

    def assignment(self) -> None:
        """Parameters, alone and beside words that use them."""
        target = self.random.choice(
            ["#1", "#2", "#3", "#4", "#5", "#[1+2]", "#<x>", "#<_g>", "#31"]
        )
        value = self.expression()
        if self.random.random() < 0.3:
            self.lines.append(f"#1={value} G0 X#1 Y[#1 MOD 7]")
        else:
            self.lines.append(f"{target}={value}")

    def read(self) -> None:
        """Parameters of the control in a move."""
        name = self.random.choice(
            [
                "#5420",
                "#5421",
                "#5422",
                "#5220",
                "#<_x>",
                "#<_z>",
                "#<_metric>",
                "#<_coord_system>",
                "#<_motion_mode>",
                "#<_plane>",
                "#<_feed>",
                "#<_tool_offset>",
                "#<_incremental>",
                "#<_ccomp>",
            ]
        )
        self.lines.append(f"G0 Y[{name} / 10]")

    def flow(self, depth: int) -> None:
        """Conditions, loops and subroutines."""
        self.labels += 1
        label = self.random.choice([f"o{self.labels}", f"o<l{self.labels}>"])
        kind = self.random.randrange(5)
        if kind == 0:
            self.lines.append(f"{label} if [{self.expression()} GT 2]")
            self.some(depth + 1)
            if self.random.random() < 0.3:
                self.lines.append(f"{label} elseif [{self.expression()} LT 4]")
                self.some(depth + 1)
            if self.random.random() < 0.5:
                self.lines.append(f"{label} else")
                self.some(depth + 1)
            self.lines.append(f"{label} endif")
        elif kind == 1:
            self.lines.append(f"{label} repeat [{self.random.randrange(0, 4)}]")
            self.some(depth + 1)
            self.lines.append(f"{label} endrepeat")
        elif kind == 2:
            self.lines.append(f"#{40 + depth}=0")
            self.lines.append(f"{label} while [#{40 + depth} LT {self.random.randrange(4)}]")
            self.some(depth + 1)
            self.lines.append(f"#{40 + depth}=[#{40 + depth}+1]")
            if self.random.random() < 0.4 and depth == 0:  # rs274 leaves a do loop around it too
                self.labels += 1
                leave = self.random.choice(["break", "continue"])
                self.lines += [
                    f"o{self.labels} if [#{40 + depth} GT 1]",
                    f"{label} {leave}",
                    f"o{self.labels} endif",
                    "G0 X1",
                ]
            self.lines.append(f"{label} endwhile")
        elif kind == 3:
            self.lines.append(f"#{40 + depth}=0")
            self.lines.append(f"{label} do")
            self.some(depth + 1)
            self.lines.append(f"#{40 + depth}=[#{40 + depth}+1]")
            self.lines.append(f"{label} while [#{40 + depth} LT {self.random.randrange(4)}]")
        elif depth == 0:
            self.lines.append(f"{label} sub")
            self.lines.append("G0 X[#1 - 2]")
            self.some(1)
            value = self.random.choice(["", " [#1 * 2]"])
            self.lines.append(f"{label} endsub{value}")
            self.lines.append(f"{label} call [{self.number()}] [{self.number()}]")
            self.lines.append("G0 X#<_value> Y#1")

    def some(self, depth: int) -> None:
        """A few blocks."""
        for _ in range(self.random.randrange(1, 4)):
            self.block(depth)

    def block(self, depth: int = 0) -> None:
        """One thing or another."""
        weights = [8, 4, 2, 3, 1, 2, 2, 1, 2 if depth < 2 else 0, 1, 1, 3]
        (kind,) = self.random.choices(range(len(weights)), weights)
        (
            self.line,
            self.arc,
            self.cycle,
            self.offset,
            self.machine,
            self.mode,
            self.assignment,
            self.read,
            lambda: self.flow(depth),
            self.cycle_elsewhere,
            self.exact_arc,
            self.mixed,
        )[kind]()

    def slip(self) -> None:
        """Damage a line, as a person would."""
        at = self.random.randrange(len(self.lines))
        line = self.lines[at]
        if "elseif" in line:  # rs274 does not read on behind one that is false
            return
        self.lines[at] = self.random.choice(
            [
                line + " X1",
                line + " P1",
                line + " G1",
                line[: len(line) // 2],
                line.replace("G", "G1", 1),
                line.replace(" ", ""),
                line.lower(),
                f"N{at} {line}",
                f"/{line}",
            ]
        )


def program(seed: int) -> str:
    """A program."""
    author = Author(seed)
    author.lines.append("G21 G90 F100 S500 M3")
    for _ in range(author.random.randrange(2, 14)):
        author.block()
    if author.random.random() < 0.3:
        author.slip()
    lines = "\n".join(author.lines).split("\n")
    return "\n".join([*(line[:LONGEST] for line in lines), "M2", ""])


def contour(seed: int) -> str:
    """A contour of lines and arcs under radius compensation."""
    author = Author(seed)
    chance, lines = author.random, ["G21 G90 G64 F100", "G0 X-30 Y-30"]
    side = chance.choice(["G41", "G42"])
    start = chance.choice([f"{side} D1", f"{side}.1 D{chance.uniform(0.5, 6):.2f}"])
    x, y = round(chance.uniform(-20, -10), 3), round(chance.uniform(-20, -10), 3)
    lines += [start, f"{chance.choice(['G0', 'G1'])} X{x:.3f} Y{y:.3f}"]
    heading = chance.uniform(-math.pi, math.pi)
    for _ in range(chance.randrange(2, 7)):
        heading += chance.uniform(-2.0, 2.0)
        way = chance.uniform(8.0, 25.0)
        kind = chance.random()
        if kind < 0.6:
            x, y = x + way * math.cos(heading), y + way * math.sin(heading)
            lines.append(f"{chance.choice(['G1', 'G1', 'G0'])} X{x:.9f} Y{y:.9f}")
        elif kind < 0.9:
            sense = chance.choice([1.0, -1.0])
            sweep = chance.uniform(0.3, 3.0)
            inward = heading + sense * math.pi / 2.0
            i, j = way * math.cos(inward), way * math.sin(inward)
            outward = inward + math.pi + sense * sweep
            x, y = x + i + way * math.cos(outward), y + j + way * math.sin(outward)
            lines.append(f"{'G3' if sense > 0.0 else 'G2'} X{x:.9f} Y{y:.9f} I{i:.9f} J{j:.9f}")
            heading += sense * sweep
        else:
            lines.append(
                chance.choice([f"G1 Z{chance.uniform(-3, 3):.2f}", "M8", "F200", "S100 M3"])
            )
    lines += ["G40", "G1 X-40 Y-40", "M2", ""]
    return "\n".join(lines)
