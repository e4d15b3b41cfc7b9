"""Spindle and coolant, which a program's auxiliary functions switch as well as the operator."""

import dataclasses

from twin.nc.canonical import Function
from twin.nc.functions import COOLANT_OFF, COOLANT_ON, PROGRAM_ENDS, SpindleState


class Auxiliaries:
    """What M functions switch; other files read it and call its methods.

    Attributes:
        running_down: The spindle, stopped by a reset, still turns while the axes brake.
    """

    def __init__(self, spindle: SpindleState) -> None:
        self.spindle = spindle
        self.running_down = False
        self.coolant = False

    def turn(self, state: SpindleState) -> None:
        """Change what the spindle is commanded."""
        self.spindle = state

    def mount(self, tool_speed: float | None) -> None:
        """A tool has come into the spindle for which the job has a speed [1/min], or none."""
        self.spindle = dataclasses.replace(self.spindle, tool_speed=tool_speed)

    def switch_coolant(self, *, on: bool) -> None:
        """Open or close the coolant."""
        self.coolant = on

    def follow(self, function: Function) -> None:
        """Switch the coolant as a function of the program says."""
        if function.word in COOLANT_ON:
            self.coolant = True
        elif function.word in COOLANT_OFF | PROGRAM_ENDS:
            self.coolant = False

    def stop(self) -> None:
        """Stop the spindle and close the coolant, as an alarm and a reset do.

        LinuxCNC closes the coolant with every abort (iocontrol, EMC_TOOL_ABORT).
        """
        self.spindle = self.spindle.stopped()
        self.coolant = False

    def reset(self, *, axes_move: bool) -> None:
        """Stop both; while the axes still brake, the spindle runs down and cuts."""
        self.running_down = axes_move and self.spindle.turns
        self.stop()

    def run_down(self, *, axes_move: bool) -> None:
        """After a slice: the spindle counts as standing once the axes stand."""
        self.running_down = self.running_down and axes_move

    @property
    def edges_stand(self) -> bool:
        """Whether the tool does not turn, so that it must not cut."""
        return not self.spindle.turns and not self.running_down
