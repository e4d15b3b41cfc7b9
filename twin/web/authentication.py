"""Authentication: a token for each role, kept as a cookie; guesses are rate limited.

A token is behind the ``#`` of an address, which browsers tell no server: so it is in no log and
in no referrer. The page hands it in once and gets a cookie that no script can read: a pass that is
derived from the token, so that whoever has it is known again by a server that was started again with
the same tokens.

A token of 128 bits cannot be guessed, so that the right one is let in whatever else has come: a class
behind one address is not kept out by what one pupil tries.
"""

import hashlib
import hmac
import http.cookies
import secrets
import time
from collections import deque
from collections.abc import Iterable, Mapping

TOKEN_BYTES = 16
"""128 bits."""
GUESSES = 10
"""Wrong tokens within ``GUESSES_S`` that are answered as wrong; further ones have to wait."""
GUESSES_S = 60.0


def new_tokens(roles: Iterable[str]) -> dict[str, str]:
    """A token for each role that nobody can guess."""
    return {role: secrets.token_urlsafe(TOKEN_BYTES) for role in roles}


class Authentication:
    """Checks tokens and cookies of roles."""

    def __init__(self, tokens: Mapping[str, str], port: int, *, encrypted: bool = False) -> None:
        """Take the tokens.

        Args:
            tokens: By the name of the role, which is the first part of its pages' paths.
            port: Of the server: browsers share cookies between ports.
            encrypted: Whether the pages are served over https. Safari keeps no ``Secure`` cookie that
                came over http, not even from this computer.
        """
        self._secure = " Secure;" if encrypted else ""
        self.tokens = dict(tokens)
        self._port = port
        self._passes = {role: _pass_of(role, token) for role, token in tokens.items()}
        self._wrong: deque[float] = deque(maxlen=GUESSES)

    @property
    def rate_limited(self) -> bool:
        """Too many wrong tokens within ``GUESSES_S``."""
        return len(self._wrong) == GUESSES and time.monotonic() - self._wrong[0] < GUESSES_S

    def admit(self, role: str, token: str) -> str | None:
        """Look at a token.

        Returns:
            The cookie's header where it is right, else None.
        """
        if not _same(self.tokens.get(role, ""), token):
            if not self.rate_limited:
                self._wrong.append(time.monotonic())
            return None
        known = self._passes[role]
        return (
            f"{self._cookie(role)}={known}; Path=/{role};{self._secure} HttpOnly; SameSite=Strict"
        )

    def knows(self, role: str, cookies: str) -> bool:
        """Whether a request's cookies show that it comes from a browser with this role."""
        jar = http.cookies.SimpleCookie()
        try:
            jar.load(cookies)
        except http.cookies.CookieError:
            return False
        name = self._cookie(role)
        return name in jar and _same(self._passes.get(role, ""), jar[name].value)

    def _cookie(self, role: str) -> str:
        return f"twin_{self._port}_{role}"


def _pass_of(role: str, token: str) -> str:
    return hmac.new(token.encode(), f"pass of {role}".encode(), hashlib.sha256).hexdigest()


def _same(known: str, given: str) -> bool:
    return bool(known) and secrets.compare_digest(known.encode(), given.encode())
