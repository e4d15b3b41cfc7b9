"""The viewer in a notebook's cell."""

import http.server
import threading
from collections.abc import Iterator

import pytest
from panel_player import browser

import twin

pytestmark = pytest.mark.browser


@pytest.fixture
def notebook() -> Iterator[tuple[int, list[str]]]:
    """A server of one page: its port, and what stands on it."""
    pages: list[str] = []

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(pages[-1].encode())

        def log_message(self, format: str, *args: object) -> None:  # noqa: A002 - its base calls it so
            """Say nothing."""

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield server.server_port, pages
    server.shutdown()
    server.server_close()


def test_a_cell_shows_the_viewer(notebook: tuple[int, list[str]]):
    port, pages = notebook
    with twin.run("G1 X5. F600.\nM30", dialect="haas").show() as viewer, browser() as opened:
        pages.append(f"<body>{viewer._repr_html_()}</body>")
        page = opened.new_page(viewport={"width": 900, "height": 800})
        page.goto(f"http://localhost:{port}/")
        frame = page.frame_locator("iframe")
        frame.locator("body[data-ready=yes]").wait_for()
        assert "X" in frame.locator("#axes").inner_text()
