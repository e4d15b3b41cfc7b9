"""The variables of a running program: those that all of it shares, and those of each call."""

import math
from collections.abc import Callable


class Variables:
    """Values by name; NaN: a program has taken it away."""

    def __init__(
        self,
        is_local: Callable[[str], bool],
        given: Callable[[str], float | None],
        *,
        vacant: bool = False,
    ) -> None:
        """Without variables.

        Args:
            is_local: Whether calls have a variable of that name of their own.
            given: The job's value of a variable, or None.
            vacant: A program can take the value of a variable away, so that the job's is what the main
                program's variable begins with; else it counts wherever the program has set none.
        """
        self._is_local = is_local
        self._given = given
        self._vacant = vacant
        self._local_names: dict[str, bool] = {}
        self._common: dict[str, float] = {}
        self._calls: list[dict[str, float]] = [{}]

    def _values(self, name: str) -> dict[str, float]:
        local = self._local_names.get(name)
        if local is None:
            local = self._local_names[name] = self._is_local(name)
        return self._calls[-1] if local else self._common

    def read(self, name: str) -> float | None:
        """The value of a variable; where the program has set none the job's, or None."""
        values = self._values(name)
        value = values.get(name)
        if value is None:
            begins = not self._vacant or values is self._common or values is self._calls[0]
            return self._given(name) if begins else None
        return value if value == value else None

    def write(self, name: str, value: float) -> None:
        """Set a variable."""
        self._values(name)[name] = value

    def forget(self, name: str) -> None:
        """Take a variable's value away."""
        self._values(name)[name] = math.nan

    def enter(self) -> None:
        """A call begins that has variables of its own."""
        self._calls.append({})

    def leave(self) -> None:
        """It has ended."""
        self._calls.pop()
