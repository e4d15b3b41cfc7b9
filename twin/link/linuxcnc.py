"""LinuxCNC as a process: found, started, ended, and nothing left behind."""

import contextlib
import json
import os
import re
import shutil
import signal
import socket
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from twin.errors import UsageError

LOCK = Path("/tmp/linuxcnc.lock")  # noqa: S108 - LinuxCNC's own
"""Exists while a LinuxCNC runs on this computer; there can be only one."""
PACKAGE = "linuxcnc-uspace"
_CLAIM = b"\0mill-twin-linuxcnc"
"""A name that the kernel gives to one process at a time, and takes back however that process ends."""
_MESSAGES = Path("/usr/share/linuxcnc/linuxcnc.nml")
"""Which shared memory LinuxCNC's parts speak through."""
_MOTION_KEY = "100"
"""Of the shared memory of its motion controller (``DEFAULT_SHMEM_KEY``)."""
LOG_NAME = "linuxcnc.log"
OPERATOR = Path(__file__).with_name("headless_screen.py")
_UNPRIVILEGED = "nobody"
_NOT_PLAIN = re.compile(r"[^\w/.+-]")
"""What splits or ends a word of LinuxCNC's files and of the shell that starts it."""
_LEAVING_TIMEOUT_S = 30.0
"""How long LinuxCNC may take from its component's farewell to its end [s]."""
_END_TIMEOUT_S = 10.0
_REALTIME = "rtapi_app"
_PARTS = ("milltask", _REALTIME)
"""Processes without which the others wait for ever: the task controller and the realtime part."""


class Event(NamedTuple):
    """A line of the operator's log."""

    event: str
    text: str


class LinuxCnc:
    """A running LinuxCNC.

    Attributes:
        lost: The part of it that has gone while others went on; empty where none has.
    """

    def __init__(self, process: subprocess.Popen[bytes], folder: Path, log: Path) -> None:
        self._process = process
        self.folder = folder
        self.log = log
        self.lost = ""
        self._parts: dict[str, int] = {}

    def goes_on(self) -> bool:
        """Whether it is still there: its start script, and each part that has been seen running."""
        if self._process.poll() is not None:
            return False
        self.lost = next(
            (name for name, number in self._parts.items() if process_name(number) != name), ""
        )
        if not self.lost and len(self._parts) < len(_PARTS):
            names = {process_name(number): number for number in processes_at_home(self.folder)}
            self._parts = {
                name: names[name] for name in _PARTS if name in names and _lasts(name, names[name])
            }
        return not self.lost

    def events(self) -> list[Event]:
        """The lines of its operator's log so far."""
        path = operator_log(self.folder)
        lines = path.read_text(encoding="utf-8").splitlines() if path.is_file() else []
        return [Event(**json.loads(line)) for line in lines]

    def end_soon(self) -> None:
        """Wait until it has ended by itself; it is ended where it does not, or where a part is lost."""
        finished = any(event.event in ("finished", "failed") for event in self.events())
        try:
            self._process.wait(0.0 if self.lost and not finished else _LEAVING_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            self.end()

    def end(self) -> None:
        """End it, and all that it started."""
        for number in (signal.SIGTERM, signal.SIGKILL):
            if self._process.poll() is not None:
                break
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self._process.pid, number)
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(_END_TIMEOUT_S)
        for number in processes_at_home(self.folder):
            with contextlib.suppress(ProcessLookupError):
                os.kill(number, signal.SIGKILL)


@contextlib.contextmanager
def claimed_linuxcnc() -> Iterator[Path]:
    """LinuxCNC for this process alone, by its start script, until the block ends.

    LinuxCNC's own lock is only once it runs, and its remains are taken away afterwards: a second
    twin that began meanwhile would take away the first one's.

    Raises:
        UsageError: It is not installed, or one runs already.
    """
    found = shutil.which("linuxcnc")
    if found is None:
        raise UsageError(f"LinuxCNC is not installed: Debian has it as {PACKAGE}")
    with socket.socket(socket.AF_UNIX) as claim:
        try:
            claim.bind(_CLAIM)
        except OSError as error:
            raise UsageError(
                "another twin works LinuxCNC on this computer, where there can be one: wait for its end"
            ) from error
        if LOCK.exists():
            raise UsageError(
                "a LinuxCNC runs on this computer, or was killed: end it, say halrun -U and remove "
                f"{LOCK}"
            )
        yield Path(found)


def require_plain(folder: Path) -> None:
    """Refuse a folder that LinuxCNC's files cannot name.

    Args:
        folder: Where its configuration is to lie, absolute.

    Raises:
        UsageError: Its path holds a blank or a sign that INI and HAL files read otherwise.
    """
    strange = sorted(set(_NOT_PLAIN.findall(str(folder))))
    if strange:
        shown = ", ".join("a blank" if sign == " " else repr(sign) for sign in strange)
        raise UsageError(
            f"LinuxCNC cannot read its files from '{folder}', whose path holds {shown}: give --out a "
            "folder with letters, digits and -_.+ in its path"
        )


@contextlib.contextmanager
def running(start: Path, ini: Path, log: Path) -> Iterator[LinuxCnc]:
    """Start LinuxCNC; it is ended with the block.

    Args:
        ini: The configuration, in a folder of its own.

    Raises:
        UsageError: It refuses to run as root and the unprivileged user cannot read the folder.
    """
    folder = ini.parent
    user = _as_unprivileged(folder) if os.geteuid() == 0 else []
    # Its sockets and its logs go where its user may write.
    at_home = [*user, "env", f"HOME={folder}"]
    _forget_messages(at_home)
    with log.open("wb") as output:
        process = subprocess.Popen(  # noqa: S603 - names no user has a hand in
            [*at_home, str(start), "-r", str(ini)],
            stdin=subprocess.DEVNULL, stdout=output, stderr=output, start_new_session=True,
        )  # fmt: skip
        linuxcnc = LinuxCnc(process, folder, log)
        try:
            yield linuxcnc
        finally:
            linuxcnc.end()
            _tidy_up(at_home)


def processes_at_home(folder: Path) -> list[int]:
    """Processes that a LinuxCNC started from a folder, which is their home; it leaves its session."""
    home = f"HOME={folder}".encode()
    found = []
    for path in Path("/proc").glob("[0-9]*/environ"):
        with contextlib.suppress(OSError):
            if home in path.read_bytes().split(b"\0"):
                found.append(int(path.parent.name))
    return found


def process_name(number: int) -> str:
    """What a process is called; empty where there is none, or where it has ended and nobody asked."""
    try:
        text = Path(f"/proc/{number}/stat").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""
    name, _, rest = text.partition("(")[2].rpartition(")")
    return "" if rest.split()[:1] == ["Z"] else name


def _lasts(name: str, number: int) -> bool:
    """Whether a process is the part itself.

    Each ``loadrt`` starts an ``rtapi_app`` too, which hands the module to the first one and ends; that first
    one leads a session of its own.
    """
    with contextlib.suppress(OSError):
        return name != _REALTIME or os.getsid(number) == number
    return False


def operator_log(folder: Path) -> Path:
    """Where the operator writes what happened."""
    return folder / "operator.jsonl"


def _as_unprivileged(folder: Path) -> list[str]:
    """LinuxCNC refuses to run as root: what to put before its command."""
    for path in (folder, *folder.iterdir()):
        shutil.chown(path, _UNPRIVILEGED)
    prefix = ["runuser", "-u", _UNPRIVILEGED, "--"]
    if subprocess.run([*prefix, "test", "-w", str(folder)], check=False).returncode:  # noqa: S603
        raise UsageError(
            f"LinuxCNC does not run as root, and {_UNPRIVILEGED} cannot enter {folder}: run "
            "twin link as another user, or give --out a folder that everybody may enter"
        )
    return prefix


def _tidy_up(at_home: list[str]) -> None:
    """Take away what a LinuxCNC leaves that was killed: its realtime part, its messages, its lock."""
    if LOCK.exists():
        _try([*at_home, "halrun", "-U"])
    _forget_messages(at_home)
    LOCK.unlink(missing_ok=True)


def _forget_messages(at_home: list[str]) -> None:
    """Remove the shared memory of LinuxCNC's messages: the next one would answer old ones."""
    rows = _MESSAGES.read_text(encoding="utf-8").splitlines() if _MESSAGES.is_file() else []
    buffers = [words for words in map(str.split, rows) if words[:1] == ["B"]]
    keys = [words[9] for words in buffers if words[2:3] == ["SHMEM"]]
    for key in (_MOTION_KEY, *keys):
        _try([*at_home, "ipcrm", "-M", key])


def _try(command: list[str]) -> None:
    with contextlib.suppress(subprocess.TimeoutExpired, FileNotFoundError):
        subprocess.run(  # noqa: S603 - names no user has a hand in
            command, capture_output=True, check=False, timeout=_END_TIMEOUT_S
        )
