"""The bytes of a program, as lines of text with the name that the user gave them."""

import dataclasses
import hashlib
import itertools
from collections.abc import Iterable, Iterator
from pathlib import Path

from twin.errors import UsageError
from twin.nc.text.lines import PAGE, SURROGATES, Lines
from twin.nc.text.syntax import Language

LEADER = b"\0\x7f\x11\x12\x13\x14"
"""What a DNC link sends before and behind a program: blank tape, deleted characters, DC1 to DC4."""


@dataclasses.dataclass(frozen=True, slots=True)
class Source:
    """A program that was read.

    Attributes:
        name: The file as the user named it.
        sha256: Digest of its bytes, without those of further files.
        parts: Further files whose lines follow: number of the first line, from 1, and name.
    """

    name: str
    lines: Lines
    sha256: str
    parts: tuple[tuple[int, str], ...] = ()

    def place(self, line: int) -> tuple[str, int]:
        """The file that a line is in, and its number there, from 1."""
        name, first = self.name, 1
        for begin, part in self.parts:
            if line >= begin:
                name, first = part, begin
        return name, line - first + 1

    def followed_by(self, line: str, other: "Source") -> "Source":
        """The program with a line of text and another file behind it."""

        def texts() -> Iterator[bytes]:
            last = b"\n"
            for page in self.lines.pages():
                yield page.text
                last = page.text
            if not last.endswith((b"\n", b"\r")):
                yield b"\n"
            yield f"{line}\n".encode()

        first = len(Lines(texts())) + 1
        lines = Lines(itertools.chain(texts(), (page.text for page in other.lines.pages())))
        return dataclasses.replace(self, lines=lines, parts=(*self.parts, (first, other.name)))

    @property
    def text(self) -> str:
        """All lines, ended by newlines."""
        return "".join(page.joined for page in self.lines.pages())


def read_source(path: Path, dialect: Language | None = None) -> Source:
    """Read a program as UTF-8, else in the legacy code page of its dialect, if that is known, else byte by byte."""
    try:
        with path.open("rb") as file:
            return source_from_pieces(iter(lambda: file.read(PAGE), b""), str(path), dialect)
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror}") from error


def source_from_text(text: str, name: str = "program") -> Source:
    """Make a source of text, for tests and programs that are made on the fly."""
    data = text.encode("utf-8", SURROGATES)
    return Source(name, Lines([data]), hashlib.sha256(data).hexdigest())


def source_from_pieces(
    pieces: Iterable[bytes], name: str, dialect: Language | None = None
) -> Source:
    """Make a source of the bytes of a file, piece by piece; encodings as in ``read_source``."""
    digest = hashlib.sha256()

    def seen() -> Iterator[bytes]:
        for piece in pieces:
            digest.update(piece)
            yield piece

    def tape() -> Iterator[bytes]:
        """Without the leader and the trailer of the tape; a tape of nothing else stays as a NUL."""
        begun, blanks, any_piece = False, b"", False
        for piece in seen():
            any_piece = any_piece or bool(piece)
            whole = (blanks + piece) if begun else piece.lstrip(LEADER)
            text = whole.rstrip(LEADER)
            blanks = whole[len(text) :]
            begun = begun or bool(text)
            if text:
                yield text
        if not begun and any_piece:
            yield b"\0"

    encodings = ("utf-8",) if dialect is None else ("utf-8", dialect.code_page)
    lines = Lines(tape(), encodings)
    return Source(name, lines, digest.hexdigest())
