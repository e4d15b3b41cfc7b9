"""Lines that say nothing, or nonsense, keep nobody else waiting."""

import http.client
import socket
import time

import pytest
from starlette.responses import PlainTextResponse

from twin.errors import UsageError
from twin.web import server as server_module
from twin.web.server import WebServer, server_of_views


@pytest.fixture
def server():
    opened = WebServer()
    opened.start(PlainTextResponse("here"))
    yield opened
    opened.stop()


def answered(server: WebServer) -> bool:
    line = http.client.HTTPConnection("127.0.0.1", server.port, timeout=10)
    line.request("GET", "/")
    said = line.getresponse().read() == b"here"
    line.close()
    return said


def closed(line: socket.socket, within_s: float) -> bool:
    line.settimeout(within_s)
    try:
        return line.recv(1) == b""
    except ConnectionError:
        return True
    except TimeoutError:
        return False


def test_of_many_silent_lines_the_oldest_are_hung_up(server):
    lines = [socket.create_connection(("127.0.0.1", server.port)) for _ in range(200)]
    assert answered(server)
    assert closed(lines[0], 5.0)
    assert len(server_module.BoundedProtocol._waiting) <= server_module.MOST_WAITING
    for line in lines:
        line.close()
    assert answered(server)


def test_a_line_that_speaks_letter_by_letter_is_hung_up(server, monkeypatch):
    monkeypatch.setattr(server_module, "FIRST_REQUEST_S", 0.3)
    with socket.create_connection(("127.0.0.1", server.port)) as line:
        for letter in b"GET / HT":
            line.send(bytes([letter]))
            time.sleep(0.02)
        assert closed(line, 10.0)


@pytest.mark.parametrize(
    "noise", [b"", b"\x00\xff" * 500, b"GET\r\n\r\n", b"A" * 200000, b"GET / HTTP/9.9\r\n\r\n"]
)
def test_noise_does_not_stop_the_server(server, noise):
    with socket.create_connection(("127.0.0.1", server.port), timeout=10) as line:
        try:
            line.sendall(noise)
            line.shutdown(socket.SHUT_WR)
            while line.recv(4096):
                pass
        except OSError:
            pass  # It hung up on the noise.
    assert answered(server)


def test_nobody_listens_on_any_other_address(server):
    with pytest.raises(OSError, match=r"refused|unreachable|timed out"):
        socket.create_connection(("127.0.0.2", server.port), timeout=2)


def test_arguments_are_looked_at_before_the_view_s_library(tmp_path, monkeypatch):
    monkeypatch.setattr(server_module, "THREE", tmp_path)
    with pytest.raises(UsageError, match="certificate"):
        server_of_views("0.0.0.0")  # noqa: S104 (that it is refused is the test)
    with pytest.raises(UsageError, match="three"):
        server_of_views()
