"""The agent as a client sees it: over HTTP, from a machine that is made up."""

import contextlib
import http.client
import logging
import re
import socket
import threading
import time
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator
from itertools import count, pairwise

import pytest

from twin.job.job_file import ToolTable
from twin.nc.canonical import Axes
from twin.serve.agent import Agent, Clock, RequestError
from twin.serve.buffer import NORMAL, Condition
from twin.serve.device import device_of
from twin.serve.playback import Tick, feed

uvicorn = pytest.importorskip("uvicorn", reason="the web server of the extra 'serve' is missing")
from twin.serve.http_server import (  # noqa: E402 (it needs that web server)
    application,
    without_broken_requests,
)

AXES = Axes(("X", "Y", "Z", "C"), ("linear", "linear", "linear", "rotary"))
STREAMS = "{urn:mtconnect.org:MTConnectStreams:2.0}"
DEVICES = "{urn:mtconnect.org:MTConnectDevices:2.0}"
ASSETS = "{urn:mtconnect.org:MTConnectAssets:2.0}"
ERROR = "{urn:mtconnect.org:MTConnectError:2.0}"
FAULT = Condition("Fault", "hard-limit", "X < -300 & stays \x01 there")
HOSTILE_BLOCK = 'N5 "]]> <X> & \x00 \ud800'
PERIOD_S = 0.01


def machine() -> Iterator[Tick]:
    """A hundred positions a second, and a fault at the very first."""
    yield Tick(0.0, {"execution": "READY", "system": NORMAL, "block": HOSTILE_BLOCK})
    yield Tick(0.0, {"execution": "STOPPED", "system": FAULT})
    for number in count(1):
        yield Tick(number * PERIOD_S, {"X_position": f"{number:.3f}"})


@contextlib.contextmanager
def served(agent: Agent, ticks: Iterator[Tick]) -> Iterator[int]:
    """The port at which an agent of a machine listens."""
    config = uvicorn.Config(
        application(agent, lambda: feed(agent, ticks)),
        log_level="error",
        timeout_graceful_shutdown=1,
    )
    server = uvicorn.Server(config)
    with socket.create_server(("127.0.0.1", 0)) as listener:
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
        thread.start()
        yield listener.getsockname()[1]
        server.should_exit = True
        thread.join()


@pytest.fixture
def port() -> Iterator[int]:
    """Where an agent of this machine listens; its buffer holds five seconds."""
    tools = [ToolTable(number=1), ToolTable(number=7, kind="drill", diameter=6.0)]
    agent = Agent(device_of("mill", AXES), Clock(), "made up", 500, tools)
    with served(agent, machine()) as port:
        yield port


def ask(port: int, target: str, method: str = "GET") -> tuple[int, ET.Element]:
    with contextlib.closing(
        http.client.HTTPConnection("127.0.0.1", port, timeout=20)
    ) as connection:
        connection.request(method, target)
        answer = connection.getresponse()
        return answer.status, ET.fromstring(answer.read())  # noqa: S314 (own server)


@contextlib.contextmanager
def stream(port: int, target: str) -> Iterator[Iterator[ET.Element]]:
    """The documents of a stream."""
    with contextlib.closing(
        http.client.HTTPConnection("127.0.0.1", port, timeout=20)
    ) as connection:
        connection.request("GET", target)
        with connection.getresponse() as answer:
            kind = answer.getheader("Content-Type") or ""
            boundary = re.fullmatch(r"multipart/x-mixed-replace;boundary=(\w+)", kind)
            assert boundary
            yield parts(answer, boundary[1])


def test_the_probe_names_every_item_once(port: int) -> None:
    for target in ("/", "/probe", "/mill/probe"):
        status, root = ask(port, target)
        assert status == 200
        assert root.tag == f"{DEVICES}MTConnectDevices"
        found = [item.attrib["id"] for item in root.iter(f"{DEVICES}DataItem")]
        assert len(found) == len(set(found)) == 3 + 4 * 3 + 1 + 2 + 8 + 6
        assert [axis.attrib["name"] for axis in root.iter(f"{DEVICES}Linear")] == ["X", "Y", "Z"]


def test_the_tools_are_assets(port: int) -> None:
    status, root = ask(port, "/assets?type=CuttingTool&count=1")
    (last,) = root.iter(f"{ASSETS}CuttingTool")
    assert (status, last.attrib["toolId"]) == (200, "drill")
    _, root = ask(port, "/assets")
    identifiers = [each.attrib["assetId"] for each in root.iter(f"{ASSETS}CuttingTool")]
    status, root = ask(port, f"/asset/{identifiers[1]};{identifiers[0]}")
    diameters = [each.text for each in root.iter(f"{ASSETS}CuttingDiameterMax")]
    assert (status, diameters) == (200, ["10", "6"])
    _, root = ask(port, "/current?path=//DataItem[@type='ASSET_CHANGED']")
    (changed,) = root.iter(f"{STREAMS}AssetChanged")
    assert (changed.text, changed.attrib["assetType"]) == (identifiers[0], "CuttingTool")
    for target, code, expected in (
        ("/asset/mill.T2", "ASSET_NOT_FOUND", 404),
        ("/assets?count=0", "OUT_OF_RANGE", 404),
        ("/lathe/assets", "NO_DEVICE", 404),
    ):
        status, root = ask(port, target)
        (error,) = root.iter(f"{ERROR}Error")
        assert (status, error.attrib["errorCode"]) == (expected, code)


def test_current_tells_faults_and_hostile_texts(port: int) -> None:
    status, root = ask(port, "/current?path=//Controller")
    assert status == 200
    (fault,) = root.iter(f"{STREAMS}Fault")
    assert fault.attrib["nativeCode"] == "hard-limit"
    assert fault.text == "X < -300 & stays \N{REPLACEMENT CHARACTER} there"
    (block,) = root.iter(f"{STREAMS}Block")
    assert block.text == 'N5 "]]> <X> & \N{REPLACEMENT CHARACTER} '
    (execution,) = root.iter(f"{STREAMS}Execution")
    assert execution.text == "STOPPED"
    (mode,) = root.iter(f"{STREAMS}ControllerMode")
    assert mode.text == "UNAVAILABLE"
    assert not list(root.iter(f"{STREAMS}Position"))


def test_requests_go_on_where_the_last_one_ended(port: int) -> None:
    following, seen = "1", []
    while len(seen) < 60:
        _, root = ask(port, f"/sample?from={following}&count=7&path=//Linear[@name='X']")
        (header,) = root.iter(f"{STREAMS}Header")
        following = header.attrib["nextSequence"]
        seen += [
            float(each.text or "")
            for each in root.iter(f"{STREAMS}Position")
            if each.text != "UNAVAILABLE"
        ]
        time.sleep(0.01)
    assert seen == [float(number + 1) for number in range(len(seen))]


def test_a_stream_has_no_gap_and_a_heartbeat(port: int) -> None:
    with stream(port, "/sample?interval=50&path=//DataItem[@id='X_position']") as documents:
        numbers = [value for _ in range(12) for value in positions(next(documents))]
    assert len(numbers) > 20
    assert all(after - before == 1.0 for before, after in pairwise(numbers))
    rare = "/sample?interval=10&heartbeat=100&path=//DataItem[@type='EXECUTION']"
    with stream(port, rare) as documents:
        assert list(next(documents).iter(f"{STREAMS}Execution"))
        for _ in range(2):
            assert not list(next(documents).iter(f"{STREAMS}Execution"))


def parts(answer: http.client.HTTPResponse, boundary: str) -> Iterator[ET.Element]:
    while answer.readline() == f"--{boundary}\r\n".encode():
        assert answer.readline() == b"Content-type: text/xml\r\n"
        length = int(answer.readline().partition(b":")[2])
        assert answer.readline() == b"\r\n"
        yield ET.fromstring(answer.read(length))  # noqa: S314 (own server)
        assert answer.readline() == b"\r\n"


def positions(root: ET.Element) -> list[float]:
    found = [each.text or "" for each in root.iter(f"{STREAMS}Position")]
    return [float(text) for text in found if text != "UNAVAILABLE"]


@pytest.mark.parametrize(
    ("target", "status", "code"),
    [
        ("/sample?from=999999", 404, "OUT_OF_RANGE"),
        ("/sample?from=-1", 404, "OUT_OF_RANGE"),
        ("/sample?count=0", 404, "OUT_OF_RANGE"),
        ("/sample?count=1e3", 400, "INVALID_REQUEST"),
        ("/sample?count=" + "9" * 5000, 400, "INVALID_REQUEST"),
        ("/sample?interval=soon", 400, "INVALID_REQUEST"),
        ("/sample?heartbeat=0", 404, "OUT_OF_RANGE"),
        ("/current?at=999999", 404, "OUT_OF_RANGE"),
        ("/current?at=30&interval=100", 400, "INVALID_REQUEST"),
        ("/sample?count=-5&interval=100", 400, "INVALID_REQUEST"),
        ("/sample?interval=1000000000", 404, "OUT_OF_RANGE"),
        ("/sample?from=", 400, "INVALID_REQUEST"),
        ("/current?path=//*%5B@id='x'%20or%20'1'='1'%5D", 400, "INVALID_XPATH"),
        ("/current?path=document('/etc/passwd')", 400, "INVALID_XPATH"),
        ("/current?path=//../..", 400, "INVALID_XPATH"),
        ("/current?path=//Linear%5B0%5D", 400, "INVALID_XPATH"),
        ("/current?path=//%5B", 400, "INVALID_XPATH"),
        ("/current?path=//Nothing", 400, "INVALID_XPATH"),
        ("/current?path=" + "/" * 2000, 400, "INVALID_XPATH"),
        ("/current?path=", 400, "INVALID_XPATH"),
        ("/lathe/current", 404, "NO_DEVICE"),
        ("/fixtures", 404, "INVALID_URI"),
        ("/probe/", 404, "INVALID_URI"),
        ("/%00%ff/probe", 404, "NO_DEVICE"),
    ],
)
def test_what_cannot_be_answered_is_an_error_document(
    port: int, target: str, status: int, code: str
) -> None:
    found, root = ask(port, target)
    (error,) = root.iter(f"{ERROR}Error")
    assert (found, error.attrib["errorCode"]) == (status, code)


@pytest.mark.parametrize(
    "path",
    ["/MTConnectDevices/Devices/Device//Linear[@name='X']", "//Linear[1]", "Devices//Linear[1]"],
)
def test_a_path_begins_at_the_document_or_anywhere(port: int, path: str) -> None:
    status, root = ask(port, f"/current?path={path}")
    assert status == 200
    items = {each.attrib["dataItemId"] for each in root.iter() if "dataItemId" in each.attrib}
    assert items == {"X_position", "X_position_commanded", "X_load"}


def said(port: int, words: bytes, until: bytes) -> bytes:
    """What comes on a line on which something was said, up to an answer's end."""
    heard = b""
    with socket.create_connection(("127.0.0.1", port), timeout=20) as line:
        line.sendall(words)
        while until not in heard and (more := line.recv(1 << 16)):
            heard += more
    return heard


@pytest.mark.parametrize("host", [b"elsewhere.example", b"localhost.elsewhere.example:5000", b"["])
def test_a_browser_that_was_sent_here_by_another_name_is_refused(port: int, host: bytes) -> None:
    heard = said(
        port, b"GET /current HTTP/1.1\r\nHost: " + host + b"\r\n\r\n", b"</MTConnectError>"
    )
    assert heard.startswith(b"HTTP/1.1 403 ")
    assert b'errorCode="UNAUTHORIZED"' in heard


def test_the_names_of_this_computer_and_none_are_served(port: int) -> None:
    for host in (b"Host: localhost:5000\r\n", b"Host: [::1]:5000\r\n", b"Host: 127.0.0.1\r\n"):
        heard = said(port, b"GET /probe HTTP/1.1\r\n" + host + b"\r\n", b"</MTConnectDevices>")
        assert heard.startswith(b"HTTP/1.1 200 ")
    heard = said(port, b"GET /probe HTTP/1.0\r\n\r\n", b"</MTConnectDevices>")
    assert heard.startswith(b"HTTP/1.1 200 ")


def test_requests_on_one_line_are_answered_in_their_order(port: int) -> None:
    head = b" HTTP/1.1\r\nHost: localhost\r\n\r\n"
    asked = b"".join(
        method + head for method in (b"HEAD /sample?interval=10", b"GET /probe", b"GET /nothing")
    )
    heard = said(port, asked, b"</MTConnectError>")
    kinds = (b"multipart/x-mixed-replace", b"<MTConnectDevices", b"INVALID_URI")
    places = [heard.find(kind) for kind in kinds]
    assert -1 not in places
    assert places == sorted(places)


@pytest.mark.parametrize(("filters", "told"), [([without_broken_requests], False), ([], True)])
def test_a_request_that_breaks_off_is_no_error_of_the_agent(
    port: int,
    filters: list[Callable[[logging.LogRecord], bool]],
    told: bool,
    caplog: pytest.LogCaptureFixture,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    logger = logging.getLogger("uvicorn.error")
    monkeypatch.setattr(logger, "filters", filters)
    monkeypatch.setattr(logger, "handlers", [caplog.handler])
    chunked = (
        b"GET /current HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n"
    )
    assert b" 400 " in said(port, chunked, b"never")
    assert ask(port, "/probe")[0] == 200
    assert any(record.exc_info for record in caplog.records) == told


def test_nobody_can_write(port: int) -> None:
    for method in ("POST", "PUT", "DELETE"):
        status, root = ask(port, "/current", method)
        (error,) = root.iter(f"{ERROR}Error")
        assert (status, error.attrib["errorCode"]) == (405, "UNSUPPORTED")


def test_a_client_that_the_buffer_passed_by_is_told() -> None:
    agent = Agent(device_of("mill", AXES), Clock(), "made up", size=30)
    query = agent.query("sample", {"from": "1"})
    for number in range(100):
        agent.observe(number * PERIOD_S, {"X_position": str(number)})
    last = agent.buffer.next_sequence - 1
    with pytest.raises(RequestError, match=f"the buffer holds {last - 29} to {last}"):
        agent.answer(query)
