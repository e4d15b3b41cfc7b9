"""The lines of a program, kept as bytes in pages; those behind the first megabytes are packed.

So a program of many millions of lines takes a fraction of its length, and the others lie as they
were read. A page is unpacked, turned into UTF-8 and divided into lines when one of them is wanted.
The file is not mapped (``mmap``): where an editor saves over it during a run, a mapping shows the new lines,
and ends the process (SIGBUS) where the file has become shorter; text from MDI has no file.
"""

import bisect
import re
import zlib
from collections.abc import Iterable, Iterator, Sequence
from typing import overload

import numpy as np
import numpy.typing as npt

PAGE = 1 << 18
"""Bytes of a page, about; none ends within a line."""
UNPACKED_PAGES = 64
"""Pages of a program that are kept as they are: up to 16 MB cost no time to unpack."""
_OPEN_PAGES = 8
"""Pages whose lines are known at a time."""
_FASTEST = 1
"""Level of zlib that packs numbers to a sixth at 230 MB/s; the slower ones gain little."""
_LINE_FEED, _RETURN = 10, 13
_MARK = b"\xef\xbb\xbf"
"""What some editors put before UTF-8."""
_UTF_8 = "utf-8"
SURROGATES = "surrogatepass"
"""Text that is made on the fly may hold what no file can."""
_ANY_BYTE = "latin-1"
"""Decodes any byte; used where a file is neither UTF-8 nor in the dialect's own code page."""

_DIVIDED = 256
"""Lines that are divided at once: one by one is slow, and a whole page takes eight times its text."""
Places = npt.NDArray[np.signedinteger]


class Page:
    """Some of a program's lines.

    Attributes:
        lines: Their numbers, from 0.
        text: The lines as UTF-8, with their ends.
        data: The bytes of ``text``, shape (bytes,).
        starts: Where each line begins in it, shape (n,).
        ends: Where it ends, before CR, LF or CR LF, shape (n,).
    """

    def __init__(self, first: int, text: bytes) -> None:
        self.text = text
        self.data = np.frombuffer(text, np.uint8)
        self.starts, self.ends = _line_places(self.data)
        self.lines = range(first, first + len(self.starts))
        self._first_divided = -_DIVIDED
        self._divided: list[str] = []

    @property
    def joined(self) -> str:
        """Its lines as one text, with LF between them."""
        return self.text.decode(_UTF_8, SURROGATES).replace("\r\n", "\n").replace("\r", "\n")

    def line(self, number: int) -> str:
        """One of its lines without its end."""
        at = number - self.lines.start
        if not 0 <= at - self._first_divided < _DIVIDED:
            self._first_divided = at - at % _DIVIDED
            part = slice(self._first_divided, self._first_divided + _DIVIDED)
            places = zip(self.starts[part].tolist(), self.ends[part].tolist(), strict=True)
            self._divided = [
                self.text[begin:end].decode(_UTF_8, SURROGATES) for begin, end in places
            ]
        return self._divided[at - self._first_divided]


class Lines(Sequence[str]):
    """The lines of a program without their ends."""

    def __init__(self, pieces: Iterable[bytes], encodings: Sequence[str] = ()) -> None:
        """Take the text in.

        Args:
            pieces: Its bytes, in pieces of any length.
            encodings: What they may be in besides bytes without a meaning; the first that fits
                all of them counts. None: they are UTF-8.
        """
        self.size = 0
        self._pages: list[bytes] = []
        self._firsts: list[int] = []
        self._count = 0
        self._open: dict[int, Page] = {}
        self._latest = Page(0, b"")
        fitting = list(encodings) or [_UTF_8]
        for page in _whole_lines(pieces):
            if encodings and not page.isascii():
                fitting = [encoding for encoding in fitting if _fits(page, encoding)]
                if not self._pages and _UTF_8 in fitting:
                    page = page.removeprefix(_MARK)
            if page:
                self._keep(page)
        self._encoding = fitting[0] if fitting else _ANY_BYTE

    def _keep(self, page: bytes) -> None:
        packed = len(self._pages) >= UNPACKED_PAGES
        self._pages.append(zlib.compress(page, _FASTEST) if packed else page)
        self._firsts.append(self._count)
        self._count += _line_count(page)
        self.size += len(page)

    def __len__(self) -> int:
        return self._count

    @overload
    def __getitem__(self, index: int) -> str: ...
    @overload
    def __getitem__(self, index: slice) -> list[str]: ...
    def __getitem__(self, index: int | slice) -> str | list[str]:
        if isinstance(index, slice):
            return [self[each] for each in range(*index.indices(len(self)))]
        line = index if index >= 0 else index + self._count
        if not 0 <= line < self._count:
            raise IndexError(index)
        return self.page_of(line).line(line)

    def __iter__(self) -> Iterator[str]:
        return (page.line(line) for page in self.pages() for line in page.lines)

    def page_of(self, line: int) -> Page:
        """The page that a line, from 0, is on."""
        if line in self._latest.lines:
            return self._latest
        number = bisect.bisect_right(self._firsts, line) - 1
        page = self._open.get(number)
        if page is None:
            page = Page(self._firsts[number], self._utf_8(number))
            if len(self._open) == _OPEN_PAGES:
                del self._open[next(iter(self._open))]
            self._open[number] = page
        self._latest = page
        return page

    def pages(self) -> Iterator[Page]:
        """All pages, in order."""
        return (self.page_of(first) for first in self._firsts)

    def _utf_8(self, number: int) -> bytes:
        kept = self._pages[number]
        page = zlib.decompress(kept) if number >= UNPACKED_PAGES else kept
        if self._encoding == _UTF_8 or page.isascii():
            return page
        return page.decode(self._encoding).encode(_UTF_8)

    def any_holds(self, pattern: re.Pattern[bytes]) -> bool:
        """Whether a pattern, which must not match line ends, is in any line."""
        pages = range(len(self._pages))
        return any(pattern.search(self._utf_8(number)) is not None for number in pages)

    def holding(self, mark: "str | re.Pattern[bytes]") -> Iterator[tuple[int, str]]:
        """The lines in which a text or a pattern, which must not match line ends, occurs, with their numbers from 0."""
        pattern = (
            re.compile(re.escape(mark.encode(_UTF_8, SURROGATES)))
            if isinstance(mark, str)
            else mark
        )
        for number, first in enumerate(self._firsts):
            if pattern.search(self._utf_8(number)) is not None:
                page, at = self.page_of(first), 0
                while (found := pattern.search(page.text, at)) is not None:
                    index = int(np.searchsorted(page.starts, found.start(), side="right")) - 1
                    yield first + index, page.line(first + index)
                    at = int(page.ends[index])


def _whole_lines(pieces: Iterable[bytes]) -> Iterator[bytes]:
    """Bytes in pages that end where lines do; never between CR and LF."""
    waiting: list[bytes] = []
    for piece in pieces:
        for begin in range(0, len(piece), PAGE):
            part = piece[begin : begin + PAGE]
            end = max(part.rfind(b"\n"), part.rfind(b"\r", 0, len(part) - 1)) + 1
            if end:
                yield b"".join([*waiting, part[:end]])
                waiting = []
            waiting.append(part[end:])
    if rest := b"".join(waiting):
        yield rest


def _fits(page: bytes, encoding: str) -> bool:
    try:
        page.decode(encoding)
    except UnicodeDecodeError:
        return False
    return True


def _line_count(page: bytes) -> int:
    """Lines that end with LF, CR or CR LF, and one behind the last end, if there is any text."""
    ends = page.count(b"\n") + page.count(b"\r") - page.count(b"\r\n")
    return ends + (not page.endswith((b"\n", b"\r")))


def _line_places(data: npt.NDArray[np.uint8]) -> tuple[Places, Places]:
    """Where lines begin, and where they end; they are divided as ``_line_count`` has it."""
    feed, back = data == _LINE_FEED, data == _RETURN
    divides = feed | back
    divides[:-1] &= ~(back[:-1] & feed[1:])
    behind = np.flatnonzero(divides) + 1
    if len(data) and not divides[-1]:
        behind = np.append(behind, len(data))
    starts = np.append(0, behind)[:-1]
    ends = behind - divides[behind - 1]
    ends -= feed[behind - 1] & (ends > starts) & back[ends - 1]
    return starts, ends
