"""Bad days of ``twin serve``: a crowd of streams, clients that never read, and requests that are none.

All of them come at once, for a minute, while one monitor follows every observation of the machine and
an independent client, ``pymtconnect``, its states. The twin must keep real time, the monitor must
miss nothing, and the memory must not grow.
"""

import contextlib
import http.client
import os
import random
import resource
import selectors
import socket
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from datetime import datetime
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple
from urllib.parse import urlsplit
from xml.etree import ElementTree as ET

ROOT = Path(__file__).resolve().parents[2]
JOB = ROOT / "programs" / "codesys" / "semicircle_by_radius.toml"
CROWD, SLOW = 50, 20
"""Clients that stream everything, and clients that ask for everything and read nothing."""
WATCHED_S = 60.0
TICK_S = 0.01
"""Between two observations of an axis."""
LATEST_S = 0.5
"""How long after its time stamp an observation may be reported, in the median [s]."""
BUFFER = 1 << 14
"""Observations that the agent remembers: soon as many as there can be, so that its memory has its size."""
FULL_S = 60.0
MORE_MB = 10.0
"""By how much more memory may be in use in the second half of the minute than in the first: what is on its
way to clients that do not read is there from the beginning."""
EVERYTHING = f"/sample?interval=100&count={BUFFER}"
STREAMS = "{urn:mtconnect.org:MTConnectStreams:2.0}"
NONSENSE = (
    b"\x00\xff\x16\x03\x01 hello", b"GET /current", b"GET /sample?path=//%5B HTTP/1.1\r\n\r\n",
    b"GET /" + b"x" * 70_000 + b" HTTP/1.1\r\n\r\n", b"POST /current HTTP/1.1\r\nContent-Length: 9\r\n\r\n",
    b"GET /sample?from=-1&count=99999999999999999999 HTTP/1.1\r\nHost: localhost\r\n\r\n",
    b"GET /current?at=1 HTTP/1.1\r\nHost: localhost\r\nAccept: application/json;q=zero\r\n\r\n",
    b"GET /sample?interval=0&heartbeat=1 HTTP/1.1\r\nHost: localhost\r\n\r\n",
    b"HEAD /sample?interval=10 HTTP/1.1\r\nHost: localhost\r\n\r\n" * 9,
    b"GET /current HTTP/1.1\r\nHost: elsewhere.example\r\n\r\n", b"GET /probe HTTP/1.0\r\n\r\n",
    b"GET /current HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n",
)  # fmt: skip


class Served(NamedTuple):
    """A running ``twin serve``: its process number and where it listens."""

    process: int
    host: str
    port: int

    def memory_mb(self) -> float:
        """Resident memory."""
        pages = int(Path(f"/proc/{self.process}/statm").read_text(encoding="ascii").split()[1])
        return pages * resource.getpagesize() / 1e6

    def processor_s(self) -> float:
        """Processor time that it has used."""
        fields = Path(f"/proc/{self.process}/stat").read_text(encoding="ascii").rpartition(")")[2]
        return sum(map(int, fields.split()[11:13])) / os.sysconf("SC_CLK_TCK")

    def said(self, words: bytes) -> socket.socket:
        """A line on which something was said."""
        line = socket.create_connection((self.host, self.port), timeout=20.0)
        line.sendall(words)
        return line

    def asked(self, target: str) -> http.client.HTTPResponse:
        """The answer to a request."""
        connection = http.client.HTTPConnection(self.host, self.port, timeout=20.0)
        connection.request("GET", target)
        return connection.getresponse()


def complaints() -> Iterator[str]:
    """Serve a job and let them all come; what is wrong meanwhile and afterwards."""
    with serving(JOB) as served:
        wait_until_full(served)
        with contextlib.ExitStack() as attack:
            attack.enter_context(crowd(served))
            for _ in range(SLOW):
                attack.enter_context(never_reading(served))
            attack.enter_context(nonsense(served))
            states = attack.enter_context(independent_client(served))
            memory = attack.enter_context(sampled_memory(served))
            used = served.processor_s()
            found = list(followed(served, WATCHED_S))
            share = 100.0 * (served.processor_s() - used) / WATCHED_S
        print(f"  meanwhile the agent took {share:.0f} % of a processor")
        yield from found
        if not {"ACTIVE", "READY", "PROGRAM_COMPLETED"} & set(states):
            yield f"the independent client saw {states}"
        half = len(memory) // 2
        early, late = max(memory[:half]), max(memory[half:])
        print(f"  {early:.0f} MB were in use in the first half, {late:.0f} MB in the second")
        if late - early > MORE_MB:
            yield f"{late - early:.0f} MB more are in use"
        yield from (f"afterwards: {each}" for each in followed(served, 5.0))


@contextlib.contextmanager
def serving(job: Path) -> Iterator[Served]:
    """``twin serve`` in a process of its own."""
    command = [sys.executable, "-m", "twin", "serve", str(job), "--buffer", str(BUFFER)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            address = urlsplit(process.stdout.readline().strip())
            assert address.hostname is not None
            assert address.port is not None
            yield Served(process.pid, address.hostname, address.port)
        finally:
            process.terminate()


def wait_until_full(served: Served) -> None:
    """Return once the oldest observation has been overwritten."""
    end = time.monotonic() + FULL_S
    while time.monotonic() < end:
        with served.asked("/current?path=//Controller") as answer:
            header = ET.fromstring(answer.read()).find(f"{STREAMS}Header")  # noqa: S314 (own server)
        if header is not None and header.get("firstSequence") != "1":
            return
        time.sleep(1.0)


@contextlib.contextmanager
def crowd(served: Served) -> Iterator[None]:
    """Clients that stream everything, and read it."""
    request = f"GET {EVERYTHING} HTTP/1.1\r\nHost: localhost\r\n\r\n".encode()
    selector = selectors.DefaultSelector()
    lines = [served.said(request) for _ in range(CROWD)]
    for line in lines:
        selector.register(line, selectors.EVENT_READ)

    def read() -> None:
        for key, _ in selector.select(0.2):
            assert isinstance(key.fileobj, socket.socket)
            if not key.fileobj.recv(1 << 20):
                selector.unregister(key.fileobj)

    try:
        with repeating(read, every_s=0.02):
            yield
    finally:
        left = CROWD - len(selector.get_map())
        print(f"  {left} of {CROWD} streams were ended by the agent")
        for line in lines:
            line.close()


@contextlib.contextmanager
def never_reading(served: Served) -> Iterator[None]:
    """A client that asks for everything there is, again and again, and never reads."""
    with served.said(f"GET {EVERYTHING} HTTP/1.1\r\nHost: localhost\r\n\r\n".encode()) as line:
        line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        yield


@contextlib.contextmanager
def sampled_memory(served: Served) -> Iterator[list[float]]:
    """Its memory, once a second [MB]."""
    memory: list[float] = []
    with repeating(lambda: memory.append(served.memory_mb()), every_s=1.0):
        yield memory


@contextlib.contextmanager
def nonsense(served: Served) -> Iterator[None]:
    """Requests that are none, twenty a second."""
    chance = random.Random(1)  # noqa: S311 (no cryptography)

    def send() -> None:
        with contextlib.suppress(OSError), served.said(chance.choice(NONSENSE)) as line:
            line.settimeout(0.05)
            line.recv(4096)

    with repeating(send, every_s=0.05):
        yield


@contextlib.contextmanager
def independent_client(served: Served) -> Iterator[list[str]]:
    """States of the machine as ``pymtconnect`` reads them."""
    from pymtconnect import mtconnect_client

    states: list[str] = []
    stream = mtconnect_client.stream_sample(
        f"http://{served.host}:{served.port}", interval=200, from_seq=newest(served), count=5000
    )

    def read() -> None:
        _, events, _ = next(stream)
        states.extend(event.result for event in events if event.type == "Execution")

    try:
        with repeating(read):
            yield states
    finally:
        print(f"  the independent client saw {' '.join(states)}")


@contextlib.contextmanager
def repeating(act: Callable[[], object], every_s: float = 0.0) -> Iterator[None]:
    """Do something again and again on a thread of its own while the block runs.

    Args:
        act: What is done; it ends soon by itself.
        every_s: Pause before each time [s].
    """
    over = threading.Event()

    def repeat() -> None:
        while not over.wait(every_s):
            act()

    thread = threading.Thread(target=repeat)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


def followed(served: Served, seconds: float) -> Iterator[str]:
    """Stream everything for some time; what is missing of it, or late."""
    numbers: list[int] = []
    moments: list[float] = []
    late: list[float] = []
    end = time.monotonic() + seconds
    with served.asked(EVERYTHING + f"&from={newest(served)}") as answer:
        boundary = str(answer.getheader("Content-Type")).partition("boundary=")[2]
        for document in parts(answer, boundary):
            told = [each for each in document.iter() if "sequence" in each.attrib]
            if not told:
                continue
            numbers += sorted(int(each.attrib["sequence"]) for each in told)
            moments += sorted(
                moment(each.attrib["timestamp"])
                for each in told
                if each.attrib["dataItemId"] == "X_position"
            )
            header = document.find(f"{STREAMS}Header")
            assert header is not None
            last = max(moment(each.attrib["timestamp"]) for each in told)
            late.append(moment(header.attrib["creationTime"]) - last)
            if time.monotonic() > end:
                break
    steps = [after - before for before, after in pairwise(moments)]
    print(
        f"  {len(numbers)} observations in {seconds:.0f} s, told {statistics.median(late):.2f} s late "
        f"in the median, {max(late):.2f} s at most"
    )
    if any(after - before != 1 for before, after in pairwise(numbers)):
        yield "sequence numbers are missing"
    if not steps or statistics.median(steps) > 1.5 * TICK_S:
        yield f"X was told every {statistics.median(steps or [0.0]):.3f} s"
    if statistics.median(late) > LATEST_S:
        yield f"observations came {statistics.median(late):.2f} s late"


def newest(served: Served) -> int:
    """Number that the next observation will have."""
    with served.asked("/current?path=//Controller") as answer:
        header = ET.fromstring(answer.read()).find(f"{STREAMS}Header")  # noqa: S314 (own server)
    assert header is not None
    return int(header.attrib["nextSequence"])


def parts(answer: http.client.HTTPResponse, boundary: str) -> Iterator[ET.Element]:
    """The documents of a stream."""
    while answer.readline() == f"--{boundary}\r\n".encode():
        answer.readline()
        length = int(answer.readline().partition(b":")[2])
        answer.readline()
        yield ET.fromstring(answer.read(length))  # noqa: S314 (own server)
        answer.readline()


def moment(stamp: str) -> float:
    """Seconds of a time stamp."""
    return datetime.fromisoformat(stamp).timestamp()
