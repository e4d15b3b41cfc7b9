"""The text of a log, a piece at a time: a log of an hour is far larger than what is wanted of it."""

import codecs
from collections.abc import Iterator
from pathlib import Path

from twin.errors import UsageError

_PIECE = 1 << 21
"""Bytes that are read at a time."""
_LONGEST_LINE = 1 << 22
"""Bytes of a line, above which a file is no table."""
_MOST_AT_ONCE = 1 << 28
"""Bytes of a log of a form that can only be read as a whole."""
_MEGABYTE = 1e6


def text_pieces(path: Path) -> Iterator[str]:
    """Whole lines of a file, some megabytes of them at a time.

    UTF-8 or UTF-16 as its mark says, else the code page that controls in Europe write.

    Raises:
        UsageError: The file cannot be read, or is no text.
    """
    try:
        with path.open("rb") as file:
            rest = b""
            while chunk := file.read(_PIECE):
                whole = rest + chunk
                if whole.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
                    refuse_larger(path, path.stat().st_size)
                    yield (whole + file.read()).decode("utf-16", errors="replace")
                    return
                end = whole.rfind(b"\n") + 1
                if not end and len(whole) > _LONGEST_LINE:
                    raise UsageError(
                        f"{path}: is not a log: a line of it is {len(whole)} bytes long"
                    )
                if end:
                    yield _decoded(path, whole[:end])
                rest = whole[end:]
            yield _decoded(path, rest)
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror}") from error


def whole_text(path: Path, first: str, more: Iterator[str]) -> str:
    """All pieces as one, where a form needs that.

    Raises:
        UsageError: It is too large for that.
    """
    refuse_larger(path, path.stat().st_size)
    return first + "".join(more)


def refuse_larger(path: Path, size: int) -> None:
    """Refuse a file that does not fit into memory with what comes of it."""
    if size > _MOST_AT_ONCE:
        raise UsageError(
            f"{path}: has {size / _MEGABYTE:.0f} MB; a log of this form is read up to "
            f"{_MOST_AT_ONCE / _MEGABYTE:.0f} MB: log for a shorter time, or save it as CSV"
        )


def _decoded(path: Path, content: bytes) -> str:
    if b"\0" in content:
        raise UsageError(f"{path}: is not a log: it is no text")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("cp1252", errors="replace")
