"""Open pages and the panel: many pages, one panel. A page asks for the panel and is given it."""

import dataclasses
import itertools
import time
from typing import Any

MOST_PAGES = 40
"""Pages that may be open at a time."""
KEPT_FREE = 8
"""Of them those that no watcher takes, so that operators and trainers can always connect."""
MESSAGES, MESSAGES_PER_S = 150.0, 75.0
"""How many messages a page may send at once, and how many it may send in the long run."""


@dataclasses.dataclass
class OpenPage:
    """An open page.

    Attributes:
        role: ``operator``, ``trainer`` or ``watcher``.
    """

    number: int
    role: str
    _left: float = MESSAGES
    _heard: float = dataclasses.field(default_factory=time.monotonic)

    def within_rate_limit(self) -> bool:
        """Rate limit not exceeded; counts one message."""
        now = time.monotonic()
        self._left = min(MESSAGES, self._left + MESSAGES_PER_S * (now - self._heard))
        self._heard = now
        self._left -= 1.0
        return self._left >= 0.0


class Connections:
    """The pages that are open, and which of the operators' has the panel."""

    def __init__(self) -> None:
        self._numbers = itertools.count(1)
        self._pages: dict[int, OpenPage] = {}
        self._holder: int | None = None
        self._asking: list[int] = []

    def open(self, role: str) -> OpenPage | None:
        """A page is opened; None where there are too many."""
        most = MOST_PAGES - (KEPT_FREE if role == "watcher" else 0)
        if len(self._pages) >= most:
            return None
        page = OpenPage(next(self._numbers), role)
        self._pages[page.number] = page
        if role == "operator" and self._holder is None:
            self._holder = page.number
        return page

    def close(self, page: OpenPage) -> None:
        """A page is closed; the panel goes to who asked for it first, else to any operator."""
        self._pages.pop(page.number, None)
        self._asking = [number for number in self._asking if number != page.number]
        if self._holder == page.number:
            operators = [one.number for one in self._pages.values() if one.role == "operator"]
            self._give(next(iter(self._asking or operators), None))

    def allows(self, page: OpenPage, command: Any) -> bool:
        """Whether a page may give a command: the emergency stop may be pressed by all who act."""
        if page.role == "trainer" or page.number == self._holder:
            return True
        stop = isinstance(command, dict) and command.get("do") == "emergency_stop"
        return page.role == "operator" and stop and command.get("pressed", True) is True

    def hand_over(self, page: OpenPage, what: str) -> None:
        """Ask for the panel, give it to who asks, or keep it."""
        if page.role != "operator":
            return
        if what == "ask" and page.number != self._holder and page.number not in self._asking:
            self._asking.append(page.number)
            if self._holder is None:
                self._give(page.number)
        elif what == "give" and page.number == self._holder and self._asking:
            self._give(self._asking[0])
        elif what == "keep" and page.number == self._holder:
            self._asking.clear()

    def _give(self, number: int | None) -> None:
        self._holder = number
        self._asking = [one for one in self._asking if one != number]

    def count(self, role: str) -> int:
        """How many pages of a role are open."""
        return sum(page.role == role for page in tuple(self._pages.values()))

    def words(self, page: OpenPage) -> dict[str, Any]:
        """What a page shows of the connections."""
        roles = [one.role for one in self._pages.values()]
        return {
            "role": page.role,
            "has_panel": page.number == self._holder,
            "panel_taken": self._holder is not None,
            "asked": page.number in self._asking,
            "somebody_asks": page.number == self._holder and bool(self._asking),
            "pages": {role: roles.count(role) for role in sorted(set(roles))},
        }
