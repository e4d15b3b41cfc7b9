"""Who may come in: a token of its own for each role, kept as a cookie; a brake on guesses.

A token stands behind the ``#`` of an address, which browsers tell no server: so it is in no log and
in no referrer. The page hands it in once and gets a cookie that no script can read.

A token of 128 bits cannot be guessed, so that the right one is let in whatever else has come: a class
behind one address is not kept out by what one pupil tries.
"""

import http.cookies
import secrets
import time
from collections import OrderedDict, deque
from collections.abc import Sequence

TOKEN_BYTES = 16
"""128 bits."""
GUESSES = 10
"""Wrong tokens within ``GUESSES_S`` that are told to be wrong; then all are told to wait."""
GUESSES_S = 60.0
MOST_PASSES = 512
"""Browsers that are remembered; of more the ones that came first must show their token again."""


class Doorkeeper:
    """Knows the roles and who has which.

    Attributes:
        tokens: By role, made anew for every session.
    """

    def __init__(self, roles: Sequence[str], port: int, *, encrypted: bool = False) -> None:
        """Make the tokens.

        Args:
            roles: Names of the roles; each is the first part of its pages' paths.
            port: Of the server: browsers share cookies between ports.
            encrypted: Whether the pages are served over https. Safari keeps no ``Secure`` cookie that
                came over http, not even from this computer.
        """
        self._secure = " Secure;" if encrypted else ""
        self.tokens = {role: secrets.token_urlsafe(TOKEN_BYTES) for role in roles}
        self._port = port
        self._passes: OrderedDict[str, str] = OrderedDict()
        self._wrong: deque[float] = deque(maxlen=GUESSES)

    @property
    def braked(self) -> bool:
        """Whether too many wrong tokens have come of late."""
        return len(self._wrong) == GUESSES and time.monotonic() - self._wrong[0] < GUESSES_S

    def admit(self, role: str, token: str) -> str | None:
        """Look at a token.

        Returns:
            The cookie's header where it is right, else None.
        """
        known = self.tokens.get(role, "")
        if not known or not secrets.compare_digest(known.encode(), token.encode()):
            if not self.braked:
                self._wrong.append(time.monotonic())
            return None
        key = secrets.token_urlsafe(TOKEN_BYTES)
        self._passes[key] = role
        while len(self._passes) > MOST_PASSES:
            self._passes.popitem(last=False)
        return f"{self._cookie(role)}={key}; Path=/{role};{self._secure} HttpOnly; SameSite=Strict"

    def knows(self, role: str, cookies: str) -> bool:
        """Whether a request's cookies show that it comes from a browser with this role."""
        jar = http.cookies.SimpleCookie()
        try:
            jar.load(cookies)
        except http.cookies.CookieError:
            return False
        name = self._cookie(role)
        return name in jar and self._passes.get(jar[name].value) == role

    def _cookie(self, role: str) -> str:
        return f"twin_{self._port}_{role}"
