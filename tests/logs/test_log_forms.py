"""Every form of log comes to the same columns."""

import json
from pathlib import Path

import numpy as np
import pytest

from twin.compare.tracks import read_track
from twin.errors import ConfigError, UsageError
from twin.logs.column_map import read_column_map
from twin.logs.machine_log import MachineLog, read_machine_log

TIME = np.arange(0.0, 0.5, 0.004)
COMMAND = 20.0 * TIME**2
ACTUAL = COMMAND - 0.16 * TIME

MAP = """
[columns]
{time}
[columns.X]
command = {{ column = {command}, unit = "mm" }}
actual = {{ column = {actual}, unit = "mm" }}
"""


def write(tmp_path: Path, text: str, name: str = "log.csv") -> Path:
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


def mapped(tmp_path: Path, log: Path, *, command: str, actual: str, time: str = "") -> MachineLog:
    text = MAP.format(time=time, command=command, actual=actual)
    return read_machine_log(log, read_column_map(write(tmp_path, text, "map.toml")))


def holds(log: MachineLog) -> None:
    assert log.time - log.time[0] == pytest.approx(TIME, abs=1e-9)
    assert log.axes["X"].command == pytest.approx(COMMAND, abs=1e-5)
    assert log.axes["X"].actual == pytest.approx(ACTUAL, abs=1e-5)


def comma(value: float) -> str:
    return f"{value:.6f}".replace(".", ",")


def test_a_scope_of_twincat_with_decimal_commas_and_a_time_per_group(tmp_path: Path):
    head = (
        "Name;Scope Project\nFile;C:\\trace.svdx\nStarttime of export;133000000000000000;;\n\n"
        "Name;Command;Actual;Name;Torque\nSymbolName;Axes.X.SetPos;Axes.X.ActPos;SymbolName;T\n"
        "SampleTime[ms];4;4;SampleTime[ms];8\n\n"
    )
    rows = [
        f"{comma(1e3 * t)};{comma(c)};{comma(a)};"
        + (f"{comma(1e3 * t)};1,5" if i % 2 == 0 else ";")
        for i, (t, c, a) in enumerate(zip(TIME, COMMAND, ACTUAL, strict=True))
    ]
    log = write(tmp_path, head + "\n".join(rows) + "\nEOF\n")
    holds(mapped(tmp_path, log, command='"Axes.X.SetPos"', actual='"Actual"'))


@pytest.mark.parametrize(("flags", "tick"), [(32, 1e-6), (16, 1e-3), (36, 1e-6)])
def test_a_trace_of_codesys_counts_as_its_flags_say(tmp_path: Path, flags: int, tick: float):
    def block(number: int, name: str, values: np.ndarray) -> str:
        rows = [f"; {round(t / tick)}; {v:.6f}" for t, v in zip(TIME, values, strict=True)]
        return f"{number}.Variable; {name}\n{number}.Data; \n" + "\n".join(rows) + "\n"

    text = f"[key]; [value]\nIecTaskName; MainTask\nFlags; {flags}\n"
    text += block(0, "PLC.X.fSetPosition", COMMAND) + block(1, "PLC.X.fActPosition", ACTUAL)
    log = write(tmp_path, text)
    holds(mapped(tmp_path, log, command='"PLC.X.fSetPosition"', actual='"PLC.X.fActPosition"'))


def test_a_trace_of_codesys_that_does_not_say_what_it_counts_needs_a_map(tmp_path: Path):
    text = "[key]; [value]\n0.Variable; X_command_mm\n; 0; 1\n; 4; 2\n"
    text += "1.Variable; X_actual_mm\n; 0; 1\n; 4; 2\n"
    log = write(tmp_path, text)
    with pytest.raises(UsageError, match="Flags do not say"):
        read_machine_log(log)
    found = mapped(
        tmp_path, log, command='"X_command_mm"', actual='"X_actual_mm"', time='time = {unit = "ms"}'
    )
    assert found.time.tolist() == [0.0, 0.004]


def test_a_trace_of_sinumerik_operate(tmp_path: Path):
    records = "".join(
        f'<rec time="{t:.4f}" f1="{c:.6f}" f2="{a:.6f}"/>'
        for t, c, a in zip(TIME, COMMAND, ACTUAL, strict=True)
    )
    text = (
        '<?xml version="1.0"?><traceSession><traceData><dataFrame><frameHeader>'
        '<dataSignal name="/Nck/!SD/nckServoDataDesPos[1]" description="Set X"/>'
        '<dataSignal name="/Nck/!SD/nckServoDataActPos[1]" description="Actual X"/></frameHeader>'
        f"{records}</dataFrame></traceData></traceSession>"
    )
    log = write(tmp_path, text, "trace.xml")
    holds(mapped(tmp_path, log, command='"Set X"', actual='"Actual X"'))


def test_a_capture_of_sinumerik_edge_names_its_axes_and_its_cycle(tmp_path: Path):
    header = {
        "CycleTimeMs": 4,
        "SignalListHFData": [
            {"Name": "CYCLE", "Axis": "Cycle", "Address": "CYCLE"},
            {"Name": "DES_POS", "Axis": "X1", "Address": "DES_POS|1"},
            {"Name": "CTRL_DIFF", "Axis": "X1", "Address": "CTRL_DIFF|1"},
        ],
    }
    rows = np.column_stack([np.arange(7, 7 + len(TIME)), COMMAND, COMMAND - ACTUAL]).tolist()
    half = len(rows) // 2
    payload = [{"HFData": rows[:half]}, {"HFBlockEvent": {}}, {"HFData": rows[half:]}]
    log = write(tmp_path, json.dumps({"Header": header, "Payload": payload}), "capture.json")
    text = """
    [columns.X]
    command = { column = "DES_POS|1", unit = "mm" }
    following_error = { column = "CTRL_DIFF|X1", unit = "mm" }
    """
    holds(read_machine_log(log, read_column_map(write(tmp_path, text, "map.toml"))))


def test_the_sampler_of_linuxcnc_has_no_headings(tmp_path: Path):
    rows = [f"{i} {c:.6f} {a:.6f}" for i, (c, a) in enumerate(zip(COMMAND, ACTUAL, strict=True))]
    log = write(tmp_path, "\n".join(rows) + "\n", "samples.txt")
    holds(mapped(tmp_path, log, command="2", actual="3", time="period = 0.004"))


def test_a_table_under_a_preamble_with_a_row_of_units(tmp_path: Path):
    rows = [f"{t:.4f}\t{c:.6f}\t{a:.6f}" for t, c, a in zip(TIME, COMMAND, ACTUAL, strict=True)]
    text = "Oscilloscope export\nMachine\t4711\n\ntime\tX_command\tX_actual\n[s]\t[mm]\t[mm]\n"
    log = write(tmp_path, text + "\n".join(rows) + "\n")
    holds(read_machine_log(log, units_needed=True))


def test_scale_offset_unit_and_known_delay_of_a_column(tmp_path: Path):
    rows = [f"{t * 1e3:.4f},{c / 25.4:.9f},{a * 1e3 - 7.0:.9f},{5 * i}" for i, (t, c, a) in
            enumerate(zip(TIME, COMMAND, ACTUAL, strict=True))]  # fmt: skip
    log = write(tmp_path, "t,a,b,c\n" + "\n".join(rows) + "\n")
    text = """
    [columns]
    time = { column = "t", unit = "ms" }
    [columns.X]
    command = { column = "a", unit = "in" }
    actual = { column = "b", unit = "um", offset = 7.0 }
    force = { column = "c", unit = "kN", scale = 2.0, delay_s = -0.004 }
    """
    found = read_machine_log(log, read_column_map(write(tmp_path, text, "map.toml")))
    holds(found)
    force = found.axes["X"].more["force"]
    assert force[:3].tolist() == pytest.approx([10e3, 20e3, 30e3])


def test_headings_without_units_are_asked_for_with_a_map_to_fill_in(tmp_path: Path):
    log = write(tmp_path, "time_s,X_commanded,X_actual\n0,1,2\n1,2,3\n")
    with pytest.raises(UsageError, match=r'(?s)in which unit.*command = \{ column = "X_commanded"'):
        read_machine_log(log, units_needed=True)
    assert list(read_machine_log(log).axes) == ["X"]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("[columns.X]\ncommand = 'a'\n", "columns.X: 'command'"),
        ("[columns.X]\ncommand = {column='a', unit='mm'}\n", "either 'actual' or"),
        ("[columns]\nX = 3\n", "columns.X must be a table"),
        ("period = -1\n[columns.X]\ncommand = 1\n", "'period' must be"),
        ("[colums.X]\n", "unknown key 'colums'"),
        ("[columns.X]\ncommand={column='a',unit='mm'}\nactua={column='b',unit='mm'}\n", "actual"),
        ("[columns.X]\ncommand={column='a',unit='mm',scale='2'}\n", "columns.X"),
    ],
)
def test_a_wrong_map_is_refused_with_its_key(tmp_path: Path, text: str, told: str):
    with pytest.raises(ConfigError, match=told):
        read_column_map(write(tmp_path, text, "map.toml"))


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (('"X_c"', '"mm"'), "did you mean 'X_cmd'"),
        (('"X_cmd"', '"furlong"'), "no unit of position"),
        (('"X_cmd"', '"deg"'), "one of a linear axis"),
        (("9", '"mm"'), "no column '9'"),
    ],
)
def test_a_map_that_does_not_fit_its_log_is_refused(
    tmp_path: Path, change: tuple[str, str], told: str
):
    log = write(tmp_path, "t,X_cmd,X_act\n0,1,2\n1,2,3\n")
    text = (
        f"[columns]\ntime={{column='t'}}\n[columns.X]\ncommand={{column={change[0]},"
        f"unit={change[1]}}}\nactual={{column='X_act',unit='mm'}}\n"
    )
    with pytest.raises(UsageError, match=told):
        read_machine_log(log, read_column_map(write(tmp_path, text, "map.toml")))


@pytest.mark.parametrize(
    ("name", "text", "told"),
    [
        ("a.json", '{"Header": {}}', "SignalListHFData"),
        ("a.json", "{", "not a capture"),
        ("a.xml", "<a><b></a>", "not XML"),
        ("a.xml", "<a/>", "no dataSignal"),
        ("a.csv", "[key]; [value]\nFlags; 32\n", "without a recorded variable"),
        ("a.csv", "Name;A\nSymbolName;B\n", "rows of properties|no time column"),
        ("a.csv", "a\0b", "no text"),
        ("a.csv", "a,b\n0,1,2,5\n0,2,2,6\n", "row 1 of the values has 4: are its decimals written"),
        ("a.csv", "a,b\n1,2\n3\n", "each with 2 values; row 2 of the values has 1"),
    ],
)
def test_what_is_no_log_is_refused_with_the_reason(tmp_path: Path, name: str, text: str, told: str):
    with pytest.raises(UsageError, match=told):
        read_machine_log(write(tmp_path, text, name))


def test_compare_reads_a_trace_of_codesys(tmp_path: Path):
    blocks = "".join(
        f"{number}.Variable; {name}\n; 0; 1.0\n; 4000; 2.0\n"
        for number, name in enumerate(["X_command", "X_actual"])
    )
    track = read_track(write(tmp_path, "[key]; [value]\nFlags; 32\n" + blocks))
    assert track.commanded.tolist() == [[1.0], [2.0]]
    assert track.time.tolist() == [0.0, 0.004]
