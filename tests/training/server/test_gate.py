"""Who may come in: the gate before Studio's page, against a server that answers everything."""

import http.client
import socket
import socketserver
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from twin.errors import UsageError
from twin.training.server.gate import Gate


class Inside(socketserver.BaseRequestHandler):
    """Studio's stand-in: says yes, and echoes what a stream says."""

    def handle(self) -> None:
        head = self.request.recv(65536)
        if b"upgrade: websocket" in head.lower():
            self.request.sendall(b"HTTP/1.1 101 Switching Protocols\r\n\r\n")
            while piece := self.request.recv(65536):
                self.request.sendall(piece)
            return
        self.request.sendall(
            b"HTTP/1.1 200 OK\r\nContent-Length: 6\r\nConnection: close\r\n\r\ninside"
        )


class Server(socketserver.ThreadingMixIn, socketserver.UnixStreamServer):
    daemon_threads = True


@pytest.fixture
def inside(tmp_path) -> Iterator[Path]:
    path = tmp_path / "studio.sock"
    with Server(str(path), Inside) as server:
        thread = threading.Thread(target=server.serve_forever, daemon=True)
        thread.start()
        yield path
        server.shutdown()


def get(gate: Gate, path: str = "/", **headers: str) -> http.client.HTTPResponse:
    connection = http.client.HTTPConnection("127.0.0.1", gate.port, timeout=5)
    connection.request("GET", path, headers=headers)
    answer = connection.getresponse()
    answer.read()
    return answer


def own_addresses() -> list[str]:
    """Addresses by which others would reach this computer."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))  # Sends nothing: it only picks the way out.
        except OSError:
            return []
        address = probe.getsockname()[0]
    return [] if address.startswith(("127.", "0.")) else [address]


def test_a_browser_of_this_computer_comes_in(inside):
    with Gate(inside) as gate:
        assert gate.address == f"http://127.0.0.1:{gate.port}/"
        assert get(gate).status == 200
        assert get(gate, Origin=f"http://127.0.0.1:{gate.port}").status == 200


def test_nobody_listens_on_any_other_address(inside):
    with Gate(inside) as gate:
        get(gate)
        assert gate._socket.getsockname()[0] == "127.0.0.1"
        for address in [*own_addresses(), "127.0.0.2"]:
            with pytest.raises(OSError, match=r"refused|unreachable|timed out"):
                socket.create_connection((address, gate.port), timeout=2)


def test_other_sites_pages_are_turned_away(inside):
    with Gate(inside) as gate:
        assert get(gate, Origin="http://evil.example").status == 403
        assert get(gate, Host="evil.example").status == 403
        assert get(gate, "/state", Upgrade="websocket", Origin="https://evil.example").status == 403


def test_upload_and_roads_out_are_closed(inside):
    with Gate(inside) as gate:
        assert get(gate, "/drop").status == 404
        assert get(gate, "/drop?sid=1", Upgrade="websocket", Connection="Upgrade").status == 404
        for path in ("/../secret", "/assets/../../x", "/%2e%2e/x"):
            assert get(gate, path).status == 404


def test_an_open_host_needs_a_token(inside):
    with pytest.raises(UsageError, match="--token"):
        Gate(inside, host="0.0.0.0")  # noqa: S104 (that it is refused is the test)


def test_a_token_is_asked_for_and_remembered(inside):
    with Gate(inside, token="s3cret-ž") as gate:  # noqa: S106 (no secret of anybody)
        assert get(gate).status == 401
        assert get(gate, "/?token=guess").status == 401
        assert get(gate, "/state", Upgrade="websocket").status == 401
        answer = get(gate, "/?token=s3cret-%C5%BE")
        assert answer.status == 303
        assert "token=" not in (answer.getheader("Location") or "")
        cookie = (answer.getheader("Set-Cookie") or "").split(";")[0]
        assert get(gate, Cookie=cookie).status == 200
        assert get(gate, Cookie=f"twin_token_{gate.port}=wrong").status == 401


def test_a_taken_port_is_refused(inside):
    with Gate(inside) as gate, pytest.raises(UsageError, match=f"port {gate.port}"):
        Gate(inside, port=gate.port)


@pytest.mark.parametrize(
    "noise", [b"", b"\x00\xff" * 500, b"GET\r\n\r\n", b"POST / HTTP/1.1\r\n\r\n", b"A" * 200000]
)
def test_noise_does_not_stop_the_gate(inside, noise):
    with Gate(inside) as gate:
        with socket.create_connection(("127.0.0.1", gate.port), timeout=5) as line:
            try:
                line.sendall(noise)
                line.shutdown(socket.SHUT_WR)
                while line.recv(4096):
                    pass
            except OSError:
                pass  # It hung up on the noise.
        assert get(gate).status == 200


def test_a_stream_is_passed_on_both_ways_and_counted(inside):
    with Gate(inside) as gate:
        with socket.create_connection(("127.0.0.1", gate.port), timeout=5) as line:
            head = f"GET /ui?sid=1 HTTP/1.1\r\nHost: 127.0.0.1:{gate.port}\r\nUpgrade: websocket\r\n\r\n"
            line.sendall(head.encode())
            assert b"101" in line.recv(4096)
            line.sendall(b"frame")
            assert line.recv(4096) == b"frame"
            assert gate.heard == 1
        end = time.monotonic() + 5
        while get(gate).status != 200 and time.monotonic() < end:
            time.sleep(0.05)
        assert get(gate).status == 200


@pytest.mark.parametrize(("says", "given"), [(b"\x82frame", True), (b"\x88goodbye", False)])
def test_the_page_that_studio_opens_the_stream_to_has_the_panel(inside, says, given):
    with Gate(inside) as gate:
        assert not gate.has_panel
        with socket.create_connection(("127.0.0.1", gate.port), timeout=5) as line:
            host = f"Host: 127.0.0.1:{gate.port}"
            head = f"GET /ui?sid=1 HTTP/1.1\r\n{host}\r\nUpgrade: websocket\r\n\r\n"
            line.sendall(head.encode())
            assert b"101" in line.recv(4096)
            line.sendall(says)
            answer = b""
            while len(answer) < len(says):
                answer += line.recv(4096)
            assert answer == says
            assert gate.has_panel == given
        end = time.monotonic() + 5
        while gate.has_panel and time.monotonic() < end:
            time.sleep(0.01)
        assert not gate.has_panel


def test_two_gates_of_one_computer_keep_their_own_tokens(inside):
    first, second = Gate(inside, token="one"), Gate(inside, token="two")  # noqa: S106 (no secrets of anybody)
    assert first.port != second.port
    with first, second:
        jar = []
        for gate in (first, second):
            answer = get(gate, f"/?token={gate.token}")
            jar.append((answer.getheader("Set-Cookie") or "").split(";")[0])
        assert get(first, Cookie="; ".join(jar)).status == 200
        assert get(second, Cookie="; ".join(jar)).status == 200
        assert get(second, Cookie=jar[0]).status == 401


def test_a_second_request_on_the_same_line_is_not_passed_on(inside):
    with (
        Gate(inside) as gate,
        socket.create_connection(("127.0.0.1", gate.port), timeout=5) as line,
    ):
        request = f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{gate.port}\r\n\r\n"
        line.sendall((request + "GET /drop HTTP/1.1\r\nHost: x\r\n\r\n").encode())
        answer = b""
        while piece := line.recv(4096):
            answer += piece
        assert answer.count(b"HTTP/1.1") == 1
