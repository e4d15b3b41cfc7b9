"""Programs that compute, loop and call, made at random in every dialect that can.

Most run to their end; some are wrong somewhere, which both ways must say alike.
"""

import abc
from collections.abc import Callable
from random import Random

from tests.nc.compiled.effect_words import EFFECTS

NUMBERS = ["0", "1", "2", "3", ".5", "7.25", "10", "45", "90", "0.001", "360", "12.", "1000000"]


class Writer(abc.ABC):
    """Writes one program: its dialect's forms filled at random."""

    def __init__(self, random_: Random) -> None:
        self.random = random_
        self.lines: list[str] = []
        self.depth = 0
        self.label = 0
        self.effects = random_.choice([0.0, 0.1, 0.4])
        """How much of the program does more than move and compute."""

    @abc.abstractmethod
    def text(self) -> str:
        """The program."""

    def add(self, *lines: str) -> None:
        self.lines += lines

    def pick(self, *choices: str) -> str:
        return self.random.choice(choices)

    def odds(self, share: float) -> bool:
        return self.random.random() < share

    def number(self) -> str:
        if self.odds(0.5):
            return self.random.choice(NUMBERS)
        return f"{self.random.uniform(0, 60):.{self.random.randrange(0, 5)}f}"

    def new_label(self) -> int:
        self.label += 10
        return self.label


class Fagor(Writer):
    """Parameters, $ structures, subroutines, #RPT and NR of the Fagor CNC 8070."""

    OPERATORS = ("+", "-", "*", "/", " MOD ", "<", ">", "<=", ">=", "==", "!=", "&", "|", "^")
    FUNCTIONS = ("SIN", "COS", "TAN", "ABS", "SQR", "INT", "FRACT", "ROUND", "FUP", "INV", "ATAN")
    RARE = ("SQRT", "LOG", "LN", "ASIN", "ACOS", "EXP", "DEXP")

    def variable(self) -> str:
        if self.odds(0.005):
            return "P777"
        if self.odds(0.05):
            return self.pick("P[P1]", "P[2]", "P[1.5]", "P[-0]", "P[P0+1]", "V.G.PORGF", "P05")
        return self.pick("P0", "P1", "P2", "P3", "P100", "V.P.a")

    def value(self, depth: int = 2) -> str:
        kind = self.random.random()
        if depth == 0 or kind < 0.3:
            return self.number()
        if kind < 0.55:
            return self.variable()
        if kind < 0.65:
            return f"-{self.value(0)}"
        if kind < 0.75:
            return f"{self.pick(*self.FUNCTIONS)}[{self.value(depth - 1)}]"
        if kind < 0.77:
            return f"{self.pick(*self.RARE)}[{self.value(depth - 1)}]"
        if kind < 0.78:
            return f"ARG[{self.value(depth - 1)},{self.value(depth - 1)}]"
        if kind < 0.79:
            return f"EXIST[{self.pick('P1', 'P9', 'P[1]', 'P1+P9')}]"
        inner = f"{self.value(depth - 1)}{self.pick(*self.OPERATORS)}{self.value(depth - 1)}"
        return f"[{inner}]" if self.odds(0.5) else inner

    def small(self) -> str:
        """A value that no coordinate is too small for."""
        return f"[{self.value()}] MOD 100"

    def move(self) -> str:
        axes = "".join(
            f" {axis}{self.number() if self.odds(0.6) else self.small()}"
            for axis in "XYZC"
            if self.odds(0.5)
        )
        if self.odds(self.effects):
            return self.random.choice(EFFECTS["fagor8070"].split("|"))
        code = self.pick("G1", "G1", "G0", "G91 G1", "G90 G1", "G1", "G70 G1", "G71 G1")
        kind = self.random.random()
        if kind < 0.07:
            return f"G91 G2 X{self.pick('0', '10', '[P1*0]')} Y0 I{self.pick('5', '5', 'P1')} J0"
        if kind < 0.13:
            return self.pick("M8", "G4 K1", "R5 Q30", "X5I", "S100", "T1", "G54", "G1 F[P1]", "G1")
        repeat = f" NR{self.pick('2', '3', 'P1', '2.5')}" if self.odds(0.07) else ""
        feed = f" F{self.random.randrange(1, 900)}" if self.odds(0.1) else ""
        return f"{code}{axes}{feed}{repeat}"

    def assignment(self) -> str:
        name = self.pick("P0", "P1", "P2", "P3", "P100", "V.P.a", "P[P1]", "P[3]", "V.P.b")
        operator = self.pick("=", "=", "=", "+=", "-=", "*=", "/=", " = ")
        first = f"{name}{operator}{self.value()}"
        return f"{first} P1=2 P2 = {self.value()}" if self.odds(0.1) else first

    def block(self) -> None:
        label = f"N{self.new_label()} " if self.odds(0.2) else ""
        text = self.assignment() if self.odds(0.4) else self.move()
        self.add(label + text + self.pick("", "", "", " (text)", " ; text"))

    def body(self, in_loop: bool = False) -> None:
        self.depth += 1
        for _ in range(self.random.randrange(1, 5)):
            if self.depth < 4 and self.odds(0.35):
                self.structure(in_loop)
            else:
                self.block()
            if in_loop and self.odds(0.05):
                self.add(f"$IF {self.value(1)}", self.pick("$BREAK", "$CONTINUE"), "$ENDIF")
        self.depth -= 1

    def counted(self) -> tuple[str, str]:
        """A counter that no body touches, and how far it goes."""
        return f"P{200 + self.depth}", str(self.random.randrange(0, 5))

    def structure(self, in_loop: bool) -> None:
        counter, last = self.counted()
        kind = self.random.randrange(9)
        if kind == 0:
            self.add(f"{counter}=0", f"$WHILE {counter}<{last}", f"{counter}={counter}+1")
            self.body(in_loop=True)
            self.add("$ENDWHILE")
        elif kind == 1:
            self.add(f"$FOR {counter}={self.pick('0', '1', 'P1*0')},{last},{self.pick('1', '.5')}")
            self.body(in_loop=True)
            self.add("$ENDFOR")
        elif kind == 2:
            self.add(f"{counter}=0", "$DO", f"{counter}+=1")
            self.body(in_loop=True)
            self.add(f"$ENDDO {counter}<{last}")
        elif kind == 3:
            self.add(f"$IF {self.value()}")
            self.body(in_loop)
            for _ in range(self.random.randrange(3)):
                self.add(f"$ELSEIF {self.value(1)}")
                self.body(in_loop)
            if self.odds(0.5):
                self.add("$ELSE")
                self.body(in_loop)
            self.add("$ENDIF")
        elif kind == 4:
            self.add(f"$SWITCH [{self.value(1)}] MOD 3")
            for case in range(self.random.randrange(1, 4)):
                self.add(f"$CASE {case}", self.move(), "$BREAK")
            if self.odds(0.5):
                self.add("$DEFAULT", self.move())
            self.add("$ENDSWITCH")
        elif kind == 5:
            self.add(self.pick("LL A", "LL B", f"#PCALL A A{self.value(1)} B[P1] C3 D4", "#CALL B"))
        elif kind == 6:
            first, end = self.new_label(), self.new_label()
            self.add(f"N{first} {self.move()}", self.assignment(), f"N{end}")
            self.add(f"#RPT[N{first},N{end},{self.pick('1', '2', '3', 'P2')}]")
        elif kind == 7:
            target = self.new_label()
            self.add(f"$IF {self.value(1)} $GOTO N{target}", self.move(), f"N{target}")
        else:
            target = self.new_label()
            self.add(f"{counter}=0", f"N{target} {counter}={counter}+1", self.move())
            self.add(f"$IF {counter}<{last} $GOTO N{target}")

    def text(self) -> str:
        for name in "AB":
            self.add(f"%L {name}")
            self.body()
            if name == "A" and self.odds(0.3):
                self.add("LL B")
            self.add(self.pick("M17", "M17", "G1 X1 M17", "#RET", "M29"))
        self.add("%MAIN", "P0=1 P1=2 P2=3 P3=4.5 P100=5 V.P.a=6 V.P.b=7")
        self.add(self.pick("G90 G1 F500", "G1 F500", "G1"))
        for _ in range(self.random.randrange(2, 6)):
            self.body()
        self.add(self.pick("M30", "M30", "", "(no end)"))
        return "\n".join(self.lines)


class Codesys(Writer):
    """LET, :=, G20, G36, G37 and subprograms of CODESYS SoftMotion."""

    OPERATORS = ("+", "-", "*", "/", " MOD ", "<", ">", "<=", ">=", "=", "<>", " AND ", " OR ")
    FUNCTIONS = ("SIN", "COS", "TAN", "ATAN", "ABS", "TRUNC")

    def variable(self) -> str:
        if self.odds(0.005):
            return self.pick("#none", "$none$")
        return self.pick("#a", "#b", "#i", "$v$", "$w$", "PI", "TRUE")

    def value(self, depth: int = 2) -> str:
        kind = self.random.random()
        if depth == 0 or kind < 0.3:
            return self.number()
        if kind < 0.55:
            return self.variable()
        if kind < 0.62:
            return f"-{self.value(0)}"
        if kind < 0.72:
            return f"{self.pick(*self.FUNCTIONS)}({self.value(depth - 1)})"
        if kind < 0.74:
            name = self.pick("SQRT", "LN", "LOG", "ASIN", "ACOS", "EXP")
            return f"{name}({self.value(depth - 1)})"
        if kind < 0.78:
            name = self.pick("MIN", "MAX", "EXPT")
            return f"{name}({self.value(depth - 1)},{self.value(depth - 1)})"
        if kind < 0.8:
            name = self.pick("LIMIT", "SEL")
            return f"{name}({','.join(self.value(depth - 1) for _ in range(3))})"
        if kind < 0.82:
            return f"NOT {self.value(0)}"
        return f"({self.value(depth - 1)}{self.pick(*self.OPERATORS)}{self.value(depth - 1)})"

    def move(self) -> str:
        axes = "".join(
            f" {axis}{self.number() if self.odds(0.5) else f'(({self.value()}) MOD 100)'}"
            for axis in "XYZC"
            if self.odds(0.5)
        )
        if self.odds(self.effects):
            return self.random.choice(EFFECTS["codesys"].split("|"))
        kind = self.random.random()
        if kind < 0.1:
            return f"G91 G3 X{self.pick('0', '10')} Y0 I{self.pick('5', '5', '#a')} J0"
        if kind < 0.13:
            return self.pick("M8", "G4 T1", "G1 X1 H2 O0.5", "G1 X5 E100", "FF10", "F(#a)", "G1")
        feed = f" F{self.random.randrange(1, 90)}" if self.odds(0.1) else ""
        return f"{self.pick('G1', 'G1', 'G0', 'G91 G1', 'G90 G1')}{axes}{feed}"

    def assignment(self) -> str:
        kind = self.random.randrange(6)
        if kind == 0:
            return f"G36 O{self.pick('$v$', '#a', '$w$')} D{self.pick('1', '2.5', '(#b+1)')}"
        if kind == 1:
            return f"G37 O{self.pick('$v$', '#a')} D{self.pick('1', '-2', '(#b)')}"
        if kind == 2:
            return f"{self.pick('G36', 'G37')} D{self.pick('0', '1', '-1')}"
        if kind == 3:
            return f"LET #{self.pick('a', 'c')} := {self.value()}"
        return f"#{self.pick('a', 'b')} := {self.value()}"

    def block(self) -> None:
        text = self.assignment() if self.odds(0.4) else self.move()
        text = f"N{self.new_label()} {text}"
        if self.lines and self.odds(0.15) and self.lines[-1].startswith("N"):
            self.lines[-1] += f" {text}"
        else:
            self.add(text + self.pick("", "", "", " (text)", " // text"))

    def body(self) -> None:
        self.depth += 1
        for _ in range(self.random.randrange(1, 5)):
            if self.depth < 4 and self.odds(0.3):
                self.structure()
            else:
                self.block()
        self.depth -= 1

    def structure(self) -> None:
        counter = f"#n{self.depth}"
        kind = self.random.randrange(5)
        if kind < 2:
            self.add(f"N{self.new_label()} LET {counter} := 0")
            target = self.new_label()
            self.add(f"N{target} {counter} := {counter} + 1")
            self.body()
            last = self.random.randrange(0, 6)
            self.add(f"N{self.new_label()} G20 L{target} K({counter} < {last})")
        elif kind == 2:
            target = self.new_label()
            label = self.new_label()
            self.add(f"N{label} G36 D-{self.random.randrange(1, 4)}", f"N{target} {self.move()}")
            self.add(f"N{self.new_label()} G37 D1", f"N{self.new_label()} G20 L{target}")
        elif kind == 3:
            target = self.new_label()
            condition = self.pick("", f" K({self.value(1)})", " K0", " K1")
            self.add(f"N{self.new_label()} G20 L{target}{condition}")
            self.block()
            self.add(f"N{target} {self.move()}")
        else:
            values = self.pick("1,2", f"{self.value(1)},#b", "3,#i", "#i,3", "4,5")
            self.add(f"N{self.new_label()} {self.pick('S', 'S', 'T')}UB{{{values}}}")

    def text(self) -> str:
        self.add("LET #a := 1", "LET #b : LREAL := 2", "LET #i := 3", "LET #c", "G36 O$v$ D4")
        self.add("G36 O$w$ D5", self.pick("G1 F20", "G1 X0"))
        for _ in range(self.random.randrange(2, 5)):
            self.body()
        self.add(self.pick("M30", "M30", ""))
        for name in "ST":
            self.add(f"SUBPROGRAM {name}UB{{#a, #b}} {self.pick('', 'RESTORE')}", "LET #i := 2")
            self.body()
            self.add(f"N{self.new_label()} {self.pick('RETURN', 'X5')}", "END_SUBPROGRAM")
        return "\n".join(self.lines)


class Mefi(Writer):
    """G73 of the MEFI CNC8x6: nested and overlapping repeats."""

    def move(self) -> str:
        if self.odds(self.effects):
            return self.random.choice(EFFECTS["mefi"].split("|"))
        axes = "".join(f" {axis}{self.number()}" for axis in "XYZC" if self.odds(0.5))
        kind = self.random.random()
        if kind < 0.1:
            return f"G91 G2 X{self.pick('0', '10')} Y0 I5"
        if kind < 0.15:
            return self.pick(
                "M8", "G4 P1", "G41 D1", "G40", "Z1.05 G10", "G09 G02 X0 Y0 I10", "G98"
            )
        return f"{self.pick('G1', 'G0', 'G91 G1', 'G90 G1')}{axes}"

    def text(self) -> str:
        self.add(self.pick("G90 G1 F500", "G1", "F500"))
        for _ in range(self.random.randrange(3, 20)):
            label = self.new_label()
            jump = ""
            if self.odds(0.35):
                target = 10 * self.random.randrange(max(1, self.depth), label // 10 + 1)
                if self.odds(0.4):
                    self.depth = label // 10
                jump = f" G73 L{target}{self.pick(' Q2', ' Q3', '', ' Q0', ' Q1')}"
                if self.odds(0.03):
                    jump = self.pick(" G73", " G73 L999", " G73 L10 Q-1", " G73 L10 Q1.5", " L10")
            self.add(f"N{label} {self.move()}{jump}" + self.pick("", "", ' "text'))
        self.add(self.pick("M30", ""))
        return "\n".join(self.lines)


MAKERS: dict[str, Callable[[Random], Writer]] = {
    "fagor8070": Fagor,
    "codesys": Codesys,
    "mefi": Mefi,
}


def program(dialect: str, random_: Random) -> str:
    """A program of a dialect."""
    return MAKERS[dialect](random_).text()
