"""Programs with drilling cycles made at random: called, changed, ended, in loops, in every plane.

Most run to their end; some lack a word or have a wrong one, which both ways must say alike.
"""

from random import Random

CYCLES = {
    "fagor8070": {
        "G81": "K",
        "G82": "BBDRLHJCK",
        "G83": "JJDK",
        "G84": "K",
        "G85": "K",
        "G86": "K",
    },
    "iso": {"G81": "", "G82": "P", "G83": "Q", "G84": "P", "G85": "", "G86": "", "G89": "P"},
}
"""The words of each besides those of its heights; a letter that stands twice is needed."""
GOOD = {
    "K": ("1", "0.5", "0"),
    "P": ("1", "0.5", "0"),
    "Q": ("2", "0.7", "9"),
    "B": ("2", "1.3", "9"),
    "D": ("1", "0", "0.5"),
    "R": ("1", "0.7", "1.2"),
    "L": ("1", "0.5", "0"),
    "H": ("1", "0.3", "0"),
    "J": ("2", "3", "1"),
    "C": ("0.5", "0", "2"),
}
BAD = ("-1", "0", "-0", "0.5", "-2.5", "1000000", "0.00001")
BESIDE = {
    "fagor8070": (
        "G54|G55|G158 X3 Y1|G158|G92 X5 Y7|D0|D1|T2 M6|G70|G71|S100 M3|M8|M5|G4 K1|F200|G94|G93 F3"
        "|G30 I3 J4|G30|G73 Q30|G73|G11|G10|G12|G72 S2|G41|G40|G5|G7|G91|G90|G98|G99|N5"
        "|G0 X1 Z9|G1 X5 Y5|R9 Q[P1*30]|G2 X9 I2|/X3"
    ),
    "gost": (
        "G54|G55|G92 X5 Y7|G43 H2|G49|T2 M6|G70|G71|S100 M3|M8|M5|G4 P1|F200|G41 D1|G40|G91|G90|G98"
        "|G99|G0 X1 Z9|G1 X5 Y5|G61|G9 X3|G94|G95 F0.1|G102 C360|G2 X9 I2|/X3"
    ),
    "mefi": (
        "G54|G55|G92 X5 Y7|G43 H2|G49|T2 M6|G70|G71|S100 M3|M8|M5|G4 P1|F200|G41 D1|G40|G91|G90"
        "|G0 X1 Z9|G1 X5 Y5|G94|G2 X9 I2|/X3"
    ),
}
"""What stands between the cycles."""
HOLES = {
    "fagor8070": "X{}|X{} Y{}|Y{} M8|X{} F90|R{} Q30|Q{}|X{}I|Z{}|C{} X{}|G91 X{}|G99 X{}|X{} NR2",
    "gost": "X{}|X{} Y{}|Y{} M8|X{} F90|Z-{}|X{} R3|Y{} Z-5 R{}|C{} X{}|G91 X{}|G99 X{}",
    "mefi": "X{}|X{} Y{}|Y{} M8|X{} F90|Z-{}|X{} R3|Y{} Z-5 R{}|C{} X{}|G91 X{}",
}
"""Blocks that name further holes."""
DOUBTFUL_HOLES = ("X{} Q2", "X{} I3", "X{} P1", "X{} Q45", "Y3 J2", "U5", "X1 X2", "K3")
"""The same, wrong in most dialects and cycles."""


class _Writer:
    def __init__(self, dialect: str, random_: Random) -> None:
        self.dialect = dialect
        self.random = random_
        self.wrong = random_.choice([0.0, 0.0, 0.0, 0.02, 0.1])
        self.planes = random_.choice([0.0, 0.0, 0.3])
        self.across = "Z"

    def odds(self, share: float) -> bool:
        return self.random.random() < share

    def number(self) -> str:
        if self.dialect == "fagor8070" and self.odds(0.3):
            return self.random.choice(["[P1*3]", "P1", "[P2+P1]", "[-P1]", "[P1/3]"])
        return self.random.choice(["0", "3", "7.5", "12", f"{self.random.uniform(0, 40):.3f}"])

    def word(self, letter: str) -> str:
        if self.odds(self.wrong):
            return letter + self.random.choice(BAD)
        value = self.random.choice(GOOD[letter])
        return f"{letter}[{value}+P1*0]" if self._computes(0.2) else letter + value

    def _computes(self, share: float) -> bool:
        return self.dialect == "fagor8070" and self.odds(share)

    def call(self) -> str:
        """A block that calls a cycle."""
        own = CYCLES.get(self.dialect, CYCLES["iso"])
        code = self.random.choice(list(own))
        letters = own[code]
        needed = {each for each in letters if letters.count(each) > 1 or each == "Q"}
        words = [
            self.word(each)
            for each in sorted(set(letters))
            if (each in needed and not self.odds(self.wrong)) or self.odds(0.4)
        ]
        words += self.heights(code)
        words += [
            f"{each}{self.number()}" for each in "XYZ" if each != self.across and self.odds(0.6)
        ]
        words += [each for each in ("F90", "M8", "S50", "C30", "T1") if self.odds(0.06)]
        if self.dialect == "fagor8070" and self.odds(0.1):
            words = [each for each in words if each[0] not in "XYR"] + ["R7 Q[P1*20]"]
        self.random.shuffle(words)
        codes = [code, *(each for each in ("G90", "G91", "G1", "G70") if self.odds(0.08))]
        if self.dialect != "mefi" and self.odds(0.4):
            codes.append(self.random.choice(["G98", "G99"]))
        if "G90" in codes and "G91" in codes:
            codes.remove("G91")
        if self.odds(self.planes):
            plane, self.across = self.random.choice([("G17", "Z"), ("G18", "Y"), ("G19", "X")])
            codes.append(plane)
        self.random.shuffle(codes)
        return " ".join([*codes, *words] if self.odds(0.9) else [*words, *codes])

    def heights(self, code: str) -> list[str]:
        if self.dialect == "fagor8070":
            depth = self.random.choice(["-5", "-7.25", "-[P1+3]"])
            if code == "G83":
                depth = self.random.choice(["2", "1.5", "-3"])
            words = [f"{self.across}{self.random.choice(['2', '0', '1.5'])}", f"I{depth}"]
            if self.odds(0.05):
                words = [each + "I" for each in words if not each.endswith("]")]
        else:
            words = [
                f"{self.across}-{self.random.choice(['5', '7.25', '3'])}",
                f"R{self.random.choice(['2', '0', '1.5'])}",
            ]
        if self.odds(self.wrong):
            words.pop(self.random.randrange(len(words)))
        return words

    def blocks(self) -> list[str]:
        """A cycle with its holes, and what ends it."""
        lines = [self.call()]
        for _ in range(self.random.randrange(5)):
            lines.append(self.hole())
            if self.odds(0.15):
                lines.append(self.random.choice(BESIDE[self.dialect].split("|")))
        if self.odds(0.7):
            lines.append(self.random.choice(["G80", "G80", "G80", "G0 Z9", "G1 X3", "G0 G80 Z5"]))
            if self.odds(self.planes):
                lines.append("G17")
                self.across = "Z"
        if self.odds(0.3):
            lines.append(self.random.choice(BESIDE[self.dialect].split("|")))
        return lines

    def hole(self) -> str:
        text = self.random.choice(HOLES[self.dialect].split("|"))
        if self.odds(self.wrong):
            text = self.random.choice(DOUBTFUL_HOLES)
        if text[0] in "ZQ" and not self.odds(0.3):
            text = "X{}"
        while "{}" in text:
            text = text.replace("{}", self.number(), 1)
        return text

    def text(self) -> str:
        lines = [self.random.choice(["G90 G0 Z9 F500", "G1 F200 X1 Y1 Z1", "G0 Z12 S80 M3 F100"])]
        body = [line for _ in range(self.random.randrange(1, 5)) for line in self.blocks()]
        end = ["G90 G80", "G17", "G0 Z9"]
        passes = self.random.choice([2, 3, 9])
        if self.dialect == "fagor8070":
            lines = ["P1=1 P2=2.5", *lines]
            if self.odds(0.4):
                head = ["%L HOLES", *body, "M17", "%MAIN"]
                calls = [f"$FOR P1=1,{passes},1", "LL HOLES", *end, "$ENDFOR"]
                return "\n".join([*head, *lines, *calls, "M30"])
            loop = [f"$FOR P1=1,{passes},1", *body, *(end if self.odds(0.7) else []), "$ENDFOR"]
            return "\n".join([*lines, *loop, "M30"])
        if self.dialect == "mefi":
            again = f"N90 G0 X0 G73 L10 Q{passes}"
            if self.odds(0.2):
                again = f"N90 X3 G73 L10 Q{passes}"
            return "\n".join([*lines, "N10", *body, *end, again, "M30"])
        return "\n".join([*lines, *(body + end) * passes, "M30"])


def program(dialect: str, random_: Random) -> str:
    """A program of a dialect that has cycles."""
    return _Writer(dialect, random_).text()
