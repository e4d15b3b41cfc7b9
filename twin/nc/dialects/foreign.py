"""Files that no dialect here can read: what each looks to be, and what to do with it."""

import codecs
import re
from itertools import islice
from pathlib import Path
from typing import NamedTuple

from twin.errors import UsageError
from twin.nc.text.source import LEADER


class Foreign(NamedTuple):
    """One kind of file.

    Attributes:
        pattern: What its bytes or lines hold; several lines may match.
        least: How many matches there must be.
        comments: Comments are looked at too.
    """

    name: str
    advice: str
    pattern: str
    least: int = 1
    comments: bool = False


_CONTROLS = [bytes([each]) for each in range(32) if each not in b"\t\n\v\f\r"]
_MOST_CONTROLS = 0.05
"""Share of control characters beyond which a file is no text."""
_FEW_CONTROLS = 3
"""So many are damage."""
HEAD = 200_000
"""Bytes of a file that are looked at."""

_POST = "post the part again for one of: twin dialects"
_MODEL = "it is a shape, not a program: make toolpaths in CAM and post them"
_AS_LINUXCNC = "its moves are a part of LinuxCNC's language: --dialect linuxcnc reads it so"

_ROBOT = "the machines here are mills"

BINARY: tuple[tuple[bytes, str, str], ...] = (
    (b"%PDF-", "a PDF document", "save the program itself, as text"),
    (b"PK\x03\x04", "a zip archive, or a file of an office or CAM program", "unpack it first"),
    (b"\x1f\x8b", "a gzip archive", "unpack it first"),
    (b"\x89PNG", "a PNG picture", "an NC program is text"),
    (b"\xff\xd8\xff", "a JPEG picture", "an NC program is text"),
    (b"GIF8", "a GIF picture", "an NC program is text"),
    (b"BM", "a BMP picture", "an NC program is text"),
    (b"\xd0\xcf\x11\xe0", "a document of an older office or CAD program", "an NC program is text"),
    (b"AC10", "a DWG drawing", _MODEL),
    (b"\x7fELF", "a program for Linux", "an NC program is text"),
    (b"MZ", "a program for Windows", "an NC program is text"),
    (b"SQLite format 3", "a database", "an NC program is text"),
)
"""First bytes, what such a file is, what to do."""

TEXTS: tuple[Foreign, ...] = (
    Foreign(
        "a STEP-NC file (ISO 14649, AP 238)",
        _POST,
        r"(?s)\AISO-10303-21;.*?(?:STEP_NC|AP238|INTEGRATED_CNC|MACHINING_WORKINGSTEP)",
        comments=True,
    ),
    Foreign("a STEP file", _MODEL, r"\AISO-10303-21;", comments=True),
    Foreign("an IGES file", _MODEL, r"\A.{72}S {6}1", comments=True),
    Foreign("a DXF drawing", _MODEL, r"\A\s*(?:999\n.*\n\s*)?0\nSECTION\b", comments=True),
    Foreign("an STL shape", _MODEL, r"\A\s*solid\b[^\n]*\n\s*facet normal", comments=True),
    Foreign("an OBJ or a PLY shape", _MODEL, r"(?m)\Aply$|^v (?:-?[\d.]+ ?){3}$", comments=True),
    Foreign(
        "an SVG drawing",
        _MODEL,
        r"(?i)\A\s*(?:<\?xml[^>]*>\s*)?(?:<!--.*?-->\s*)?<svg\b",
        comments=True,
    ),
    Foreign(
        "a web page",
        "save the program itself, as text",
        r"(?i)\A\s*<(?:!doctype html|html)\b",
        comments=True,
    ),
    Foreign("an XML file", "an NC program is text of blocks", r"\A\s*<\?xml\b", comments=True),
    Foreign(
        "an APT or CL file (ISO 4343)", _POST, r"(?m)^[ \t]*(?:GOTO\s*/|FEDRAT\s*/|PARTNO\b)", 2
    ),
    Foreign("an HP-GL plot", _MODEL, r"(?:\bP[UD](?:-?\d+,-?\d+)?;){2}", comments=True),
    Foreign("an RML plot, for a Roland", _MODEL, r"\^(?:IN|PA|PR|DF);", 2, comments=True),
    Foreign(
        "a post processor, and no program",
        "post a part by it in CAM",
        r"(?m)^vendor = \"|^POST_NAME ?= ?\"|^function onOpen\(",
        comments=True,
    ),
    Foreign(
        "a list of a Fanuc control's parameters",
        "it holds no moves",
        r"(?m)^N\d{4,5}(?:Q\d)?(?:[AL]\d)?P-?\d",
        2,
    ),
    Foreign(
        "a table of a Heidenhain control",
        "it holds no moves",
        r"\ABEGIN +\S+ *\.[A-Z]+ +(?:MM|INCH)",
    ),
    Foreign(
        "a program for a Philips or Maho control",
        _POST,
        r"(?m)^%(?:PM|MM)[ \t]*$|\bN1=\d+ +N2=\d+|\(\s*(?:PHILIPS|MAHO)\b",
        comments=True,
    ),
    Foreign(
        "a program for a SINUMERIK before the 840D",
        _POST,
        r"(?m)^[ \t]*(?:N\d+ *)?@\d{2,3}\b|\bSINUMERIK *8(?:05|10|20|50|80)(?![D\d])",
        comments=True,
    ),
    Foreign(
        "a program for a NUM", _POST, r"(?m)^[ \t]*(?:N\d+ *)?E[3-9]\d{4} *=|\bG77 *N\d+ *N\d+"
    ),
    Foreign(
        "a Heidenhain program in DIN/ISO",
        "post it as Klartext (.h), which --dialect heidenhain reads",
        r"(?m)^[ \t]*%\S+[ \t]+G7[01][ \t]*\*",
        comments=True,
    ),
    Foreign(
        "a Mazatrol program",
        _POST,
        r"(?im)^[ \t]*UNo\.?\s|\bMAZATROL\b|^[ \t]*UNIT +NO|\bWPC-\d",
    ),
    Foreign(
        "a program for an Okuma (OSP)",
        _POST,
        r"(?m)^\$[A-Z0-9_-]+\.(?:MIN|SUB|SSB)%|\bCALL +O[A-Z0-9]+|\bVC\d+ ?=|\bG15 *H\d+|\bG56 *H\d+"
        r"|\bMODIN\b|\bNCYL\b|\bVZOF[XYZ]",
    ),
    Foreign(
        "a program for Marlin, a 3D printer's control",
        "post it for one of: twin dialects",
        r"(?m)^[ \t]*;\s*FLAVOR:|^[ \t]*;\s*(?:generated (?:by|with) )?(?:PrusaSlicer|Cura_SteamEngine|Slic3r|Marlin)"
        r"|^[ \t]*M(?:10[49]|140|190|106) ?[ST]\d|^[ \t]*M20[45] ?[SPTXYZ]|^[ \t]*M(?:8[23]|107|400|420) *(?:;|$)"
        r"|^[ \t]*M(?:18|84|280|300)\b(?! *[A-RT-Z])",
        2,
        comments=True,
    ),
    Foreign(
        "a program for TinyG or g2core",
        _AS_LINUXCNC,
        r"(?m)^[ \t]*\{\"?(?:sr|qr|xvm|gc|sys)\"?\s*:",
        comments=True,
    ),
    Foreign(
        "a program for Mach3 or Mach4",
        "write G20 for G70, G21 for G71, leave G50 out, and --dialect linuxcnc reads it",
        r"(?s)G9[01]\.1.{0,200}?G(?:50|7[01])(?![0-9.])|G(?:50|7[01])(?![0-9.]).{0,200}?G9[01]\.1",
    ),
    Foreign(
        "a program for a lathe",
        "the machines here are mills",
        r"(?m)^[^(\n]*G28 *[UW]-?0|G96(?!\d)|G50 *S\d|(?<![A-Z])T(\d\d)\1(?!\d)",
        2,
    ),
    Foreign("a list of Grbl's settings", "it holds no moves", r"(?m)^\$\d+ ?= ?[\d.]+", 3),
    Foreign(
        "a program for a Brother Speedio",
        "write G100 T as T, G43 H and M6, or post it for fanuc",
        r"(?m)^(?:N\d+ *)?G100 *T\d+",
    ),
    Foreign(
        "a drill file of a circuit board (Excellon)",
        "make a program of it by the CAM of circuit boards",
        r"(?m)^M48[ \t]*$|^T\d+(?:F\d+S\d+)?C[\d.]+",
        2,
        comments=True,
    ),
    Foreign(
        "a picture of a circuit board (Gerber)",
        "make a program of it by the CAM of circuit boards",
        r"%FS[LTD]?[AI]X\d\dY\d\d|%MO(?:MM|IN)\*%",
        comments=True,
    ),
    Foreign(
        "a program for a robot (Fanuc TP)",
        _ROBOT,
        r"(?m)^/(?:PROG|MN|POS|ATTR)\b",
        2,
        comments=True,
    ),
    Foreign(
        "a program for a robot (KUKA KRL)",
        _ROBOT,
        r"(?m)^[ \t]*(?:&ACCESS|DEF \w+ ?\(|(?:PTP|LIN|CIRC) +\{)",
        2,
        comments=True,
    ),
    Foreign(
        "a program for a robot (ABB RAPID)",
        _ROBOT,
        r"(?im)^[ \t]*(?:MODULE \w+|PROC \w+\(|Move[JLC] )",
        2,
        comments=True,
    ),
    Foreign(
        "a Python program", "an NC program is text of blocks", r"(?m)^(?:import \w+|def \w+\()", 1
    ),
    Foreign(
        "a JSON file", "an NC program is text of blocks", r"\A\s*[\[{]\s*[\"{\[]", comments=True
    ),
    Foreign(
        "a MATLAB program",
        "an NC program is text of blocks",
        r"(?m)^[ \t]*function\b[^\n;]*\)[ \t]*;?[ \t]*$",
        comments=True,
    ),
    Foreign(
        "a file of settings",
        "an NC program is text of blocks",
        r"(?m)^\[{1,2}[A-Za-z][\w.\- ]*\]{1,2}[ \t]*$|^[\w-]+:[ \t]*$",
    ),
    Foreign("a C program", "an NC program is text of blocks", r"(?m)^#include *[<\"]"),
    Foreign(
        "a table of values",
        "an NC program is text of blocks",
        r"\A(?:[\w .]+[,;\t]){2,}[\w .]+\r?\n(?:-?[\d.]+[,;\t])+",
    ),
)
"""Texts of other controls and other kinds, in the order in which they are looked for."""

CONTROLS: tuple[tuple[str, str, str], ...] = (
    (
        r"mazak|mazatrol",
        "a program for a Mazak (EIA)",
        f"{_POST}; where it is plain ISO: --dialect fanuc",
    ),
    (r"okuma|\bosp\b", "a program for an Okuma (OSP)", _POST),
    (
        r"mitsubishi|meldas|\bm70\b|\bm80\b",
        "a program for a Mitsubishi control",
        f"{_POST}; where it is plain ISO: --dialect fanuc",
    ),
    (r"\bmach ?[234]\b|mach2/3|mach3mill", "a program for Mach3 or Mach4", _AS_LINUXCNC),
    (r"\bmarlin\b|reprap|smoothie", "a program for Marlin or a control like it", _AS_LINUXCNC),
    (
        r"\bbrother\b|speedio",
        "a program for a Brother",
        f"{_POST}; where it is plain ISO: --dialect fanuc",
    ),
    (r"\bhurco\b", "a program for a Hurco", f"{_POST}; where it is plain ISO: --dialect fanuc"),
    (r"\bfadal\b", "a program for a Fadal", f"{_POST}; where it is plain ISO: --dialect fanuc"),
    (
        r"\bcentroid\b|\bacorn\b",
        "a program for a Centroid",
        f"{_POST}; where it is plain ISO: --dialect fanuc",
    ),
    (r"\buccnc\b|eding ?cnc|planet ?cnc|\bddcs", "a program for a hobby control", _AS_LINUXCNC),
)
"""What comments at a program's head call its control or its post, what the file then is, what to do."""

_NUMBERS = re.compile(r"[A-Z] *[-+]?\.?\d", re.IGNORECASE)
_WORDS_OF_PROSE = re.compile(r"[^\W\d_]{3,}")
_COMMENTS = re.compile(r"\([^()\n]*\)|[;\"].*|^%.*", re.MULTILINE)


def require_program(path: Path) -> None:
    """Refuse a file that is no NC program, or one of a control that is not known here.

    Raises:
        UsageError: It is; the message says what it looks to be and what to do.
    """
    try:
        with path.open("rb") as file:
            data = file.read(HEAD)
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror}") from error
    found = foreign_kind(data)
    if found is not None:
        raise UsageError(f"{path}: looks like {found[0]}: {found[1]}")


def foreign_kind(data: bytes) -> tuple[str, str] | None:
    """What the bytes of a file look to be, and what to do; None: they may be a program."""
    for magic, name, advice in BINARY:
        if data.startswith(magic):
            return name, advice
    if _is_binary_stl(data):
        return "an STL shape", _MODEL
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return "a text in UTF-16", "save it as UTF-8"
    body = data.strip(LEADER)
    controls = sum(body.count(byte) for byte in _CONTROLS)
    if controls > max(_FEW_CONTROLS, _MOST_CONTROLS * len(body)):
        return "a binary file", "an NC program is text"
    for encoding in ("utf-8", "cp1252", "latin-1"):
        try:
            text = data.decode(encoding)
            break
        except UnicodeDecodeError:
            continue
    else:
        text = ""
    text = text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")
    blocks = _COMMENTS.sub("", text)
    for kind in TEXTS:
        matches = re.finditer(kind.pattern, text if kind.comments else blocks)
        if len(list(islice(matches, kind.least))) == kind.least:
            return kind.name, kind.advice
    return None


def is_prose(text: str) -> bool:
    """Whether a text holds many words and hardly any addresses with numbers."""
    blocks = _COMMENTS.sub("", text)
    words, numbers = len(_WORDS_OF_PROSE.findall(blocks)), len(_NUMBERS.findall(blocks))
    return words > 5 and words > 2 * numbers


def control_of_head(comments: str) -> tuple[str, str] | None:
    """What the comments at a program's head call its control, where that is none of the dialects."""
    for pattern, name, advice in CONTROLS:
        if re.search(pattern, comments, re.IGNORECASE):
            return name, advice
    return None


def _is_binary_stl(data: bytes) -> bool:
    """Eighty bytes of heading, the number of triangles, fifty bytes for each."""
    if len(data) < 84 or b"\0" not in data[:200]:
        return False
    count = int.from_bytes(data[80:84], "little")
    if len(data) < HEAD:
        return count > 0 and 84 + 50 * count == len(data)
    # Behind each triangle is a number of further bytes, which is 0.
    return 84 + 50 * count >= HEAD and not any(data[84 + 48 : HEAD - 1 : 50])
