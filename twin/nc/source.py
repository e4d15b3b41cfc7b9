"""The bytes of a program, as lines of text with the name that the user gave them."""

import dataclasses
import hashlib
import re
from pathlib import Path
from typing import Protocol

from twin.errors import UsageError

_LINE_END = re.compile("\r\n|\n|\r")
_FALLBACK = "latin-1"
"""Decodes any byte; used where a file is neither UTF-8 nor in the dialect's own code page."""


class HasCodePage(Protocol):
    """What reading needs to know of a dialect."""

    @property
    def code_page(self) -> str:
        """Legacy code page of its programs, such as ``cp1251``."""
        ...


@dataclasses.dataclass(frozen=True, slots=True)
class Source:
    """A program that was read.

    Attributes:
        name: The file as the user named it.
        lines: Its lines without their ends.
        sha256: Digest of its bytes.
    """

    name: str
    lines: tuple[str, ...]
    sha256: str

    @property
    def text(self) -> str:
        """All lines, joined by newlines."""
        return "\n".join(self.lines)


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
    return _source(_decoded(data, dialect), name, hashlib.sha256(data).hexdigest())


def source_from_text(text: str, name: str = "program") -> Source:
    """Make a source of text, for tests and programs that are made on the fly."""
    digest = hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()
    return _source(text, name, digest)


def _source(text: str, name: str, digest: str) -> Source:
    lines = _LINE_END.split(text)
    if lines[-1] == "":
        lines.pop()
    return Source(name, tuple(lines), digest)


def _decoded(data: bytes, dialect: HasCodePage | None) -> str:
    encodings = ("utf-8-sig",) if dialect is None else ("utf-8-sig", dialect.code_page)
    for encoding in encodings:
        try:
            return data.decode(encoding)
        except UnicodeDecodeError:
            continue
    return data.decode(_FALLBACK)
