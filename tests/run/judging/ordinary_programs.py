"""Ordinary programs in great number, as posts write them: nothing in them deserves a warning."""

import math
import re
from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

import numpy as np

SIZE = (60.0, 60.0, 20.0)
CLEAR, NEAR = 25.0, 3.0
"""Heights of rapids between features, and from which on it is fed [mm]."""

JOB = """
program = "p.nc"
dialect = "{dialect}"
part_zero = {{ Z = -500.0 }}
[start]
Z = 60.0
[stock]
{stock}
cell = 0.6
[[tools]]
number = 1
kind = "flat"
diameter = {mill}
flute = 25.0
teeth = {teeth}
[[tools]]
number = 2
kind = "drill"
diameter = {drill}
flute = 40.0
length = 90.0
free_length = 60.0
[[tools]]
number = 3
kind = "flat"
diameter = 16.0
flute = 20.0
teeth = 4
[tolerance]
contour_um = 200.0
"""


class Post(NamedTuple):
    """How a post writes what differs between controls.

    Attributes:
        head: Of a program.
        change: Of a tool, by its number, speed and place above the first feature.
        lift: The tool at the end of its work.
        end: Of a program.
        drill: A cycle at places; None: it has none, and changes no tool.
        spelt: The lines of a feature as it writes them.
    """

    head: str
    change: Callable[[int, int, str], str]
    lift: str
    end: str
    drill: Callable[[list[tuple[float, float]], float, int], Iterator[str]] | None
    spelt: Callable[[Iterable[str]], Iterable[str]] = list


def _cycle(code: str, extra: str = "") -> Callable[..., Iterator[str]]:
    def write(places: list[tuple[float, float]], depth: float, feed: int) -> Iterator[str]:
        for number, (x, y) in enumerate(places):
            word = f"G98 {code} Z{-depth:.3f} R{NEAR:.1f} {extra}F{feed}." if number == 0 else ""
            yield f"{word} X{x:.3f} Y{y:.3f}".strip()
        yield "G80"

    return write


def _by_moves(places: list[tuple[float, float]], depth: float, feed: int) -> Iterator[str]:
    for x, y in places:
        yield f"G0 X{x:.3f} Y{y:.3f}"
        yield f"G0 Z{NEAR:.3f}"
        yield f"G1 Z{-depth:.3f} F{feed}"
        yield f"G0 Z{CLEAR:.3f}"


FANUC = Post(
    "%\nO1001 (PART)\nG90 G94 G17 G40 G49 G80\nG21\n",
    lambda tool, speed, at: f"T{tool} M6\nS{speed} M3\nG54\nG0 {at}\nG43 Z{CLEAR:.1f} H{tool}\nM8\n",
    "M9\nG0 Z25.\nG91 G28 Z0.\nG90\nM5\n", "M30\n%\n", _cycle("G83", "Q2. "),
)  # fmt: skip
HAAS = Post(
    "%\nO02001 (PART)\nG00 G17 G20 G40 G49 G80 G90\nG21\n".replace(" G20", ""),
    lambda tool, speed, at: f"T{tool} M06\nG54\nG00 {at} S{speed} M03\nG43 H{tool:02d} Z{CLEAR:.1f} M08\n",
    "M09\nG00 Z25.\nG53 G00 Z0. M05\n", "M30\n%\n", _cycle("G81"),
)  # fmt: skip
LINUXCNC = Post(
    "G90 G94 G17 G91.1\nG21\nG64 P0.01\n",
    lambda tool, speed, at: f"M6 T{tool}\nS{speed} M3\nG54\nG0 {at}\nG43 Z{CLEAR:.1f} H{tool}\n",
    "G0 Z25.\nG53 G0 Z0.\nM5\n", "M30\n", _cycle("G83", "Q2. "),
)  # fmt: skip
FAGOR = Post(
    "%PART\nN10 G90 G17 G71\n",
    lambda tool, speed, at: f"T{tool} D1\nM6\nS{speed} M3\nG0 {at}\nG0 Z{CLEAR:.1f}\nM8\n",
    "M9\nG0 Z25\n#MCS G0 Z0\nM5\n", "M30\n", _by_moves,
)  # fmt: skip


def _mcall(places: list[tuple[float, float]], depth: float, feed: int) -> Iterator[str]:
    yield f"F{feed}"
    yield f"MCALL CYCLE83({CLEAR:.1f},0,{NEAR:.1f},{-depth:.3f},,,4,1,0,0,1,0)"
    for x, y in places:
        yield f"X{x:.3f} Y{y:.3f}"
    yield "MCALL"


def _cycle_200(places: list[tuple[float, float]], depth: float, feed: int) -> Iterator[str]:
    values = (NEAR, -depth, feed, 2.0, 0.0, 0.0, CLEAR - 1.0, 0.0)
    numbers = (200, 201, 206, 202, 210, 203, 204, 211)
    words = (f"Q{number}={value:+.3f}" for number, value in zip(numbers, values, strict=True))
    yield f"CYCL DEF 200 BOHREN {' '.join(words)}"
    for x, y in places:
        yield f"L X{x:+.3f} Y{y:+.3f} R0 FMAX M99"


def klartext(lines: Iterable[str]) -> Iterator[str]:
    """ISO lines as Klartext: arcs by their centre, helices by their angle."""
    here = {"X": 0.0, "Y": 0.0}
    for line in lines:
        words = {letter: float(value) for letter, value in re.findall(r"([A-Z])(-?[0-9.]+)", line)}
        code, feed = words.pop("G"), words.pop("F", None)
        paced = " FMAX" if code == 0 else "" if feed is None else f" F{feed:.0f}"
        if "I" in words:
            yield f"CC X{here['X'] + words.pop('I'):+.4f} Y{here['Y'] + words.pop('J'):+.4f}"
            sense = "DR-" if code == 2 else "DR+"
            if "Z" in words:
                yield f"CP IPA+360 Z{words['Z']:+.3f} {sense}{paced}"
            else:
                yield f"C X{words['X']:+.3f} Y{words['Y']:+.3f} {sense}{paced}"
        else:
            aims = " ".join(f"{letter}{value:+.3f}" for letter, value in words.items())
            yield f"L {aims} R0{paced}"
        here |= {letter: words[letter] for letter in "XY" if letter in words}


SINUMERIK = Post(
    "; PART\nG17 G90 G94 G71\nG40\n",
    lambda tool, speed, at: f"T{tool} D1\nM6\nS{speed} M3\nG54\nG0 {at}\nG0 Z{CLEAR:.1f}\nM8\n",
    "M9\nG0 Z25\nSUPA G0 Z0 D0\nM5\n", "M30\n", _mcall,
)  # fmt: skip
HEIDENHAIN = Post(
    "BEGIN PGM PART MM\nBLK FORM 0.1 Z X-30 Y-30 Z-20\nBLK FORM 0.2 X+30 Y+30 Z+0\n",
    lambda tool, speed, at: (
        f"TOOL CALL {tool} Z S{speed}\nL {at.replace('X', 'X+').replace('Y', 'Y+').replace('+-', '-')} R0 FMAX M3\n"
        f"L Z+{CLEAR:.1f} R0 FMAX M8\n"
    ),
    "M9\nL Z+25 R0 FMAX\nL Z+0 R0 FMAX M91\nM5\n", "M30\nEND PGM PART MM\n", _cycle_200, klartext,
)  # fmt: skip
GRBL = Post(
    "; PART\nG90 G94 G17\nG21\n",
    lambda tool, speed, at: f"T{tool}\nS{speed} M3\nG54\nG0 {at}\nG0 Z{CLEAR:.1f}\nM8\n",
    "M9\nG0 Z25\nG53 G0 Z0\nM5\n", "M30\n", None,
)  # fmt: skip
POSTS = {
    "fanuc": FANUC,
    "haas": HAAS,
    "linuxcnc": LINUXCNC,
    "fagor8070": FAGOR,
    "sinumerik": SINUMERIK,
    "heidenhain": HEIDENHAIN,
    "grbl": GRBL,
}


def _at(x: float, y: float) -> str:
    return f"X{x:.3f} Y{y:.3f}"


def pocket(rng: np.random.Generator, mill: float, feed: int) -> Iterator[str]:
    """A helix down, then rings outwards, layer by layer."""
    half, step = rng.uniform(mill, 24.0), 0.5 * mill
    radius = 0.4 * mill
    layers, depth = int(rng.integers(1, 4)), rng.uniform(0.5, 2.5)
    yield f"G0 {_at(radius, 0.0)}"
    yield f"G0 Z{NEAR:.3f}"
    for layer in range(1, layers + 1):
        top, bottom = NEAR if layer == 1 else -depth * (layer - 1) + 0.2, -depth * layer
        turns = max(1, math.ceil((top - bottom) / 1.5))
        yield f"G1 Z{top:.3f} F{feed}."
        for turn in range(1, turns + 1):
            z = top + (bottom - top) * turn / turns
            yield f"G3 {_at(radius, 0.0)} Z{z:.3f} I{-radius:.3f} J0. F{feed}."
        yield f"G3 {_at(radius, 0.0)} I{-radius:.3f} J0."
        reach = step
        while True:
            reach = min(reach, half)
            corners = [(reach, -reach), (reach, reach), (-reach, reach), (-reach, -reach)]
            for x, y in [*corners, corners[0]]:
                yield f"G1 {_at(x, y)} F{feed}."
            if reach >= half:
                break
            reach += step
        yield f"G1 {_at(radius, 0.0)}"
    yield f"G0 Z{CLEAR:.3f}"


def contour(rng: np.random.Generator, mill: float, feed: int) -> Iterator[str]:
    """Around the block with round corners, begun beside it."""
    half, round_by = rng.uniform(24.0, 29.0) + 0.5 * mill, rng.uniform(1.0, 6.0) + 0.5 * mill
    out = 30.0 + mill
    z = -rng.uniform(0.8, 2.0)
    for _ in range(int(rng.integers(1, 4))):
        yield f"G0 {_at(-out, -out)}"
        yield f"G0 Z{NEAR:.3f}"
        yield f"G1 Z{z:.3f} F{feed}."
        yield f"G1 {_at(-half, -half + round_by)}"
        inner = half - round_by
        for (x, y), (u, v), (i, j) in (
            ((-half, inner), (-inner, half), (round_by, 0.0)),
            ((inner, half), (half, inner), (0.0, -round_by)),
            ((half, -inner), (inner, -half), (-round_by, 0.0)),
            ((-inner, -half), (-half, -inner), (0.0, round_by)),
        ):
            yield f"G1 {_at(x, y)} F{feed}."
            yield f"G2 {_at(u, v)} I{i:.3f} J{j:.3f}"
        yield f"G1 {_at(-out, -inner)}"
        yield f"G0 Z{CLEAR:.3f}"
        z -= 1.5


def facing(rng: np.random.Generator, mill: float, feed: int) -> Iterator[str]:
    """To and fro over all of the top, from beside it to beside it."""
    z, y, way = -rng.uniform(0.2, 1.0), -30.0, 1.0
    out = 32.0 + 0.5 * mill
    yield f"G0 {_at(-out, y)}"
    yield f"G0 Z{NEAR:.3f}"
    yield f"G1 Z{z:.3f} F{feed}."
    while True:
        yield f"G1 X{way * out:.3f} F{feed}."
        if y >= 30.0:
            break
        y, way = min(30.0, y + 0.7 * mill), -way
        yield f"G1 Y{y:.3f}"
    yield f"G0 Z{CLEAR:.3f}"


def ramp_slot(rng: np.random.Generator, mill: float, feed: int) -> Iterator[str]:
    """A slot that is entered by a ramp."""
    depth, length = rng.uniform(0.1, 0.3) * mill, rng.uniform(10.0, 20.0)
    y = rng.uniform(-15.0, 15.0)
    yield f"G0 {_at(-length, y)}"
    yield f"G0 Z{NEAR:.3f}"
    yield f"G1 Z0.200 F{feed}."
    yield f"G1 X{length:.3f} Z{-depth:.3f} F{feed // 2}."
    yield f"G1 X{-length:.3f} F{feed}."
    yield f"G0 Z{CLEAR:.3f}"


def flats(rng: np.random.Generator, mill: float, feed: int) -> Iterator[str]:
    """Flats around the block, the table indexed between them."""
    count = int(rng.integers(3, 7))
    depth = rng.uniform(0.5, 2.0)
    for index in range(count):
        yield f"G0 C{360.0 * index / count:.3f}"
        yield f"G0 {_at(27.0 + 0.5 * mill, -40.0)}"
        yield f"G0 Z{NEAR:.3f}"
        yield f"G1 Z{-depth:.3f} F{feed}."
        yield f"G1 Y40. F{feed}."
        yield f"G0 Z{CLEAR:.3f}"


MILLING = (pocket, contour, facing, ramp_slot, flats)


def holes(rng: np.random.Generator) -> list[tuple[float, float]]:
    """A circle of holes, or a row of them."""
    if rng.random() < 0.5:
        count, radius = int(rng.integers(2, 7)), rng.uniform(8.0, 22.0)
        angles = [2.0 * math.pi * k / count for k in range(count)]
        return [(radius * math.cos(a), radius * math.sin(a)) for a in angles]
    return [(float(x), 12.0) for x in np.linspace(-20.0, 20.0, int(rng.integers(2, 6)))]


def ordinary(seed: int) -> tuple[str, str, list[str]]:
    """A program, its job, and what it is made of."""
    rng = np.random.default_rng(seed)
    dialect = list(POSTS)[seed % len(POSTS)]
    post = POSTS[dialect]
    mill, drill = float(rng.choice([6.0, 8.0, 10.0, 12.0])), float(rng.choice([3.0, 5.0, 6.8]))
    teeth = int(rng.integers(2, 5))
    made = [
        MILLING[int(k)] for k in rng.choice(len(MILLING), int(rng.integers(1, 3)), replace=False)
    ]
    text, names = post.head, [dialect]
    for feature in made:
        if feature is flats and dialect == "grbl":
            feature = contour  # it turns no table
        big = feature is facing and post.drill is not None and rng.random() < 0.5
        tool, diameter = (3, 16.0) if big else (1, mill)
        number = 4 if big else teeth
        speed = min(10000, round(1e5 / diameter / 10) * 10)
        feed = round(speed * number * float(rng.uniform(0.02, 0.05)))
        lines = list(feature(rng, diameter, feed))
        first = next(line for line in lines if "X" in line).partition("X")[2]
        spelt = "\n".join(post.spelt(lines))
        text += post.change(tool, speed, "X" + first) + spelt + "\n" + post.lift
        names.append(feature.__name__)
    if post.drill is not None and rng.random() < 0.6:
        places, depth = holes(rng), float(rng.uniform(4.0, 12.0))
        text += post.change(2, 2500, _at(*places[0]))
        text += "\n".join(post.drill(places, depth, 200)) + "\n" + post.lift
        names.append("holes")
    stock = f'shape = "box"\nsize = {list(SIZE)}'
    if rng.random() < 0.3:
        stock = 'shape = "cylinder"\ndiameter = 60.0\nheight = 20.0'
    job = JOB.format(dialect=dialect, stock=stock, mill=mill, teeth=teeth, drill=drill)
    return text + post.end, job, names
