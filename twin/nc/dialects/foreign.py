"""Files that no dialect here can read: their likely kind, and what to do with them.

``foreign.toml`` lists them. Libraries that tell files by their first bytes (libmagic, puremagic) or languages by
files' names (Pygments) know none of the controls, and take what NC programs end in for other things: ``.nc`` for
nesC, ``.h`` for C alone.
"""

import codecs
import re
import tomllib
from collections.abc import Mapping, Sequence
from functools import cache
from itertools import islice
from pathlib import Path
from typing import NamedTuple

import pydantic

from twin.errors import UsageError
from twin.nc.text.source import LEADER


class _ForeignKind(pydantic.BaseModel):
    model_config = pydantic.ConfigDict(extra="forbid", frozen=True)

    name: str
    """What the file looks to be."""
    advice: str
    """What to do with it, a key of ``[advice]``."""


class BinaryKind(_ForeignKind):
    """A file that is no text, by bytes that are written as the characters of Latin 1."""

    begins: str
    """Its first bytes."""
    at: int = 0
    """So many bytes stand before them."""
    holds: str = ""
    """Further bytes, anywhere in its head."""


class TextKind(_ForeignKind):
    """A text, by what its lines hold."""

    pattern: str
    """Regular expression."""
    least: int = 1
    """How many matches there must be."""
    comments: bool = False
    """Comments are looked at too."""


class ForeignFiles(pydantic.BaseModel):
    """Kinds of files, in the order in which they are looked for."""

    model_config = pydantic.ConfigDict(extra="forbid", frozen=True)

    advice: Mapping[str, str]
    """What to do, by key."""
    binary: Sequence[BinaryKind]
    program: Sequence[TextKind]
    """Programs of other controls, looked for in every text."""
    text: Sequence[TextKind]
    """Looked for in a text whose lines do not begin as blocks do."""
    control: Sequence[TextKind]
    """What comments at a program's head call its control or its post."""
    suffixes: Mapping[str, str]
    """What a text without blocks is by the end of its file's name."""


class Foreign(NamedTuple):
    """What a file looks to be, and what to do with it."""

    name: str
    advice: str


HEAD = 200_000
"""Bytes of a file that are looked at."""
_CONTROL_CHARACTERS = [bytes([each]) for each in range(32) if each not in b"\t\n\v\f\r"]
_MOST_CONTROL_CHARACTERS = 0.05
"""Share beyond which a file is no text."""
_FEW_CONTROL_CHARACTERS = 3
"""So many are damage."""
_SHARE_OF_BLOCKS = 0.5
"""Where fewer lines begin as blocks do, a text may be of another kind."""
_LEAST_BLOCKS = 0.2
"""Where fewer do, a text is no program."""
_FEW_LINES = 3
"""A text of fewer lines may be a program with a slip."""
_COMMENTS = re.compile(r"\([^()\n]*\)|[;\"].*|^%.*", re.MULTILINE)
_WORD = r"(?:[A-Z][ \t]*[-+]?[ \t]*[.\d#\[]|[A-Z]\d*[ \t]*=)"
_BLOCK = re.compile(
    rf"[/:]?[ \t]*(?:{_WORD}|[%:]\d|\d+[ \t]*(?:{_WORD}|[A-Z]{{2,}}\b)|#[\d<\[]|\$[\dA-Z#$]?(?:=|$)|[O@^][\d<]|FN ?\d)",
    re.IGNORECASE,
)
"""The beginning of a block."""
_FIRST_NAME = re.compile(r"/?[ \t]*(?:\d+[ \t]*)?/?([#$]?[A-Z_]*\d*)")
_SYMBOLS = re.compile(r"[(){}\[\]=<>_;*/\\|&$#@~^]")
_SHARE_OF_SYMBOLS = 0.03
"""Prose has fewer of them."""
_SETTING = re.compile(r"\s*(?:\[[^\]]+\]$|[\w.\-/\"]+\s*(?::(?:\s|$)|=))")
_SHARE_OF_SETTINGS = 0.6
_LINES_OF_TABLE = 20
_WORDS_OF_PROSE = re.compile(r"[^\W\d_]{3,}")
_FEW_WORDS = 5


@cache
def foreign_files() -> ForeignFiles:
    """All kinds."""
    file = Path(__file__).with_name("foreign.toml")
    return ForeignFiles.model_validate(tomllib.loads(file.read_text(encoding="utf-8")))


def require_text(path: Path) -> None:
    """Refuse a file that is no text.

    Raises:
        UsageError: It cannot be read, or is none; the message says what it looks to be and what to do.
    """
    _refuse(path, binary_kind(_head_of(path)))


def require_program(path: Path) -> None:
    """Refuse a file that is no NC program, or one of a control that is not known here.

    Raises:
        UsageError: It is; the message says what it looks to be and what to do.
    """
    _refuse(path, foreign_kind(_head_of(path), path.name))


def _head_of(path: Path) -> bytes:
    try:
        with path.open("rb") as file:
            return file.read(HEAD)
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror}") from error


def _refuse(path: Path, found: Foreign | None) -> None:
    if found is not None:
        raise UsageError(f"{path}: looks like {found.name}: {found.advice}")


def foreign_kind(data: bytes, name: str = "") -> Foreign | None:
    """What the bytes of a file look to be, by its name too; None: they may be a program."""
    binary = binary_kind(data)
    if binary is not None:
        return binary
    kinds = foreign_files()
    text = _decoded(data)
    blocks = _COMMENTS.sub("", text)
    found = _first(kinds.program, text, blocks)
    lines = [line for line in map(str.strip, blocks.split("\n")) if line]
    if found is not None or not lines:
        return found
    share = sum(map(_begins_block, lines)) / len(lines)
    if share < _SHARE_OF_BLOCKS:
        found = _first(kinds.text, text, text)
    if found is None and share < _LEAST_BLOCKS and _may_be_told(name, len(lines)):
        found = _kind_without_blocks(name, text)
    return found


def _kind_without_blocks(name: str, text: str) -> Foreign:
    """What a text looks to be that holds hardly a block and is of none of the kinds."""
    advice = foreign_files().advice
    lines = [line for line in text.split("\n") if line.strip()]
    named = foreign_files().suffixes.get(Path(name).suffix.lower())
    if named:
        return Foreign(f"{named}, by its name", advice["blocks"])
    if _is_table(lines):
        return Foreign("a table of values", advice["blocks"])
    if sum(_SETTING.match(line) is not None for line in lines) > _SHARE_OF_SETTINGS * len(lines):
        return Foreign("a file of settings", advice["settings"])
    if len(_SYMBOLS.findall(text)) > _SHARE_OF_SYMBOLS * len(text):
        return Foreign("source code", advice["code"])
    if is_prose(text):
        return Foreign("prose", advice["blocks"])
    return Foreign("a text without blocks", advice["blocks"])


def binary_kind(data: bytes) -> Foreign | None:
    """What the bytes of a file that is no text look to be; None: they are text."""
    kinds = foreign_files()
    for kind in kinds.binary:
        begins, holds = kind.begins.encode("latin-1"), kind.holds.encode("latin-1")
        if data.startswith(begins, kind.at) and holds in data:
            return Foreign(kind.name, kinds.advice[kind.advice])
    if _is_binary_stl(data):
        return Foreign("an STL shape", kinds.advice["shape"])
    wide = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
    if data.startswith(wide) or _is_wide(data):
        return Foreign("a text in UTF-16", kinds.advice["utf8"])
    body = data.strip(LEADER)
    controls = sum(body.count(byte) for byte in _CONTROL_CHARACTERS)
    if controls > max(_FEW_CONTROL_CHARACTERS, _MOST_CONTROL_CHARACTERS * len(body)):
        return Foreign("a binary file", kinds.advice["picture"])
    return None


def is_prose(text: str) -> bool:
    """Whether a text holds many words and hardly any addresses with numbers."""
    blocks = _COMMENTS.sub("", text)
    words = len(_WORDS_OF_PROSE.findall(blocks))
    numbers = len(re.findall(r"[A-Z] *[-+]?\.?\d", blocks, re.IGNORECASE))
    return words > _FEW_WORDS and words > 2 * numbers


def control_of_head(comments: str) -> Foreign | None:
    """What the comments at a program's head call its control, where that is none of the dialects."""
    kinds = foreign_files()
    for kind in kinds.control:
        if re.search(kind.pattern, comments, re.IGNORECASE):
            return Foreign(kind.name, kinds.advice[kind.advice])
    return None


def _decoded(data: bytes) -> str:
    for encoding in ("utf-8", "cp1252", "latin-1"):
        try:
            text = data.decode(encoding)
            break
        except UnicodeDecodeError:
            continue
    else:
        text = ""
    return text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")


def _first(kinds: Sequence[TextKind], text: str, blocks: str) -> Foreign | None:
    """The first kind that fits a text, which is given without its comments too."""
    for kind in kinds:
        matches = re.finditer(kind.pattern, text if kind.comments else blocks)
        if len(list(islice(matches, kind.least))) == kind.least:
            return Foreign(kind.name, foreign_files().advice[kind.advice])
    return None


@cache
def _statements() -> frozenset[str]:
    from twin.nc.dialects import OWN

    return frozenset(
        word.split()[0]
        for dialect in OWN.values()
        for word in (*dialect.keywords, *dialect.syntax.codes)
    )


def _may_be_told(name: str, lines: int) -> bool:
    """Whether a text without blocks is no program with a slip, by its length and the end of its name."""
    from twin.nc.dialects import OWN

    suffix = Path(name).suffix.lower()
    own = any(suffix in dialect.suffixes for dialect in OWN.values())
    listed = suffix in foreign_files().suffixes
    return (listed and not own) or (lines >= _FEW_LINES and (listed or not own))


def _begins_block(line: str) -> bool:
    """Whether a line without comments begins as a block or a statement of any dialect does."""
    name = _FIRST_NAME.match(line)
    return _BLOCK.match(line) is not None or (name is not None and name[1] in _statements())


def _is_table(lines: Sequence[str]) -> bool:
    """Whether all lines have as many fields as the first one."""
    head = lines[:_LINES_OF_TABLE]
    return len(head) > 1 and any(
        head[0].count(mark) and len({line.count(mark) for line in head}) == 1 for mark in ",;\t"
    )


def _is_wide(data: bytes) -> bool:
    """Whether every second byte is NUL, as in UTF-16 without a mark."""
    head = data[:200]
    return len(head) > 8 and any(
        half.count(0) > 0.9 * len(half) and rest.count(0) < 0.1 * len(rest)
        for half, rest in ((head[::2], head[1::2]), (head[1::2], head[::2]))
    )


def _is_binary_stl(data: bytes) -> bool:
    """Eighty bytes of heading, the number of triangles, fifty bytes for each."""
    if len(data) < 84 or b"\0" not in data[:200]:
        return False
    count = int.from_bytes(data[80:84], "little")
    if len(data) < HEAD:
        return count > 0 and 84 + 50 * count == len(data)
    # Behind each triangle is a number of further bytes, which is 0.
    return 84 + 50 * count >= HEAD and not any(data[84 + 48 : HEAD - 1 : 50])
