"""A cluster that does not answer is told at once, before Ray waits for it."""

import socket
import threading

import pytest

from twin import ray_cluster
from twin.errors import UsageError

pytest.importorskip("ray", reason="the extra 'cluster' is not installed")
pytestmark = pytest.mark.processes
"""What brings Ray is set up for these kinds of tests alone: among the others it would be skipped everywhere."""


def test_an_address_that_nobody_answers_is_refused_with_what_would_have_worked(monkeypatch):
    monkeypatch.setattr(ray_cluster, "ANSWERED_S", 0.2)
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
        with pytest.raises(UsageError, match=r"timed out.*ray start --head"):
            ray_cluster.connected(f"127.0.0.1:{port}")

        def answer_as_a_web_server() -> None:
            line, _ = listener.accept()
            line.recv(100)
            line.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n")
            line.close()

        listener.accept()[0].close()  # What timed out.
        threading.Thread(target=answer_as_a_web_server, daemon=True).start()
        with pytest.raises(UsageError, match="is not Ray"):
            ray_cluster.connected(f"ray://127.0.0.1:{port}")
    with pytest.raises(UsageError, match=r"refused.*--cluster local"):
        ray_cluster.connected(f"127.0.0.1:{port}")
