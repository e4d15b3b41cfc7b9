"""What somebody at the gate asks for."""

import urllib.parse

OPERATOR_STREAM = "/ui"
STREAMS = (OPERATOR_STREAM, "/state")
"""The page's two streams: what the operator does and sees, and where the machine stands."""


class RequestHead:
    """The head of a request, as far as the gate looks at it.

    Attributes:
        valid: It asks to read something, in a form that is understood.
        path: What it asks for.
        token: What it shows to come in; empty for nothing.
        headers: Its fields by their names in small letters.
    """

    def __init__(self, head: bytes) -> None:
        """Read it.

        Args:
            head: All lines up to the empty one (RFC 9112).
        """
        first, *rest = head.decode("latin-1").split("\r\n")
        parts = first.split(" ")
        self.valid = len(parts) == 3 and parts[0] == "GET" and parts[1].startswith("/")
        split = urllib.parse.urlsplit(parts[1] if self.valid else "/")
        self.path = split.path
        self.token = urllib.parse.parse_qs(split.query).get("token", [""])[0]
        fields = (line.partition(":") for line in rest if ":" in line)
        self.headers = {name.strip().lower(): value.strip() for name, _, value in fields}

    @property
    def is_stream(self) -> bool:
        """Whether it opens one of the page's streams."""
        return self.path in STREAMS and self.headers.get("upgrade", "").lower() == "websocket"

    @property
    def wanted(self) -> bool:
        """Whether the page needs it: everything is but the upload, and roads out of the folder."""
        parts = urllib.parse.unquote(self.path).split("/")
        return self.path != "/drop" and ".." not in parts
