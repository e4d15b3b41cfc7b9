"""Wider random programs of LinuxCNC: subroutines, units, tools, probing, feeds, and damage of every kind."""

import math

from tests.nc.linuxcnc.random_programs import LONGEST, Author


class WideAuthor(Author):
    """Writes programs with what ``Author`` leaves out."""

    def lengths(self) -> None:
        """Tools, their lengths in several ways, and moves between."""
        tool = self.random.choice([1, 2, 99])
        self.lines += self.random.choice(
            [
                [f"T{tool} M6", "G43", f"G0 {self.point()}"],
                [f"T{tool} M6 G43", f"G0 {self.point()}"],
                [f"T{tool}", "G1 X1", "M6", f"G43 H{self.random.choice([0, 1, 2, 99, 5])}"],
                [f"M61 Q{tool}", "G43", f"G0 {self.point()}"],
                [f"G43 H{tool} G0 {self.point()}"],
                [f"G43.2 H{tool}", f"G0 {self.point('XY')}", "G49"],
                [f"G43.1 X{self.number(0, 3)} Z{self.number(0, 9)}", f"G1 {self.point()}", "G49"],
                [f"G10 L1 P{tool} Z{self.number(0, 20)} R{self.number(0, 5)}", "G43", "G0 X1"],
                [f"G10 L11 P{tool} Z{self.number(0, 20)}", f"G43 H{tool}", f"G0 {self.point()}"],
            ]
        )

    def subroutine(self) -> None:
        """One that gives a value back, calls itself, or returns early."""
        self.labels += 1
        name, inner = f"o<s{self.labels}>", f"o{self.labels}"
        kind = self.random.randrange(3)
        if kind == 0:
            body = [f"{inner} if [#1 GT 0]", f"G91 G0 X{self.number(-2, 2)}", "G90"]
            body += [f"{name} call [#1 - 1] [#2]", f"{inner} endif"]
        elif kind == 1:
            body = [f"{inner} if [#1 GT #2]", f"{name} return [#1 - #2]", f"{inner} endif"]
            body += [f"G1 X[#1] Y[#2] F{self.random.randrange(50, 300)}"]
        else:
            body = ["#<local>=[#1 + #2]", "#<_shared>=#<local>", "G0 Z#<local>"]
        self.lines += [f"{name} sub", *body, f"{name} endsub [#1 * 2]"]
        first = self.random.randrange(5)
        self.lines.append(f"{name} call [{first}] [{self.random.randrange(5)}]")
        self.lines.append("G0 Y#<_value> Z[#<_value_returned>]")

    def nested_loop(self) -> None:
        """Loops within loops, with break and continue at any depth."""
        outer, inner, test = self.labels + 1, self.labels + 2, self.labels + 3
        self.labels += 3
        head = self.random.choice(["while [#20 LT 3]", "do"])
        tail = f"o{outer} while [#20 LT 3]" if head == "do" else f"o{outer} endwhile"
        leave = self.random.choice([f"o{inner} break", f"o{inner} continue", f"o{outer} break"])
        self.lines += [
            "#20=0",
            f"o{outer} {head}",
            "#20=[#20 + 1]",
            "#21=0",
            f"o{inner} while [#21 LT {self.random.randrange(4)}]",
            "#21=[#21 + 1]",
            f"o{test} if [#21 {self.random.choice(['EQ', 'GT', 'LT'])} 2]",
            leave,
            f"o{test} endif",
            f"G91 G0 X#21 Y{self.number(-3, 3)}",
            "G90",
            f"o{inner} endwhile",
            f"G1 Z#20 F{self.random.randrange(60, 400)}",
            tail,
        ]

    def feeds(self) -> None:
        """Feeds by time and by revolution."""
        self.lines += self.random.choice(
            [
                ["G93", f"G1 {self.point('XYC')} F{self.number(1, 9)}", f"G1 {self.point()} F2", "G94 F100"],
                ["S300 M3", f"G95 F0.{self.random.randrange(1, 9)}", f"G1 {self.point()}", "G94 F90"],
                ["G94", f"G1 {self.point()}"],
                ["G93", f"G2 X1 Y1 R{self.number(5, 20)} F3", "G94 F100"],
                [f"G1 F{self.number(10, 90)}", f"X{self.number()}"],
            ]
        )  # fmt: skip

    def switches(self) -> None:
        """What changes no path, and what the path depends on behind it."""
        self.lines += self.random.choice(
            [
                ["M66 P0 L0", "G0 X#5399"],
                ["M62 P1", "M63 P1", "M67 E1 Q2.5"],
                ["M19 R45", "S200 M3"],
                ["(MSG, a message)", "(DEBUG, #1)", "(PRINT,x #<_x>)"],
                ["M51 P1", "M50 P0", "M48"],
                ["G38.3 Z-5 F50", "G0 Z[#5063 + 1] X#5070"],
                ["M70", "G20 G91 F3", f"G1 {self.point('XYZ')}", "M72"],
                ["M73"],
                ["G0 X[EXISTS[#<_x>]] Y[EXISTS[#<none>]]"],
                ["#30=31 #31=4", "G0 X##30 Y[##30 + #30]"],
                [f"G0 X-#1 Y+[{self.expression()}] Z-[#2]"],
                ["G54 G0 X1 (in) Y[2 * [3 + #3]] ; behind"],
            ]
        )

    def preset(self) -> None:
        """Presets, systems and turns, with moves in between."""
        for _ in range(self.random.randrange(1, 4)):
            self.offset()
            self.lines.append(
                f"{self.random.choice(['G0', 'G1', 'G91 G1'])} {self.point('XYZC')} F200"
            )
        self.lines.append("G90")

    def block(self, depth: int = 0) -> None:
        """One thing or another."""
        kinds = [self.lengths, self.feeds, self.switches, self.preset, self.nested_loop]
        if depth == 0:
            kinds.append(self.subroutine)
        if self.random.random() < 0.45:
            self.random.choice(kinds)()
        else:
            super().block(depth)

    def damage(self) -> None:
        """A character lost, doubled, or put where another one was."""
        at = self.random.randrange(len(self.lines))
        line = self.lines[at]
        if not line or "elseif" in line:
            return
        place = self.random.randrange(len(line))
        other = self.random.choice("GXYZRPLQFST0123456789.-+[]#()<>= ")
        self.lines[at] = self.random.choice(
            [
                line[:place] + line[place + 1 :],
                line[:place] + line[place] + line[place:],
                line[:place] + other + line[place + 1 :],
                line[:place] + other + line[place:],
            ]
        )


def wide(seed: int) -> str:
    """A program."""
    author = WideAuthor(seed)
    author.lines.append(
        author.random.choice(["G21 G90 F100 S500 M3", "G20 G90 F4 S500 M3 G64 P0.001"])
    )
    for _ in range(author.random.randrange(2, 10)):
        author.block()
    if author.random.random() < 0.3:
        author.damage()
    lines = "\n".join(author.lines).split("\n")
    return "\n".join([*(line[:LONGEST] for line in lines), "M2", ""])


def wide_contour(seed: int) -> str:
    """A contour under compensation in either plane and unit, with helices, arcs by radius and kinks."""
    chance = WideAuthor(seed).random
    plane, first, second, across, centers = chance.choice(
        [("G17", "X", "Y", "Z", "IJ"), ("G17", "X", "Y", "Z", "IJ"), ("G18", "Z", "X", "Y", "KI")]
    )
    unit = chance.choice([1.0, 1.0, 25.4])
    lines = ["G20" if unit != 1.0 else "G21", f"{plane} G90 G64 F100"]

    def at(u: float, v: float) -> str:
        return f"{first}{u / unit:.9f} {second}{v / unit:.9f}"

    lines.append(f"G0 {at(-30.0, -30.0)}")
    side = chance.choice(["G41", "G42"])
    radius = chance.uniform(0.5, 7.0)
    u, v = chance.uniform(-20, -10), chance.uniform(-20, -10)
    heading = math.atan2(v + 30.0, u + 30.0)
    lines += [f"{side}.1 D{2.0 * radius / unit:.6f}", f"{chance.choice(['G0', 'G1'])} {at(u, v)}"]
    for _ in range(chance.randrange(2, 8)):
        heading += chance.choice([0.0, chance.uniform(-0.08, 0.08), chance.uniform(-2.5, 2.5)])
        way, kind = chance.uniform(2.0, 25.0), chance.random()
        rise = f" {across}{chance.uniform(-3, 3) / unit:.4f}" if chance.random() < 0.2 else ""
        if kind < 0.5:
            u, v = u + way * math.cos(heading), v + way * math.sin(heading)
            lines.append(f"{chance.choice(['G1', 'G1', 'G0'])} {at(u, v)}{rise}")
        elif kind < 0.9:
            sense, sweep = chance.choice([1.0, -1.0]), chance.uniform(0.1, 5.0)
            inward = heading + sense * math.pi / 2.0
            i, j = way * math.cos(inward), way * math.sin(inward)
            outward = inward + math.pi + sense * sweep
            u, v = u + i + way * math.cos(outward), v + j + way * math.sin(outward)
            middle = f"{centers[0]}{i / unit:.9f} {centers[1]}{j / unit:.9f}"
            if chance.random() < 0.3:
                middle = f"R{(way if sweep < math.pi else -way) / unit:.9f}"
            lines.append(f"{'G3' if sense > 0.0 else 'G2'} {at(u, v)} {middle}{rise}")
            heading += sense * sweep
        else:
            height = f"{chance.choice(['G0', 'G1'])} {across}{chance.uniform(-3, 3) / unit:.2f}"
            lines.append(chance.choice([height, "M8", "F200", "G4 P0.1", "S100 M3"]))
    lines += ["G40", f"G1 {at(-40.0, -40.0)}", "M2", ""]
    return "\n".join(lines)
