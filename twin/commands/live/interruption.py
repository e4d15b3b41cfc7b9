"""Ctrl+C in commands that run until they are interrupted."""

import contextlib
import signal
from collections.abc import Callable, Iterator


@contextlib.contextmanager
def stop_on_sigint(stop: Callable[[], None]) -> Iterator[list[int]]:
    """Stop on the first SIGINT or SIGTERM: the command ends regularly.

    The second interrupts whatever is being done, as everywhere else.

    Args:
        stop: Asks for the end; called between two steps of the main thread, so it may not wait.

    Yields:
        The signals that came.
    """
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    came: list[int] = []

    def put_back() -> None:
        for number, handler in before.items():
            signal.signal(number, handler)

    def asked(number: int, _: object) -> None:
        came.append(number)
        put_back()
        stop()

    for number in before:
        signal.signal(number, asked)
    try:
        yield came
    finally:
        put_back()
