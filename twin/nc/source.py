"""The bytes of a program, as lines of text with the name that the user gave them."""

import dataclasses
import hashlib
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Protocol, overload

import numpy as np
import numpy.typing as npt

from twin.errors import UsageError

_FALLBACK = "latin-1"
"""Decodes any byte; used where a file is neither UTF-8 nor in the dialect's own code page."""


class HasCodePage(Protocol):
    """What reading needs to know of a dialect."""

    @property
    def code_page(self) -> str:
        """Legacy code page of its programs, such as ``cp1251``."""
        ...


_SURROGATES = "surrogatepass"
"""Text that is made on the fly may hold what no file can."""
_BLOCK = 1 << 20
"""Bytes that are searched for line ends at a time."""
_LINE_FEED, _RETURN = 10, 13


class Lines(Sequence[str]):
    """The lines of a program without their ends: kept as bytes, decoded when they are asked for.

    Attributes:
        data: The whole program as UTF-8, read-only.
        starts: Where each line begins, and where the last one ends, shape (n + 1,).
    """

    def __init__(self, text: bytes) -> None:
        self._text = text
        self.data = np.frombuffer(text, np.uint8)
        self.starts = _line_starts(self.data)
        self._count = len(self.starts) - 1

    def __len__(self) -> int:
        return self._count

    @overload
    def __getitem__(self, index: int) -> str: ...
    @overload
    def __getitem__(self, index: slice) -> list[str]: ...
    def __getitem__(self, index: int | slice) -> str | list[str]:
        if isinstance(index, slice):
            return [self[each] for each in range(*index.indices(len(self)))]
        if not -len(self) <= index < len(self):
            raise IndexError(index)
        begin = index % len(self)
        line = self.data[self.starts[begin] : self.starts[begin + 1]].tobytes()
        return line.removesuffix(b"\n").removesuffix(b"\r").decode("utf-8", _SURROGATES)

    def __iter__(self) -> Iterator[str]:
        return (self[index] for index in range(len(self)))

    def any_holds(self, pattern: re.Pattern[bytes]) -> bool:
        """Whether a pattern, which must not match line ends, stands in any line."""
        return pattern.search(self._text) is not None

    def holding(self, mark: str) -> Iterator[tuple[int, str]]:
        """The lines in which a text stands, with their numbers from 0."""
        wanted, at = mark.encode("utf-8", _SURROGATES), 0
        while (at := self._text.find(wanted, at)) >= 0:
            index = int(np.searchsorted(self.starts, at, side="right")) - 1
            yield index, self[index]
            at = int(self.starts[index + 1])


def _line_starts(data: npt.NDArray[np.uint8]) -> npt.NDArray[np.signedinteger]:
    """Where lines begin that end with LF, CR or CR LF; the text behind the last end is a line."""
    # Of millions of lines, half the memory.
    kind = np.int32 if len(data) <= np.iinfo(np.int32).max else np.int64
    found: list[npt.NDArray[np.signedinteger]] = [np.zeros(1, kind)]
    for begin in range(0, len(data), _BLOCK):
        # One byte more, so that a CR at the border sees the LF behind it.
        block = data[begin : begin + _BLOCK + 1]
        feed = block == _LINE_FEED
        ends = feed | (block == _RETURN)
        ends[:-1] &= ~((block[:-1] == _RETURN) & feed[1:])
        found.append((np.flatnonzero(ends[:_BLOCK]) + (begin + 1)).astype(kind))
    starts = np.concatenate(found)
    end = np.array([len(data)], kind)
    return starts if starts[-1] == len(data) else np.concatenate([starts, end])


@dataclasses.dataclass(frozen=True, slots=True)
class Source:
    """A program that was read.

    Attributes:
        name: The file as the user named it.
        lines: Its lines without their ends.
        sha256: Digest of its bytes, without those of further files.
        parts: Further files whose lines follow: number of the first line, from 1, and name.
    """

    name: str
    lines: Lines
    sha256: str
    parts: tuple[tuple[int, str], ...] = ()

    def place(self, line: int) -> tuple[str, int]:
        """The file that a line stands in, and its number there, from 1."""
        name, first = self.name, 1
        for begin, part in self.parts:
            if line >= begin:
                name, first = part, begin
        return name, line - first + 1

    def followed_by(self, line: str, other: "Source") -> "Source":
        """The program with a line of text and another file behind it."""
        data = self.lines.data.tobytes()
        if data and not data.endswith((b"\n", b"\r")):
            data += b"\n"
        data += f"{line}\n".encode()
        first = len(Lines(data)) + 1
        lines = Lines(data + other.lines.data.tobytes())
        return dataclasses.replace(self, lines=lines, parts=(*self.parts, (first, other.name)))

    @property
    def text(self) -> str:
        """All lines, ended by newlines."""
        text = self.lines.data.tobytes().decode("utf-8", _SURROGATES)
        return text.replace("\r\n", "\n").replace("\r", "\n")


def read_source(path: Path, dialect: HasCodePage | None = None) -> Source:
    """Read a program as UTF-8, else in the dialect's legacy code page, else byte by byte.

    Args:
        path: The file.
        dialect: Whose legacy code page it may be in; None when that is not known.

    Raises:
        UsageError: The file cannot be read.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror}") from error
    return source_from_bytes(data, str(path), dialect)


def source_from_bytes(data: bytes, name: str, dialect: HasCodePage | None = None) -> Source:
    """Make a source of bytes that need not come from a file; arguments as in ``read_source``."""
    return Source(name, Lines(_as_utf8(data, dialect)), hashlib.sha256(data).hexdigest())


def source_from_text(text: str, name: str = "program") -> Source:
    """Make a source of text, for tests and programs that are made on the fly."""
    data = text.encode("utf-8", _SURROGATES)
    return Source(name, Lines(data), hashlib.sha256(data).hexdigest())


def _as_utf8(data: bytes, dialect: HasCodePage | None) -> bytes:
    if data.isascii():
        return data
    encodings = ("utf-8-sig",) if dialect is None else ("utf-8-sig", dialect.code_page)
    for encoding in encodings:
        try:
            return data.decode(encoding).encode("utf-8")
        except UnicodeDecodeError:
            continue
    return data.decode(_FALLBACK).encode("utf-8")
