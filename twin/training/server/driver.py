"""Keeps the machine's time with the wall clock, on a thread that lives as long as the room."""

import contextlib
import dataclasses
import queue
import threading
import time
import traceback
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, TypeVar

from twin.errors import TwinError
from twin.processor import release_precedence, take_precedence
from twin.training.room.room import Room
from twin.training.session.log import Who
from twin.training.session.session import SceneSession
from twin.training.session.snapshot import Snapshot

ResultT = TypeVar("ResultT")

SHORTEST_REST_S = 0.001
"""What the machine always leaves to the server between two looks at the clock [s]."""
MOST_BEHIND_S = 1.0
"""How far machine time may fall behind the wall's before it is given up, and shown as lost [s]."""
CAUGHT_UP_AT_ONCE_S = 0.1
"""Machine time that is caught up between two looks at the machine [s]; what is asked meanwhile interrupts it."""
REPLAY_SPEED = 4.0
"""Times faster than it was, a session is shown again."""
HELD_S = 0.1
"""A key counts as let go when its page has not said for so long that it is held [s]."""
SHOWN_EVERY_S = 0.03
"""Between two looks at the machine for the pages [s]."""
RESTING_S, SHOWN_AT_REST_S = 0.1, 0.25
"""Between two turns, and two looks for the pages, while the machine rests [s]; what is asked ends the wait."""


@dataclasses.dataclass(frozen=True, slots=True)
class Look:
    """The machine as the pages show it.

    Attributes:
        lost_s: Wall-clock time by which the machine is behind so far [s].
        trouble: What went wrong outside the machine, as with the results' folder.
    """

    now: Snapshot
    lost_s: float
    trouble: str


class Driver:
    """Steps a session and does what the pages ask for.

    Attributes:
        speed: Machine time per wall-clock time.
        lost_s: Wall-clock time by which the machine is behind so far [s].
        trouble: Reports what is wrong outside the machine; empty: nothing.
        noted: Called with the session before each look at it; reports what is wrong with what it keeps.
        look: The last look at the machine.
    """

    def __init__(self, session: SceneSession, changed: Callable[[], None] = lambda: None) -> None:
        """Prepare a session.

        Args:
            changed: Called after each request.
        """
        self.session = session
        self.speed = 1.0
        self.lost_s = 0.0
        self.trouble: Callable[[], str] = str
        self.noted: Callable[[SceneSession], str] = lambda _session: ""
        self._changed = changed
        self._questions: queue.SimpleQueue[tuple[Callable[[Room], Any], Future[Any]]] = (
            queue.SimpleQueue()
        )
        self._asked: queue.SimpleQueue[tuple[Any, Who, int]] = queue.SimpleQueue()
        self._wake = threading.Event()
        self._over = threading.Event()
        self._beats: dict[int, float] = {}
        self._holder: int | None = None
        self._owed_s = 0.0
        self._kept_up = 1.0
        self._shown = -1.0
        self.look = Look(session.snapshot(), 0.0, "")

    @property
    def seen(self) -> Room:
        """The room that the pages see: the machine's, or that of a replay."""
        replay = self.session.replay
        return self.session.room if replay is None else replay.room

    def ask(self, command: Any, who: Who, page: int) -> None:
        """Ask for a command, from any thread.

        Args:
            command: As plain data.
            page: Number of the page that it comes from.
        """
        self._beats[page] = time.perf_counter()
        self._asked.put((command, who, page))
        self._wake.set()

    def inquire(self, question: Callable[[Room], ResultT]) -> "Future[ResultT]":
        """Ask the machine something, from any thread: answered on its own between two slices.

        Args:
            question: Quickly answered; changes nothing.
        """
        answer: Future[ResultT] = Future()
        self._questions.put((question, answer))
        self._wake.set()
        return answer

    def change(
        self, session: SceneSession, changed: Callable[[], None], trouble: Callable[[], str]
    ) -> "Future[None]":
        """Play another session from the next slice on, from any thread.

        Args:
            trouble: What is wrong outside the machine.
        """

        def take_over(_room: Room) -> None:
            self.session, self._changed, self.trouble = session, changed, trouble
            self.lost_s = self._owed_s = 0.0
            self._holder, self._shown = None, -1.0

        return self.inquire(take_over)

    def beat(self, page: int) -> None:
        """Note that a page's key is still held."""
        self._beats[page] = time.perf_counter()

    def leave(self, page: int) -> None:
        """Release the key of a page that is gone."""
        self._beats.pop(page, None)
        self._wake.set()

    def stop(self) -> None:
        """End ``serve``, which runs on another thread."""
        self._over.set()
        self._wake.set()

    def serve(self, *, promptly: bool = False) -> None:
        """Let time go on until the room is stopped.

        Args:
            promptly: Whether to ask the system for precedence: a press must not wait for what
                draws on the same cores. A machine that loses time gives it back, so that its
                pages do not stand still.
        """
        precedes = promptly and take_precedence()
        wall = time.perf_counter()
        while not self._over.is_set():
            now = time.perf_counter()
            passed, wall = now - wall, now
            self._step(passed)
            if precedes and self.lost_s > 0.0:
                precedes = False
                release_precedence()
            due = self.session.room.slice_s - self._owed_s - (time.perf_counter() - now)
            self._wake.wait(RESTING_S if self._rests else max(due / self.speed, SHORTEST_REST_S))
            self._wake.clear()
        if precedes:
            release_precedence()

    @property
    def _rests(self) -> bool:
        """Whether nothing that is shown changes but the clock."""
        session = self.session
        return session.replay is None and (session.frozen or session.room.rest.lasts)

    def _step(self, passed: float) -> None:
        """One turn; whatever goes wrong in it becomes an alarm."""
        try:
            if self._rests:
                # What has passed was rest; what is asked begins now.
                self._go_on(passed)
                passed = 0.0
            self._do_what_was_asked()
            self._answer()
            self._let_go_of_lost_keys()
            self._go_on(passed)
        except TwinError as error:
            self.session.room.fail(str(error))
        except Exception as error:  # noqa: BLE001 (a class loses its room by whatever ends this thread)
            where = traceback.extract_tb(error.__traceback__)[-1]
            self.session.room.fail(f"{type(error).__name__}: {error} ({where.name})")
        every_s = SHOWN_AT_REST_S if self._rests else SHOWN_EVERY_S
        if time.perf_counter() - self._shown >= every_s:
            self._shown = time.perf_counter()
            self.look = Look(
                dataclasses.replace(self.session.snapshot(), speed=self._kept_up),
                self.lost_s,
                self.noted(self.session) or self.trouble(),
            )

    def _do_what_was_asked(self) -> None:
        done = False
        with contextlib.suppress(queue.Empty):
            while True:
                command, who, page = self._asked.get_nowait()
                done = True
                accepted = self.session.submit(command, who)
                if accepted and _moves_while_held(command):
                    # From here on: what it took to begin the motion is no silence of the page.
                    self._holder = page
                    self._beats[page] = time.perf_counter()
        if done:
            self._shown = -1.0
            self._changed()

    def _answer(self) -> None:
        """Answer what was inquired of the machine; errors go to who asked."""
        with contextlib.suppress(queue.Empty):
            while True:
                question, answer = self._questions.get_nowait()
                try:
                    answer.set_result(question(self.session.room))
                except Exception as error:  # noqa: BLE001 - the asker's, never the machine's
                    answer.set_exception(error)

    def _let_go_of_lost_keys(self) -> None:
        """Dead man's key: what moves while a key is held stops when its page falls silent."""
        if self._holder is None:
            return
        last_beat = self._beats.get(self._holder, -1.0)
        if self.session.room.slot.running != "jog":
            self._holder = None
        elif time.perf_counter() - last_beat > HELD_S:
            self._holder = None
            self.session.submit({"do": "jog_stop"})
            self._changed()

    def _go_on(self, passed: float) -> None:
        session = self.session
        if session.replay is not None:
            session.replay.advance(REPLAY_SPEED * min(passed, CAUGHT_UP_AT_ONCE_S))
            if session.replay.over:
                session.submit({"do": "end_replay"}, "trainer")
            self._owed_s = 0.0
            return
        if session.frozen:
            self._owed_s = 0.0
            return
        slice_s = session.room.slice_s
        self._owed_s += self.speed * passed
        kept = min(self._owed_s, self.speed * MOST_BEHIND_S)
        self.lost_s += self._owed_s - kept
        share = kept / self._owed_s if self._owed_s > 0.0 else 1.0
        self._kept_up += 0.02 * (self.speed * share - self._kept_up)
        gone, most = 0, int(min(kept, self.speed * CAUGHT_UP_AT_ONCE_S) / slice_s)
        while gone < most and (
            gone == 0 or self._rests or (self._asked.empty() and self._questions.empty())
        ):
            session.advance()
            gone += 1
        self._owed_s = kept - gone * slice_s


def _moves_while_held(command: Any) -> bool:
    return isinstance(command, dict) and command.get("do") == "jog" and command.get("step") is None
