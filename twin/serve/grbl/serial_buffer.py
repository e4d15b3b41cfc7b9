"""What comes over the line: real-time commands are picked out, the rest waits in a buffer, as in Grbl 1.1.

Grbl's receive interrupt takes every byte above 127 and ``?``, ``~``, ``!`` and Ctrl-X out of the stream as it comes;
everything else goes into a ring of 128 bytes, and what does not fit is lost (``serial.c``). Senders that count
characters keep it filled; those that wait for each answer never fill it.
"""

from collections import deque

BUFFER_SIZE = 128
"""Bytes that wait."""
LONGEST_LINE = 79
"""Characters of a line without blanks and comments (``LINE_BUFFER_SIZE`` is 80, with its end)."""
_REALTIME = frozenset((*b"?~!\x18", *range(0x80, 0x100)))
_LINE_ENDS = frozenset(b"\r\n")


class SerialBuffer:
    """The receive buffer of one control.

    Attributes:
        lost: Bytes that found no room since the last ``clear``.
    """

    def __init__(self) -> None:
        self._lines: deque[tuple[bytes, bool]] = deque()
        self._open = bytearray()
        self._damaged = False
        self._used = 0
        self.lost = 0

    @property
    def free(self) -> int:
        """Bytes that it has room for."""
        return BUFFER_SIZE - self._used

    def receive(self, data: bytes) -> list[int]:
        """Take bytes; return the real-time commands among them, in their order."""
        commands: list[int] = []
        for byte in data:
            if byte in _REALTIME:
                commands.append(byte)
                if byte == 0x18:
                    self.clear()
            elif self._used >= BUFFER_SIZE:
                self.lost += 1
                self._damaged = True
            else:
                self._used += 1
                self._take(byte)
        return commands

    def _take(self, byte: int) -> None:
        if byte in _LINE_ENDS:
            self._lines.append((bytes(self._open), self._damaged))
            self._open.clear()
            self._damaged = False
        else:
            self._open.append(byte)

    @property
    def head(self) -> bytes | None:
        """The line that comes next; None: none is whole."""
        return self._lines[0][0] if self._lines else None

    def pop(self) -> tuple[bytes, bool]:
        """Take the line that comes next; whether bytes of it were lost."""
        line, damaged = self._lines.popleft()
        self._used -= len(line) + 1
        return line, damaged

    def forget_open(self) -> None:
        """Forget the bytes of a line that has no end yet."""
        self._used -= len(self._open)
        self._open.clear()
        self._damaged = False

    def clear(self) -> None:
        """Forget everything."""
        self._lines.clear()
        self._open.clear()
        self._damaged = False
        self._used = self.lost = 0


def cleaned(line: bytes) -> str:
    """A line as Grbl keeps it: upper case, without blanks, comments and slashes (``protocol_main_loop``)."""
    kept: list[str] = []
    in_brackets = False
    for byte in line:
        letter = chr(byte).upper()
        if in_brackets:
            in_brackets = letter != ")"
        elif letter == ";":
            break
        elif letter == "(":
            in_brackets = True
        elif letter > " " and letter != "/":
            kept.append(letter)
    return "".join(kept)
