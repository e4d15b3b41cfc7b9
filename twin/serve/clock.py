"""The twin's clock: it starts at the time of day and may run faster."""

import datetime as dt
import time


class Clock:
    """Time of day as the twin sees it."""

    def __init__(self, speed: float = 1.0) -> None:
        """Start.

        Args:
            speed: Seconds of the twin for each second of the day.
        """
        self._speed = speed
        self._began = dt.datetime.now(dt.UTC)
        self._since = time.monotonic()

    def elapsed_s(self) -> float:
        """Seconds of the twin since the start."""
        return (time.monotonic() - self._since) * self._speed

    def at(self, elapsed_s: float) -> str:
        """ISO 8601 in UTC, to the microsecond.

        Args:
            elapsed_s: Seconds of the twin since the start.
        """
        moment = self._began + dt.timedelta(seconds=elapsed_s)
        return moment.strftime("%Y-%m-%dT%H:%M:%S.%fZ")

    def now(self) -> str:
        """The twin's time, ISO 8601 in UTC."""
        return self.at(self.elapsed_s())
