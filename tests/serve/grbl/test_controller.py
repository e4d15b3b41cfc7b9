"""A control that speaks Grbl, driven by hand over the machine of a shipped job."""

import random
import re

import pytest

from twin.files.shipped import resource_root
from twin.run.preparing.preparation import prepare
from twin.serve.grbl import stream
from twin.serve.grbl.controller import GrblController
from twin.training.room.room import Room
from twin.training.scene.scene_file import Scene, scene_of_job

WELCOME = "Grbl 1.1h ['$' for help]"
START_Z = -445.0
"""Where the shipped job's machine is first, 60 mm over its part zero [mm]."""


@pytest.fixture(scope="module")
def scene() -> Scene:
    return scene_of_job("grbl", prepare(resource_root("programs") / "grbl" / "box_lid.toml"))


class Bench:
    """A machine and its control; time goes on as the test says."""

    def __init__(self, scene: Scene) -> None:
        self.room = Room(scene)
        self.control = GrblController(self.room)

    def send(self, data: bytes, slices: int = 0) -> list[str]:
        """What is answered to bytes within so many slices of time."""
        out = self.control.work(self.room, data)
        for _ in range(slices):
            self.room.advance()
            out += self.control.work(self.room)
        return [line for line in out.decode().split("\r\n") if line]

    def settle(self) -> list[str]:
        """What is answered until the machine is at rest."""
        lines: list[str] = []
        for _ in range(3000):
            lines += self.send(b"", 1)
            if self.room.slot.run is None and not self.room.machine.moving and self.state != "Home":
                return lines
        raise AssertionError("the machine never stands")

    @property
    def state(self) -> str:
        return self.send(b"?")[0].strip("<>").split("|")[0]

    @property
    def place(self) -> tuple[float, ...]:
        found = re.search(r"MPos:([-.,0-9]+)", self.send(b"?")[0])
        assert found is not None
        return tuple(map(float, found[1].split(",")))


@pytest.fixture
def bench(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> Bench:
    monkeypatch.setattr(stream, "QUIET_S", 0.0)
    return Bench(scene)


def test_a_line_is_answered_moves_and_comes_to_rest(bench: Bench) -> None:
    assert bench.send(b"G21G90\ng0 x10 y5 (there)\n") == ["ok", "ok"]
    bench.settle()
    assert bench.place == (10.0, 5.0, START_Z)
    assert bench.state == "Idle"


def test_reports_are_those_of_grbl(bench: Bench) -> None:
    assert bench.send(b"$G\n") == ["[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]", "ok"]
    assert bench.send(b"?") == ["<Idle|MPos:0.000,0.000,-445.000|FS:0,0|WCO:0.000,0.000,-505.000>"]
    settings = bench.send(b"$$\n")
    assert settings[-1] == "ok"
    assert all(re.fullmatch(r"\$\d+=[\d.]+", line) for line in settings[:-1])
    assert bench.send(b"$10=2\n$110=30000\n$110=5\n") == ["ok", "ok", "error:3"]
    assert "|WPos:0.000,0.000,60.000|Bf:640,128|" in bench.send(b"?")[0]
    parameters = bench.send(b"$#\n")
    assert parameters[0] == "[G54:0.000,0.000,-505.000]"
    assert parameters[-2:] == ["[PRB:0.000,0.000,0.000:0]", "ok"]


@pytest.mark.parametrize(
    ("line", "number"),
    [
        ("X", 2), ("GO X1", 2), ("G0 X1 X2", 25), ("G1 X1", 22), ("G81 X1", 20), ("M6", 20), ("G0 A5", 20),
        ("G0 G1 X1", 21), ("G0 G92 X1", 24), ("G2 X5 F100", 35), ("G2 X50 R1 F100", 34),
        ("G2 X5 I1 F100", 33), ("G53 G2 X1 R1 F9", 30), ("G92", 26), ("G0 X1 P2", 36), ("G4", 28),
        ("G4 P-1", 4), ("G1 X1 F-5", 4), ("T300", 38), ("G80\nX1", 31), ("$J=X1", 22),
        ("$J=G2X1F9", 16), ("$J=X9999F100", 15), ("$Q", 3), ("$999=1", 3), ("?", 0), ("%", 1),
        ("G1 X" + "1" * 80, 11),
    ],
)  # fmt: skip
def test_wrong_lines_have_grbls_codes_and_leave_no_trace(
    bench: Bench, line: str, number: int
) -> None:
    before = bench.send(b"$G\n")
    answers = bench.send(f"{line}\n".encode(), 8)
    assert answers[-1] == (f"error:{number}" if number else "ok")
    if not line.startswith("G80"):
        assert bench.send(b"$G\n", 3) == before


def test_hold_and_start(bench: Bench) -> None:
    bench.send(b"G1 X30 F3000\n", 30)
    assert bench.state == "Run"
    bench.send(b"!", 40)
    assert bench.state == "Hold:0"
    held = bench.place
    bench.send(b"", 20)
    assert bench.place == held
    bench.send(b"~")
    bench.settle()
    assert bench.place[0] == 30.0


def test_a_jog_is_cancelled_and_changes_nothing_that_is_in_force(bench: Bench) -> None:
    bench.send(b"G1 F500\n", 3)
    before = bench.send(b"$G\n")
    assert bench.send(b"$J=G91 G20 X2 F100\n", 20)[-1] == "ok"
    assert bench.state == "Jog"
    assert bench.send(b"G0 X1\n") == ["error:9"]
    bench.send(b"\x85")
    bench.settle()
    assert 0.0 < bench.place[0] < 50.8
    assert bench.send(b"$G\n") == before


def test_the_end_of_travel_is_alarm_2_until_reset_and_unlock(bench: Bench) -> None:
    answers = bench.send(b"G0 X900\n", 60)
    assert "ALARM:2" in answers
    assert bench.state == "Alarm"
    assert bench.send(b"$X\n") == []
    assert bench.send(b"\x18") == [WELCOME, "[MSG:'$H'|'$X' to unlock]"]
    assert bench.send(b"G0 X1\n") == ["error:9"]
    assert bench.send(b"$X\n") == ["[MSG:Caution: Unlocked]", "ok"]
    assert bench.place[0] == 0.0


def test_a_reset_while_axes_move_is_alarm_3(bench: Bench) -> None:
    bench.send(b"G0 X100\n", 30)
    assert bench.send(b"\x18")[:2] == ["ALARM:3", WELCOME]
    bench.send(b"", 100)
    assert bench.send(b"$H\n")[-1] == "[MSG:Caution: Unlocked]"
    assert bench.state == "Home"


def test_what_the_part_says_is_alarm_3_with_its_name(bench: Bench) -> None:
    answers = bench.send(b"G0 Z-5\n", 200)
    assert "ALARM:3" in answers
    assert any("rapid-into-stock" in line for line in answers)


@pytest.mark.seconds("an axis is driven along its travel")
def test_homing_answers_when_it_is_done(bench: Bench) -> None:
    assert bench.send(b"$H\n", 3) == []
    assert bench.state == "Home"
    lines = bench.settle()
    while not lines:
        lines = bench.send(b"", 10)
    assert lines == ["ok"]
    assert bench.place == (0.0, 0.0, 0.0)


def test_check_mode_reads_and_moves_nothing(bench: Bench) -> None:
    answers = bench.send(b"$C\nG1 X5 F100\nG7\n$C\n", 2)
    assert answers == ["[MSG:Enabled]", "ok", "ok", "error:20", "ok", "[MSG:Disabled]", WELCOME]
    assert bench.place[0] == 0.0


def test_what_is_in_force_stays_from_one_run_to_the_next(bench: Bench) -> None:
    bench.send(b"G91 G1 X5 F2000\n", 5)
    bench.settle()
    bench.send(b"G92 X0\nG55\nG10 L2 P2 X3\nX5\n", 5)
    bench.settle()
    assert bench.place[0] == 10.0
    assert bench.send(b"$G\n")[0].startswith("[GC:G1 G55 G17 G21 G91 G94")


def test_the_end_of_a_program_puts_back_and_a_stop_waits(bench: Bench) -> None:
    bench.send(b"G91 M3 S1000\nG1 X2 F3000\nM0\nX2\n", 200)
    assert bench.state == "Hold:0"
    assert bench.place[0] == 2.0
    bench.send(b"~", 5)
    bench.settle()
    assert bench.place[0] == 4.0
    assert bench.send(b"M30\n", 5)[-2:] == ["[MSG:Pgm End]", "ok"]
    assert bench.send(b"$G\n")[0] == "[GC:G1 G54 G17 G21 G90 G94 M5 M9 T0 F3000 S1000]"


def test_overrides_change_at_once(bench: Bench) -> None:
    bench.send(b"G1 X100 F3000\n", 60)
    bench.send(b"\x92" * 5, 60)
    assert bench.room.panel.feed_override == 50
    bench.send(b"\x90\x97")
    assert (bench.room.panel.feed_override, bench.room.panel.rapid_override) == (100, 25)


@pytest.mark.seconds("hundreds of lines go to a machine that runs")
def test_a_stream_is_one_motion_however_its_bytes_are_cut(scene: Scene) -> None:
    lines = [b"G21G90\n", b"G1F3000\n", *(f"X{i % 7}Y{i / 20:.2f}\n".encode() for i in range(60))]
    taken = []
    for size in (1, 17, 127):
        bench = Bench(scene)
        text, oks = b"".join(lines), 0
        while text:
            most = min(size, bench.control.serial.free)
            oks += bench.send(text[:most], 1 if most == 0 else 0).count("ok")
            text = text[most:]
        oks += bench.settle().count("ok")
        assert oks == len(lines)
        assert bench.place[:2] == (3.0, 2.95)
        taken.append(bench.room.time_s)
    assert max(taken) - min(taken) < 0.5


@pytest.mark.parametrize("seed", range(3))
def test_nonsense_never_takes_the_control_down(bench: Bench, seed: int) -> None:
    draw = random.Random(seed)  # noqa: S311 (a test of any bytes)
    words = [
        b"G0",
        b"X5",
        b"F200",
        b"\n",
        b"$J=",
        b"?",
        b"!",
        b"~",
        b"\x18",
        b"\x85",
        b"$H",
        b"$X\n",
    ]
    for _ in range(60):
        data = b"".join(draw.choice(words) for _ in range(6))
        bench.send(draw.randbytes(40) if draw.random() < 0.3 else data, 1)
    bench.send(b"\x18", 200)
    bench.send(b"\x18$X\n", 3)
    assert bench.send(b"$G\n")[-1] == "ok"
    assert bench.state == "Idle"
