"""The machine's panel: its mode switch, dials, switches, stop button and MDI line, as the operator has set them."""

import dataclasses
from typing import Literal

from twin.training.scene.scene_file import Mode, StartTable

Dial = Literal["feed", "rapid", "spindle"]
Switch = Literal["optional_stop", "block_skip", "dry_run"]
FULL = 100
"""An override dial that changes nothing [%]."""


@dataclasses.dataclass(slots=True)
class Panel:
    """What is set at the panel; other files read it and call its methods.

    Attributes:
        feed_override: Feed override dial [%].
        rapid_override: Rapid override dial [%].
        spindle_override: Spindle override dial [%].
        optional_stop: M1 stops.
        dry_run: All feeds are replaced by that of the dry run.
    """

    mode: Mode
    feed_override: int = FULL
    rapid_override: int = FULL
    spindle_override: int = FULL
    optional_stop: bool = False
    block_skip: bool = False
    dry_run: bool = False
    stop_pressed: bool = False
    entered: str = ""

    @classmethod
    def at_start(cls, start: StartTable) -> "Panel":
        """The panel as a scene begins with it."""
        return cls(start.mode, start.feed_override, start.rapid_override)

    def select(self, mode: Mode) -> None:
        """Turn the mode switch."""
        self.mode = mode

    def turn_dial(self, dial: Dial, percent: int) -> None:
        """Set an override [%]."""
        setattr(self, f"{dial}_override", percent)

    def reset_dials(self) -> None:
        """Set all overrides to 100 %."""
        self.feed_override = self.rapid_override = self.spindle_override = FULL

    def turn_switch(self, switch: Switch, *, on: bool) -> None:
        """Turn a switch on or off."""
        setattr(self, switch, on)

    def press_stop(self, *, pressed: bool) -> None:
        """Press the emergency stop button, or turn it free."""
        self.stop_pressed = pressed

    def enter(self, text: str) -> None:
        """Type a block into the MDI line."""
        self.entered = text
