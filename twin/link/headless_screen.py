#!/usr/bin/python3
"""Stands in for LinuxCNC's screen: switches the machine on, runs a program and leaves.

LinuxCNC starts it, with the Python that LinuxCNC's modules are installed for, not with the twin's;
so it imports nothing of the twin. What happened it writes as JSON, line by line.

Usage: ``headless_screen.py -ini INI --program PROGRAM --joints N --twin PID --log FILE``.
"""

import argparse
import json
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TextIO

ANSWER_S = 60.0
"""How long LinuxCNC may take to carry out a command [s]."""
PAUSE_S = 0.02


class FailedError(Exception):
    """LinuxCNC does not carry out a command, or stopped."""


class LinuxcncClient:
    """Operates LinuxCNC through its own Python module."""

    def __init__(self, linuxcnc: Any, log: TextIO, twin: int) -> None:
        self._linuxcnc = linuxcnc
        self._log = log
        self._twin = twin
        self._command, self._status = linuxcnc.command(), linuxcnc.stat()
        self._errors = linuxcnc.error_channel()
        self._failed = False

    def tell(self, event: str, text: str = "") -> None:
        """Write a line of the log."""
        print(json.dumps({"event": event, "text": text}), file=self._log, flush=True)

    def switch_on(self, joints: int) -> None:
        """Reset the emergency stop, switch on and take the encoders' positions."""
        linuxcnc, command, status = self._linuxcnc, self._command, self._status
        command.state(linuxcnc.STATE_ESTOP_RESET)
        self._wait("reset", lambda: status.task_state >= linuxcnc.STATE_ESTOP_RESET)
        command.state(linuxcnc.STATE_ON)
        self._wait("switch on", lambda: status.task_state == linuxcnc.STATE_ON)
        for joint in range(joints):
            command.home(joint)
        self._wait("home", lambda: all(status.homed[:joints]))

    def run(self, program: str) -> None:
        """Run a program to its end.

        Raises:
            FailedError: The machine stopped before.
        """
        linuxcnc, command, status = self._linuxcnc, self._command, self._status
        command.mode(linuxcnc.MODE_AUTO)
        command.wait_complete()
        command.program_open(program)
        command.wait_complete()
        command.set_optional_stop(False)
        command.auto(linuxcnc.AUTO_RUN, 0)
        self.tell("running")
        began = time.monotonic()
        while True:
            self._look()
            status.poll()
            if status.task_state != linuxcnc.STATE_ON:
                time.sleep(10 * PAUSE_S)
                self._look()
                raise FailedError("the machine is off")
            if status.interp_state == linuxcnc.INTERP_PAUSED:
                self._go_on()
                continue
            idle = status.interp_state == linuxcnc.INTERP_IDLE and status.inpos
            if idle and time.monotonic() - began > 10 * PAUSE_S:
                break
            time.sleep(PAUSE_S)
        self._look()
        if self._failed:
            raise FailedError("LinuxCNC reported an error")

    def _go_on(self) -> None:
        """Press cycle start where the program waits for somebody who does: at M0, M1 or M60."""
        linuxcnc, status = self._linuxcnc, self._status
        line = status.current_line
        self.tell(
            "message",
            f"after line {line} the program stops (M0, M1 or M60); there is no operator, so it continues",
        )
        self._command.auto(linuxcnc.AUTO_RESUME)
        self._wait("go on", lambda: status.interp_state != linuxcnc.INTERP_PAUSED)

    def _wait(self, what: str, done: Callable[[], bool]) -> None:
        end = time.monotonic() + ANSWER_S
        while time.monotonic() < end:
            self._look()
            self._status.poll()
            if done():
                return
            time.sleep(PAUSE_S)
        raise FailedError(f"LinuxCNC does not {what}")

    def _look(self) -> None:
        """Log what LinuxCNC says."""
        while (report := self._errors.poll()) is not None:
            kind, text = report
            wrong = kind in (self._linuxcnc.NML_ERROR, self._linuxcnc.OPERATOR_ERROR)
            self.tell("error" if wrong else "message", text.strip())
            self._failed = self._failed or wrong
        if not self._any_twin():
            raise FailedError("the twin has gone")

    def _any_twin(self) -> bool:
        try:
            os.kill(self._twin, 0)
        except ProcessLookupError:
            return False
        except PermissionError:
            return True  # It is somebody else's, and there.
        return True


def main() -> int:
    """Run a program and leave; the exit code."""
    import linuxcnc

    parser = argparse.ArgumentParser()
    parser.add_argument("-ini")
    parser.add_argument("--program", required=True)
    parser.add_argument("--joints", type=int, required=True)
    parser.add_argument("--twin", type=int, required=True)
    parser.add_argument("--log", type=Path, required=True)
    given = parser.parse_args()
    with given.log.open("w", encoding="utf-8") as log:
        operator = LinuxcncClient(linuxcnc, log, given.twin)
        try:
            operator.switch_on(given.joints)
            operator.run(given.program)
        except FailedError as error:
            operator.tell("failed", str(error))
            return 1
        operator.tell("finished")
        return 0


if __name__ == "__main__":
    sys.exit(main())
