"""A run that is told part after part, and the command that serves it."""

import asyncio
import os
import shutil
import signal
import subprocess
import sys
import urllib.request
from collections.abc import Iterator
from itertools import takewhile
from pathlib import Path

import numpy as np
import pytest

from twin.recording.alarms import Alarm
from twin.recording.reader import open_recording
from twin.run.preparing.preparation import prepare
from twin.run.progress import no_progress
from twin.run.run import Run
from twin.serve.agent import Agent, Clock
from twin.serve.buffer import Condition
from twin.serve.device import device_of
from twin.serve.playback import BEFORE_START_S, TICK_S, Production, Tick, coolant_of, feed, ticks

PROGRAM = """N1 X0 Y0 Z0 C0 G00
N2 G01 F1500
N3 G01 X20 Y5 C30
N4 G02 X0 Y5 I-10 J0
N5 M30
"""


@pytest.fixture(scope="module")
def production(tmp_path_factory: pytest.TempPathFactory) -> Production:
    folder = tmp_path_factory.mktemp("serve")
    program = folder / "part.nc"
    program.write_text(PROGRAM, encoding="utf-8")
    run = Run(prepare(program, dialect="mefi"))
    outcome = run.execute(folder, no_progress)
    return Production(
        machine=run.preparation.machine,
        program="part.nc",
        source=run.preparation.source.lines,
        summary=run.dry_run.summary,
        recording=folder / "recording.h5",
        alarms=outcome.alarms,
    )


def one_part(machine: Iterator[Tick]) -> list[Tick]:
    """From one start to the next end."""
    next(tick for tick in machine if tick.values.get("execution") == "ACTIVE")
    return list(takewhile(lambda tick: "execution" not in tick.values, machine))


def test_each_part_is_made_by_the_recorded_motion(production: Production):
    machine = ticks(production)
    first, second = one_part(machine), one_part(machine)
    assert [tick.values for tick in first] == [tick.values for tick in second]
    steps = np.diff([tick.elapsed_s for tick in first])
    assert steps == pytest.approx(np.full(len(steps), TICK_S))
    assert production.recording is not None
    with open_recording(production.recording) as recording:
        every = round(TICK_S / recording.header.period_s)
        joint = recording.column("joint/position")[::every]
    told = [[tick.values[f"{axis}_position"] for axis in "XYZC"] for tick in first]
    assert np.array(told, np.float64) == pytest.approx(joint, abs=1e-6)


def test_the_recording_is_opened_once(production: Production, tmp_path: Path):
    """Clients may have taken all the files that the process may open."""
    assert production.recording is not None
    copy = Path(shutil.copy(production.recording, tmp_path / "copy.h5"))
    machine = ticks(production._replace(recording=copy))
    first = one_part(machine)
    copy.unlink()
    assert len(one_part(machine)) == len(first)


def test_feed_and_block_are_those_of_the_program(production: Production):
    circle = [tick.values for tick in one_part(ticks(production)) if tick.values["line"] == "4"]
    assert {values["block"] for values in circle} == {"N4 G02 X0 Y5 I-10 J0"}
    middle = circle[len(circle) // 2]
    assert float(str(middle["path_feedrate"])) == pytest.approx(1500.0 / 60.0, rel=0.001)


def test_coolant_flows_from_its_word_to_the_end(tmp_path: Path):
    program = tmp_path / "wet.nc"
    program.write_text("N1 G01 X1 F600\nN2 M8\nN3 X2\nN4 X3\nN5 M9\nN6 X4\nN7 M7\nN8 X5\nN9 M30\n")
    run = Run(prepare(program, dialect="gost"))
    coolant = coolant_of(run.dry_run.program.chunks())
    assert [coolant.at(move) for move in range(-1, 6)] == [
        False,
        False,
        True,
        True,
        False,
        True,
        False,
    ]


def test_an_alarm_is_a_fault_until_somebody_resets_it(production: Production):
    alarm = Alarm("soft-limit", 3, 0.25, "X", "X would leave its travel")
    machine = ticks(production._replace(recording=None, alarms=(alarm,)))
    told: list[tuple[object, object]] = []
    at = []
    while len(told) < 8:
        tick = next(machine)
        if "system" in tick.values or "execution" in tick.values:
            told.append((tick.values.get("execution"), tick.values.get("system")))
            at.append(tick.elapsed_s)
    fault = Condition("Fault", "soft-limit", "X would leave its travel")
    assert told[:3] == [("READY", Condition("Normal")), ("ACTIVE", None), ("STOPPED", fault)]
    assert told[3:6] == told[:3]
    assert at[2] == pytest.approx(BEFORE_START_S + 0.25)


class HandWoundClock(Clock):
    """A clock that goes on when it is told to."""

    wound_s = 0.0

    def elapsed_s(self) -> float:
        return self.wound_s


def test_busy_clients_do_not_hold_the_machine_up(
    production: Production, monkeypatch: pytest.MonkeyPatch
):
    """Every round of answers takes half a second, in which fifty ticks become due."""
    monkeypatch.setattr("twin.serve.playback._WAKE_S", 0.0)
    clock = HandWoundClock()
    agent = Agent(device_of("mill", production.machine.axes), clock, "made up")

    async def observe() -> None:
        feeding = asyncio.create_task(feed(agent, ticks(production)))
        for _ in range(40):
            clock.wound_s += 0.5
            await asyncio.sleep(0)
        feeding.cancel()

    asyncio.run(observe())
    assert clock.wound_s - agent.observed_s < 2.0


@pytest.mark.seconds("a process of the command runs a program")
def test_the_command_prints_its_address_and_ends_on_request(tmp_path: Path):
    program = tmp_path / "part.nc"
    program.write_text(PROGRAM, encoding="utf-8")
    command = [sys.executable, "-m", "twin", "serve", str(program), "--dialect", "mefi"]
    with subprocess.Popen(
        [*command, "--speed", "5"], stdout=subprocess.PIPE, text=True, env=os.environ
    ) as process:
        assert process.stdout is not None
        address = process.stdout.readline().strip()
        try:
            assert address.startswith("http://127.0.0.1:")
            with urllib.request.urlopen(address + "current", timeout=20) as answer:  # noqa: S310 (own server)
                document = answer.read().decode()
            assert "<Availability" in document
            assert "part.nc</Program>" in document
        finally:
            process.send_signal(signal.SIGINT)
        assert process.wait(timeout=30) == 0
