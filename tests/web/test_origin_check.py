"""Who may come in: hosts, origins, tokens, cookies, and what every answer says to the browser."""

import contextlib
import http.client
import re
from typing import NamedTuple

import pytest
from starlette.responses import PlainTextResponse

from twin.errors import UsageError
from twin.web import authentication
from twin.web.authentication import Authentication, new_tokens
from twin.web.origin_check import OriginCheck
from twin.web.server import WebServer

GUESS = "guess"


async def inside(scope, receive, send) -> None:
    await PlainTextResponse(f"inside as {scope['twin_role']}")(scope, receive, send)


class Answer(NamedTuple):
    status: int
    content: str
    headers: dict[str, str]


class House:
    def __init__(self, *, framed: bool = False) -> None:
        self.server = WebServer()
        self.authentication = Authentication(new_tokens(("operator", "watcher")), self.server.port)
        self.server.start(OriginCheck(inside, self.authentication, local=True, framed=framed))
        self.own = f"http://127.0.0.1:{self.server.port}"

    def ask(self, path="/operator/", method="GET", body=None, **headers):
        line = http.client.HTTPConnection("127.0.0.1", self.server.port, timeout=10)
        with contextlib.closing(line):
            line.request(method, path, body=body, headers=headers)
            answer = line.getresponse()
            return Answer(
                answer.status,
                answer.read().decode(),
                {name.lower(): value for name, value in answer.getheaders()},
            )

    def enter(self, role="operator", token=None, **headers):
        token = self.authentication.tokens[role] if token is None else token
        return self.ask(f"/enter/{role}", "POST", token, **({"Origin": self.own} | headers))

    def cookie(self, role="operator") -> str:
        return self.enter(role).headers["set-cookie"].split(";")[0]


@pytest.fixture
def house():
    opened = House()
    yield opened
    opened.server.stop()


def test_a_token_of_128_bits_is_made_anew_for_each_role_and_session(house):
    tokens = list(house.authentication.tokens.values())
    assert len(set(tokens)) == 2
    assert all(re.fullmatch(r"[\w-]{22}", token) for token in tokens)
    again = Authentication(new_tokens(("operator", "watcher")), house.server.port)
    assert not set(tokens) & set(again.tokens.values())


def test_without_a_token_there_is_only_the_page_that_hands_one_in(house):
    answer = house.ask()
    assert answer.status == 200
    assert "enter.js" in answer.content
    assert "inside" not in answer.content
    for path in ("/operator/scene.json", "/", "/nobody/", "/operator", "/view/view.js"):
        assert house.ask(path).status == 401


def test_a_token_is_handed_in_once_and_kept_where_no_script_reads_it(house):
    answer = house.enter()
    assert answer.status == 204
    kept = answer.headers["set-cookie"]
    assert house.authentication.tokens["operator"] not in kept
    for word in ("HttpOnly", "SameSite=Strict", "Path=/operator"):
        assert word in kept
    cookie = kept.split(";")[0]
    assert house.ask(Cookie=cookie).content == "inside as operator"
    assert house.ask("/watcher/x", Cookie=cookie).status == 401
    assert house.ask("/operator/x", Cookie=cookie[:-1] + "!").status == 401


@pytest.mark.parametrize("origin", ["null", "http://evil.example", "https://127.0.0.1", "file://"])
def test_other_sites_pages_and_frames_without_origin_are_turned_away(house, origin):
    cookie = house.cookie()
    assert house.enter(Origin=origin).status == 403
    assert house.ask(Origin=origin, Cookie=cookie).status == 403
    stream = {"Upgrade": "websocket", "Connection": "Upgrade", "Cookie": cookie,
              "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==", "Sec-WebSocket-Version": "13"}  # fmt: skip
    assert house.ask("/operator/stream", **stream, Origin=origin).status == 403
    assert house.ask("/operator/stream", **stream).status == 403


def test_a_name_that_is_not_this_computers_is_refused(house):
    assert house.ask(Host="evil.example").status == 403
    assert house.ask(Host=f"evil.example:{house.server.port}").status == 403
    # Through ssh -L the port is another one.
    assert house.ask(Host="localhost:9999").status == 200


def test_guesses_are_braked_and_keep_nobody_out_who_has_the_token(house, monkeypatch):
    cookie = house.cookie()
    for _ in range(authentication.GUESSES):
        assert house.enter(token=GUESS).status in (401, 429)
    assert house.enter(token=GUESS).status == 429
    assert house.enter().status == 204
    assert house.enter(token=GUESS).status == 429
    assert house.ask(Cookie=cookie).status == 200
    monkeypatch.setattr(authentication, "GUESSES_S", 0.0)
    assert house.enter(token=GUESS).status == 401


def test_every_answer_tells_the_browser_to_trust_nobody_else(house):
    for answer in (house.ask(), house.ask(Cookie=house.cookie()), house.ask("/x"), house.enter()):
        policy = answer.headers["content-security-policy"]
        assert "default-src 'none'" in policy
        assert "unsafe" not in policy
        assert answer.headers.get("referrer-policy") == "no-referrer"
        assert answer.headers.get("x-frame-options") == "DENY"
        assert answer.headers.get("x-content-type-options") == "nosniff"
        assert answer.headers.get("server") is None


def test_pages_of_this_computer_alone_may_hold_one_that_only_shows():
    opened = House(framed=True)
    try:
        headers = opened.ask(Cookie=opened.cookie()).headers
    finally:
        opened.server.stop()
    policy = headers["content-security-policy"].split("; ")
    assert "frame-ancestors http://localhost:* http://127.0.0.1:*" in policy
    assert "default-src 'none'" in policy
    assert "x-frame-options" not in headers


@pytest.mark.parametrize("method", ["PUT", "DELETE", "TRACE", "OPTIONS"])
def test_only_reading_and_handing_in_a_token_are_possible(house, method):
    assert house.ask(method=method, Cookie=house.cookie()).status == 405


def test_a_host_that_others_reach_needs_a_certificate():
    with pytest.raises(UsageError, match="certificate"):
        WebServer("0.0.0.0")  # noqa: S104 (that it is refused is the test)


def test_a_taken_port_is_refused(house):
    with pytest.raises(UsageError, match=f"port {house.server.port}"):
        WebServer(port=house.server.port)


@pytest.mark.parametrize("encrypted", [False, True])
def test_a_cookie_is_secure_where_the_line_is(encrypted):
    authentication = Authentication(new_tokens(("operator",)), 1, encrypted=encrypted)
    cookie = authentication.admit("operator", authentication.tokens["operator"])
    assert cookie is not None
    # Safari drops a Secure cookie that came over http, also from this computer.
    assert ("; Secure" in cookie) == encrypted
