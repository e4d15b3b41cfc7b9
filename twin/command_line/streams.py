"""The command's output: a pipe that is closed, and a terminal that cannot show µ."""

import codecs
import io
import os
import sys

from twin.files.atomic import with_path

CLOSED_PIPE = 141
"""Exit code of a command whose output is closed before its end, as shells give it (128 + SIGPIPE)."""

_TRANSLITERATED = str.maketrans(
    {"µ": "u", "–": "-", "—": "-", "°": "deg", "²": "2", "³": "3", "·": "*", "×": "x", "…": "..."}
)
_ERRORS = "mill-twin-plain"


class _Pipe(io.FileIO):
    """Ends the process when the reader of the pipe has gone (``twin interpret ... | head``).

    Where nothing can be written for another reason, a full disk say, that is raised once.
    """

    def write(self, data: object, /) -> int | None:
        try:
            return super().write(data)  # pyright: ignore[reportArgumentType] (a buffer of any kind)
        except BrokenPipeError:
            self._write_nowhere()
            raise SystemExit(CLOSED_PIPE) from None
        except OSError as error:
            self._write_nowhere()
            name = "the standard output" if self.fileno() == 1 else "the standard error"
            raise with_path(error, name) from None

    def _write_nowhere(self) -> None:
        """What is still in the buffers is lost, without a complaint of Python's."""
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, self.fileno())
        os.close(nowhere)


def prepare_streams() -> None:
    """Let stdout and stderr end the command when they are closed, and write in any encoding."""
    codecs.register_error(_ERRORS, _plain)
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if not isinstance(stream, io.TextIOWrapper):
            continue  # closed from the start, or put there by a test
        stream.flush()
        raw = _Pipe(stream.fileno(), "w", closefd=False)
        prepared = io.TextIOWrapper(
            io.BufferedWriter(raw),
            encoding=stream.encoding,
            errors=_ERRORS,
            line_buffering=stream.line_buffering or name == "stderr",
            write_through=stream.write_through,
        )
        setattr(sys, name, prepared)


def _plain(error: UnicodeError) -> tuple[str | bytes, int]:
    """What a narrow encoding shows instead of a character that it lacks."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    shown = error.object[error.start : error.end].translate(_TRANSLITERATED)
    return shown.encode("ascii", "backslashreplace").decode("ascii"), error.end
